//! What all examples share: an 8 MHz crystal, 80 MHz for core and peripherals, and a reset when the program panics.

use pic32mx3_hal::configuration;
use pic32mx3_hal::configuration::{Configuration, PrimaryOscillator};

/// The configuration words.
pub(crate) const CONFIGURATION: Configuration = Configuration::new()
    .primary_oscillator(PrimaryOscillator::HighSpeed, 8_000_000)
    .pll_to_80_mhz()
    .clock_monitor(true)
    .watchdog_period_ms(128);
configuration!(CONFIGURATION);

#[cfg(target_arch = "mips")]
#[panic_handler]
fn on_panic(_: &core::panic::PanicInfo<'_>) -> ! {
    pic32mx3_hal::reset::software_reset()
}
