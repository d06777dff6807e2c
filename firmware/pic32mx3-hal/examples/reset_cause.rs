//! Says on UART 1 (RF3, 115200 baud) why the chip started, then provokes the next kind of reset: by an interrupt that
//! has no handler, by the watchdog while the program runs, by the watchdog while it sleeps, by software, by a bus error.
//!
//! Each line is: number of the start, bits of RCON in hexadecimal, and what broke before, if something did.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::fmt::Write as _;
use core::sync::atomic::AtomicU32;
use embedded_io::Write;
use pic32mx3_hal::exception::{self, Exception};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::interrupt::{Priority, Source, SubPriority, Vector};
use pic32mx3_hal::persistent::Persistent;
use pic32mx3_hal::reset::{self, Causes};
use pic32mx3_hal::{Peripherals, cpu, entry, exception_hook, interrupt, stack};

#[cfg_attr(target_arch = "mips", unsafe(link_section = ".noinit"))]
static STARTS: Persistent<1> = Persistent::uninitialised();
static NEVER: AtomicU32 = AtomicU32::new(0);

fn on_exception(_: &Exception) -> ! {
    // A program with motors turns them off here.
    reset::software_reset()
}
exception_hook!(on_exception);

/// Lets `write!` write to a UART.
struct Text<W>(W);

impl<W: Write> core::fmt::Write for Text<W> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.0.write_all(text.as_bytes()).map_err(|_| core::fmt::Error)
    }
}

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let causes = Causes::take();
    let [start] = STARTS.load().unwrap_or([0]);
    STARTS.store([start + 1]);
    let broken = exception::take_last();

    let pins = (
        peripherals.pins.rf3.into_output(Level::High),
        peripherals.pins.rf2.into_input(),
    );
    let clocks = board::CONFIGURATION.clocks();
    let Ok((transmitter, _)) = peripherals.uart1.start(pins, 115_200, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    write!(text, "{start} {:x}", causes.bits()).ok();
    if let Some(exception) = broken {
        write!(text, " {:?}", exception.kind()).ok();
    }
    if !stack::canary_is_alive() || stack::used_most() > stack::size() / 2 {
        write!(text, " stack").ok();
    }
    writeln!(text).ok();
    text.0.flush().ok();

    let mut watchdog = peripherals.watchdog;
    match start {
        0 => request_what_nobody_handles(),
        1 => watchdog.start(),
        2 => {
            watchdog.start();
            loop {
                cpu::sleep_while_zero(&NEVER);
            }
        }
        3 => reset::software_reset(),
        4 => read_where_nothing_is(),
        _ => {}
    }
    loop {
        core::hint::spin_loop();
    }
}
entry!(main);

fn read_where_nothing_is() {
    let nothing = core::ptr::with_exposed_provenance::<u32>(0x8010_0000);
    // SAFETY: it is not safe: the bus answers with an error, which is what this shows. No memory is there to be damaged.
    unsafe { nothing.read_volatile() };
}

fn request_what_nobody_handles() {
    interrupt::set_priority(Vector::CoreSoftware1, Priority::Level1, SubPriority::Sub0).ok();
    Source::CoreSoftware1.enable();
    interrupt::start();
    Source::CoreSoftware1.request();
}
