//! The core's interface to the peripherals.

use super::Taken;

/// How many bytes an access moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One byte.
    Byte,
    /// Two bytes.
    Half,
    /// Four bytes.
    Word,
}

impl Width {
    /// Number of bytes.
    pub const fn bytes(self) -> u32 {
        match self {
            Self::Byte => 1,
            Self::Half => 2,
            Self::Word => 4,
        }
    }
}

/// One access to a special function register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Physical address, 0x1F80_0000..=0x1F8F_FFFF, a multiple of the width.
    pub address: u32,
    /// How much is moved.
    pub width: Width,
    /// SYSCLK cycles since power-on at which the instruction began.
    pub cycle: u64,
    /// Virtual address of the instruction.
    pub pc: u32,
}

/// Nothing answers at this address: the core takes a bus error exception.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("nothing answers at this address")]
pub struct BusFault;

/// The special function registers. RAM and flash are not behind it, see [`Memory`](crate::memory::Memory).
///
/// What a register write changes outside of the peripherals (an interrupt request, flash timing, a reset) is done
/// between two runs of the core: the bus moves its horizon to the cycle of the access, and
/// [`Cpu::run`](crate::cpu::Cpu::run) returns before the next instruction.
pub trait Bus {
    /// Reads a register; unused upper bits of the result are ignored for narrow widths.
    ///
    /// # Errors
    /// [`BusFault`] when the chip would raise a bus error.
    fn load(&mut self, access: Access) -> Result<u32, BusFault>;

    /// Writes a register; only the lowest bits that the width says are meant.
    ///
    /// # Errors
    /// [`BusFault`] when the chip would raise a bus error.
    fn store(&mut self, access: Access, value: u32) -> Result<(), BusFault>;

    /// The cycle at which the peripherals must be served next; `u64::MAX` for never. Asked at the begin of a run and
    /// after each access.
    fn horizon(&self) -> u64;

    /// The core executes WAIT. What follows of it for the clock, follows when the horizon is moved to this cycle.
    fn waits(&mut self, cycle: u64) {
        let _ = cycle;
    }

    /// The core enters an interrupt handler; several may be entered and left within one run.
    fn interrupt_taken(&mut self, taken: Taken) {
        let _ = taken;
    }

    /// The core executes ERET, which begins at this cycle.
    fn exception_returned(&mut self, cycle: u64) {
        let _ = cycle;
    }
}
