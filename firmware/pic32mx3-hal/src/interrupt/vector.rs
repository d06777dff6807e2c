//! The vectors, as a type each for handlers and as numbers (section 5).

/// A vector that can have a handler.
pub trait Handled: sealed::Sealed {
    /// Its number.
    const VECTOR: Vector;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! vectors {
    ($($number:literal $name:ident $variant:ident $text:literal;)*) => {
        /// The vectors. Each has one level.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Vector {
            $(#[doc = $text] $variant = $number,)*
        }

        $(
            #[doc = $text]
            #[derive(Debug)]
            #[allow(non_camel_case_types, reason = "the name of the handler's symbol, written like it")]
            pub struct $name(());
            impl sealed::Sealed for $name {}
            impl Handled for $name {
                const VECTOR: Vector = Vector::$variant;
            }
        )*
    };
}

vectors! {
    0 CORE_TIMER CoreTimer "The core timer's match.";
    1 CORE_SOFTWARE_0 CoreSoftware0 "Set by software.";
    2 CORE_SOFTWARE_1 CoreSoftware1 "Set by software.";
    3 EXTERNAL_0 External0 "Pin INT0, RF6.";
    4 TIMER_1 Timer1 "Timer 1.";
    5 INPUT_CAPTURE_1 InputCapture1 "Input capture 1.";
    6 OUTPUT_COMPARE_1 OutputCompare1 "Output compare 1.";
    7 EXTERNAL_1 External1 "Pin INT1, RE8.";
    8 TIMER_2 Timer2 "Timer 2.";
    9 INPUT_CAPTURE_2 InputCapture2 "Input capture 2.";
    10 OUTPUT_COMPARE_2 OutputCompare2 "Output compare 2.";
    11 EXTERNAL_2 External2 "Pin INT2, RE9.";
    12 TIMER_3 Timer3 "Timer 3.";
    13 INPUT_CAPTURE_3 InputCapture3 "Input capture 3.";
    14 OUTPUT_COMPARE_3 OutputCompare3 "Output compare 3.";
    15 EXTERNAL_3 External3 "Pin INT3, RA14.";
    16 TIMER_4 Timer4 "Timer 4.";
    17 INPUT_CAPTURE_4 InputCapture4 "Input capture 4.";
    18 OUTPUT_COMPARE_4 OutputCompare4 "Output compare 4.";
    19 EXTERNAL_4 External4 "Pin INT4, RA15.";
    20 TIMER_5 Timer5 "Timer 5.";
    21 INPUT_CAPTURE_5 InputCapture5 "Input capture 5.";
    22 OUTPUT_COMPARE_5 OutputCompare5 "Output compare 5.";
    23 SPI_1 Spi1 "SPI 1: fault, sent, received.";
    24 UART_1 Uart1 "UART 1: error, received, sent.";
    25 I2C_1 I2c1 "I2C 1: collision, slave, master.";
    26 CHANGE_NOTICE ChangeNotice "Change notice, all pins.";
    27 ADC Adc "ADC.";
    28 PARALLEL_PORT ParallelPort "Parallel master port.";
    29 COMPARATOR_1 Comparator1 "Comparator 1.";
    30 COMPARATOR_2 Comparator2 "Comparator 2.";
    31 SPI_2 Spi2 "SPI 2: fault, sent, received.";
    32 UART_2 Uart2 "UART 2: error, received, sent.";
    33 I2C_2 I2c2 "I2C 2: collision, slave, master.";
    34 CLOCK_MONITOR ClockMonitor "Fail-safe clock monitor.";
    35 CALENDAR Calendar "Real-time clock and calendar.";
    36 DMA_0 Dma0 "DMA channel 0.";
    37 DMA_1 Dma1 "DMA channel 1.";
    38 DMA_2 Dma2 "DMA channel 2.";
    39 DMA_3 Dma3 "DMA channel 3.";
    44 FLASH Flash "Flash controller.";
}
