//! The 10-bit converter: sampling, converting, scanning, alternating and its buffer.

use super::rate::{CountSpan, NEVER, Now, Rate};

const ON: u32 = 1 << 15;
const STOP_AFTER_SEQUENCE: u32 = 1 << 4;
const AUTO_SAMPLE: u32 = 1 << 2;
const SAMPLING: u32 = 1 << 1;
const DONE: u32 = 1 << 0;
const SCAN: u32 = 1 << 10;
const UPPER_FILLING: u32 = 1 << 7;
const HALVES: u32 = 1 << 1;
const ALTERNATE: u32 = 1 << 0;
const INTERNAL_CLOCK: u32 = 1 << 15;
/// A conversion takes this many TAD; general knowledge of the family.
const CONVERSION_TAD: u64 = 12;
/// TAD of the internal clock: about 250 ns by general knowledge.
const INTERNAL_HZ: u64 = 4_000_000;
/// The fastest conversion clock: TAD is at least 65 ns by general knowledge of the family.
const FASTEST_HZ: u64 = 1_000_000_000 / 65;

/// What ends sampling (SSRC).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Trigger {
    /// The program clears SAMP.
    Manual,
    /// An edge on INT0.
    External0,
    /// A match of timer 3.
    Timer3,
    /// SAMC, by itself.
    Auto,
    /// A reserved code: nothing ends it.
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AdcState {
    Idle,
    /// Until the trigger comes nothing says when it ends.
    Sampling(Option<Wait>),
    Converting {
        value: u16,
        wait: Wait,
    },
}

/// So many TAD from some moment on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Wait {
    span: CountSpan,
    tads: u64,
}

impl Wait {
    fn ends(&self) -> u64 {
        self.span.cycle_of(self.tads)
    }
}

/// Action of the ADC that is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AdcDue {
    Nothing,
    /// The level at this channel is held now.
    Hold(u8),
    /// A result is there.
    Result,
}

/// The registers and what is going on.
#[derive(Clone, Debug)]
pub(crate) struct AdcModule {
    control: [u32; 3],
    channels: u32,
    scan: u32,
    digital: u32,
    buffer: [u32; 16],
    state: AdcState,
    /// Results since the last interrupt.
    results: u32,
    upper_half: bool,
    /// The channel that is sampled, and where the scan goes on after it.
    channel: u8,
    scan_from: u32,
    second: bool,
}

impl AdcModule {
    pub(crate) fn new() -> AdcModule {
        AdcModule {
            control: [0; 3],
            channels: 0,
            scan: 0,
            digital: 0,
            buffer: [0; 16],
            state: AdcState::Idle,
            results: 0,
            upper_half: false,
            channel: 0,
            scan_from: 0,
            second: false,
        }
    }

    /// Port B pins that are analog inputs.
    pub(crate) fn analog_pins(&self) -> u16 {
        !u16::try_from(self.digital).unwrap_or(u16::MAX)
    }

    /// What ends sampling, while the converter is on.
    pub(crate) fn trigger_source(&self) -> Trigger {
        if self.control[0] & ON == 0 {
            return Trigger::None;
        }
        match self.control[0] >> 5 & 7 {
            0 => Trigger::Manual,
            1 => Trigger::External0,
            2 => Trigger::Timer3,
            7 => Trigger::Auto,
            _ => Trigger::None,
        }
    }

    /// Whether settings are in use that are not modelled: references other than the supply, or a negative input.
    pub(crate) fn has_other_reference(&self) -> bool {
        self.control[0] & ON != 0 && (self.control[1] >> 13 != 0 || self.channels & 0x8080_0000 != 0)
    }

    /// Whether TAD is shorter than the converter can do.
    pub(crate) fn is_too_fast(&self, peripheral: Rate) -> bool {
        self.control[0] & ON != 0 && self.clock(peripheral).hz() > FASTEST_HZ
    }

    /// One count for each TAD.
    fn clock(&self, peripheral: Rate) -> Rate {
        if self.control[2] & INTERNAL_CLOCK != 0 {
            return Rate::from_hz(INTERNAL_HZ);
        }
        peripheral.divided(2 * (u64::from(self.control[2] & 0xFF) + 1))
    }

    fn wait(&self, tads: u64, now: Now) -> Wait {
        Wait {
            span: CountSpan::new(now.cycle, self.clock(now.peripheral)),
            tads,
        }
    }

    /// The peripheral clock is another one from now on.
    pub(crate) fn change_clock(&mut self, now: Now) {
        let rate = self.clock(now.peripheral);
        if let AdcState::Sampling(Some(wait)) | AdcState::Converting { wait, .. } = &mut self.state {
            wait.span.change_rate(now.cycle, rate);
        }
    }

    pub(crate) fn next_event(&self) -> u64 {
        match self.state {
            AdcState::Idle | AdcState::Sampling(None) => NEVER,
            AdcState::Sampling(Some(wait)) | AdcState::Converting { wait, .. } => wait.ends(),
        }
    }

    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control[0],
            1 => self.control[1] | if self.upper_half { UPPER_FILLING } else { 0 },
            2 => self.control[2],
            4 => self.channels,
            5 => self.scan,
            6 => self.digital,
            7..=22 => self.buffer[usize::from(word - 7)],
            _ => return None,
        })
    }

    pub(crate) fn write(&mut self, word: u8, value: u32, now: Now) {
        match word {
            0 => self.write_control(value & 0xE7F7, now),
            1 => {
                self.control[1] = value & 0xF43F;
                self.upper_half &= value & HALVES != 0;
            }
            2 => self.control[2] = value & 0x9FFF,
            4 => self.channels = value & 0x8F8F_0000,
            5 => self.scan = value & 0xFFFF,
            6 => self.digital = value & 0xFFFF,
            _ => {}
        }
    }

    fn write_control(&mut self, value: u32, now: Now) {
        let before = std::mem::replace(&mut self.control[0], value);
        if value & ON == 0 {
            self.state = AdcState::Idle;
            self.restart_sequence();
            self.upper_half = false;
            self.control[0] &= !SAMPLING;
            return;
        }
        match self.state {
            AdcState::Idle if value & (SAMPLING | AUTO_SAMPLE) != 0 => self.begin_sample(now),
            AdcState::Sampling { .. } if before & SAMPLING != 0 && value & SAMPLING == 0 => {
                self.state = AdcState::Sampling(Some(self.wait(0, now)));
            }
            _ => {}
        }
    }

    fn begin_sample(&mut self, now: Now) {
        self.channel = self.choose_channel();
        self.control[0] |= SAMPLING;
        let automatic = self.trigger_source() == Trigger::Auto;
        let tads = u64::from(self.control[2] >> 8 & 0x1F);
        self.state = AdcState::Sampling(automatic.then(|| self.wait(tads, now)));
    }

    /// MUX A or, when they alternate, MUX B at every other sample; MUX A goes through the scan list if it scans.
    fn choose_channel(&mut self) -> u8 {
        let second = self.control[1] & ALTERNATE != 0 && self.second;
        self.second = !second;
        let field = |shift: u32| u8::try_from(self.channels >> shift & 0xF).unwrap_or(0);
        if second {
            return field(24);
        }
        if self.control[1] & SCAN == 0 || self.scan == 0 {
            return field(16);
        }
        let ahead = self.scan & (u32::MAX << self.scan_from);
        let next = if ahead == 0 { self.scan } else { ahead }.trailing_zeros();
        self.scan_from = next + 1;
        u8::try_from(next).unwrap_or(0)
    }

    /// The event of this trigger has happened.
    pub(crate) fn trigger(&mut self, trigger: Trigger, now: Now) {
        if self.state == AdcState::Sampling(None) && self.trigger_source() == trigger {
            self.state = AdcState::Sampling(Some(self.wait(0, now)));
        }
    }

    /// What is to be done now that [`AdcModule::next_event`] has come.
    pub(crate) fn due(&self, cycle: u64) -> AdcDue {
        match self.state {
            AdcState::Sampling(Some(wait)) if wait.ends() <= cycle => AdcDue::Hold(self.channel),
            AdcState::Converting { wait, .. } if wait.ends() <= cycle => AdcDue::Result,
            _ => AdcDue::Nothing,
        }
    }

    /// Sampling ends with this level, 0..=1023.
    pub(crate) fn hold(&mut self, value: u16, now: Now) {
        self.control[0] &= !(SAMPLING | DONE);
        self.state = AdcState::Converting {
            value: value.min(1023),
            wait: self.wait(CONVERSION_TAD, now),
        };
    }

    /// The conversion ends; `true` when that is an interrupt.
    pub(crate) fn finish(&mut self, now: Now) -> bool {
        let AdcState::Converting { value, .. } = self.state else {
            return false;
        };
        self.control[0] |= DONE;
        let halves = self.control[1] & HALVES != 0;
        let place = if halves {
            self.results % 8 + if self.upper_half { 8 } else { 0 }
        } else {
            self.results
        };
        self.buffer[(place % 16) as usize] = self.formatted(value);
        self.results += 1;
        let interrupt = self.results > self.control[1] >> 2 & 0xF;
        if interrupt {
            self.restart_sequence();
            self.upper_half = halves && !self.upper_half;
            if self.control[0] & STOP_AFTER_SEQUENCE != 0 {
                self.control[0] &= !AUTO_SAMPLE;
            }
        }
        self.state = AdcState::Idle;
        if self.control[0] & AUTO_SAMPLE != 0 {
            self.begin_sample(now);
        }
        interrupt
    }

    /// The next result goes to the first place, and the scan begins with the lowest channel.
    fn restart_sequence(&mut self) {
        self.results = 0;
        self.scan_from = 0;
        self.second = false;
    }

    /// AD1CON1.FORM.
    fn formatted(&self, value: u16) -> u32 {
        let plain = u32::from(value);
        let signed = plain.wrapping_sub(512);
        match self.control[0] >> 8 & 7 {
            1 => signed & 0xFFFF,
            2 => plain << 6,
            3 => signed << 6 & 0xFFFF,
            5 => signed,
            6 => plain << 22,
            7 => signed << 22,
            _ => plain,
        }
    }
}
