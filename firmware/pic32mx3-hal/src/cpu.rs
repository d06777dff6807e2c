//! The processor itself: coprocessor 0, interrupts as a whole, sleeping until one (section 1 and 5).
//!
//! On a machine that is no MIPS these do nothing, except that the counter counts its readings.

use core::sync::atomic::AtomicU32;

/// Status.IE.
const INTERRUPTS_ENABLED: u32 = 1;
/// Status.IPL, bits 15:10: only interrupts of a higher level are taken.
const LEVEL_SHIFT: u32 = 10;
const LEVEL_MASK: u32 = 0b11_1111 << LEVEL_SHIFT;

/// The Count register: half of SYSCLK (40 MHz at 80 MHz), wraps at 32 bits (107 s).
#[inline(always)]
#[must_use]
pub fn count() -> u32 {
    read::count()
}

/// Sleeps until an interrupt when the word is zero (the instruction WAIT, in Idle mode: peripherals go on).
///
/// No wake-up is lost: a handler of level 1 to 5 that comes between the reading of the word and the instruction makes this
/// code start again, so when it set the word, this returns. It may also return without the word being set.
#[inline(always)]
pub fn sleep_while_zero(word: &AtomicU32) {
    read::sleep(word);
}

/// Runs a function with all interrupts off, and turns them on again if they were on. Keep it short: it delays every
/// handler. See [`with_level`] for something milder.
#[inline(always)]
pub fn without_interrupts<R>(function: impl FnOnce() -> R) -> R {
    let were_on = disable_interrupts();
    let result = function();
    restore_interrupts(were_on);
    result
}

/// Runs a function that only interrupts above `level` (1 to 6) can interrupt. Within a handler of a higher level nothing
/// changes.
#[inline(always)]
pub fn with_level<R>(level: crate::interrupt::Priority, function: impl FnOnce() -> R) -> R {
    let before = read::status();
    let wanted = (level as u32) << LEVEL_SHIFT;
    if before & LEVEL_MASK < wanted {
        read::set_status((before & !LEVEL_MASK) | wanted);
    }
    let result = function();
    read::set_status(before);
    result
}

/// The level of the handler that runs; 0 in the main program. A handler of level 6 runs with its level not entered but
/// all interrupts held off, which counts as 6.
#[must_use]
pub fn level() -> u32 {
    let status = read::status();
    if status & 0b110 != 0 {
        6
    } else {
        (status & LEVEL_MASK) >> LEVEL_SHIFT
    }
}

/// DI: turns interrupts off, returns whether they were on.
#[inline(always)]
pub(crate) fn disable_interrupts() -> bool {
    read::disable() & INTERRUPTS_ENABLED != 0
}

/// EI, when they were on.
#[inline(always)]
pub(crate) fn restore_interrupts(were_on: bool) {
    if were_on {
        read::enable();
    }
}

/// EI.
pub(crate) fn enable_interrupts() {
    read::enable();
}

/// The match register of the core timer. Writing it also takes back the request.
#[inline(always)]
pub(crate) fn set_compare(value: u32) {
    read::set_compare(value);
}

#[cfg(target_arch = "mips")]
mod read {
    use core::arch::asm;
    use core::sync::atomic::AtomicU32;

    /// Instructions that may use register 1, which the assembler would otherwise keep for itself and warn about.
    macro_rules! instructions {
        ($($instruction:literal),*; $($rest:tt)*) => {
            asm!(".set push", ".set noat", $($instruction,)* ".set pop", $($rest)*)
        };
    }

    #[inline(always)]
    pub(super) fn count() -> u32 {
        let value: u32;
        // SAFETY: reads coprocessor 0 register 9 and nothing else.
        unsafe { instructions!("mfc0 {0}, $9"; out(reg) value, options(nomem, nostack, preserves_flags)) };
        value
    }

    #[inline(always)]
    pub(super) fn set_compare(value: u32) {
        // SAFETY: writes coprocessor 0 register 11: when the core timer asks for an interrupt next.
        unsafe {
            instructions!("mtc0 {0}, $11", "ehb"; in(reg) value, options(nomem, nostack, preserves_flags))
        };
    }

    #[inline(always)]
    pub(super) fn status() -> u32 {
        let value: u32;
        // SAFETY: reads coprocessor 0 register 12 and nothing else.
        unsafe { instructions!("mfc0 {0}, $12"; out(reg) value, options(nomem, nostack, preserves_flags)) };
        value
    }

    /// Also a barrier for the compiler: memory is not kept in registers across it.
    #[inline(always)]
    pub(super) fn set_status(value: u32) {
        // SAFETY: the callers change the interrupt level only, in a value they read before; a handler that comes
        // between leaves Status as it was.
        unsafe { instructions!("mtc0 {0}, $12", "ehb"; in(reg) value, options(nostack, preserves_flags)) };
    }

    #[inline(always)]
    pub(super) fn disable() -> u32 {
        let status: u32;
        // SAFETY: holding interrupts off breaks no rule of memory.
        unsafe { instructions!("di {0}", "ehb"; out(reg) status, options(nostack, preserves_flags)) };
        status
    }

    #[inline(always)]
    pub(super) fn enable() {
        // SAFETY: handlers share memory with the rest by types that are `Sync`, or by `HandlerCell`.
        unsafe { asm!("ei", options(nostack, preserves_flags)) };
    }

    #[inline(always)]
    pub(super) fn sleep(word: &AtomicU32) {
        unsafe extern "C" {
            fn __idle_begin(word: *mut u32);
        }
        // SAFETY: the routine (start/interrupt.S) only reads the word.
        unsafe { __idle_begin(word.as_ptr()) };
    }
}

#[cfg(all(test, not(target_arch = "mips")))]
pub(crate) use read::{compare, set_count};

#[cfg(not(target_arch = "mips"))]
mod read {
    use core::sync::atomic::{AtomicU32, Ordering};

    static COUNT: AtomicU32 = AtomicU32::new(0);
    static COMPARE: AtomicU32 = AtomicU32::new(0);
    static STATUS: AtomicU32 = AtomicU32::new(0);

    pub(super) fn count() -> u32 {
        COUNT.fetch_add(1, Ordering::SeqCst)
    }

    pub(super) fn set_compare(value: u32) {
        COMPARE.store(value, Ordering::SeqCst);
    }

    #[cfg(test)]
    pub(crate) fn set_count(value: u32) {
        COUNT.store(value, Ordering::SeqCst);
    }

    #[cfg(test)]
    pub(crate) fn compare() -> u32 {
        COMPARE.load(Ordering::SeqCst)
    }

    pub(super) fn status() -> u32 {
        STATUS.load(Ordering::SeqCst)
    }

    pub(super) fn set_status(value: u32) {
        STATUS.store(value, Ordering::SeqCst);
    }

    pub(super) fn disable() -> u32 {
        STATUS.fetch_and(!1, Ordering::SeqCst)
    }

    pub(super) fn enable() {
        STATUS.fetch_or(1, Ordering::SeqCst);
    }

    pub(super) fn sleep(_word: &AtomicU32) {}
}
