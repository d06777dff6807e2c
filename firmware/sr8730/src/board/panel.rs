//! Lights, display and sound.

use cordlib::board::{Beeper, Lights};
use pic32mx3_hal::gpio::{ErasedPin, Level, Output, Pin};
use pic32mx3_hal::pwm::{PwmChannel, PwmTimer};
use pic32mx3_hal::timer::{Prescaler, Timer};
use rvac_units::{Frequency, Ratio};

use crate::generated::pins::{self, Active, Signal};
use crate::generated::variant::{self, Display};
use crate::logic::display::{DIGITS, DisplayContent, PanelRound, SEGMENTS, Turn};
use crate::logic::lamps::{Group, LIGHTS};
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
    /// Those of the display, which stay off where none is fitted.
    pub display: DisplayPins,
}

/// Pins of the display beside the lines that it shares with the lights.
#[derive(Debug)]
pub struct DisplayPins {
    /// Commons in the order of [`COMMONS`].
    pub commons: [ErasedPin<Output>; DIGITS],
    /// The first two of [`COLUMNS`].
    pub segments: [ErasedPin<Output>; SEGMENTS - LINES],
    /// The colon.
    pub colon: Pin<'F', 1, Output>,
}

/// Commons of the digits.
const COMMONS: [Signal; DIGITS] = [
    pins::DISPLAY_DIGIT_1,
    pins::DISPLAY_DIGIT_2,
    pins::DISPLAY_DIGIT_3,
    pins::DISPLAY_DIGIT_4,
];

/// Lines that light segments: two of the display's own, then those of the lights.
const COLUMNS: [Signal; SEGMENTS] = [
    pins::DISPLAY_SEGMENT_A,
    pins::DISPLAY_SEGMENT_B,
    pins::LIGHT_LINE_0,
    pins::LIGHT_LINE_1,
    pins::LIGHT_LINE_2,
    pins::LIGHT_LINE_3,
    pins::LIGHT_LINE_4,
];

/// Which common each digit has, and which column each segment, if this variant of the robot has a display.
const PLACES: Option<([usize; DIGITS], [usize; SEGMENTS])> = match variant::DISPLAY {
    None => None,
    Some(display) => Some(places(&display)),
};

const fn places(display: &Display) -> ([usize; DIGITS], [usize; SEGMENTS]) {
    let (mut digits, mut segments) = ([0; DIGITS], [0; SEGMENTS]);
    let mut number = 0;
    while number < DIGITS {
        digits[number] = place(&COMMONS, display.digits[number]);
        number += 1;
    }
    number = 0;
    while number < SEGMENTS {
        segments[number] = place(&COLUMNS, display.segments[number]);
        number += 1;
    }
    (digits, segments)
}

/// Where a signal stands in a list; a variant that names another signal does not compile.
const fn place(list: &[Signal], wanted: Signal) -> usize {
    assert!(
        matches!(wanted.active, Active::High),
        "the line is on at the high level"
    );
    let mut number = 0;
    while number < list.len() {
        if list[number].port.index() == wanted.port.index() && list[number].bit == wanted.bit {
            return number;
        }
        number += 1;
    }
    panic!("the display is on another line");
}

/// The eight lights, as a ninth the supply of unknown purpose, so that its load can be found out, and the display.
#[derive(Debug)]
pub struct PanelLights {
    pins: LightPins,
    round: PanelRound,
    dark: bool,
}

impl PanelLights {
    /// All off.
    #[must_use]
    pub fn take(pins: LightPins) -> Self {
        Self {
            pins,
            round: PanelRound::default(),
            dark: true,
        }
    }

    /// What the display shows from now on, and whether its colon is lit; nothing where none is fitted.
    #[inline(never)]
    pub fn write(&mut self, content: DisplayContent, colon: bool) {
        if PLACES.is_some() {
            self.round.write(content.segments());
            self.pins.display.colon.set_level(level(colon));
        }
    }

    /// Called once a millisecond: switches to the other group, or to the next digit.
    pub fn service(&mut self) {
        if self.round.any() {
            let turn = self.round.change();
            self.show(turn);
            self.dark = false;
        } else if !self.dark {
            self.supplies_off();
            self.write_columns(0);
            self.dark = true;
        }
    }

    /// Supplies off, lines set, supply on: so no line lights another group or digit.
    fn show(&mut self, turn: Turn) {
        self.supplies_off();
        match turn {
            Turn::Lamps(shown) => {
                self.write_columns(shown.lines << (SEGMENTS - LINES));
                match shown.group {
                    _ if shown.lines == 0 => {}
                    Group::Main => self.pins.main.set_high(),
                    Group::Battery => self.pins.battery.set_high(),
                }
            }
            Turn::Digit { digit, segments } => self.show_digit(digit, segments),
        }
    }

    #[inline(never)]
    fn show_digit(&mut self, digit: usize, segments: u8) {
        let Some((digits, columns)) = &PLACES else { return };
        let lit = columns.iter().enumerate();
        let lit = lit.filter(|(segment, _)| segments >> segment & 1 == 1);
        self.write_columns(lit.fold(0, |lines, (_, column)| lines | 1 << column));
        let common = digits
            .get(digit)
            .and_then(|place| self.pins.display.commons.get_mut(*place));
        if let Some(common) = common.filter(|_| segments != 0) {
            common.set_level(Level::High);
        }
    }

    #[inline(never)]
    fn supplies_off(&mut self) {
        self.pins.main.set_low();
        self.pins.battery.set_low();
        for common in &mut self.pins.display.commons {
            common.set_level(Level::Low);
        }
    }

    /// Bit by number in [`COLUMNS`]. Copies of it in each caller would take half a kilobyte of flash.
    #[inline(never)]
    fn write_columns(&mut self, columns: u8) {
        let pins = self.pins.display.segments.iter_mut().chain(&mut self.pins.lines);
        for (number, pin) in pins.enumerate() {
            pin.set_level(level(columns >> number & 1 == 1));
        }
    }
}

const fn level(high: bool) -> Level {
    if high { Level::High } else { Level::Low }
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
        self.round.set(light, brightness, PLACES.is_some());
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
