//! The profile with which a pad, the keyboard and the stick on the screen work at once.

use crate::{
    Calibration, Condition, KeyCode, Line, Mix, Name, Output, OutputName, Profile, Source, Switch, VERSION,
};

/// Sticks at rest read up to this much.
const STICK_DEAD_BAND: f64 = 0.1;
/// The stick on the screen has a centre that fingers cannot find by touch.
const TOUCH_DEAD_BAND: f64 = 0.08;
/// Hands that hold still tilt by some degrees.
const TILT_DEAD_BAND: f64 = 0.08;
/// The middle of a stick is for small corrections.
const STICK_EXPO: f64 = 0.3;
/// Keys drive at this share of the top speed, because a key is either up or down.
const KEY_SHARE: f64 = 0.7;
/// The cross of a pad is for slow steps.
const CROSS_SHARE: f64 = 0.5;
/// No sensor covers the floor behind the robot, so it reverses more slowly.
const REVERSE_SHARE: f64 = 0.5;
/// With the left shoulder button everything is slower by this.
const SLOW_SHARE: f64 = 0.4;
/// A tilt of 45 degrees is full speed.
const TILT_WEIGHT: f64 = 2.0;

// Numbers of the "standard" mapping of the W3C.
const STICK_ACROSS: u8 = 0;
const STICK_ALONG: u8 = 1;
const RIGHT_STICK_ACROSS: u8 = 2;
const EAST: u8 = 1;
const WEST: u8 = 2;
const NORTH: u8 = 3;
const LEFT_SHOULDER: u8 = 4;
const RIGHT_TRIGGER: u8 = 7;
const START: u8 = 9;
const UP: u8 = 12;
const DOWN: u8 = 13;
const LEFT: u8 = 14;
const RIGHT: u8 = 15;

/// Left stick, cross, W A S D and arrows, touch and tilt drive; the left shoulder slows; the right trigger cleans; Start
/// starts, and of the four buttons the right one stops, the left one cleans a spot and the upper one docks.
#[must_use]
pub fn standard_profile() -> Profile {
    let calibrations = [
        (axis(STICK_ACROSS), STICK_DEAD_BAND),
        (axis(STICK_ALONG), STICK_DEAD_BAND),
        (axis(RIGHT_STICK_ACROSS), STICK_DEAD_BAND),
        (Source::TouchRight, TOUCH_DEAD_BAND),
        (Source::TouchUp, TOUCH_DEAD_BAND),
        (Source::TiltForward, TILT_DEAD_BAND),
        (Source::TiltLeft, TILT_DEAD_BAND),
    ];
    Profile {
        version: VERSION,
        name: Name::ours("Standard"),
        inputs: calibrations
            .into_iter()
            .map(|(input, dead_band)| Calibration::new(input, dead_band))
            .collect(),
        switches: vec![Switch {
            name: slow(),
            on: Condition::Above {
                input: button(LEFT_SHOULDER),
                level: 0.5,
            },
        }],
        trims: Vec::new(),
        modes: Vec::new(),
        outputs: outputs(),
    }
}

fn outputs() -> Vec<Output> {
    let trigger = || Line::new(Name::ours("Right trigger"), button(RIGHT_TRIGGER));
    let with = |output, lines| Output {
        lines,
        ..Output::new(output)
    };
    let press = |name, number| Line::new(Name::ours(name), button(number));
    vec![
        Output {
            low: -REVERSE_SHARE,
            ..with(OutputName::Forward, forward())
        },
        with(OutputName::Turn, turn()),
        with(OutputName::Suction, vec![trigger()]),
        with(OutputName::MainBrush, vec![trigger()]),
        with(OutputName::SideBrushes, vec![trigger()]),
        with(OutputName::Start, vec![press("Start button", START)]),
        with(
            OutputName::Stop,
            vec![
                press("Right button", EAST),
                Line::new(Name::ours("Space"), key("Space")),
            ],
        ),
        with(OutputName::Spot, vec![press("Left button", WEST)]),
        with(OutputName::Dock, vec![press("Upper button", NORTH)]),
    ]
}

fn forward() -> Vec<Line> {
    vec![
        stick("Left stick", STICK_ALONG),
        scaled("Cross up", button(UP), CROSS_SHARE),
        scaled("Cross down", button(DOWN), -CROSS_SHARE),
        scaled("W", key("KeyW"), KEY_SHARE),
        scaled("S", key("KeyS"), -KEY_SHARE),
        scaled("Arrow up", key("ArrowUp"), KEY_SHARE),
        scaled("Arrow down", key("ArrowDown"), -KEY_SHARE),
        scaled("Touch", Source::TouchUp, 1.0),
        scaled("Tilt", Source::TiltForward, TILT_WEIGHT),
        slower(),
    ]
}

fn turn() -> Vec<Line> {
    vec![
        stick("Left stick", STICK_ACROSS),
        stick("Right stick", RIGHT_STICK_ACROSS),
        scaled("Cross left", button(LEFT), CROSS_SHARE),
        scaled("Cross right", button(RIGHT), -CROSS_SHARE),
        scaled("A", key("KeyA"), KEY_SHARE),
        scaled("D", key("KeyD"), -KEY_SHARE),
        scaled("Arrow left", key("ArrowLeft"), KEY_SHARE),
        scaled("Arrow right", key("ArrowRight"), -KEY_SHARE),
        scaled("Touch", Source::TouchRight, -1.0),
        scaled("Tilt", Source::TiltLeft, TILT_WEIGHT),
        slower(),
    ]
}

/// Right and down are positive on a pad, left and forward on a robot.
fn stick(name: &'static str, number: u8) -> Line {
    Line {
        invert: true,
        expo: STICK_EXPO,
        ..Line::new(Name::ours(name), axis(number))
    }
}

fn scaled(name: &'static str, input: Source, weight: f64) -> Line {
    Line {
        weight,
        ..Line::new(Name::ours(name), input)
    }
}

fn slower() -> Line {
    Line {
        mix: Mix::Multiply,
        when: Some(slow()),
        ..scaled("Slow", Source::Always, SLOW_SHARE)
    }
}

fn slow() -> Name {
    Name::ours("slow")
}

const fn axis(axis: u8) -> Source {
    Source::PadAxis { pad: 0, axis }
}

const fn button(button: u8) -> Source {
    Source::PadButton { pad: 0, button }
}

fn key(code: &'static str) -> Source {
    Source::Key(KeyCode::ours(code))
}
