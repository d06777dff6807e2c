//! A lamp on RG7 that changes every 10 ms, by waiting.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

use embedded_hal::delay::DelayNs;
use pic32mx3_hal::configuration::{Configuration, PrimaryOscillator};
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::{Peripherals, configuration, entry, reset};

const CONFIGURATION: Configuration = Configuration::new()
    .primary_oscillator(PrimaryOscillator::HighSpeed, 8_000_000)
    .pll_to_80_mhz();
configuration!(CONFIGURATION);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let mut lamp = peripherals.pins.rg7.into_output(Level::Low);
    let mut delay = Delay::new(CONFIGURATION.clocks());
    loop {
        lamp.toggle();
        delay.delay_ms(10);
    }
}
entry!(main);

#[cfg(target_arch = "mips")]
#[panic_handler]
fn on_panic(_: &core::panic::PanicInfo) -> ! {
    reset::software_reset()
}
