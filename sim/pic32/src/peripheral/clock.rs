//! The clock: which oscillator runs core and peripherals, switching it, and what happens when the crystal stops.

use super::configuration::{Configuration, Oscillator};
use super::rate::Rate;

/// The crystal of the board; inferred from the dividers of the original's settings.
const CRYSTAL_HZ: u64 = 8_000_000;
/// The internal oscillator, nominal; general knowledge of the family.
const FAST_HZ: u64 = 8_000_000;
/// The low-power oscillator. Sources say 31 to 32 kHz; with 32 kHz the watchdog's base period is the 1 ms that they say.
pub(crate) const LOW_POWER_HZ: u64 = 32_000;
/// The fastest clock of the part.
pub(crate) const FASTEST_HZ: u64 = 80_000_000;
/// What the PLL may be fed with; general knowledge of the family.
const PLL_INPUT_HZ: std::ops::RangeInclusive<u64> = 4_000_000..=5_000_000;
/// How long the clock monitor takes to see that the clock is gone, in cycles of the time base: 2 ms. No source has the
/// figure; other parts of the maker take 0.5 to 0.9 ms, and outputs stand still meanwhile, so longer is the safe side.
pub(crate) const MONITOR_CYCLES: u64 = 160_000;
/// How long a wanted switch takes; no source has the figure.
const SWITCH_CYCLES: u64 = 800;

/// What waking takes: 10 us, 1024 cycles of an 8 MHz crystal, at most 2 ms until the PLL is in step.
const WAKE_CYCLES: u64 = 800;
const CRYSTAL_START_CYCLES: u64 = 10_240;
const PLL_LOCK_CYCLES: u64 = 160_000;

const SWITCH: u32 = 1 << 0;
const SECONDARY_ON: u32 = 1 << 1;
const FAILED: u32 = 1 << 3;
const SLEEP: u32 = 1 << 4;
const PLL_LOCKED: u32 = 1 << 5;
const LOCKED: u32 = 1 << 7;
const SECONDARY_READY: u32 = 1 << 22;
/// The crystal of a watch, which the robot's board lacks.
const WATCH_HZ: u64 = 32_768;
/// Fields of OSCCON that keep what is written: SOSCEN, SLPEN, CLKLOCK, NOSC, PLLMULT, PBDIV, FRCDIV, PLLODIV.
const KEPT: u32 = 0x3F1F_0792;

/// What else a write to OSCCON, a reset or a failure leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Nothing.
    None,
    /// Rates are other ones now.
    Rates,
    /// Something happens after so many cycles.
    After(u64),
    /// A switch was asked for that the configuration words forbid.
    Forbidden,
}

/// The clock's state.
#[derive(Clone, Debug)]
pub(crate) struct Clock {
    configuration: Configuration,
    current: Oscillator,
    /// OSCCON without what is worked out on reading.
    control: u32,
    tuning: u32,
    crystal_alive: bool,
    failed: bool,
    switching: bool,
    /// Sleep has stopped everything but the low-power oscillator.
    asleep: bool,
    /// The board has a crystal of 32.768 kHz.
    pub(crate) has_watch_crystal: bool,
    pub(crate) system: Rate,
    pub(crate) peripheral: Rate,
}

impl Clock {
    pub(crate) fn new(configuration: Configuration) -> Clock {
        let mut clock = Clock {
            configuration,
            current: configuration.oscillator(),
            control: 0,
            tuning: 0,
            crystal_alive: true,
            failed: false,
            switching: false,
            asleep: false,
            has_watch_crystal: false,
            system: Rate::STOPPED,
            peripheral: Rate::STOPPED,
        };
        clock.reset();
        clock
    }

    /// As the configuration words say. A crystal that is dead stays dead.
    pub(crate) fn reset(&mut self) -> Change {
        let configuration = &self.configuration;
        self.current = configuration.oscillator();
        self.control = self.current.field() << 8
            | configuration.pll_multiplier_field() << 16
            | configuration.peripheral_field() << 19
            | configuration.pll_output_field() << 27
            | 1 << 24; // FRCDIV: by 2.
        (self.tuning, self.failed, self.switching) = (0, false, false);
        self.asleep = false;
        self.settle();
        self.rescue()
    }

    pub(crate) fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// Other configuration words, before a reset.
    pub(crate) fn set_configuration(&mut self, configuration: Configuration) {
        self.configuration = configuration;
    }

    /// Whether WAIT means Sleep instead of Idle.
    pub(crate) fn sleeps(&self) -> bool {
        self.control & SLEEP != 0
    }

    /// Works out both rates.
    fn settle(&mut self) {
        let hz = if self.asleep { 0 } else { self.hz_of(self.current) };
        self.system = Rate::from_hz(hz);
        self.peripheral = self.system.divided(1 << (self.control >> 19 & 3));
    }

    fn hz_of(&self, oscillator: Oscillator) -> u64 {
        let crystal_runs = self.crystal_alive && self.configuration.has_primary();
        let crystal = if crystal_runs { CRYSTAL_HZ } else { 0 };
        match oscillator {
            Oscillator::Fast => FAST_HZ,
            Oscillator::FastPll => self.through_pll(FAST_HZ),
            Oscillator::Primary => crystal,
            Oscillator::PrimaryPll => self.through_pll(crystal),
            Oscillator::Secondary if self.secondary_runs() => WATCH_HZ,
            Oscillator::Secondary => 0,
            Oscillator::LowPower => LOW_POWER_HZ,
            Oscillator::FastBy16 => FAST_HZ / 16,
            Oscillator::FastDivided => {
                FAST_HZ / [1, 2, 4, 8, 16, 32, 64, 256][(self.control >> 24 & 7) as usize]
            }
        }
    }

    /// Whether the secondary oscillator swings; Sleep lets it.
    pub(crate) fn secondary_runs(&self) -> bool {
        self.has_watch_crystal && self.control & SECONDARY_ON != 0
    }

    fn through_pll(&self, hz: u64) -> u64 {
        let multiplier = [15, 16, 17, 18, 19, 20, 21, 24][(self.control >> 16 & 7) as usize];
        let divider = [1, 2, 4, 8, 16, 32, 64, 256][(self.control >> 27 & 7) as usize];
        hz / self.configuration.pll_input_divider() * multiplier / divider
    }

    /// What the PLL is fed with, if that is not what it is made for.
    pub(crate) fn wrong_pll_input(&self) -> Option<u64> {
        let source = if self.current.needs_crystal() {
            CRYSTAL_HZ
        } else {
            FAST_HZ
        };
        let fed = source / self.configuration.pll_input_divider();
        (self.current.has_pll() && !PLL_INPUT_HZ.contains(&fed)).then_some(fed)
    }

    pub(crate) fn read(&self, word: u8) -> Option<u32> {
        let flag = |set: bool, mask: u32| if set { mask } else { 0 };
        match word {
            0 => Some(
                self.control
                    | flag(self.switching, SWITCH)
                    | flag(self.failed, FAILED)
                    | flag(self.secondary_runs(), SECONDARY_READY)
                    | flag(self.current.has_pll() && !self.system.is_stopped(), PLL_LOCKED)
                    | self.current.field() << 12,
            ),
            1 => Some(self.tuning),
            _ => None,
        }
    }

    /// Writes OSCCON or OSCTUN; the lock was open.
    pub(crate) fn write(&mut self, word: u8, value: u32) -> Change {
        if word == 1 {
            self.tuning = value & 0x3F;
            return Change::None;
        }
        let locked = self.control & LOCKED != 0;
        self.control = value & KEPT;
        if value & FAILED == 0 {
            self.failed = false;
        }
        if value & SWITCH != 0 && !self.switching {
            if locked || !self.configuration.may_switch() {
                return Change::Forbidden;
            }
            self.switching = true;
            return Change::After(SWITCH_CYCLES);
        }
        let before = (self.system, self.peripheral);
        self.settle();
        if before == (self.system, self.peripheral) {
            Change::None
        } else {
            Change::Rates
        }
    }

    /// What was announced by [`Change::After`] happens; `true` when the monitor did it, which is an interrupt.
    pub(crate) fn happen(&mut self) -> bool {
        let lost = self.system.is_stopped() && !self.asleep;
        if lost {
            self.current = Oscillator::Fast;
            self.failed = true;
            self.switching = false;
        } else if self.switching {
            let wanted = Oscillator::of(self.control >> 8);
            // A switch to an oscillator that does not run is never completed.
            if self.hz_of(wanted) > 0 {
                self.current = wanted;
                self.switching = false;
            }
        }
        self.settle();
        lost
    }

    /// Sleep begins: nothing is clocked any more.
    pub(crate) fn fall_asleep(&mut self) -> Change {
        self.asleep = true;
        self.settle();
        Change::Rates
    }

    /// Sleep is over, and the clock runs as before.
    pub(crate) fn wake(&mut self) -> Change {
        self.asleep = false;
        self.settle();
        Change::Rates
    }

    /// How long the clock takes to run again: general knowledge of the family, like the figures.
    pub(crate) fn wake_cycles(&self) -> u64 {
        let crystal = if self.current.needs_crystal() {
            CRYSTAL_START_CYCLES
        } else {
            0
        };
        let pll = if self.current.has_pll() {
            PLL_LOCK_CYCLES
        } else {
            0
        };
        WAKE_CYCLES + crystal + pll
    }

    /// The crystal stops.
    pub(crate) fn fail_crystal(&mut self) -> Change {
        self.crystal_alive = false;
        let before = self.system;
        self.settle();
        if before == self.system {
            Change::None
        } else {
            self.rescue()
        }
    }

    /// Whether the monitor will replace a clock that stands still.
    fn rescue(&self) -> Change {
        if self.system.is_stopped() && self.configuration.has_monitor() {
            Change::After(MONITOR_CYCLES)
        } else {
            Change::Rates
        }
    }
}
