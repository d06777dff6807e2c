//! Lights, sounds and keys of the SR8730's own image, as people perceive them: at the pins of the emulated chip.
//!
//! It is built by `cargo xtask firmware sr8730`; `cargo xtask test --only emulator` names it in `RVAC_FIRMWARE`, and that of a sister
//! with a display in `RVAC_FIRMWARE_DISPLAY`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use home::{Home, Noise, RobotModel, World};
use pic32::board::{Blueprint, CalibrationChoice, EmulatedRobot, EmulatedSettings};
use pic32::image::Image;
use pic32::pins::{Level, Pin};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{Battery, Beep, BinaryKinds, Command, Event, Led, LedPattern, Report};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::{Frequency, Ratio, Tick};

const ROOM: &str = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n";
/// Switches the speaker's amplifier.
const AMPLIFIER: &str = "RD13";
const CYCLES_PER_MS: u64 = 80_000;
/// Contacts of cheap buttons bounce for up to that.
const BOUNCE_US: u32 = 4_000;
/// From a command on its way until the robot has carried it out: two packets on the line, and its ticks.
const WAY_MS: u32 = 20;
/// Lights that are there, and on how many lines and supplies.
const LIGHTS: u8 = 8;
const MAIN_LIGHTS: u8 = 5;

/// Which firmware a robot has: the variable that names its image, and the robot by whose name it is built.
const PLAIN: (&str, &str) = ("RVAC_FIRMWARE", "sr8730");
const WITH_DISPLAY: (&str, &str) = ("RVAC_FIRMWARE_DISPLAY", "sr8750");

/// The image, if it was built. Where it must be there, it is named.
fn image((variable, robot): (&str, &str)) -> Option<Image> {
    let named = std::env::var_os(variable).map(PathBuf::from);
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../target/firmware/{robot}.elf"));
    let path = named.clone().unwrap_or(built);
    if named.is_none() && !path.is_file() {
        println!("skipped: the firmware is not built (cargo xtask firmware {robot} builds it)");
        return None;
    }
    let bytes = std::fs::read(&path).expect("the firmware can be read");
    Some(Image::from_elf(&bytes).expect("the firmware fits the chip"))
}

/// A robot that stands in a room, and a host that talks to it.
struct Desk {
    robot: EmulatedRobot,
    session: HostSession,
    packet: PacketBuffer,
    /// Each press and release that the host was told of.
    keys: Vec<(u8, bool)>,
    /// Buttons that are down by the newest state.
    down: u8,
    /// The charge of the battery by the newest state that knows it, in percent.
    charge_percent: Option<i32>,
}

impl Desk {
    fn new() -> Option<Self> {
        Self::with(PLAIN, &CalibrationChoice::Complete)
    }

    fn with(firmware: (&str, &str), calibration: &CalibrationChoice) -> Option<Self> {
        Self::in_room(firmware, calibration, ROOM)
    }

    /// With a battery that is half empty.
    fn in_room(firmware: (&str, &str), calibration: &CalibrationChoice, room: &str) -> Option<Self> {
        let blueprint =
            Blueprint::sr8730(image(firmware)?, calibration).expect("the project's board is sound");
        let model = RobotModel::by_name("sr8730").expect("it comes with the project");
        let home = Arc::new(Home::from_floorplan("room", room, &model).expect("a valid home"));
        let mut world = World::new(home, &model, &Noise::nominal(), 1, None);
        world.set_battery_charge(0.5);
        let settings = EmulatedSettings {
            bounce_us: BOUNCE_US,
            ..EmulatedSettings::default()
        };
        let mut desk = Self {
            robot: EmulatedRobot::new(&blueprint, world, &settings),
            session: HostSession::new(BinaryKinds::NONE, Tick(0)),
            packet: PacketBuffer::new(),
            keys: Vec::new(),
            down: 0,
            charge_percent: None,
        };
        desk.pass_ms(2_000);
        assert!(desk.session.is_open(), "the robot answers");
        Some(desk)
    }

    fn tick(&mut self) {
        let mut heard = Vec::new();
        self.robot.tick(&mut heard);
        let now = Tick(self.robot.now_ms() as u32);
        let mut events: Vec<_> = heard
            .iter()
            .filter_map(|byte| self.session.receive(*byte, now))
            .collect();
        events.extend(std::iter::from_fn(|| self.session.poll(now)));
        while self.session.next_packet(&mut self.packet) {
            self.robot.send(self.packet.as_bytes());
        }
        for event in events {
            match event {
                HostEvent::Report(Report::State(state)) => self.down = state.buttons,
                HostEvent::Report(Report::Info(info)) => {
                    let percent = |battery: Battery| (battery.charge.millionths() + 5_000) / 10_000;
                    self.charge_percent = info.battery.map(percent).or(self.charge_percent);
                }
                HostEvent::Report(Report::Event(told)) => {
                    if let Event::Button { button, pressed } = told.kind {
                        self.keys.push((button, pressed));
                    }
                }
                _ => {}
            }
        }
    }

    fn pass_ms(&mut self, ms: u32) {
        for _ in 0..ms {
            self.tick();
        }
    }

    fn send(&mut self, command: Command) {
        let now = Tick(self.robot.now_ms() as u32);
        self.session
            .send(command, now, &mut self.packet)
            .expect("a session is open");
        self.robot.send(self.packet.as_bytes());
    }

    fn light(&mut self, led: u8, pattern: LedPattern, brightness: Ratio) {
        self.send(Command::Led(Led {
            led,
            pattern,
            brightness,
        }));
        self.pass_ms(WAY_MS);
    }

    /// Whether the display's colon is lit.
    fn colon(&self) -> bool {
        let colon = self.robot.wiring().display.colon;
        colon.is_on(self.robot.machine().output(colon.pin))
    }

    /// What a person reads on the display in the next `ms`: a letter a digit. A segment counts as lit when it is on for at
    /// least a sixteenth of the time, and is dark when it never is.
    fn read_display(&mut self, ms: u32) -> String {
        let before = self.robot.digit_cycles();
        self.pass_ms(ms);
        let after = self.robot.digit_cycles();
        let letter = |(before, after): ([u64; 7], [u64; 7])| {
            let lit: String = (0..7)
                .filter(|segment| after[*segment] > before[*segment])
                .map(|segment| {
                    let cycles = after[segment] - before[segment];
                    let bright = cycles * 16 >= u64::from(ms) * CYCLES_PER_MS;
                    if bright {
                        char::from(b'a' + segment as u8)
                    } else {
                        '?'
                    }
                })
                .collect();
            reading(&lit)
        };
        before.into_iter().zip(after).map(letter).collect()
    }

    /// Share of the time in which each light was lit in the next `ms`, in percent, and whether anything else was.
    fn watch_lights(&mut self, ms: u32) -> ([u64; LIGHTS as usize], bool) {
        let before = self.robot.lit_cycles();
        self.pass_ms(ms);
        let after = self.robot.lit_cycles();
        let cycles = u64::from(ms) * CYCLES_PER_MS;
        let lit = |supply: usize, line: usize| (after[supply][line] - before[supply][line]) * 100 / cycles;
        let shares = std::array::from_fn(|light| match light {
            0..5 => lit(0, light),
            _ => lit(1, light - 3),
        });
        // The third supply is that of the cliff sensors' emitters in a calibrated robot.
        let elsewhere = lit(1, 0) + lit(1, 1);
        (shares, elsewhere > 0)
    }
}

/// The letter that these segments show: a is the top one, b to f follow clockwise, g is in the middle.
fn reading(lit: &str) -> char {
    match lit {
        "" => ' ',
        "g" => '-',
        "abcdef" => '0',
        "bc" => '1',
        "abdeg" => '2',
        "abcdg" => '3',
        "bcfg" => '4',
        "acdfg" => '5',
        "acdefg" => '6',
        "abc" => '7',
        "abcdefg" => '8',
        "abcdfg" => '9',
        "adefg" => 'E',
        "eg" => 'r',
        _ => '?',
    }
}

fn ratio(millionths: i32) -> Ratio {
    Ratio::from_millionths(millionths).expect("a share")
}

#[test]
fn tones_have_their_pitch_and_length_and_then_it_is_silent() {
    let Some(mut desk) = Desk::new() else { return };
    let amplifier: Pin = AMPLIFIER.parse().expect("the pin exists");
    for (pitch_hz, duration_ms, volume) in [
        (440, 200, 1_000_000),
        (880, 100, 500_000),
        (2_000, 350, 1_000_000),
        (100, 300, 100_000),
    ] {
        desk.send(Command::Beep(Beep {
            pitch: Frequency(pitch_hz),
            duration_ms,
            volume: ratio(volume),
        }));
        let (mut sounding_ms, mut heard) = (0, Vec::new());
        for _ in 0..u32::from(duration_ms) + 200 {
            desk.tick();
            sounding_ms += u16::from(desk.robot.machine().level(amplifier) == Level::High);
            heard.extend(desk.robot.pitch_hz());
        }
        assert!(
            sounding_ms.abs_diff(duration_ms) <= 2,
            "{pitch_hz} Hz for {sounding_ms} ms, not {duration_ms}"
        );
        // All but the first two periods, which say how long a period is.
        let judged_ms = usize::from(duration_ms) - 2_000 / pitch_hz as usize;
        assert!(
            heard.len() + 10 >= judged_ms,
            "{pitch_hz} Hz heard for {} ms",
            heard.len()
        );
        for pitch in heard {
            assert!(
                (pitch - f64::from(pitch_hz)).abs() < 0.1,
                "{pitch} Hz, not {pitch_hz}"
            );
        }
    }
}

#[test]
fn tones_follow_one_another_with_the_pause_between_them() {
    let Some(mut desk) = Desk::new() else { return };
    for (pitch_hz, duration_ms) in [(500, 100), (0, 100), (1_000, 100)] {
        desk.send(Command::Beep(Beep {
            pitch: Frequency(pitch_hz),
            duration_ms,
            volume: Ratio::ONE,
        }));
    }
    let mut runs: Vec<(Option<u32>, u32)> = Vec::new();
    for _ in 0..500 {
        desk.tick();
        let pitch = desk.robot.pitch_hz().map(|pitch_hz| pitch_hz.round() as u32);
        match runs.last_mut() {
            Some((last, ms)) if *last == pitch => *ms += 1,
            _ => runs.push((pitch, 1)),
        }
    }
    let heard: Vec<Option<u32>> = runs.iter().map(|(pitch, _)| *pitch).collect();
    assert_eq!(heard, [None, Some(500), None, Some(1_000), None], "{runs:?}");
    for (place, (_, ms)) in runs.iter().enumerate().skip(1).take(3) {
        assert!(ms.abs_diff(100) <= 5, "{place}: {runs:?}");
    }
}

/// Lights one light at this brightness, in millionths, and asserts that it is lit for this share of the time, and no other.
fn assert_lit_alone(desk: &mut Desk, light: u8, brightness: i32, percent: u64) {
    desk.light(light, LedPattern::On, ratio(brightness));
    let (shares, elsewhere) = desk.watch_lights(320);
    for (number, share) in shares.iter().enumerate() {
        let wanted = if number == usize::from(light) { percent } else { 0 };
        assert!(
            share.abs_diff(wanted) <= 2,
            "light {light} at {brightness}: {shares:?}"
        );
    }
    assert!(!elsewhere, "light {light} is the only one");
}

#[test]
fn each_light_is_lit_alone_as_brightly_as_it_was_told() {
    let Some(mut desk) = Desk::new() else { return };
    // What the robot shows by itself is not judged here.
    for light in 0..LIGHTS {
        desk.light(light, LedPattern::Off, Ratio::ZERO);
    }
    for light in 0..LIGHTS {
        // A supply is on for half of the time.
        for (brightness, percent) in [(1_000_000, 50_u64), (500_000, 25), (125_000, 6)] {
            assert_lit_alone(&mut desk, light, brightness, percent);
        }
        desk.light(light, LedPattern::Off, Ratio::ONE);
        let (shares, _) = desk.watch_lights(64);
        assert_eq!(shares, [0; LIGHTS as usize], "light {light} is off again");
    }
}

#[test]
fn a_blinking_light_is_lit_half_of_each_second() {
    let Some(mut desk) = Desk::new() else { return };
    for light in 0..LIGHTS {
        desk.light(light, LedPattern::Off, Ratio::ZERO);
    }
    for light in [0, MAIN_LIGHTS] {
        desk.light(light, LedPattern::Blink, Ratio::ONE);
        let lit: Vec<bool> = (0..100)
            .map(|_| desk.watch_lights(32).0[usize::from(light)] > 10)
            .collect();
        let changes = lit.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let count = lit.iter().filter(|lit| **lit).count();
        // 3.2 s: six or seven half seconds begin, and half of all slots are lit.
        assert!((6..=7).contains(&changes), "light {light}: {changes} changes");
        assert!((40..=60).contains(&count), "light {light}: {count} of 100 slots");
        desk.light(light, LedPattern::Off, Ratio::ZERO);
    }
}

#[test]
fn each_key_is_pressed_held_and_released_once_however_it_bounces() {
    let Some(mut desk) = Desk::new() else { return };
    for button in 0..3 {
        for held_ms in [60, 1_500] {
            desk.keys.clear();
            desk.robot.world_mut().press_button(button);
            desk.pass_ms(held_ms);
            assert_eq!(desk.keys, [(button, true)], "held for {held_ms} ms");
            if held_ms > 100 {
                assert_eq!(desk.down, 1 << button, "the state shows it");
            }
            desk.robot.world_mut().release_button(button);
            desk.pass_ms(300);
            assert_eq!(
                desk.keys,
                [(button, true), (button, false)],
                "held for {held_ms} ms"
            );
            assert_eq!(desk.down, 0);
        }
    }
}

#[test]
fn a_sister_with_a_display_shows_the_charge_that_the_host_is_told() {
    let Some(mut desk) = Desk::with(WITH_DISPLAY, &CalibrationChoice::Complete) else {
        return;
    };
    desk.pass_ms(3_000);
    let percent = desk.charge_percent.expect("the battery has been measured");
    assert_eq!(desk.read_display(400), format!("{percent:>4}"));
    assert!(!desk.colon());
}

#[test]
fn the_colon_of_a_display_is_lit_while_the_battery_charges() {
    let room = format!("{ROOM}[dock]\nposition = [0.0, 1.5]\nheading-deg = 0.0\n");
    let Some(mut desk) = Desk::in_room(WITH_DISPLAY, &CalibrationChoice::Complete, &room) else {
        return;
    };
    assert!(!desk.colon(), "the charger waits");
    let lit = (0..60_000).find(|_| {
        desk.tick();
        desk.colon()
    });
    assert!(lit.is_some(), "a docked robot with half a charge charges");
    // A person takes it off the dock.
    desk.robot.world_mut().lift();
    desk.pass_ms(2_000);
    assert!(!desk.colon());
}

#[test]
fn a_display_says_that_the_charge_is_not_known_or_that_something_is_wrong() {
    let Some(mut desk) = Desk::with(WITH_DISPLAY, &CalibrationChoice::Absent) else {
        return;
    };
    assert_eq!(desk.read_display(400), "  --");
    let Some(mut desk) = Desk::with(WITH_DISPLAY, &CalibrationChoice::Complete) else {
        return;
    };
    // A thermistor that has come off is latched.
    let (channel, now) = (desk.robot.wiring().thermistor, desk.robot.cycle());
    desk.robot.hold_analog(channel, 1_023, (now, u64::MAX));
    desk.pass_ms(20_000);
    assert_eq!(desk.read_display(400), " Err");
}

#[test]
fn lights_beside_a_display_are_lit_alone_and_half_as_brightly() {
    let Some(mut desk) = Desk::with(WITH_DISPLAY, &CalibrationChoice::Complete) else {
        return;
    };
    for light in 0..LIGHTS {
        desk.light(light, LedPattern::Off, Ratio::ZERO);
    }
    for light in 0..LIGHTS {
        for (brightness, percent) in [(1_000_000, 25_u64), (500_000, 12), (1, 6)] {
            assert_lit_alone(&mut desk, light, brightness, percent);
        }
        let percent = desk.charge_percent.expect("the battery has been measured");
        assert_eq!(
            desk.read_display(400),
            format!("{percent:>4}"),
            "beside light {light}"
        );
        desk.light(light, LedPattern::Off, Ratio::ONE);
    }
}

#[test]
fn a_robot_without_a_display_leaves_its_lines_alone() {
    let Some(mut desk) = Desk::new() else { return };
    desk.light(0, LedPattern::On, Ratio::ONE);
    desk.pass_ms(1_000);
    assert_eq!(desk.robot.digit_cycles(), [[0; 7]; 4]);
}
