//! When the crystal fails, the chip goes on with its internal oscillator, ten times slower, and asks for an interrupt. Its
//! handler takes the pulses off RD0 (OC1), which would last ten times longer now, and sets RG7; the main program is informed and
//! sets RG8 when it finds the same in the register.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::sync::atomic::{AtomicU32, Ordering};
use pic32mx3_hal::clock::{self, Running};
use pic32mx3_hal::gpio::{Level, Output, Pin, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::pwm::{PwmChannel, PwmTimer};
use pic32mx3_hal::timer::Prescaler;
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};

type Motor = PwmChannel<1, 3, Pin<'D', 0, Output>>;

static MOTOR: HandlerCell<vector::CLOCK_MONITOR, Motor> = HandlerCell::empty();
static FAILED: AtomicU32 = AtomicU32::new(0);

fn on_failure(context: &mut Context<vector::CLOCK_MONITOR>) {
    if let Some(motor) = MOTOR.get(context) {
        motor.disable();
    }
    Port::G.set(1 << 7);
    // The request stays up while the failure does.
    Source::ClockMonitor.disable();
    FAILED.store(1, Ordering::Release);
}
interrupt!(CLOCK_MONITOR, on_failure);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let _told = pins.rg7.into_output(Level::Low);
    let mut found = pins.rg8.into_output(Level::Low);
    let time_base = PwmTimer::timer3(peripherals.timer3, Prescaler::By1, 4_000);
    let mut motor = time_base.channel(peripherals.compare1, pins.rd0.into_output(Level::Low));
    motor.set_width(1_000);
    let ready = MOTOR.hand_over(motor).is_ok()
        && interrupt::set_priority(Vector::ClockMonitor, Priority::Level5, SubPriority::Sub3).is_ok();
    if !ready || clock::running() != Running::PrimaryPll {
        reset::software_reset();
    }
    Source::ClockMonitor.enable();
    interrupt::start();
    loop {
        cpu::sleep_while_zero(&FAILED);
        if clock::has_failed() && clock::running() == Running::Internal {
            found.set_high();
        }
        FAILED.store(0, Ordering::Relaxed);
    }
}
entry!(main);
