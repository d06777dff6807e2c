//! An owner calibrates a robot: the real firmware in the emulated chip with an empty record, the real `rvac`, hands
//! through the simulator's socket. What is found must be what the emulated board was built with.
//!
//! `cargo xtask test --only emulator` names firmware and program in `RVAC_FIRMWARE` and `RVAC_PROGRAM`.
#![allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

mod fixture;

use std::fs;

use fixture::{OwnerFixture, Terminal};
use pic32::board::{CalibrationValues, GyroLayout};
use serde_json::{Value, json};

/// Free floor of the flat, two metres before the robot, in the frame of the plan.
const FREE_FLOOR: [f64; 3] = [-0.5, 0.06, std::f64::consts::PI];
/// How far the owner pushes the robot.
const PUSHED_MM: f64 = 1_900.0;
/// Longer than a value of the buttons takes.
const HOLD_MS: u32 = 8_000;

/// An owner who does what the screen says.
struct Owner {
    fixture: OwnerFixture,
    screen: Terminal,
    item: String,
}

impl Owner {
    fn obey(&mut self) {
        while let Some(line) = self.screen.read() {
            println!("{line}");
            if let Some((_, rest)) = line.split_once(" of ").filter(|_| line.contains("needed for")) {
                self.item = rest.split([' ', ',']).nth(1).unwrap().to_owned();
            }
            self.obey_line(&line);
        }
    }

    fn obey_line(&mut self, line: &str) {
        let is_button = self.item.strip_prefix("button-ladder-");
        let button = is_button.map(|number| number.parse::<u8>().unwrap() - 1);
        if line.contains("Once more?") {
            panic!("{}: {line}", self.item);
        } else if line.contains("Ready?") {
            if let Some(button) = button {
                self.touch(json!({"c": "press", "button": button, "ms": HOLD_MS}));
            }
            self.enter();
        } else if line.contains("Keep it?") {
            match self.item.as_str() {
                "wheel-left-order" | "wheel-right-order" | "cliff-floor-level" => {
                    self.touch(json!({"c": "put-down"}));
                }
                "proximity-touching" => self.touch(json!({"c": "paper"})),
                _ => {}
            }
            self.enter();
        } else {
            self.obey_request(line);
        }
    }

    fn obey_request(&mut self, line: &str) {
        if line.starts_with("Push it straight ahead") {
            self.do_then_enter(json!({"c": "push", "distance": PUSHED_MM / 1e3}));
        } else if line.starts_with("How far did it go") {
            self.screen.answer(&PUSHED_MM.to_string());
        } else if line.starts_with("Turn it ten times") {
            self.do_then_enter(json!({"c": "turn", "turns": 10}));
        } else if line.starts_with("Turn the wheel forward") {
            let wheel = if self.item.contains("left") {
                "left"
            } else {
                "right"
            };
            self.touch(json!({"c": "lift"}));
            self.do_then_enter(json!({"c": "roll", "wheel": wheel, "distance": 0.1}));
        } else if line.contains("over the edge of a table") {
            self.touch(json!({"c": "lift"}));
            self.enter();
        } else if line.contains("paper flat against") {
            let number = line.split_once('(').unwrap().1[..1].parse::<u8>().unwrap();
            self.touch(json!({"c": "paper", "sensor": number - 1}));
            self.enter();
        } else if line.starts_with("Hold the left wheel fast") {
            self.touch(json!({"c": "hold", "on": true}));
            self.enter();
            // The needle comes to rest.
            self.fixture.pass(1.5);
            self.type_meter("drawn-a");
        } else if line.starts_with("What did the ammeter") {
            self.touch(json!({"c": "hold", "on": false}));
        } else if line.starts_with("What does the ammeter") {
            self.type_meter("drawn-a");
        } else if line.starts_with("What does the multimeter") {
            self.type_meter("pack-v");
        } else if line.contains("press Enter") {
            self.enter();
        }
    }

    fn enter(&mut self) {
        self.screen.answer("");
    }

    fn touch(&mut self, request: Value) {
        self.fixture.touch(&request);
    }

    fn do_then_enter(&mut self, request: Value) {
        assert_eq!(self.fixture.ask(&request)["e"], "done");
        self.enter();
    }

    fn meter(&mut self, which: &str) -> f64 {
        self.fixture.ask(&json!({"c": "meters"}))[which].as_f64().unwrap()
    }

    /// Reads thousandths off an instrument and types them.
    fn type_meter(&mut self, which: &str) {
        let milli = (self.meter(which) * 1e3).round();
        self.screen.answer(&format!("{milli}"));
    }
}

/// Calibrates these values, each to be found within so much of what the board was built with.
fn calibrate(name: &str, wanted: &[(&'static str, i32)]) {
    // On an even floor: how far wheels slip under a hand is no question to the program.
    let Some(mut fixture) = OwnerFixture::open(name, &["--uncalibrated", "--noise", "ideal"]) else {
        return;
    };
    let [x, y, heading] = FREE_FLOOR;
    fixture.touch(&json!({"c": "place", "x": x, "y": y, "heading": heading}));
    let file = fixture.file("mine.toml");
    let mut arguments = vec!["calibrate", "--file", file.to_str().unwrap()];
    arguments.extend(wanted.iter().map(|(name, _)| *name));
    let screen = fixture.rvac(&arguments);
    let mut owner = Owner {
        fixture,
        screen,
        item: String::new(),
    };
    owner.obey();
    let Owner { screen, fixture, .. } = owner;
    assert_eq!(screen.end(), (true, String::new()));
    let record = fs::read_to_string(&file).unwrap();
    drop(fixture);
    let built_with = CalibrationValues::sr8730().unwrap();
    for (name, tolerance) in wanted {
        let row = record.lines().find_map(|line| line.strip_prefix(name));
        let found: i32 = row.unwrap()[3..].split(' ').next().unwrap().parse().unwrap();
        let true_value = match *name {
            // Half of the gap between the simulator's floors and its drops; the table's own value is merely one
            // below.
            "cliff-floor-level" => 320,
            name => built_with.value(name).unwrap(),
        };
        println!("{name}: found {found}, built with {true_value}");
        assert!(
            (found - true_value).abs() <= *tolerance,
            "{name}: {found} for {true_value}"
        );
    }
}

#[test]
fn wheels() {
    calibrate(
        "wheels",
        &[
            ("wheel-distance-per-count", 15_000),
            ("wheel-track", 9_000),
            ("wheel-left-order", 0),
            ("wheel-right-order", 0),
            ("wheel-dead-band", 30),
            ("wheel-free-speed", 20),
        ],
    );
}

#[test]
fn currents_and_brush() {
    calibrate(
        "currents",
        &[
            ("wheel-left-current-zero", 1),
            ("wheel-right-current-zero", 1),
            ("wheel-current-scale", 200),
            ("brush-main-pulse-rate", 2),
            ("brush-main-dead-band", 50),
        ],
    );
}

#[test]
fn buttons_and_battery() {
    calibrate(
        "buttons",
        &[
            ("button-ladder-1", 1),
            ("battery-scale", 30),
            ("charge-current-zero", 12),
            ("button-ladder-2", 1),
        ],
    );
}

#[test]
fn sensors_of_light() {
    calibrate(
        "light",
        &[
            ("cliff-emitter-line", 0),
            ("cliff-floor-level", 70),
            ("proximity-none", 3),
            ("proximity-touching", 5),
            ("button-ladder-3", 1),
        ],
    );
}

#[test]
fn a_gyro_that_nobody_knows() {
    const NUMBER: u64 = 2;
    let layout = GyroLayout::unknown(NUMBER);
    let Some(mut fixture) = OwnerFixture::open("gyro", &["--uncalibrated", "--gyro", "2"]) else {
        return;
    };
    let [x, y, heading] = FREE_FLOOR;
    fixture.touch(&json!({"c": "place", "x": x, "y": y, "heading": heading}));
    let file = fixture.file("gyro.bin");
    let mut screen = fixture.rvac(&["probe", "gyro", "--file", file.to_str().unwrap()]);
    let mut said = String::new();
    while let Some(line) = screen.read() {
        println!("{line}");
        if line.contains("press Enter to begin") {
            screen.answer("");
            // The robot is turned while the program listens; the simulator answers when it was.
            let turns = [("to the left", 1), ("to the right", -1)];
            for (_, turns) in turns.into_iter().filter(|(way, _)| line.contains(way)) {
                // A breath before it, as a person takes one.
                fixture.pass(0.7);
                fixture.ask(&json!({"c": "turn", "turns": turns}));
            }
        }
        said.push_str(&line);
        said.push('\n');
    }
    assert_eq!(screen.end(), (true, String::new()));
    let [high, low] = layout.head;
    let heading_big_endian = layout.tells_heading && layout.big_endian && !layout.wide;
    assert!(
        heading_big_endian && layout.steps_per_degree == -10.0,
        "{layout:?}"
    );
    for wanted in [
        format!(
            "frames of {} bytes that begin with {high:02X} {low:02X}",
            layout.frame_bytes()
        ),
        format!("gyro-uart = {}", layout.uart),
        format!("gyro-rate = {}", layout.baud),
        format!(
            "byte {}: heading as I16Big, falls counter-clockwise",
            layout.number_at()
        ),
    ] {
        assert!(said.contains(&wanted), "{wanted} is missing in {said}");
    }
    let scale = said
        .split_once("clockwise, ")
        .unwrap()
        .1
        .split(' ')
        .next()
        .unwrap();
    let scale: f64 = scale.parse().unwrap();
    assert!((9.5..10.5).contains(&scale), "{scale}");
}

#[test]
fn a_gyro_that_says_nothing() {
    let Some(fixture) = OwnerFixture::open("silent", &["--uncalibrated", "--gyro", "none"]) else {
        return;
    };
    let file = fixture.file("gyro.bin");
    let mut screen = fixture.rvac(&["probe", "gyro", "--file", file.to_str().unwrap()]);
    while screen.read().is_some() {}
    let (ended_well, complaint) = screen.end();
    assert!(!ended_well && !file.exists());
    assert_eq!(
        complaint,
        "rvac: neither UART hears anything: is the module fitted and its plug in?\n"
    );
}
