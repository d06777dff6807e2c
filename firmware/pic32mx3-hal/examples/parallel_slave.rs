//! A slave of the parallel port (PMD0 to PMD7 RE0 to RE7, PMRD RD5, PMWR RD4, PMCS1 RD11, all active low) whose handler answers each
//! byte with its complement. The lamp on RG7 comes on when a byte was lost.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::sync::atomic::AtomicU32;
use pic32mx3_hal::gpio::{Level, Output, Pin};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, SubPriority, Vector, vector};
use pic32mx3_hal::parallel_port::{ActiveLevel, ParallelPort, ParallelSlave, SlaveLevels};
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};

const LEVELS: SlaveLevels = SlaveLevels {
    select: ActiveLevel::Low,
    read: ActiveLevel::Low,
    write: ActiveLevel::Low,
};

struct Answering {
    slave: ParallelSlave,
    lamp: Pin<'G', 7, Output>,
}

static ANSWERING: HandlerCell<vector::PARALLEL_PORT, Answering> = HandlerCell::empty();
static NEVER: AtomicU32 = AtomicU32::new(0);

fn on_access(context: &mut Context<vector::PARALLEL_PORT>) {
    ParallelPort::SOURCE.clear();
    let Some(answering) = ANSWERING.get(context) else {
        return;
    };
    while let Some(received) = answering.slave.try_receive() {
        let done = received.is_ok_and(|byte| answering.slave.try_send(!byte));
        if !done {
            answering.lamp.set_high();
        }
    }
}
interrupt!(PARALLEL_PORT, on_access);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let data = (
        pins.re0.into_input(),
        pins.re1.into_input(),
        pins.re2.into_input(),
        pins.re3.into_input(),
        pins.re4.into_input(),
        pins.re5.into_input(),
        pins.re6.into_input(),
        pins.re7.into_input(),
    );
    let strobes = (
        pins.rd11.into_input(),
        pins.rd5.into_input(),
        pins.rd4.into_input(),
    );
    let answering = Answering {
        slave: peripherals.parallel_port.into_slave((data, strobes), LEVELS),
        lamp: pins.rg7.into_output(Level::Low),
    };
    if ANSWERING.hand_over(answering).is_err()
        || interrupt::set_priority(Vector::ParallelPort, Priority::Level3, SubPriority::Sub0).is_err()
    {
        reset::software_reset();
    }
    ParallelPort::SOURCE.enable();
    interrupt::start();
    loop {
        cpu::sleep_while_zero(&NEVER);
    }
}
entry!(main);
