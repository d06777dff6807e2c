//! Which register an address is: block and word, from the tables of the reference.

use crate::pins::Port;

/// A block of registers, 16 bytes apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Block {
    Watchdog,
    Timer(u8),
    Capture(u8),
    Compare(u8),
    Serial(u8),
    Spi(u8),
    I2c(u8),
    Analog,
    Comparators,
    Calendar,
    VoltageReference,
    ParallelPort,
    Dma,
    Oscillator,
    Device,
    Flash,
    Reset,
    Interrupts,
    BusMatrix,
    Cache,
    Port(Port),
    ChangeNotice,
}

/// One register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Register {
    pub(crate) block: Block,
    /// Its number in the block: its distance from the first / 16.
    pub(crate) word: u8,
    /// Its offset in the register window.
    pub(crate) offset: u32,
}

/// Which of the four addresses of a register was used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Via {
    Plain,
    Clear,
    Set,
    Invert,
}

impl Via {
    pub(crate) const fn of(address: u32) -> Via {
        match address >> 2 & 3 {
            0 => Via::Plain,
            1 => Via::Clear,
            2 => Via::Set,
            _ => Via::Invert,
        }
    }

    /// What a register holds after this write.
    pub(crate) const fn apply(self, old: u32, value: u32) -> u32 {
        match self {
            Via::Plain => value,
            Via::Clear => old & !value,
            Via::Set => old | value,
            Via::Invert => old ^ value,
        }
    }
}

const TIMER_BASE: u32 = 0x0600;
const CAPTURE_BASE: u32 = 0x2000;
const COMPARE_BASE: u32 = 0x3000;
const SERIAL_BASE: u32 = 0x6000;
/// From one timer, capture, compare, I2C, SPI or UART block to the next.
const STEP: u32 = 0x200;

impl Register {
    /// The register at a physical address in the window 0x1F80_0000..=0x1F8F_FFFF, whichever of its four addresses it is.
    pub(crate) fn at(address: u32) -> Option<Register> {
        let offset = address & 0xF_FFF0;
        let (block, base) = block_of(offset)?;
        let word = u8::try_from((offset - base) / 16).ok()?;
        is_there(block, word).then_some(Register { block, word, offset })
    }

    /// Whether CLR, SET and INV exist.
    pub(crate) const fn has_bit_operations(self) -> bool {
        !matches!(
            (self.block, self.word),
            (Block::Device, 2 | 3)
                | (Block::Flash, 1 | 3 | 4)
                | (Block::Serial(_), 2 | 3)
                | (Block::Spi(_), 2)
                | (Block::I2c(_), 6)
                | (Block::Capture(_), 1)
                | (Block::Interrupts, 1)
        )
    }
}

/// Number of a repeated block, 0 for the first, and where it begins.
fn repeated(offset: u32, first: u32) -> (u8, u32) {
    let number = (offset - first) / STEP;
    (u8::try_from(number).unwrap_or(u8::MAX), first + number * STEP)
}

fn block_of(offset: u32) -> Option<(Block, u32)> {
    let numbered = |first: u32, block: fn(u8) -> Block| {
        let (number, base) = repeated(offset, first);
        Some((block(number), base))
    };
    match offset {
        0x0_0000..=0x0_000F => Some((Block::Watchdog, 0)),
        0x0_0200..=0x0_025F => Some((Block::Calendar, 0x0200)),
        TIMER_BASE..=0x0_0FFF => numbered(TIMER_BASE, Block::Timer),
        CAPTURE_BASE..=0x0_29FF => numbered(CAPTURE_BASE, Block::Capture),
        COMPARE_BASE..=0x0_39FF => numbered(COMPARE_BASE, Block::Compare),
        0x0_5000..=0x0_53FF => numbered(0x5000, Block::I2c),
        0x0_5800..=0x0_5BFF => numbered(0x5800, Block::Spi),
        SERIAL_BASE..=0x0_63FF => numbered(SERIAL_BASE, Block::Serial),
        0x0_7000..=0x0_706F => Some((Block::ParallelPort, 0x7000)),
        0x0_9000..=0x0_916F => Some((Block::Analog, 0x9000)),
        0x0_9800 => Some((Block::VoltageReference, 0x9800)),
        0x0_A000..=0x0_A06F => Some((Block::Comparators, 0xA000)),
        0x0_F000..=0x0_F01F => Some((Block::Oscillator, 0xF000)),
        0x0_F200..=0x0_F23F => Some((Block::Device, 0xF200)),
        0x0_F400..=0x0_F44F => Some((Block::Flash, 0xF400)),
        0x0_F600..=0x0_F61F => Some((Block::Reset, 0xF600)),
        0x8_1000..=0x8_114F => Some((Block::Interrupts, 0x8_1000)),
        0x8_2000..=0x8_207F => Some((Block::BusMatrix, 0x8_2000)),
        0x8_3000..=0x8_335F => Some((Block::Dma, 0x8_3000)),
        0x8_4000..=0x8_40CF => Some((Block::Cache, 0x8_4000)),
        0x8_6000..=0x8_61BF => {
            let port = Port::ALL[(offset as usize - 0x8_6000) / 0x40];
            Some((Block::Port(port), offset & !0x3F))
        }
        0x8_61C0..=0x8_61EF => Some((Block::ChangeNotice, 0x8_61C0)),
        _ => None,
    }
}

/// Gaps within the blocks.
fn is_there(block: Block, word: u8) -> bool {
    match block {
        Block::Timer(_) | Block::Compare(_) => word < 3,
        Block::Capture(_) => word < 2,
        Block::Serial(_) => word < 5,
        Block::I2c(_) => word < 7,
        Block::Spi(_) => word < 4,
        Block::Comparators => matches!(word, 0 | 1 | 6),
        Block::Analog => word != 3,
        Block::Device => word != 1,
        Block::Interrupts => !matches!(word, 5 | 8 | 19),
        Block::Cache => word != 11,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(address: u32) -> Option<(Block, u8)> {
        Register::at(address & 0x1FFF_FFFF).map(|register| (register.block, register.word))
    }

    #[test]
    fn addresses_of_the_reference() {
        let table = [
            (0xBF80_0000, Block::Watchdog, 0),
            (0xBF80_0250, Block::Calendar, 5),
            (0xBF80_0620, Block::Timer(0), 2),
            (0xBF80_0A10, Block::Timer(2), 1),
            (0xBF80_0E00, Block::Timer(4), 0),
            (0xBF80_2610, Block::Capture(3), 1),
            (0xBF80_3820, Block::Compare(4), 2),
            (0xBF80_5040, Block::I2c(0), 4),
            (0xBF80_5260, Block::I2c(1), 6),
            (0xBF80_5830, Block::Spi(0), 3),
            (0xBF80_5A20, Block::Spi(1), 2),
            (0xBF80_6240, Block::Serial(1), 4),
            (0xBF80_7060, Block::ParallelPort, 6),
            (0xBF80_9060, Block::Analog, 6),
            (0xBF80_9160, Block::Analog, 22),
            (0xBF80_9800, Block::VoltageReference, 0),
            (0xBF80_A060, Block::Comparators, 6),
            (0xBF80_F018, Block::Oscillator, 1),
            (0xBF80_F234, Block::Device, 3),
            (0xBF80_F440, Block::Flash, 4),
            (0xBF80_F610, Block::Reset, 1),
            (0xBF88_1064, Block::Interrupts, 6),
            (0xBF88_1140, Block::Interrupts, 20),
            (0xBF88_2070, Block::BusMatrix, 7),
            (0xBF88_3030, Block::Dma, 3),
            (0xBF88_3060, Block::Dma, 6),
            (0xBF88_3350, Block::Dma, 53),
            (0xBF88_40C0, Block::Cache, 12),
            (0xBF88_6068, Block::Port(Port::B), 2),
            (0xBF88_61B0, Block::Port(Port::G), 3),
            (0xBF88_61EC, Block::ChangeNotice, 2),
        ];
        for (address, block, word) in table {
            assert_eq!(at(address), Some((block, word)), "{address:#x}");
        }
        let absent = [
            0xBF80_0010,
            0xBF80_0630,
            0xBF80_1000,
            0xBF80_6800,
            0xBF80_9030,
            0xBF88_1130,
            0xBF88_1050,
            0xBF88_61F0,
            0xBF8F_FFFF,
            0xBF81_0600,
        ];
        for address in absent {
            assert_eq!(at(address), None, "{address:#x}");
        }
    }
}
