//! What the program did that the chip does not forgive or that this emulator does not know, by name.

use crate::pins::Pin;

/// How many different records of a kind are kept; those after it are only counted.
const KEPT: usize = 64;

/// Something that this emulator leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unmodelled {
    /// Addresses on the data lines of the parallel port.
    MultiplexedAddress,
    /// A reference voltage of the comparators that comes from pins.
    VoltageReference,
    /// The fault input of output compare.
    CompareFault,
    /// Infrared coding, automatic baud detection, addresses or wake-up of a UART.
    SerialOption,
    /// Other references than the supply, or a negative input, of the analog converter.
    AnalogReference,
    /// The proximity timer of the interrupt controller.
    ProximityTimer,
}

/// Direction of an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AccessDirection {
    /// The program read.
    Read,
    /// The program wrote.
    Write,
}

/// Accesses to a register that the reference does not name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownAccess {
    /// Physical address.
    pub address: u32,
    /// Direction.
    pub direction: AccessDirection,
    /// Virtual address of the first instruction that did it.
    pub pc: u32,
    /// Cycle of the first.
    pub cycle: u64,
    /// How often.
    pub count: u64,
}

/// Something that works by luck, or not at all, on the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Misuse {
    /// The chip drives a pin against what drives it from outside.
    PinConflict(Pin),
    /// The system clock is faster than the part: hertz.
    ClockTooFast(u64),
    /// The PLL is fed with what it is not made for: hertz.
    PllInput(u64),
    /// Flash has too few wait states for the system clock: instructions may be read wrongly.
    FlashTooFast {
        /// CHECON.PFMWS.
        wait_states: u8,
    },
    /// OSCCON or RSWRST was written while the lock was closed; the write was lost.
    Locked,
    /// A clock switch that the configuration words forbid; it was not done.
    ClockSwitchForbidden,
    /// The prescaler of timer 1 to 5, by number, was changed while the timer was on.
    PrescalerWhileOn(u8),
    /// NVMCON.WR was set without the two keys; nothing was programmed.
    FlashWithoutKeys,
    /// NVMCON.WR was set sooner than 6 us after WREN.
    FlashTooSoon,
    /// TAD of the analog converter is shorter than 65 ns.
    AnalogTooFast,
    /// The analog converter sampled a pin that AD1PCFG calls digital; it reads ground.
    AnalogPinIsDigital(Pin),
    /// The analog converter sampled a pin that the chip drives itself.
    AnalogPinIsOutput(Pin),
    /// A character was written into the full queue of UART 1 or 2, by number, and lost.
    TransmitQueueFull(u8),
    /// A word was written into the transmit buffer of SPI 1 or 2, by number, while another one waited there; that one is lost.
    SpiBufferFull(u8),
    /// SPI 1 or 2, by number, was switched on with settings that the part does not combine: framed or without a select pin with
    /// CKE = 1, or a slave with SMP = 1.
    SpiSettings(u8),
    /// SPI 1 or 2, by number, clocks faster than 25 MHz.
    SpiTooFast(u8),
    /// I2C 1 or 2, by number, was asked for a step while another one ran; it is not done.
    I2cStepIgnored(u8),
    /// I2C 1 or 2, by number, was switched on with a divider of 0 or 1.
    I2cDivider(u8),
    /// Addresses or sizes of DMA channel 0 to 3 were changed while it was on.
    DmaChannelOn(u8),
    /// DMA channel 0 to 3 has auto enable and chaining together.
    DmaSettings(u8),
    /// The data or the address of the parallel port was used while an access was under way.
    ParallelPortBusy,
    /// Something was switched on that this emulator does not model.
    NotModelled(Unmodelled),
}

/// A misuse and where it happened first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MisuseRecord {
    /// What.
    pub misuse: Misuse,
    /// Virtual address of the instruction that did it first, or that was next when it came from outside.
    pub pc: u32,
    /// Cycle of the first.
    pub cycle: u64,
    /// How often.
    pub count: u64,
}

/// Where in the program and when.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct AccessSite {
    pub(crate) pc: u32,
    pub(crate) cycle: u64,
}

/// All of them, each kind once.
#[derive(Clone, Debug, Default)]
pub(crate) struct AccessRecord {
    /// Where the program is, set before each access.
    pub(crate) place: AccessSite,
    pub(crate) unknown: Vec<UnknownAccess>,
    pub(crate) misuses: Vec<MisuseRecord>,
}

impl AccessRecord {
    pub(crate) fn misuse(&mut self, misuse: Misuse) {
        let full = self.misuses.len() >= KEPT;
        match self.misuses.iter_mut().find(|known| known.misuse == misuse) {
            Some(known) => known.count += 1,
            None if !full => {
                let AccessSite { pc, cycle } = self.place;
                self.misuses.push(MisuseRecord {
                    misuse,
                    pc,
                    cycle,
                    count: 1,
                });
            }
            None => {}
        }
    }

    pub(crate) fn unknown(&mut self, address: u32, direction: AccessDirection) {
        let same = |known: &&mut UnknownAccess| known.address == address && known.direction == direction;
        let full = self.unknown.len() >= KEPT;
        match self.unknown.iter_mut().find(same) {
            Some(known) => known.count += 1,
            None if !full => {
                let AccessSite { pc, cycle } = self.place;
                self.unknown.push(UnknownAccess {
                    address,
                    direction,
                    pc,
                    cycle,
                    count: 1,
                });
            }
            None => {}
        }
    }
}
