//! Interrupts: sources, levels, handlers (section 5).
//!
//! # Levels
//! A source has a level of 1 to 6; a handler is interrupted by higher levels only. Level 7 is not offered: the chip runs it
//! on its second register set, whose stack pointer is not set. A handler of level 6 runs with all interrupts held off,
//! which spares it the saving of the return state: it is the one for times of a few microseconds.
//!
//! | | cycles before the handler's first instruction | after its last |
//! | --- | --- | --- |
//! | level 6 | 32 | 24 |
//! | levels 1 to 5 | 42, of which 20 hold off higher levels | 39, of which 11 hold off higher levels |
//!
//! These are instructions of the code in `start/interrupt.S`, one cycle each; what the chip adds for taking the interrupt
//! and for reading flash comes on top.
//!
//! # Handlers
//! [`interrupt!`](crate::interrupt!) makes a function the handler of a vector. Some sources share one, and then one level
//! (the three of a UART). A vector without handler ends in the exception hook (see [`crate::exception`]) when it is taken.
//! What a handler owns is given to it through a [`HandlerCell`].
//!
//! # Entries of one's own
//! A vector of level 6 that is taken a hundred thousand times a second may be too dear with all registers saved. A program can
//! define the symbol `__enter_` with the vector's name (`__enter_CHANGE_NOTICE`) in assembly: it is jumped to instead of the
//! common entry, with the handler's address in k0, all interrupts held off, and must leave with ERET and every register but k0
//! and k1 as it was, or jump on to `__interrupt_entry` with k0 as it was.

mod cell;
mod source;
pub mod vector;

pub use cell::{Context, HandlerCell};
pub use source::Source;
pub use vector::Vector;

use crate::cpu;
use crate::register::map::{INTCON, interrupt_priorities};

/// The level of an interrupt. The higher one interrupts the handler of the lower one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Priority {
    /// The lowest.
    Level1 = 1,
    /// Level 2.
    Level2 = 2,
    /// Level 3.
    Level3 = 3,
    /// Level 4.
    Level4 = 4,
    /// Level 5.
    Level5 = 5,
    /// The highest; see the module's text.
    Level6 = 6,
}

/// Which of several waiting sources of one level comes first: the higher one. It interrupts nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
#[repr(u8)]
pub enum SubPriority {
    /// The lowest.
    #[default]
    Sub0 = 0,
    /// Sub-priority 1.
    Sub1 = 1,
    /// Sub-priority 2.
    Sub2 = 2,
    /// The highest.
    Sub3 = 3,
}

/// A level was to be changed from within a handler. A handler could then interrupt itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InHandler;

/// Gives a vector its level. Sources are enabled one by one, with [`Source::enable`].
///
/// # Errors
/// [`InHandler`] when called from a handler or an exception hook: levels are set up by the main program.
pub fn set_priority(vector: Vector, priority: Priority, sub: SubPriority) -> Result<(), InHandler> {
    if cpu::level() != 0 {
        return Err(InHandler);
    }
    let number = vector as u32;
    let register = interrupt_priorities(number / 4);
    let shift = 8 * (number % 4);
    cpu::without_interrupts(|| {
        register.clear(0x1F << shift);
        register.set((((priority as u32) << 2) | sub as u32) << shift);
    });
    Ok(())
}

/// Turns interrupts on, each source through its own vector (INTCON.MVEC). Call it once, after everything was set up.
pub fn start() {
    const MULTI_VECTOR: u32 = 1 << 12;
    INTCON.set(MULTI_VECTOR);
    cpu::enable_interrupts();
}

pub use crate::cpu::{with_level, without_interrupts as free};

/// Makes a function the handler of a vector: `interrupt!(TIMER_1, on_timer);` with
/// `fn on_timer(context: &mut Context<vector::TIMER_1>)`. The names are those of [`vector`]; a wrong one does not compile, two
/// handlers for one vector do not link.
#[macro_export]
macro_rules! interrupt {
    ($vector:ident, $handler:path) => {
        const _: () = {
            #[unsafe(no_mangle)]
            extern "C" fn $vector() {
                let handler: fn(&mut $crate::interrupt::Context<$crate::interrupt::vector::$vector>) =
                    $handler;
                // SAFETY: this function has no name outside of this block, so only the vector table calls it, and a
                // vector does not interrupt itself.
                let mut context = unsafe { $crate::interrupt::Context::new() };
                handler(&mut context)
            }
        };
    };
}

#[cfg(feature = "critical-section")]
mod section {
    use crate::cpu;

    struct Chip;
    critical_section::set_impl!(Chip);

    // SAFETY: there is one core, and with IE clear nothing else runs on it; nesting restores the state of the outer one.
    unsafe impl critical_section::Impl for Chip {
        unsafe fn acquire() -> critical_section::RawRestoreState {
            cpu::disable_interrupts()
        }

        unsafe fn release(were_on: critical_section::RawRestoreState) {
            cpu::restore_interrupts(were_on);
        }
    }
}
