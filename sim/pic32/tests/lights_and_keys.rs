//! Lights, sounds and keys of the SR8730's own image, as people perceive them: at the pins of the emulated chip.
//!
//! It is built by `cargo xtask firmware sr8730`; `cargo xtask test --only emulator` names it in `RVAC_FIRMWARE`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use home::{Home, Noise, RobotModel, World};
use pic32::board::{Blueprint, CalibrationChoice, EmulatedRobot, EmulatedSettings};
use pic32::image::Image;
use pic32::pins::{Level, Pin};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{Beep, BinaryKinds, Command, Event, Led, LedPattern, Report};
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

/// The image, if it was built. Where it must be there, it is named.
fn image() -> Option<Image> {
    let named = std::env::var_os("RVAC_FIRMWARE").map(PathBuf::from);
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/firmware/sr8730.elf");
    let path = named.clone().unwrap_or(built);
    if named.is_none() && !path.is_file() {
        println!("skipped: the firmware is not built (cargo xtask firmware sr8730 builds it)");
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
}

impl Desk {
    fn new() -> Option<Self> {
        let blueprint =
            Blueprint::sr8730(image()?, &CalibrationChoice::Complete).expect("the project's board is sound");
        let model = RobotModel::by_name("sr8730").expect("it comes with the project");
        let home = Arc::new(Home::from_floorplan("room", ROOM, &model).expect("a valid home"));
        let world = World::new(home, &model, &Noise::nominal(), 1, None);
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
