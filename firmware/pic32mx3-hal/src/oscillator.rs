//! Changing the clock while the program runs (section 8 of the peripherals).
//!
//! What is wanted is said by a [`Configuration`], so that the compiler checks it: the crystal and the divider before the PLL are
//! those of the configuration words, source, multiplier and the dividers behind it may be others. The words must allow switching
//! ([`Configuration::clock_switching`] or [`Configuration::clock_monitor`]).
//!
//! Everything that follows the peripheral clock changes with it: UARTs, SPIs, I2Cs, timers. Their drivers are to be started anew with
//! the [`Clocks`] that come back.

use crate::clock::{Clocks, Running, running};
use crate::configuration::{Configuration, OscillatorSource};
use crate::core_timer;
use crate::dma;
use crate::register::map::{CHECON, OSCCON};
use crate::reset;

const SWITCH: u32 = 1;
const SECONDARY_ENABLE: u32 = 1 << 1;
const SECONDARY_READY: u32 = 1 << 22;
const WANTED_SHIFT: u32 = 8;
const PRESENT_SHIFT: u32 = 12;
const MULTIPLIER_SHIFT: u32 = 16;
const PERIPHERAL_SHIFT: u32 = 19;
const OUTPUT_SHIFT: u32 = 27;
/// NOSC, PLLMULT, PBDIV, PLLODIV.
const CHOICES: u32 = 7 << WANTED_SHIFT | 7 << MULTIPLIER_SHIFT | 3 << PERIPHERAL_SHIFT | 7 << OUTPUT_SHIFT;
/// PFMWS.
const WAIT_STATES: u32 = 7;

/// Why the clock stays what it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SwitchError {
    /// The configuration words do not allow it.
    NotAllowed,
    /// The wanted source did not begin to run in time: no crystal, or a dead one.
    NotReady(OscillatorSource),
}

/// The oscillators.
#[derive(Debug)]
pub struct Oscillators(());

impl Oscillators {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Changes to what a configuration says, and returns the frequencies that come of it. Waits at most `patience_counts` of the
    /// core timer for each source that must begin to run; a crystal with PLL needs some 2 ms, which are 80,000 counts at 80 MHz and
    /// 8,000 at 8 MHz.
    ///
    /// # Errors
    /// [`SwitchError`]; the chip may then run on its internal oscillator, which lies between two sources with PLL.
    pub fn switch(&mut self, to: &Configuration, patience_counts: u32) -> Result<Clocks, SwitchError> {
        let clocks = to.clocks();
        // Enough for every speed, until the new one is there.
        set_wait_states(wait_states(80_000_000));
        let source = to.source();
        let has_pll = |source| {
            matches!(
                source,
                OscillatorSource::InternalPll | OscillatorSource::PrimaryPll
            )
        };
        if has_pll(source) && matches!(running(), Running::InternalPll | Running::PrimaryPll) {
            // The PLL is not changed while it is the source.
            change(
                OscillatorSource::Internal,
                OSCCON.read() & CHOICES,
                patience_counts,
            )?;
        }
        change(source, choices(to), patience_counts)?;
        set_wait_states(wait_states(clocks.system_hz));
        Ok(clocks)
    }

    /// Starts the oscillator of 32 kHz on RC13 and RC14, or stops it.
    pub fn run_secondary(&mut self, on: bool) {
        with_system_unlocked(|| {
            if on {
                OSCCON.set(SECONDARY_ENABLE);
            } else {
                OSCCON.clear(SECONDARY_ENABLE);
            }
        });
    }

    /// Whether the oscillator of 32 kHz swings.
    #[must_use]
    pub fn is_secondary_ready(&self) -> bool {
        OSCCON.has(SECONDARY_READY)
    }
}

/// Another access between the two keys would spoil them.
fn with_system_unlocked<R>(function: impl FnOnce() -> R) -> R {
    dma::suspended(|| reset::with_system_unlocked(function))
}

/// One change of the source, with the fields of the PLL and of the peripherals' divider.
fn change(source: OscillatorSource, choices: u32, patience_counts: u32) -> Result<(), SwitchError> {
    let wanted = choices & !(7 << WANTED_SHIFT) | (source as u32) << WANTED_SHIFT;
    with_system_unlocked(|| {
        OSCCON.write(OSCCON.read() & !(CHOICES | SWITCH) | wanted);
        OSCCON.set(SWITCH);
    });
    let begun = core_timer::count();
    while OSCCON.has(SWITCH) {
        if core_timer::count().wrapping_sub(begun) > patience_counts {
            with_system_unlocked(|| OSCCON.clear(SWITCH));
            return Err(SwitchError::NotReady(source));
        }
    }
    if OSCCON.read() >> PRESENT_SHIFT & 7 != source as u32 {
        return Err(SwitchError::NotAllowed);
    }
    Ok(())
}

const fn choices(to: &Configuration) -> u32 {
    let (multiplier, output, peripheral) = to.dividers();
    multiplier << MULTIPLIER_SHIFT | output << OUTPUT_SHIFT | peripheral << PERIPHERAL_SHIFT
}

/// One for each 30 MHz begun above the first (section 7).
const fn wait_states(system_hz: u32) -> u32 {
    match system_hz {
        0..=30_000_000 => 0,
        30_000_001..=60_000_000 => 1,
        _ => 2,
    }
}

fn set_wait_states(count: u32) {
    CHECON.write(CHECON.read() & !WAIT_STATES | count);
}

#[cfg(test)]
mod tests {
    use super::{SwitchError, change, choices, wait_states};
    use crate::configuration::{
        Configuration, InputDivider, Multiplier, OscillatorSource, OutputDivider, PeripheralDivider,
        PrimaryOscillator,
    };
    use crate::register::map::OSCCON;

    #[test]
    fn fields_stand_at_their_places() {
        let to = Configuration::new()
            .primary_oscillator(PrimaryOscillator::HighSpeed, 8_000_000)
            .pll(InputDivider::By2, Multiplier::Times24, OutputDivider::By4)
            .peripheral_divider(PeripheralDivider::By8);
        assert_eq!(choices(&to), 7 << 16 | 2 << 27 | 3 << 19);
        let table = [
            (8_000_000, 0),
            (30_000_000, 0),
            (30_000_001, 1),
            (60_000_000, 1),
            (80_000_000, 2),
        ];
        for (hz, count) in table {
            assert_eq!(wait_states(hz), count, "{hz} Hz");
        }
    }

    /// Memory keeps OSWEN, as a chip whose crystal is missing does.
    #[test]
    fn a_source_that_does_not_come_is_named_and_given_up() {
        // DMA's tests use the same registers.
        let _alone = crate::dma::tests::alone();
        OSCCON.write(1 << 1);
        let answer = change(OscillatorSource::Secondary, 5 << 16, 100);
        assert_eq!(answer, Err(SwitchError::NotReady(OscillatorSource::Secondary)));
        assert_eq!(
            OSCCON.read(),
            1 << 1 | 4 << 8 | 5 << 16,
            "OSWEN is taken back, SOSCEN stays"
        );
    }
}
