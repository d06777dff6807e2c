//! The parts of the chip, each once.

use crate::adc::Adc;
use crate::calendar::Calendar;
use crate::capture::InputCapture;
use crate::change_notice::ChangeNotice;
use crate::comparator::{Comparator, VoltageReference};
use crate::core_timer::CoreTimer;
use crate::cpu;
use crate::dma::Dma;
use crate::flash::DataFlash;
use crate::gpio::Pins;
use crate::i2c::I2c;
use crate::oscillator::Oscillators;
use crate::parallel_port::ParallelPort;
use crate::pwm::OutputCompare;
use crate::spi::Spi;
use crate::timer::Timer;
use crate::uart::Uart;
use crate::watchdog::Watchdog;
use core::sync::atomic::{AtomicBool, Ordering};

static TAKEN: AtomicBool = AtomicBool::new(false);

/// Everything that can have an owner.
#[derive(Debug)]
pub struct Peripherals {
    /// The pins.
    pub pins: Pins,
    /// The core timer.
    pub core_timer: CoreTimer,
    /// Timer 1.
    pub timer1: Timer<1>,
    /// Timer 2.
    pub timer2: Timer<2>,
    /// Timer 3.
    pub timer3: Timer<3>,
    /// Timer 4.
    pub timer4: Timer<4>,
    /// Timer 5.
    pub timer5: Timer<5>,
    /// Output compare 1.
    pub compare1: OutputCompare<1>,
    /// Output compare 2.
    pub compare2: OutputCompare<2>,
    /// Output compare 3.
    pub compare3: OutputCompare<3>,
    /// Output compare 4.
    pub compare4: OutputCompare<4>,
    /// Output compare 5.
    pub compare5: OutputCompare<5>,
    /// Input capture 1.
    pub capture1: InputCapture<1>,
    /// Input capture 2.
    pub capture2: InputCapture<2>,
    /// Input capture 3.
    pub capture3: InputCapture<3>,
    /// Input capture 4.
    pub capture4: InputCapture<4>,
    /// Input capture 5.
    pub capture5: InputCapture<5>,
    /// The ADC.
    pub adc: Adc,
    /// The calendar.
    pub calendar: Calendar,
    /// Comparator 1.
    pub comparator1: Comparator<1>,
    /// Comparator 2.
    pub comparator2: Comparator<2>,
    /// The comparators' reference.
    pub voltage_reference: VoltageReference,
    /// UART 1.
    pub uart1: Uart<1>,
    /// UART 2.
    pub uart2: Uart<2>,
    /// SPI 1.
    pub spi1: Spi<1>,
    /// SPI 2.
    pub spi2: Spi<2>,
    /// I2C 1.
    pub i2c1: I2c<1>,
    /// I2C 2.
    pub i2c2: I2c<2>,
    /// The parallel port.
    pub parallel_port: ParallelPort,
    /// DMA.
    pub dma: Dma,
    /// Change notice.
    pub change_notice: ChangeNotice,
    /// The watchdog.
    pub watchdog: Watchdog,
    /// The oscillators.
    pub oscillators: Oscillators,
    /// The page of flash for data.
    pub data_flash: DataFlash,
}

impl Peripherals {
    /// All parts, the first time; `None` after that.
    #[must_use]
    pub fn take() -> Option<Self> {
        let taken = cpu::without_interrupts(|| {
            let taken = TAKEN.load(Ordering::Relaxed);
            TAKEN.store(true, Ordering::Relaxed);
            taken
        });
        (!taken).then(Self::new)
    }

    const fn new() -> Self {
        Self {
            pins: Pins::new(),
            core_timer: CoreTimer::new(),
            timer1: Timer::new(),
            timer2: Timer::new(),
            timer3: Timer::new(),
            timer4: Timer::new(),
            timer5: Timer::new(),
            compare1: OutputCompare::new(),
            compare2: OutputCompare::new(),
            compare3: OutputCompare::new(),
            compare4: OutputCompare::new(),
            compare5: OutputCompare::new(),
            capture1: InputCapture::new(),
            capture2: InputCapture::new(),
            capture3: InputCapture::new(),
            capture4: InputCapture::new(),
            capture5: InputCapture::new(),
            adc: Adc::new(),
            calendar: Calendar::new(),
            comparator1: Comparator::new(),
            comparator2: Comparator::new(),
            voltage_reference: VoltageReference::new(),
            uart1: Uart::new(),
            uart2: Uart::new(),
            spi1: Spi::new(),
            spi2: Spi::new(),
            i2c1: I2c::new(),
            i2c2: I2c::new(),
            parallel_port: ParallelPort::new(),
            dma: Dma::new(),
            change_notice: ChangeNotice::new(),
            watchdog: Watchdog::new(),
            oscillators: Oscillators::new(),
            data_flash: DataFlash::new(),
        }
    }
}
