//! Sensors from the home to the pins.

use crate::rig::{AHEAD, STAY, pass_ms, program, robot, robot_with, world};
use stc90::board::{EmulatedRelax, RelaxSettings};
use stc90::pins::Level;

/// Levels of pins by name; P0.7, P0.6, P0.3 and P0.1 are the floor sensors, P2.2 and P1.0 the bumper.
fn levels<const N: usize>(robot: &EmulatedRelax, names: [&str; N]) -> [bool; N] {
    names.map(|name| robot.machine().level(name.parse().expect("a pin")).is_high())
}

const FLOORS: [&str; 4] = ["P0.7", "P0.6", "P0.3", "P0.1"];
const BUMPERS: [&str; 2] = ["P2.2", "P1.0"];
/// P2.7 low, nothing else.
const LIGHT: [(u8, u8); 1] = [(0xA0, 0x7F)];

/// Without light there is no floor and the bumper is pressed: a broken lamp is safe.
#[test]
fn sensors_see_by_the_light_that_the_chip_switches() {
    let mut lit = robot(&program(&LIGHT, &STAY));
    pass_ms(&mut lit, 5);
    assert_eq!(levels(&lit, FLOORS), [true; 4]);
    assert_eq!(levels(&lit, BUMPERS), [false; 2]);
    let mut dark = robot(&STAY);
    pass_ms(&mut dark, 5);
    assert_eq!(levels(&dark, FLOORS), [false; 4]);
    assert_eq!(levels(&dark, BUMPERS), [true; 2]);
}

/// The light changes what the next instruction reads.
#[test]
fn the_light_acts_at_once() {
    // SETB P2.7; MOV A, P0; CLR P2.7; MOV B, P0; MOV 0x30, A; MOV 0x31, B
    let code = [
        0xD2, 0xA7, 0xE5, 0x80, 0xC2, 0xA7, 0x85, 0x80, 0xF0, 0xF5, 0x30, 0x85, 0xF0, 0x31, 0x80, 0xFE,
    ];
    let mut robot = robot(&code);
    pass_ms(&mut robot, 1);
    let floors = 0b1100_1010;
    let seen = [0x30, 0x31].map(|address| robot.machine().cpu().ram()[address] & floors);
    assert_eq!(seen, [0, floors]);
}

#[test]
fn a_wall_presses_the_bumper() {
    let mut robot = robot_with(&program(&AHEAD, &STAY), world(3.4, 1.5), RelaxSettings::default());
    pass_ms(&mut robot, 3_000);
    assert_eq!(levels(&robot, BUMPERS), [true; 2]);
}

/// On the right side, near: high.
#[test]
fn a_wall_beside_is_seen() {
    for (y_m, is_near) in [(0.19, true), (1.5, false)] {
        let mut robot = robot_with(&program(&LIGHT, &STAY), world(2.0, y_m), RelaxSettings::default());
        pass_ms(&mut robot, 5);
        assert_eq!(levels(&robot, ["P0.2"]), [is_near], "{y_m}");
    }
}

#[test]
fn a_lifted_robot_hangs_and_has_no_floor() {
    let mut robot = robot(&program(&LIGHT, &STAY));
    pass_ms(&mut robot, 5);
    assert_eq!(levels(&robot, ["P1.7"]), [true]);
    robot.world_mut().lift();
    pass_ms(&mut robot, 500);
    assert_eq!(levels(&robot, ["P1.7"]), [false]);
    assert_eq!(levels(&robot, FLOORS), [false; 4]);
    let battery: stc90::pins::Pin = "P1.2".parse().expect("a pin");
    assert_eq!(robot.machine().level(battery), Level::Low);
}
