//! Runs 20 changes of RG7, 1000 counts of the core timer apart, on each of these clocks in turn: crystal and PLL at 80 MHz, the
//! internal oscillator at 8 MHz, internal oscillator and PLL at 60 MHz with a quarter for the peripherals, the crystal alone. Timer 3
//! makes pulses on RD0 meanwhile, a period of 4000 peripheral clocks. RE0 goes high when a switch fails.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use embedded_hal::pwm::SetDutyCycle;
use pic32mx3_hal::configuration::{
    Configuration, InputDivider, Multiplier, OscillatorSource, OutputDivider, PeripheralDivider,
};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::pwm::PwmTimer;
use pic32mx3_hal::timer::Prescaler;
use pic32mx3_hal::{Peripherals, core_timer, entry, reset};

const CHANGES: u32 = 20;
const CHANGE_COUNTS: u32 = 1_000;
const PERIOD_CLOCKS: u32 = 4_000;
/// More than any of the clocks needs to start.
const PATIENCE_COUNTS: u32 = 400_000;

const CLOCKS: [Configuration; 4] = [
    board::CONFIGURATION.oscillator(OscillatorSource::Internal),
    board::CONFIGURATION
        .oscillator(OscillatorSource::InternalPll)
        .pll(InputDivider::By2, Multiplier::Times15, OutputDivider::By1)
        .peripheral_divider(PeripheralDivider::By4),
    board::CONFIGURATION.oscillator(OscillatorSource::Primary),
    board::CONFIGURATION,
];

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let mut lamp = pins.rg7.into_output(Level::Low);
    let mut failed = pins.re0.into_output(Level::Low);
    let time_base = PwmTimer::timer3(peripherals.timer3, Prescaler::By1, PERIOD_CLOCKS);
    let mut pulses = time_base.channel(peripherals.compare1, pins.rd0.into_output(Level::Low));
    pulses.enable();
    let Ok(()) = pulses.set_duty_cycle_percent(50);
    let mut oscillators = peripherals.oscillators;
    loop {
        for clock in &CLOCKS {
            let mut next = core_timer::count();
            for _ in 0..CHANGES {
                next = next.wrapping_add(CHANGE_COUNTS);
                while (core_timer::count().wrapping_sub(next) as i32) < 0 {}
                lamp.toggle();
            }
            if oscillators.switch(clock, PATIENCE_COUNTS).is_err() {
                failed.set_high();
            }
        }
    }
}
entry!(main);
