//! Sets the calendar to three seconds before midnight of a 28th of February in a leap year and lets its alarm come each second: the
//! handler wakes the program, which writes the moment to UART 1 (RF3, 115200 baud) and goes back to sleep, clocks and all. A crystal
//! of 32.768 kHz is on RC13 and RC14; without one the program says so.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use core::sync::atomic::{AtomicU32, Ordering};
use embedded_io::Write as _;
use pic32mx3_hal::calendar::{AlarmCount, AlarmEvery, Calendar, DateTime};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::interrupt::{Context, Priority, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, core_timer, entry, interrupt, power, reset};
use text::Text;

const BAUD: u32 = 115_200;
const BEGIN: DateTime = DateTime {
    year: 2_028,
    month: 2,
    day: 28,
    weekday: 1,
    hour: 23,
    minute: 59,
    second: 57,
};

static RANG: AtomicU32 = AtomicU32::new(0);

fn on_alarm(_: &mut Context<vector::CALENDAR>) {
    Calendar::SOURCE.clear();
    RANG.store(1, Ordering::Release);
}
interrupt!(CALENDAR, on_alarm);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let clocks = board::CONFIGURATION.clocks();
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let mut oscillators = peripherals.oscillators;
    oscillators.run_secondary(true);
    // A crystal of this kind may take half a second.
    let begun = core_timer::count();
    while !oscillators.is_secondary_ready()
        && core_timer::count().wrapping_sub(begun) < clocks.core_timer_hz()
    {}
    let mut calendar = peripherals.calendar;
    let set = calendar.set(BEGIN);
    let alarm = calendar.set_alarm(BEGIN, AlarmEvery::Second, AlarmCount::Endless);
    if set.is_err() || alarm.is_err() {
        writeln!(text, "no calendar: {set:?}").ok();
    }
    if interrupt::set_priority(Vector::Calendar, Priority::Level2, SubPriority::Sub0).is_err() {
        reset::software_reset();
    }
    Calendar::SOURCE.enable();
    interrupt::start();
    loop {
        let Ok(()) = text.0.flush();
        while RANG.load(Ordering::Acquire) == 0 {
            power::sleep_while_zero(&RANG);
        }
        RANG.store(0, Ordering::Relaxed);
        let now = calendar.now();
        writeln!(
            text,
            "{}-{:02}-{:02} {} {:02}:{:02}:{:02}",
            now.year, now.month, now.day, now.weekday, now.hour, now.minute, now.second
        )
        .ok();
    }
}
entry!(main);
