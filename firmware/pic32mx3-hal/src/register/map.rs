//! Where the registers are. The numbers in parentheses are sections of the chip's reference
//! (`docs` of this crate: README, "Where the numbers come from").

use super::Register;

/// Watchdog (17).
pub(crate) const WDTCON: Register = Register::at(0xBF80_0000);

/// Calendar (peripherals, 4): control, alarm, time, date, time and date of the alarm.
pub(crate) const RTCCON: Register = Register::at(0xBF80_0200);
/// (peripherals, 4)
pub(crate) const RTCALRM: Register = Register::at(0xBF80_0210);
/// (peripherals, 4)
pub(crate) const RTCTIME: Register = Register::at(0xBF80_0220);
/// (peripherals, 4)
pub(crate) const RTCDATE: Register = Register::at(0xBF80_0230);
/// (peripherals, 4)
pub(crate) const ALRMTIME: Register = Register::at(0xBF80_0240);
/// (peripherals, 4)
pub(crate) const ALRMDATE: Register = Register::at(0xBF80_0250);

/// Timers (10): control, counter, period.
pub(crate) const fn timer_control(number: u8) -> Register {
    Register::at(0xBF80_0600).plus(0x200 * (number as u32 - 1))
}
/// TMRx (10).
pub(crate) const fn timer_count(number: u8) -> Register {
    timer_control(number).plus(0x10)
}
/// PRx (10).
pub(crate) const fn timer_period(number: u8) -> Register {
    timer_control(number).plus(0x20)
}

/// ICxCON (12).
pub(crate) const fn capture_control(number: u8) -> Register {
    Register::at(0xBF80_2000).plus(0x200 * (number as u32 - 1))
}
/// ICxBUF (12).
pub(crate) const fn capture_buffer(number: u8) -> Register {
    capture_control(number).plus(0x10)
}

/// OCxCON (11).
pub(crate) const fn compare_control(number: u8) -> Register {
    Register::at(0xBF80_3000).plus(0x200 * (number as u32 - 1))
}
/// OCxR (11).
pub(crate) const fn compare_primary(number: u8) -> Register {
    compare_control(number).plus(0x10)
}
/// OCxRS (11).
pub(crate) const fn compare_secondary(number: u8) -> Register {
    compare_control(number).plus(0x20)
}

/// SPIxCON (peripherals, 1).
pub(crate) const fn spi_control(number: u8) -> Register {
    Register::at(0xBF80_5800).plus(0x200 * (number as u32 - 1))
}
/// SPIxSTAT (peripherals, 1).
pub(crate) const fn spi_status(number: u8) -> Register {
    spi_control(number).plus(0x10)
}
/// SPIxBUF (peripherals, 1).
pub(crate) const fn spi_buffer(number: u8) -> Register {
    spi_control(number).plus(0x20)
}
/// SPIxBRG (peripherals, 1).
pub(crate) const fn spi_divider(number: u8) -> Register {
    spi_control(number).plus(0x30)
}

/// I2CxCON (peripherals, 2).
pub(crate) const fn i2c_control(number: u8) -> Register {
    Register::at(0xBF80_5000).plus(0x200 * (number as u32 - 1))
}
/// I2CxSTAT (peripherals, 2).
pub(crate) const fn i2c_status(number: u8) -> Register {
    i2c_control(number).plus(0x10)
}
/// I2CxADD (peripherals, 2).
pub(crate) const fn i2c_address(number: u8) -> Register {
    i2c_control(number).plus(0x20)
}
/// I2CxMSK (peripherals, 2).
pub(crate) const fn i2c_mask(number: u8) -> Register {
    i2c_control(number).plus(0x30)
}
/// I2CxBRG (peripherals, 2).
pub(crate) const fn i2c_divider(number: u8) -> Register {
    i2c_control(number).plus(0x40)
}
/// I2CxTRN (peripherals, 2).
pub(crate) const fn i2c_transmit(number: u8) -> Register {
    i2c_control(number).plus(0x50)
}
/// I2CxRCV (peripherals, 2).
pub(crate) const fn i2c_receive(number: u8) -> Register {
    i2c_control(number).plus(0x60)
}

/// UxMODE (14).
pub(crate) const fn uart_mode(number: u8) -> Register {
    Register::at(0xBF80_6000).plus(0x200 * (number as u32 - 1))
}
/// UxSTA (14).
pub(crate) const fn uart_status(number: u8) -> Register {
    uart_mode(number).plus(0x10)
}
/// UxTXREG (14).
pub(crate) const fn uart_transmit(number: u8) -> Register {
    uart_mode(number).plus(0x20)
}
/// UxRXREG (14).
pub(crate) const fn uart_receive(number: u8) -> Register {
    uart_mode(number).plus(0x30)
}
/// UxBRG (14).
pub(crate) const fn uart_baud(number: u8) -> Register {
    uart_mode(number).plus(0x40)
}

/// ADC (13).
pub(crate) const AD1CON1: Register = Register::at(0xBF80_9000);
/// (13)
pub(crate) const AD1CON2: Register = Register::at(0xBF80_9010);
/// (13)
pub(crate) const AD1CON3: Register = Register::at(0xBF80_9020);
/// (13)
pub(crate) const AD1CHS: Register = Register::at(0xBF80_9040);
/// (13)
pub(crate) const AD1CSSL: Register = Register::at(0xBF80_9050);
/// (13)
pub(crate) const AD1PCFG: Register = Register::at(0xBF80_9060);
/// ADC1BUF0 to ADC1BUFF (13); `index` is 0 to 15.
pub(crate) const fn adc_buffer(index: u8) -> Register {
    Register::at(0xBF80_9070).plus(0x10 * (index as u32 & 15))
}

/// Parallel port (peripherals, 7): control, mode, address, output, input, pins, status.
pub(crate) const PMCON: Register = Register::at(0xBF80_7000);
/// (peripherals, 7)
pub(crate) const PMMODE: Register = Register::at(0xBF80_7010);
/// (peripherals, 7)
pub(crate) const PMADDR: Register = Register::at(0xBF80_7020);
/// (peripherals, 7)
pub(crate) const PMDOUT: Register = Register::at(0xBF80_7030);
/// (peripherals, 7)
pub(crate) const PMDIN: Register = Register::at(0xBF80_7040);
/// (peripherals, 7)
pub(crate) const PMAEN: Register = Register::at(0xBF80_7050);
/// (peripherals, 7)
pub(crate) const PMSTAT: Register = Register::at(0xBF80_7060);

/// Reference of the comparators (peripherals, 6).
pub(crate) const CVRCON: Register = Register::at(0xBF80_9800);
/// CMxCON (peripherals, 5).
pub(crate) const fn comparator_control(number: u8) -> Register {
    Register::at(0xBF80_A000).plus(0x10 * (number as u32 - 1))
}

/// Oscillator (6).
pub(crate) const OSCCON: Register = Register::at(0xBF80_F000);
/// Device identity (2).
pub(crate) const DEVID: Register = Register::at(0xBF80_F220);
/// Lock of OSCCON and RSWRST (4).
pub(crate) const SYSKEY: Register = Register::at(0xBF80_F230);
/// Flash controller (16).
pub(crate) const NVMCON: Register = Register::at(0xBF80_F400);
/// (16)
pub(crate) const NVMKEY: Register = Register::at(0xBF80_F410);
/// (16)
pub(crate) const NVMADDR: Register = Register::at(0xBF80_F420);
/// (16)
pub(crate) const NVMDATA: Register = Register::at(0xBF80_F430);
/// Reset cause (4).
pub(crate) const RCON: Register = Register::at(0xBF80_F600);
/// Software reset (4).
pub(crate) const RSWRST: Register = Register::at(0xBF80_F610);

/// Interrupt controller (5).
pub(crate) const INTCON: Register = Register::at(0xBF88_1000);
/// IFS0, IFS1 (5).
pub(crate) const fn interrupt_flags(index: u32) -> Register {
    Register::at(0xBF88_1030).plus(0x10 * index)
}
/// IEC0, IEC1 (5).
pub(crate) const fn interrupt_enables(index: u32) -> Register {
    Register::at(0xBF88_1060).plus(0x10 * index)
}
/// IPC0 to IPC11 (5).
pub(crate) const fn interrupt_priorities(index: u32) -> Register {
    Register::at(0xBF88_1090).plus(0x10 * index)
}

/// DMA (peripherals, 3).
pub(crate) const DMACON: Register = Register::at(0xBF88_3000);
/// (peripherals, 3)
pub(crate) const DCRCCON: Register = Register::at(0xBF88_3030);
/// (peripherals, 3)
pub(crate) const DCRCDATA: Register = Register::at(0xBF88_3040);
/// (peripherals, 3)
pub(crate) const DCRCXOR: Register = Register::at(0xBF88_3050);
/// DCHxCON (peripherals, 3).
pub(crate) const fn dma_control(channel: u8) -> Register {
    Register::at(0xBF88_3060).plus(0xC0 * channel as u32)
}
/// DCHxECON (peripherals, 3).
pub(crate) const fn dma_event(channel: u8) -> Register {
    dma_control(channel).plus(0x10)
}
/// DCHxINT (peripherals, 3).
pub(crate) const fn dma_interrupt(channel: u8) -> Register {
    dma_control(channel).plus(0x20)
}
/// DCHxSSA (peripherals, 3).
pub(crate) const fn dma_source(channel: u8) -> Register {
    dma_control(channel).plus(0x30)
}
/// DCHxDSA (peripherals, 3).
pub(crate) const fn dma_destination(channel: u8) -> Register {
    dma_control(channel).plus(0x40)
}
/// DCHxSSIZ (peripherals, 3).
pub(crate) const fn dma_source_size(channel: u8) -> Register {
    dma_control(channel).plus(0x50)
}
/// DCHxDSIZ (peripherals, 3).
pub(crate) const fn dma_destination_size(channel: u8) -> Register {
    dma_control(channel).plus(0x60)
}
/// DCHxSPTR (peripherals, 3).
pub(crate) const fn dma_source_pointer(channel: u8) -> Register {
    dma_control(channel).plus(0x70)
}
/// DCHxDPTR (peripherals, 3).
pub(crate) const fn dma_destination_pointer(channel: u8) -> Register {
    dma_control(channel).plus(0x80)
}
/// DCHxCSIZ (peripherals, 3).
pub(crate) const fn dma_cell_size(channel: u8) -> Register {
    dma_control(channel).plus(0x90)
}
/// DCHxDAT (peripherals, 3).
pub(crate) const fn dma_pattern(channel: u8) -> Register {
    dma_control(channel).plus(0xB0)
}

/// Flash wait states and prefetch (7).
pub(crate) const CHECON: Register = Register::at(0xBF88_4000);
/// RAM size (7).
pub(crate) const BMXDRMSZ: Register = Register::at(0xBF88_2040);
/// Program flash size (7).
pub(crate) const BMXPFMSZ: Register = Register::at(0xBF88_2060);

/// Ports (8): TRIS of port A, B .. G by index.
pub(crate) const fn port_direction(index: u32) -> Register {
    Register::at(0xBF88_6000).plus(0x40 * index)
}
/// PORTx (8).
pub(crate) const fn port_input(index: u32) -> Register {
    port_direction(index).plus(0x10)
}
/// LATx (8).
pub(crate) const fn port_latch(index: u32) -> Register {
    port_direction(index).plus(0x20)
}
/// ODCx (8).
pub(crate) const fn port_open_drain(index: u32) -> Register {
    port_direction(index).plus(0x30)
}

/// Change notice (9).
pub(crate) const CNCON: Register = Register::at(0xBF88_61C0);
/// (9)
pub(crate) const CNEN: Register = Register::at(0xBF88_61D0);
/// (9)
pub(crate) const CNPUE: Register = Register::at(0xBF88_61E0);

#[cfg(test)]
mod tests {
    use super::{
        PMSTAT, adc_buffer, capture_buffer, comparator_control, compare_secondary, dma_cell_size,
        dma_control, dma_pattern, dma_source_pointer, i2c_receive, i2c_transmit, interrupt_enables,
        interrupt_priorities, port_latch, port_open_drain, spi_buffer, spi_divider, timer_period, uart_baud,
    };

    /// The computed addresses are those of the printed tables (sections 5, 8, 10 to 14).
    #[test]
    fn computed_addresses_are_those_of_the_tables() {
        let pairs = [
            (timer_period(1), 0xBF80_0620),
            (timer_period(5), 0xBF80_0E20),
            (capture_buffer(5), 0xBF80_2810),
            (compare_secondary(4), 0xBF80_3620),
            (comparator_control(2), 0xBF80_A010),
            (spi_divider(1), 0xBF80_5830),
            (spi_buffer(2), 0xBF80_5A20),
            (i2c_receive(1), 0xBF80_5060),
            (i2c_transmit(2), 0xBF80_5250),
            (uart_baud(2), 0xBF80_6240),
            (adc_buffer(15), 0xBF80_9160),
            (PMSTAT, 0xBF80_7060),
            (interrupt_enables(1), 0xBF88_1070),
            (interrupt_priorities(11), 0xBF88_1140),
            (dma_control(1), 0xBF88_3120),
            (dma_source_pointer(0), 0xBF88_30D0),
            (dma_cell_size(2), 0xBF88_3270),
            (dma_pattern(3), 0xBF88_3350),
            (port_latch(6), 0xBF88_61A0),
            (port_open_drain(1), 0xBF88_6070),
        ];
        for (register, address) in pairs {
            assert_eq!(register.0, address, "{register:x?}");
        }
    }
}
