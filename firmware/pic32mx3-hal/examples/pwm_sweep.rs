//! 20 kHz on OC1 (RD0): its width goes from 0 to 100 % by 5 % each 2 ms, then the pulses are taken off for 2 ms. OC4 (RD3)
//! has the rest of each period: 100 % less than that.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use embedded_hal::delay::DelayNs;
use embedded_hal::pwm::SetDutyCycle;
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::pwm::PwmTimer;
use pic32mx3_hal::timer::Prescaler;
use pic32mx3_hal::{Peripherals, entry, reset};

const PWM_HZ: u32 = 20_000;

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let clocks = board::CONFIGURATION.clocks();
    let pins = peripherals.pins;
    let time_base = PwmTimer::timer3(peripherals.timer3, Prescaler::By1, clocks.peripheral_hz / PWM_HZ);
    let mut up = time_base.channel(peripherals.compare1, pins.rd0.into_output(Level::Low));
    let mut down = time_base.channel(peripherals.compare4, pins.rd3.into_output(Level::Low));
    let mut delay = Delay::new(clocks);
    loop {
        up.enable();
        for percent in (0..=100_u8).step_by(5) {
            let (Ok(()), Ok(())) = (
                up.set_duty_cycle_percent(percent),
                down.set_duty_cycle_percent(100 - percent),
            );
            delay.delay_ms(2);
        }
        up.disable();
        delay.delay_ms(2);
    }
}
entry!(main);
