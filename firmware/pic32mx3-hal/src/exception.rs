//! When the program breaks: bus errors, unaligned accesses, reserved instructions, interrupts without a handler.
//!
//! What happened is noted in memory that a reset leaves alone ([`take_last`]), then the hook runs: the program's own
//! ([`exception_hook!`](crate::exception_hook!)), or else a software reset, which makes every pin an input.

use crate::persistent::Persistent;
use crate::reset;
use core::sync::atomic::{AtomicBool, Ordering};

/// What broke, from Cause.ExcCode (section 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExceptionKind {
    /// An interrupt without a handler.
    UnhandledInterrupt,
    /// Load or fetch from an unaligned or forbidden address.
    AddressOfLoad,
    /// Store to an unaligned or forbidden address.
    AddressOfStore,
    /// Fetch from where nothing is.
    BusErrorOfFetch,
    /// Load or store where nothing is.
    BusErrorOfData,
    /// The instruction SYSCALL.
    SystemCall,
    /// The instruction BREAK: compiled code uses it for what cannot happen.
    Breakpoint,
    /// No such instruction.
    ReservedInstruction,
    /// No such coprocessor.
    CoprocessorUnusable,
    /// Signed overflow.
    Overflow,
    /// A trap instruction: compiled code uses it for division by zero.
    Trap,
    /// Another code.
    Other(u8),
}

/// The registers when it broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Exception {
    /// Cause: code in bits 6:2, level of an interrupt in bits 15:10, bit 31 set when the instruction is in the delay
    /// slot of the branch at `program_counter`.
    pub cause: u32,
    /// EPC: the instruction. When `status` shows that a handler of level 6 was running (EXL was set before), it is the
    /// instruction which that handler interrupted.
    pub program_counter: u32,
    /// The address of an access, for the two kinds of wrong addresses.
    pub bad_address: u32,
    /// Status.
    pub status: u32,
    /// ra: where the function would have returned to, or something older.
    pub return_address: u32,
    /// sp.
    pub stack_pointer: u32,
}

impl Exception {
    /// What kind it is.
    #[must_use]
    pub const fn kind(&self) -> ExceptionKind {
        match (self.cause >> 2) & 0x1F {
            0 => ExceptionKind::UnhandledInterrupt,
            4 => ExceptionKind::AddressOfLoad,
            5 => ExceptionKind::AddressOfStore,
            6 => ExceptionKind::BusErrorOfFetch,
            7 => ExceptionKind::BusErrorOfData,
            8 => ExceptionKind::SystemCall,
            9 => ExceptionKind::Breakpoint,
            10 => ExceptionKind::ReservedInstruction,
            11 => ExceptionKind::CoprocessorUnusable,
            12 => ExceptionKind::Overflow,
            13 => ExceptionKind::Trap,
            code => ExceptionKind::Other(code as u8),
        }
    }

    const fn words(&self) -> [u32; 6] {
        [
            self.cause,
            self.program_counter,
            self.bad_address,
            self.status,
            self.return_address,
            self.stack_pointer,
        ]
    }

    const fn from_words(words: [u32; 6]) -> Self {
        let [
            cause,
            program_counter,
            bad_address,
            status,
            return_address,
            stack_pointer,
        ] = words;
        Self {
            cause,
            program_counter,
            bad_address,
            status,
            return_address,
            stack_pointer,
        }
    }
}

#[cfg_attr(target_arch = "mips", unsafe(link_section = ".noinit.exception"))]
static LAST: Persistent<6> = Persistent::uninitialised();

/// The exception that ended the run before this one, once; `None` when that run ended otherwise.
pub fn take_last() -> Option<Exception> {
    let words = LAST.load()?;
    LAST.forget();
    Some(Exception::from_words(words))
}

/// Makes a function the exception hook: `exception_hook!(on_exception);` with `fn on_exception(&Exception) -> !`. It makes safe
/// what the program drives and ends in [`crate::reset::software_reset`]. It runs on a fresh stack with interrupts off;
/// when it breaks in turn, the chip is reset at once.
#[macro_export]
macro_rules! exception_hook {
    ($hook:path) => {
        const _: () = {
            #[unsafe(no_mangle)]
            extern "C" fn __exception_hook(exception: &$crate::exception::Exception) -> ! {
                let hook: fn(&$crate::exception::Exception) -> ! = $hook;
                hook(exception)
            }
        };
    };
}

static BROKEN: AtomicBool = AtomicBool::new(false);

/// Called by the general exception vector (start/exception.S).
#[cfg_attr(target_arch = "mips", unsafe(no_mangle))]
#[allow(
    dead_code,
    reason = "called by assembly, which is not there on other machines"
)]
extern "C" fn __exception(
    cause: u32,
    program_counter: u32,
    bad_address: u32,
    status: u32,
    return_address: u32,
    stack_pointer: u32,
) -> ! {
    if BROKEN.load(Ordering::Relaxed) {
        reset::software_reset();
    }
    BROKEN.store(true, Ordering::Relaxed);
    let exception = Exception {
        cause,
        program_counter,
        bad_address,
        status,
        return_address,
        stack_pointer,
    };
    LAST.store(exception.words());
    run_hook(&exception)
}

#[cfg(target_arch = "mips")]
fn run_hook(exception: &Exception) -> ! {
    unsafe extern "C" {
        fn __exception_hook(exception: &Exception) -> !;
    }
    // SAFETY: made by `exception_hook!`, or the one of start/exception.S, with this signature.
    unsafe { __exception_hook(exception) }
}

#[cfg(not(target_arch = "mips"))]
fn run_hook(_exception: &Exception) -> ! {
    reset::software_reset()
}

#[cfg(test)]
mod tests {
    use super::{Exception, ExceptionKind};

    #[test]
    fn kinds_are_those_of_the_cause() {
        let kind = |cause| Exception::from_words([cause, 0, 0, 0, 0, 0]).kind();
        assert_eq!(kind(0x8000_001C), ExceptionKind::BusErrorOfData);
        assert_eq!(kind(0x0000_0034), ExceptionKind::Trap);
        assert_eq!(kind(0x0000_1800), ExceptionKind::UnhandledInterrupt);
        assert_eq!(kind(0x0000_007C), ExceptionKind::Other(31));
    }
}
