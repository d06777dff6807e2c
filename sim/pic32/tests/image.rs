//! The SR8730's own image in the emulated chip: mistakes of the original project that only the whole program could repeat.
//!
//! It is built by `cargo xtask firmware sr8730`; `cargo xtask test --only emulator` names it in `RVAC_FIRMWARE`, and the one with
//! `--features link-sampled` in `RVAC_FIRMWARE_SAMPLED`, that with `--features link-rs485` in `RVAC_FIRMWARE_RS485`.

mod latches;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use home::{Home, Noise, RobotModel, World};
use pic32::board::serial::HostRate;
use pic32::board::{Blueprint, CalibrationChoice, EmulatedRobot, EmulatedSettings, MotorOutput};
use pic32::image::Image;
use pic32::machine::{Grounded, Halt, Machine};
use pic32::pins::{Level, Pin};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{BinaryKinds, Command, Info, Inhibit, Report};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::Tick;

/// Lines that switch something on: wheels, main brush, side brushes, suction, charger, speaker.
const ENABLES: [&str; 7] = ["RD0", "RD3", "RD1", "RA4", "RD5", "RD2", "RD13"];
/// Lines that make the bridges of the wheels brake while they are high.
const MODES: [&str; 2] = ["RE7", "RG6"];
/// The link's transmit line.
const TRANSMIT: &str = "RB7";
/// The link's receive line.
const RECEIVE: &str = "RC13";
/// Vectors of the timers that run only while they are needed: half periods of the dock code, pulses of the charger.
const ON_DEMAND: [u8; 2] = [4, 12];
/// Vector of the timer that sends: it comes at changes of the level, at most ten in a byte, and once at its end.
const SENDING: u8 = 16;
const SENDINGS_A_BYTE: u64 = 11;
/// Nine bits at the rate with which the robot begins, 230,400 baud, with a bit to spare: a longer low is a break.
const LOW_CYCLES_MAX: u64 = 10 * 80_000_000 / 230_400;
/// Vectors that come once in a millisecond: core timer and converter.
const REGULAR: [u8; 2] = [0, 27];
/// The program memory.
const FLASH: u32 = 0x1D00_0000;
const FLASH_BYTES: usize = 256 * 1024;
/// The check of the image goes once around in less.
const FOUND_MS: u32 = 15_000;
/// The right wheel's output compare, and a value that makes its pin high until something else is written.
const OC4CON: u32 = 0xBF80_3600;
const HIGH_FOR_GOOD: u32 = 0x8001;
const CYCLES_PER_MS: u64 = 80_000;
const ROOM: &str = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n";

/// The usual image, if it was built.
fn image() -> Option<Image> {
    image_of("RVAC_FIRMWARE", "sr8730.elf")
}

/// An image, if it was built. Where it must be there, it is named.
fn image_of(variable: &str, file: &str) -> Option<Image> {
    let named = std::env::var_os(variable).map(PathBuf::from);
    let built = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../target/firmware")
        .join(file);
    let path = named.clone().unwrap_or(built);
    if named.is_none() && !path.is_file() {
        println!("skipped: the firmware is not built (cargo xtask firmware sr8730 builds it)");
        return None;
    }
    let bytes = std::fs::read(&path).expect("the firmware can be read");
    Some(Image::from_elf(&bytes).expect("the firmware fits the chip"))
}

fn robot() -> Option<EmulatedRobot> {
    Some(robot_with(image()?, &EmulatedSettings::default()))
}

fn robot_with(image: Image, settings: &EmulatedSettings) -> EmulatedRobot {
    let blueprint =
        Blueprint::sr8730(image, &CalibrationChoice::Complete).expect("the project's board is sound");
    let model = RobotModel::by_name("sr8730").expect("it comes with the project");
    let home = Arc::new(Home::from_floorplan("room", ROOM, &model).expect("a valid home"));
    let world = World::new(home, &model, &Noise::nominal(), 1, None);
    EmulatedRobot::new(&blueprint, world, settings)
}

/// Gives the number of bytes that the host has heard.
fn pass_ms(robot: &mut EmulatedRobot, ms: u64) -> u64 {
    let mut bytes = Vec::new();
    for _ in 0..ms {
        robot.tick(&mut bytes);
    }
    bytes.len() as u64
}

fn pin(name: &str) -> Pin {
    name.parse().expect("the pin exists")
}

/// The chip alone: nobody speaks to it, and its analog inputs are at ground.
fn chip() -> Option<Machine> {
    let mut machine = Machine::new(&image()?);
    machine.set_input(pin(RECEIVE), Level::High);
    machine.pull_up(pin(TRANSMIT));
    Some(machine)
}

#[test]
fn a_start_switches_nothing_on_and_sends_no_break() {
    let Some(mut machine) = chip() else { return };
    let watched = ENABLES.iter().chain(&MODES).chain([&TRANSMIT]);
    watched.for_each(|name| machine.watch(pin(name)));
    let end = 1_000 * CYCLES_PER_MS;
    assert_eq!(machine.run_until(end, &mut Grounded), Halt::Reached);
    for name in ENABLES {
        assert_eq!(machine.take_edges(pin(name)), [], "{name}");
    }
    let said = machine.take_edges(pin(TRANSMIT));
    assert!(said.len() > 100, "the robot says who it is: {} edges", said.len());
    for pair in said.chunks_exact(2) {
        assert_eq!((pair[0].1, pair[1].1), (Level::Low, Level::High));
        let low = pair[1].0 - pair[0].0;
        assert!(low < LOW_CYCLES_MAX, "low for {low} cycles at {}", pair[0].0);
    }
    for name in MODES {
        let edges = machine.take_edges(pin(name));
        let levels: Vec<Level> = edges.iter().map(|(_, level)| *level).collect();
        assert_eq!(
            levels,
            [Level::High],
            "{name}: from an input to braking, and no other level"
        );
        assert!(edges[0].0 < CYCLES_PER_MS, "{name} within the first millisecond");
    }
}

#[test]
fn the_program_uses_the_chip_as_it_is_meant() {
    let Some(mut robot) = robot() else { return };
    pass_ms(&mut robot, 1_500);
    robot.world_mut().press_button(1);
    pass_ms(&mut robot, 500);
    // Among misuses are pins driven against what drives them, and analog samples of pins that are digital or outputs.
    assert_eq!(robot.machine().misuses(), []);
    assert_eq!(robot.machine().unknown_accesses(), []);
    assert_eq!(robot.machine().exceptions(), []);
    assert_eq!(robot.resets(), 0);
}

/// Where in flash a text begins that the program does not say in these tests: with a bit of it flipped, what the program
/// does goes on, and its memory is wrong.
fn unsaid_text(robot: &EmulatedRobot) -> u32 {
    let mut flash = vec![0; FLASH_BYTES];
    let read = robot.machine().memory().read(FLASH, &mut flash);
    read.expect("the chip has flash");
    let text = Inhibit::ChargerShorted.name().as_bytes();
    let place = flash.windows(text.len()).position(|bytes| bytes == text);
    FLASH + place.expect("the image names all inhibits") as u32
}

#[test]
fn what_a_register_switches_on_by_itself_does_not_stay_on() {
    let Some(mut sound) = robot() else { return };
    pass_ms(&mut sound, 500);
    let mut damaged = sound.clone();
    let place = unsaid_text(&damaged);
    let flipped = damaged.machine_mut().flip_flash_bit(place, 3);
    flipped.expect("the image is in flash");
    let mut found_ms = 0;
    while damaged.machine().reset_count() == 0 {
        assert!(found_ms < FOUND_MS, "the damage is not found");
        pass_ms(&mut damaged, 1);
        found_ms += 1;
    }
    pass_ms(&mut damaged, 400);
    let started = [&sound, &damaged].map(|robot| robot.machine().reset_count());
    for robot in [&mut sound, &mut damaged] {
        robot.machine_mut().write_register(OC4CON, HIGH_FOR_GOOD);
        pass_ms(robot, 3);
        assert!(robot.duty(MotorOutput::WheelRight) == 0.0);
    }
    // A sound robot starts anew; in one whose image is damaged everything is switched off in each millisecond anyway.
    let resets = [&sound, &damaged].map(|robot| robot.machine().reset_count());
    assert_eq!(resets, [started[0] + 1, started[1]]);
}

#[test]
fn a_robot_at_rest_is_interrupted_by_what_it_needs_only() {
    let Some(mut robot) = robot() else { return };
    pass_ms(&mut robot, 1_500);
    robot.machine_mut().restart_accounting();
    let heard_bytes = pass_ms(&mut robot, 1_000);
    let entries = |vector| {
        let account = robot.machine().accounting().vector(vector);
        account.map_or(0, |account| account.entries)
    };
    for vector in ON_DEMAND {
        assert_eq!(entries(vector), 0, "vector {vector}");
    }
    // What was on its way at either end is not among the bytes that were heard.
    let sent_bytes = heard_bytes + 64;
    assert!(
        entries(SENDING) <= SENDINGS_A_BYTE * sent_bytes,
        "for {heard_bytes} bytes"
    );
    for vector in REGULAR {
        let count = entries(vector);
        assert!(
            (999..=1_001).contains(&count),
            "vector {vector}: {count} in a second"
        );
    }
}

/// The one rate of the sampled line.
const SAMPLED_BAUD: u32 = 57_600;
/// The host's driver always holds about so much: the line is never idle.
const AHEAD_BYTES: usize = 64;

/// A host that asks for the state as fast as the line takes it; gives the last slow facts that it was told.
fn flood(robot: &mut EmulatedRobot, ms: u32) -> Option<Info> {
    let mut session = HostSession::new(BinaryKinds::NONE, Tick(0));
    let empty_room = robot.line_room();
    let (mut packet, mut heard, mut told) = (PacketBuffer::new(), Vec::new(), None);
    for now in (0..ms).map(Tick) {
        let full = |robot: &EmulatedRobot| robot.line_room() + AHEAD_BYTES <= empty_room;
        while session.is_open() && !full(robot) && session.send(Command::State, now, &mut packet).is_ok() {
            robot.send(packet.as_bytes());
        }
        heard.clear();
        robot.tick(&mut heard);
        let mut events: Vec<_> = heard
            .iter()
            .filter_map(|byte| session.receive(*byte, now))
            .collect();
        events.extend(std::iter::from_fn(|| session.poll(now)));
        while session.next_packet(&mut packet) {
            robot.send(packet.as_bytes());
        }
        for event in events {
            if let HostEvent::Report(Report::Info(info)) = event {
                told = Some(info);
            }
        }
    }
    told
}

#[test]
fn the_sampled_line_loses_nothing_at_full_load() {
    for error_permille in [-15.0, 0.0, 15.0] {
        let Some(image) = image_of("RVAC_FIRMWARE_SAMPLED", "sr8730-link-sampled.elf") else {
            return;
        };
        let rate = HostRate {
            baud: SAMPLED_BAUD,
            error_permille,
        };
        let settings = EmulatedSettings {
            rate,
            ..EmulatedSettings::default()
        };
        let link = flood(&mut robot_with(image, &settings), 8_000)
            .expect("slow facts")
            .link;
        let damaged = link.bad_crc + link.framing + link.overrun + link.malformed;
        assert_eq!(damaged, 0, "{error_permille} permille: {link:?}");
        assert!(link.accepted > 500, "{error_permille} permille: {link:?}");
    }
}

/// The driver of an RS-485 pair.
const DRIVER: &str = "RG2";
/// Looking so often sees every bit of the line ten times.
const LOOK_CYCLES: u64 = 30;
/// Between the driver and the first bit, and between the last one and the driver: 10 us.
const SWITCH_CYCLES: u64 = 800;

/// It is on before the first low bit and until the last stop bit is over, and off at once after that, so that an answer of the host
/// meets a free pair.
#[test]
fn the_driver_of_a_pair_is_on_for_exactly_as_long_as_something_is_sent() {
    let Some(image) = image_of("RVAC_FIRMWARE_RS485", "sr8730-link-rs485.elf") else {
        return;
    };
    let mut robot = robot_with(image, &EmulatedSettings::default());
    assert!(flood(&mut robot, 5_000).is_some(), "a session with reports");
    let bit = 80_000_000 / 230_400;
    let (mut heard, mut on_since, mut last_low) = (Vec::new(), None, None);
    let (begin, mut bursts) = (robot.cycle(), 0);
    for cycle in (begin..begin + 300 * CYCLES_PER_MS).step_by(LOOK_CYCLES as usize) {
        robot.advance_to(cycle, &mut heard);
        let [line, driver] = [TRANSMIT, DRIVER].map(|name| robot.machine().level(pin(name)).is_high());
        assert!(line || driver, "a low bit without the driver");
        match (driver, on_since) {
            (true, None) => (on_since, last_low) = (Some(cycle), None),
            (false, Some(_)) => {
                // The last byte may end in ones: nine bits without a low one, the stop bit among them.
                let low = last_low.expect("the driver was on and nothing was sent");
                assert!(
                    cycle - low <= 10 * bit + SWITCH_CYCLES,
                    "on for {} too long",
                    cycle - low
                );
                (on_since, bursts) = (None, bursts + 1);
            }
            (true, Some(since)) if !line && last_low.is_none() => {
                assert!(cycle - since <= SWITCH_CYCLES, "on {} too early", cycle - since);
            }
            _ => {}
        }
        if !line {
            last_low = Some(cycle);
        }
    }
    assert!(bursts >= 5, "{bursts} times");
    assert!(heard.len() > 200, "{} bytes", heard.len());
}
