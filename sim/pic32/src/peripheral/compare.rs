//! Output compare 1 to 5 (here 0 to 4).

use super::counter::Counter;
use super::pulse::Pulse;
use super::rate::NEVER;
use crate::pins::{Level, Pin, Port, known};

/// OC1 to OC5.
pub(crate) const PINS: [Pin; 5] = [
    known(Port::D, 0),
    known(Port::D, 1),
    known(Port::D, 2),
    known(Port::D, 3),
    known(Port::D, 4),
];

const ON: u32 = 1 << 15;
const WIDE: u32 = 1 << 5;
const TIMER_3: u32 = 1 << 3;
const WRITABLE: u32 = 0xE02F;

/// OCxCON.OCM while the module is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CompareMode {
    Off,
    RiseOnce,
    FallOnce,
    Toggle,
    PulseOnce,
    PulseAlways,
    Modulate,
    ModulateWithFault,
}

impl CompareMode {
    fn of(control: u32) -> CompareMode {
        match control & (ON | 7) ^ ON {
            1 => CompareMode::RiseOnce,
            2 => CompareMode::FallOnce,
            3 => CompareMode::Toggle,
            4 => CompareMode::PulseOnce,
            5 => CompareMode::PulseAlways,
            6 => CompareMode::Modulate,
            7 => CompareMode::ModulateWithFault,
            _ => CompareMode::Off,
        }
    }

    pub(crate) const fn is_modulation(self) -> bool {
        matches!(self, CompareMode::Modulate | CompareMode::ModulateWithFault)
    }
}

/// One module.
#[derive(Clone, Debug)]
pub(crate) struct Compare {
    control: u32,
    /// OCxR.
    primary: u32,
    /// OCxRS.
    secondary: u32,
    /// The pin in all modes but PWM.
    level: Level,
    /// A mode that happens once has happened.
    done: bool,
    pub(crate) pulse: Option<Pulse>,
    /// High cycles of earlier times in PWM mode.
    past_high_cycles: u64,
}

/// What a compare event did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CompareEvent {
    pub(crate) level: Level,
    pub(crate) interrupt: bool,
}

impl Compare {
    pub(crate) const OFF: Compare = Compare {
        control: 0,
        primary: 0,
        secondary: 0,
        level: Level::Low,
        done: false,
        pulse: None,
        past_high_cycles: 0,
    };

    /// Off, with the high cycles of before.
    pub(crate) fn reset(&self) -> Compare {
        Compare {
            past_high_cycles: self.past_high_cycles(),
            ..Compare::OFF
        }
    }

    fn past_high_cycles(&self) -> u64 {
        self.past_high_cycles + self.pulse.map_or(0, |pulse| pulse.high_cycles())
    }

    pub(crate) fn mode(&self) -> CompareMode {
        CompareMode::of(self.control)
    }

    /// Its timer, by the number of the timer that counts: 2 or 3 as 1 or 2, a pair as 1.
    pub(crate) fn timer(&self) -> u8 {
        if self.control & TIMER_3 != 0 && self.control & WIDE == 0 {
            2
        } else {
            1
        }
    }

    /// The pin's level when it is not modulated; `None` when the module leaves the pin alone.
    pub(crate) fn fixed_level(&self) -> Option<Level> {
        match self.mode() {
            CompareMode::Off => None,
            mode if mode.is_modulation() => Some(Level::Low),
            _ => Some(self.level),
        }
    }

    /// For how many cycles PWM has driven the pin high.
    pub(crate) fn high_cycles_at(&self, counter: &Counter, cycle: u64) -> u64 {
        let now = self
            .pulse
            .map_or(0, |pulse| pulse.advanced(counter, cycle).high_cycles());
        self.past_high_cycles + now
    }

    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.control,
            1 => self.pulse.map_or(self.primary, |pulse| pulse.duty()),
            2 => self.secondary,
            _ => return None,
        })
    }

    /// Writes a register; a pulse must have been worked out up to `cycle` before.
    pub(crate) fn write(&mut self, word: u8, value: u32, cycle: u64) {
        let value = if self.control & WIDE == 0 && word > 0 {
            value & 0xFFFF
        } else {
            value
        };
        match word {
            0 => self.write_control(value & WRITABLE, cycle),
            // The hardware's copy is read-only in PWM mode.
            1 if self.pulse.is_some() => {}
            1 => self.primary = value,
            _ => {
                self.secondary = value;
                if let Some(pulse) = &mut self.pulse {
                    pulse.set_next_duty(value);
                }
            }
        }
    }

    fn write_control(&mut self, control: u32, cycle: u64) {
        let before = (self.mode(), self.timer(), self.control & WIDE);
        self.control = control;
        let mode = self.mode();
        if (mode, self.timer(), control & WIDE) == before {
            return;
        }
        if let Some(pulse) = self.pulse.take() {
            self.past_high_cycles += pulse.high_cycles();
            self.primary = pulse.duty();
        }
        self.done = false;
        self.level = Level::of(mode == CompareMode::FallOnce);
        if mode.is_modulation() {
            self.pulse = Some(Pulse::new(self.primary, self.secondary, cycle));
        }
    }

    /// When the pin changes next by a compare event; PWM has none.
    pub(crate) fn next_event(&self, counter: &Counter, cycle: u64) -> u64 {
        let value = match self.mode() {
            _ if self.done => return NEVER,
            CompareMode::RiseOnce | CompareMode::FallOnce | CompareMode::Toggle => self.primary,
            CompareMode::PulseOnce | CompareMode::PulseAlways if self.level == Level::Low => self.primary,
            CompareMode::PulseOnce | CompareMode::PulseAlways => self.secondary,
            CompareMode::Off | CompareMode::Modulate | CompareMode::ModulateWithFault => return NEVER,
        };
        counter.next_reach(cycle, value)
    }

    /// The compare event happens.
    pub(crate) fn happen(&mut self) -> CompareEvent {
        let rising = self.level == Level::Low;
        self.level = Level::of(rising);
        let mode = self.mode();
        let pulsing = matches!(mode, CompareMode::PulseOnce | CompareMode::PulseAlways);
        self.done = match mode {
            CompareMode::RiseOnce | CompareMode::FallOnce => true,
            CompareMode::PulseOnce => !rising,
            _ => false,
        };
        CompareEvent {
            level: self.level,
            interrupt: !(pulsing && rising),
        }
    }
}
