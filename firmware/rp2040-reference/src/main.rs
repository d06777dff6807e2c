//! cordlib on a bare RP2040: it says hello on UART0 (GPIO 0 transmits, GPIO 1 receives, 230,400 baud), answers `info` and refuses what
//! it has no parts for. `cargo xtask new-robot` makes a robot's firmware from this one.
#![no_std]
#![no_main]

mod board;

use board::{ChipDog, ChipReset, LinkPort, MicrosecondClock, NoWheels, ReferenceBoard, SerialLink};
use cordlib::board::{Absent, Board};
use cordlib::{Cord, Parameters};
use rp2040_hal::clocks::{Clock as _, ClocksManager, init_clocks_and_plls};
use rp2040_hal::fugit::{ExtU32 as _, RateExtU32 as _};
use rp2040_hal::gpio::Pins;
use rp2040_hal::timer::Timer;
use rp2040_hal::uart::{DataBits, StopBits, UartConfig, UartPeripheral};
use rp2040_hal::watchdog::Watchdog;
use rp2040_hal::{Sio, pac};
use rvac_protocol::message::{Limits, ResetCause};
use rvac_units::{AngularSpeed, Length, Speed};

/// The robot's name in the handshake.
const NAME: &str = "rp2040-reference";
/// Sizes and limits of the robot. These are nobody's: a robot without wheels has none that matter.
const LIMITS: Limits = Limits {
    speed_max: Speed(300_000),
    turn_max: AngularSpeed(1_500_000),
    track: Length(230_000),
    count_nm: 500_000,
    radius: Length(175_000),
    swath: Length(250_000),
};
/// The crystal of the Raspberry Pi Pico and of nearly all boards with this chip.
const CRYSTAL_HZ: u32 = 12_000_000;
/// Bits per second of the link.
const LINK_BAUD: u32 = 230_400;
/// A main loop that hangs this long is started anew (S19).
const WATCHDOG_MS: u32 = 100;

/// What the chip's own loader runs before anything of ours: it sets up the flash.
// SAFETY: the loader copies exactly these 256 bytes from the flash's beginning; the linker script puts nothing else there.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

#[rp2040_hal::entry]
fn main() -> ! {
    // There is nothing to do without the chip's registers, or without its clocks: wait for whoever switches it off.
    match pac::Peripherals::take().and_then(board) {
        Some(board) => {
            let mut cord = Cord::new(
                board,
                Parameters::for_machine(NAME, env!("CARGO_PKG_VERSION"), LIMITS),
            );
            loop {
                cord.step();
            }
        }
        None => loop {
            cortex_m::asm::wfi();
        },
    }
}

fn board(mut chip: pac::Peripherals) -> Option<Board<ReferenceBoard>> {
    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let reset = ChipReset::count(&mut watchdog, reset_cause(&chip.VREG_AND_CHIP_RESET));
    let clocks = init_clocks_and_plls(
        CRYSTAL_HZ,
        chip.XOSC,
        chip.CLOCKS,
        chip.PLL_SYS,
        chip.PLL_USB,
        &mut chip.RESETS,
        &mut watchdog,
    )
    .ok()?;
    let timer = Timer::new(chip.TIMER, &mut chip.RESETS, &clocks);
    let sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut chip.RESETS);
    let lines = (pins.gpio0.into_function(), pins.gpio1.reconfigure());
    let port = UartPeripheral::new(chip.UART0, lines, &mut chip.RESETS);
    let port = link_port(port, &clocks)?;
    watchdog.start(WATCHDOG_MS.millis());
    Some(Board {
        clock: MicrosecondClock(timer),
        link: SerialLink(port),
        wheels: NoWheels,
        reset,
        watchdog: ChipDog(watchdog),
        kept: Absent,
        checks: Absent,
        encoders: Absent,
        bumpers: Absent,
        cliffs: Absent,
        wheel_drops: Absent,
        proximity: Absent,
        gyro: Absent,
        currents: Absent,
        brush_main: Absent,
        brush_sides: Absent,
        vacuum: Absent,
        charger: Absent,
        dock_contacts: Absent,
        dock_beams: Absent,
        dust_box: Absent,
        beeper: Absent,
        lights: Absent,
        buttons: Absent,
        probe: Absent,
    })
}

type ClosedPort<Lines> = UartPeripheral<rp2040_hal::uart::Disabled, pac::UART0, Lines>;

fn link_port(port: ClosedPort<board::LinkLines>, clocks: &ClocksManager) -> Option<LinkPort> {
    let config = UartConfig::new(LINK_BAUD.Hz(), DataBits::Eight, None, StopBits::One);
    port.enable(config, clocks.peripheral_clock.freq()).ok()
}

/// The watchdog first: it clears no flag of the chip's last loss of power, which in its turn clears the watchdog's reason.
fn reset_cause(chip: &pac::VREG_AND_CHIP_RESET) -> ResetCause {
    // SAFETY: a load of a register that only the hardware writes.
    let reason = unsafe { (*pac::WATCHDOG::ptr()).reason().read() };
    let flags = chip.chip_reset().read();
    if reason.timer().bit_is_set() {
        ResetCause::Watchdog
    } else if reason.force().bit_is_set() {
        ResetCause::Software
    } else if flags.had_por().bit_is_set() {
        ResetCause::PowerOn
    } else if flags.had_run().bit_is_set() {
        ResetCause::External
    } else {
        ResetCause::Unknown
    }
}

/// Nothing moves yet. Once there are wheels: rebuild their part and switch it off, then wait for the watchdog.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        cortex_m::asm::nop();
    }
}
