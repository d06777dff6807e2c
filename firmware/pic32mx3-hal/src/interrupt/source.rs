//! The sources of interrupts (section 5, the table of the MX3xx and MX4xx parts).

use super::Vector;
use crate::register::map::{interrupt_enables, interrupt_flags};

macro_rules! sources {
    ($($number:literal $name:ident $vector:ident $text:literal;)*) => {
        /// A source, by its request number.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Source {
            $(#[doc = $text] $name = $number,)*
        }

        impl Source {
            /// The vector it is served through.
            #[must_use]
            pub const fn vector(self) -> Vector {
                match self {
                    $(Self::$name => Vector::$vector,)*
                }
            }
        }
    };
}

sources! {
    0 CoreTimer CoreTimer "The core timer's match.";
    1 CoreSoftware0 CoreSoftware0 "Set by software with [`Source::request`].";
    2 CoreSoftware1 CoreSoftware1 "Set by software with [`Source::request`].";
    3 External0 External0 "Pin INT0.";
    4 Timer1 Timer1 "Timer 1, at the end of its period.";
    5 InputCapture1 InputCapture1 "Input capture 1.";
    6 OutputCompare1 OutputCompare1 "Output compare 1.";
    7 External1 External1 "Pin INT1.";
    8 Timer2 Timer2 "Timer 2, at the end of its period.";
    9 InputCapture2 InputCapture2 "Input capture 2.";
    10 OutputCompare2 OutputCompare2 "Output compare 2.";
    11 External2 External2 "Pin INT2.";
    12 Timer3 Timer3 "Timer 3, at the end of its period.";
    13 InputCapture3 InputCapture3 "Input capture 3.";
    14 OutputCompare3 OutputCompare3 "Output compare 3.";
    15 External3 External3 "Pin INT3.";
    16 Timer4 Timer4 "Timer 4, at the end of its period.";
    17 InputCapture4 InputCapture4 "Input capture 4.";
    18 OutputCompare4 OutputCompare4 "Output compare 4.";
    19 External4 External4 "Pin INT4.";
    20 Timer5 Timer5 "Timer 5, at the end of its period.";
    21 InputCapture5 InputCapture5 "Input capture 5.";
    22 OutputCompare5 OutputCompare5 "Output compare 5.";
    23 Spi1Fault Spi1 "SPI 1: fault.";
    24 Spi1Sent Spi1 "SPI 1: sent.";
    25 Spi1Received Spi1 "SPI 1: received.";
    26 Uart1Error Uart1 "UART 1: error.";
    27 Uart1Received Uart1 "UART 1: received; stays while there are bytes.";
    28 Uart1Sent Uart1 "UART 1: room to send; stays while there is.";
    29 I2c1Collision I2c1 "I2C 1: bus collision.";
    30 I2c1Slave I2c1 "I2C 1: slave.";
    31 I2c1Master I2c1 "I2C 1: master.";
    32 ChangeNotice ChangeNotice "A pin changed; stays until its port was read.";
    33 Adc Adc "ADC: conversions done.";
    34 ParallelPort ParallelPort "Parallel master port.";
    35 Comparator1 Comparator1 "Comparator 1.";
    36 Comparator2 Comparator2 "Comparator 2.";
    37 Spi2Fault Spi2 "SPI 2: fault.";
    38 Spi2Sent Spi2 "SPI 2: sent.";
    39 Spi2Received Spi2 "SPI 2: received.";
    40 Uart2Error Uart2 "UART 2: error.";
    41 Uart2Received Uart2 "UART 2: received; stays while there are bytes.";
    42 Uart2Sent Uart2 "UART 2: room to send; stays while there is.";
    43 I2c2Collision I2c2 "I2C 2: bus collision.";
    44 I2c2Slave I2c2 "I2C 2: slave.";
    45 I2c2Master I2c2 "I2C 2: master.";
    46 ClockMonitor ClockMonitor "The clock failed, and the chip runs on its internal one.";
    47 Calendar Calendar "Real-time clock and calendar.";
    48 Dma0 Dma0 "DMA channel 0.";
    49 Dma1 Dma1 "DMA channel 1.";
    50 Dma2 Dma2 "DMA channel 2.";
    51 Dma3 Dma3 "DMA channel 3.";
    56 Flash Flash "Flash controller.";
}

impl Source {
    const fn index(self) -> u32 {
        self as u32 / 32
    }

    const fn bit(self) -> u32 {
        1 << (self as u32 % 32)
    }

    /// Lets it interrupt. Its vector needs a level ([`super::set_priority`]) and a handler.
    #[inline(always)]
    pub fn enable(self) {
        interrupt_enables(self.index()).set(self.bit());
    }

    /// Keeps it from interrupting. It may still become pending.
    #[inline(always)]
    pub fn disable(self) {
        interrupt_enables(self.index()).clear(self.bit());
    }

    /// Whether it may interrupt.
    #[inline(always)]
    #[must_use]
    pub fn is_enabled(self) -> bool {
        interrupt_enables(self.index()).has(self.bit())
    }

    /// Whether it asks for service, enabled or not.
    #[inline(always)]
    #[must_use]
    pub fn is_pending(self) -> bool {
        interrupt_flags(self.index()).has(self.bit())
    }

    /// Takes the request back. The cause must be gone first where the source keeps it up: bytes of a UART, a change that
    /// was not read. Flags of other sources are left alone even if they change meanwhile.
    #[inline(always)]
    pub fn clear(self) {
        interrupt_flags(self.index()).clear(self.bit());
    }

    /// Asks for service by software.
    #[inline(always)]
    pub fn request(self) {
        interrupt_flags(self.index()).set(self.bit());
    }
}

#[cfg(test)]
mod tests {
    use super::Source;

    /// Rows of section 5 from each part of the table: request, vector.
    #[test]
    fn requests_and_vectors_are_those_of_the_table() {
        let rows = [
            (Source::External0, 3, 3),
            (Source::OutputCompare3, 14, 14),
            (Source::Timer4, 16, 16),
            (Source::Spi1Received, 25, 23),
            (Source::Uart1Sent, 28, 24),
            (Source::ChangeNotice, 32, 26),
            (Source::Adc, 33, 27),
            (Source::Uart2Error, 40, 32),
            (Source::ClockMonitor, 46, 34),
            (Source::Dma3, 51, 39),
            (Source::Flash, 56, 44),
        ];
        for (source, request, vector) in rows {
            assert_eq!(
                (source as u8, source.vector() as u8),
                (request, vector),
                "{source:?}"
            );
        }
    }
}
