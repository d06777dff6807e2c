//! Lights and sound.

use cordlib::board::{Beeper, Lights};
use pic32mx3_hal::gpio::{ErasedPin, Level, Output, Pin};
use pic32mx3_hal::pwm::{PwmChannel, PwmTimer};
use pic32mx3_hal::timer::{Prescaler, Timer};
use rvac_units::{Frequency, Ratio};

use crate::logic::lamps::{Group, LIGHTS, LampLines, Lamps};
use crate::logic::tone::{ToneClock, tone};

const LINES: usize = 5;

/// Pins of the lights.
#[derive(Debug)]
pub struct LightPins {
    /// Lines 0 to 4: RE2 to RE6.
    pub lines: [ErasedPin<Output>; LINES],
    /// Supply of the first group: RA6.
    pub main: Pin<'A', 6, Output>,
    /// Supply of the second group: RG1.
    pub battery: Pin<'G', 1, Output>,
    /// LED_UNKNOWNS: a supply of unknown purpose, RG0, unless it is known to switch the emitters of the cliff sensors.
    pub unknown: Option<Pin<'G', 0, Output>>,
}

/// The eight lights, and as a ninth the supply of unknown purpose, so that its load can be found out.
#[derive(Debug)]
pub struct PanelLights {
    pins: LightPins,
    lamps: Lamps,
    dark: bool,
}

impl PanelLights {
    /// All off.
    #[must_use]
    pub fn take(pins: LightPins) -> Self {
        Self {
            pins,
            lamps: Lamps::default(),
            dark: true,
        }
    }

    /// Called once a millisecond: switches to the other group.
    pub fn service(&mut self) {
        if self.lamps.any() {
            let shown = self.lamps.change();
            self.show(shown);
            self.dark = false;
        } else if !self.dark {
            self.pins.main.set_low();
            self.pins.battery.set_low();
            self.write_lines(0);
            self.dark = true;
        }
    }

    /// Supplies off, lines set, supply on: so no line lights the other group.
    fn show(&mut self, shown: LampLines) {
        self.pins.main.set_low();
        self.pins.battery.set_low();
        self.write_lines(shown.lines);
        if shown.lines == 0 {
            return;
        }
        match shown.group {
            Group::Main => self.pins.main.set_high(),
            Group::Battery => self.pins.battery.set_high(),
        }
    }

    fn write_lines(&mut self, lines: u8) {
        for (number, pin) in self.pins.lines.iter_mut().enumerate() {
            let high = lines >> number & 1 == 1;
            pin.set_level(if high { Level::High } else { Level::Low });
        }
    }
}

impl Lights for PanelLights {
    const COUNT: u8 = LIGHTS + 1;

    fn set(&mut self, light: u8, brightness: Ratio) {
        if light == LIGHTS
            && let Some(supply) = &mut self.pins.unknown
        {
            let lit = brightness.millionths() != 0;
            supply.set_level(if lit { Level::High } else { Level::Low });
        }
        self.lamps.set(light, brightness);
    }
}

/// Pins of the sound's multiplexer, whose channel 7 is the speaker; the amplifier is switched on by `enable`.
#[derive(Debug)]
pub struct SoundPins {
    /// RA1, RF13, RC4: select lines A, B, C.
    pub select: (Pin<'A', 1, Output>, Pin<'F', 13, Output>, Pin<'C', 4, Output>),
    /// RD13.
    pub enable: Pin<'D', 13, Output>,
}

/// The tone generator: OC5 on Timer2.
pub type ToneChannel = PwmChannel<5, 2, Pin<'D', 4, Output>>;

/// The speaker.
#[derive(Debug)]
pub struct Speaker {
    channel: ToneChannel,
    enable: Pin<'D', 13, Output>,
    timer: PwmTimer<2>,
}

impl Speaker {
    /// Silent.
    #[must_use]
    pub fn take(timer: PwmTimer<2>, channel: ToneChannel, pins: SoundPins) -> Self {
        let SoundPins { select, enable } = pins;
        let (mut a, mut b, mut c) = select;
        a.set_high();
        b.set_high();
        c.set_high();
        let mut speaker = Self {
            channel,
            enable,
            timer,
        };
        speaker.silence();
        speaker
    }

    /// Timer2 as the time base of tones.
    #[must_use]
    pub fn time_base(timer: Timer<2>) -> PwmTimer<2> {
        PwmTimer::timer2(timer, Prescaler::By8, u32::from(u16::MAX))
    }
}

impl Beeper for Speaker {
    const PRESENT: bool = true;

    fn sound(&mut self, pitch: Frequency, volume: Ratio) {
        let Some(tone) = tone(pitch, volume) else {
            self.silence();
            return;
        };
        let prescaler = match tone.clock {
            ToneClock::By8 => Prescaler::By8,
            ToneClock::By64 => Prescaler::By64,
        };
        self.timer.restart(prescaler, u32::from(tone.period) + 1);
        self.channel.set_width(tone.compare);
        self.enable.set_high();
    }

    fn silence(&mut self) {
        self.channel.set_width(0);
        self.enable.set_low();
    }
}
