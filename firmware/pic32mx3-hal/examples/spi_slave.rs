//! A slave on SPI 2 (SCK RG6, SDI RG7, SDO RG8, SS RG9), mode 0: it answers each byte with the one that came before it, the
//! first one of a transfer with 0. Handlers do all of it; the lamp on RD1 shows that a byte was lost.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::sync::atomic::{AtomicU32, Ordering};
use embedded_hal::spi::MODE_0;
use pic32mx3_hal::gpio::{Input, Level, Output, Pin, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::spi::{Spi, SpiSlave};
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};

type Pins = (
    Pin<'G', 6, Input>,
    Pin<'G', 8, Output>,
    Pin<'G', 7, Input>,
    Pin<'G', 9, Input>,
);

struct Echo {
    slave: SpiSlave<2, u8, Pins>,
    lamp: Pin<'D', 1, Output>,
}

static ECHO: HandlerCell<vector::SPI_2, Echo> = HandlerCell::empty();
static RESTART: AtomicU32 = AtomicU32::new(0);
static NEVER: AtomicU32 = AtomicU32::new(0);

fn on_word(context: &mut Context<vector::SPI_2>) {
    let Some(echo) = ECHO.get(context) else { return };
    if RESTART.swap(0, Ordering::Relaxed) != 0 {
        echo.slave.restart();
        echo.slave.try_send(0);
    }
    while let Some(received) = echo.slave.try_receive() {
        match received {
            Ok(byte) => {
                echo.slave.try_send(byte);
            }
            Err(_) => echo.lamp.set_high(),
        }
    }
    Spi::<2>::RECEIVED.clear();
    Spi::<2>::FAULT.clear();
}
interrupt!(SPI_2, on_word);

/// The master lets go of SS: what was prepared for the next byte must not begin the next transfer.
fn on_select(_: &mut Context<vector::CHANGE_NOTICE>) {
    const SELECT: u16 = 1 << 9;
    let is_over = Port::G.read() & SELECT != 0;
    Source::ChangeNotice.clear();
    if is_over {
        RESTART.store(1, Ordering::Relaxed);
        // The slave belongs to the other handler.
        Spi::<2>::RECEIVED.request();
    }
}
interrupt!(CHANGE_NOTICE, on_select);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let mut select = pins.rg9.into_input();
    select.enable_pull_up();
    select.enable_notice();
    let spi_pins = (
        pins.rg6.into_input(),
        pins.rg8.into_output(Level::Low),
        pins.rg7.into_input(),
        select,
    );
    let mut slave = peripherals.spi2.into_slave::<u8, _, _, _, _>(spi_pins, MODE_0);
    slave.try_send(0);
    let lamp = pins.rd1.into_output(Level::Low);
    let mut change_notice = peripherals.change_notice;
    change_notice.start();
    let _levels = Port::G.read();
    Source::ChangeNotice.clear();
    if ECHO.hand_over(Echo { slave, lamp }).is_err()
        || interrupt::set_priority(Vector::Spi2, Priority::Level5, SubPriority::Sub0).is_err()
        || interrupt::set_priority(Vector::ChangeNotice, Priority::Level4, SubPriority::Sub0).is_err()
    {
        reset::software_reset();
    }
    Spi::<2>::RECEIVED.enable();
    Spi::<2>::FAULT.enable();
    Source::ChangeNotice.enable();
    interrupt::start();
    loop {
        cpu::sleep_while_zero(&NEVER);
    }
}
entry!(main);
