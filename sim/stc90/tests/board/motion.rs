//! Wheels and brushes from the pins to the home, and encoders back.

use crate::rig::{AHEAD, STAY, pass_ms, program, ram, robot, robot_with, world};
use stc90::board::{Motor, RelaxSettings};

#[test]
fn both_lines_forward_drive_it_ahead() {
    let mut robot = robot(&program(&AHEAD, &STAY));
    let before = robot.world().truth().pose;
    pass_ms(&mut robot, 1_000);
    let after = robot.world().truth().pose;
    assert!(after.x_m - before.x_m > 0.2, "{before:?} {after:?}");
    assert!((after.y_m - before.y_m).abs() < 0.01);
    assert_eq!(robot.duty(Motor::WheelLeft), 1.0);
    assert_eq!(robot.duty(Motor::Brush), 0.0);
    assert_eq!(robot.short_cycles(), 0);
    // Nobody asked for it.
    assert!(!robot.monitor().violations().is_empty());
}

/// One wheel forward and one backward turn it on the spot, left.
#[test]
fn opposite_lines_turn_it() {
    let mut robot = robot(&program(&[(0x90, 0xEF), (0xA0, 0x7E)], &STAY));
    let before = robot.world().truth().pose;
    pass_ms(&mut robot, 300);
    let after = robot.world().truth().pose;
    assert!(after.heading_rad - before.heading_rad > 0.1, "{after:?}");
    assert!((after.x_m - before.x_m).abs() < 0.02);
    assert!(robot.duty(Motor::WheelLeft) < 0.0);
}

/// CPL P2.1 with as many cycles on as off is half a drive.
#[test]
fn pulses_are_a_part_of_a_drive() {
    // CPL P2.1; NOP; SJMP back
    let mut robot = robot(&[0xB2, 0xA1, 0x00, 0x80, 0xFB]);
    pass_ms(&mut robot, 3);
    let duty = robot.duty(Motor::WheelLeft);
    assert!((duty - 0.5).abs() < 0.001, "{duty}");
}

/// The type of the bridge is not known: forward and backward together may be a short.
#[test]
fn both_directions_at_once_are_noticed() {
    let mut robot = robot(&program(&[(0xA0, 0xFC)], &STAY));
    pass_ms(&mut robot, 10);
    assert_eq!(robot.duty(Motor::WheelLeft), 0.0);
    assert!(robot.short_cycles() > 49_000);
}

#[test]
fn brush_and_suction_have_a_line_each() {
    for (pairs, expected) in [
        ([(0x90, 0xFF), (0xA0, 0xDF)], [1.0, 0.0]),
        ([(0x90, 0xBF), (0xA0, 0xFF)], [0.0, 1.0]),
    ] {
        let mut robot = robot(&program(&pairs, &STAY));
        pass_ms(&mut robot, 2);
        assert_eq!(
            [Motor::Brush, Motor::Suction].map(|motor| robot.duty(motor)),
            expected
        );
    }
}

/// A program that polls the left encoder's line counts as the home does.
#[test]
fn encoders_tell_each_count_by_an_edge() {
    // Wait for P0.4 low, INC 0x30, wait for high, INC 0x30, again
    let polling = [
        0x20, 0x84, 0xFD, 0x05, 0x30, 0x30, 0x84, 0xFD, 0x05, 0x30, 0x80, 0xF4,
    ];
    let mut robot = robot(&program(&AHEAD, &polling));
    pass_ms(&mut robot, 3_000);
    let shown = robot.world().sensors().count_left;
    assert!(shown > 100, "{shown}");
    assert_eq!(ram(&robot, 0x30), shown as u8);
}

/// A program of a few bytes that backs off walls: it stays in the room and never pushes for long.
#[test]
fn a_program_drives_by_its_bumpers() {
    let mut code = vec![];
    // ahead: P1 = EF, P2 = 7D
    code.extend(program(&AHEAD, &[]));
    // loop: JB P2.2, back; JB P1.0, back; SJMP loop
    code.extend([0x20, 0xA2, 0x05, 0x20, 0x90, 0x02, 0x80, 0xF8]);
    // back: P1 = F7, P2 = 7E; a pause of about 0.4 s; then turn: P1 = EF, P2 = 7E, 0.4 s; SJMP ahead
    code.extend(program(&[(0x90, 0xF7), (0xA0, 0x7E)], &pause()));
    code.extend(program(&[(0x90, 0xEF), (0xA0, 0x7E)], &pause()));
    let back = 0_u8.wrapping_sub(code.len() as u8 + 2);
    code.extend([0x80, back]);
    let mut robot = robot_with(&code, world(2.0, 1.5), RelaxSettings::default());
    let (mut pressed_ms, mut longest_ms, mut bumps, mut path_m) = (0, 0, 0, 0.0);
    let mut pose = robot.world().truth().pose;
    for _ in 0..30_000 {
        pass_ms(&mut robot, 1);
        let sensors = robot.world().sensors();
        let is_pressed = sensors.bumper_left || sensors.bumper_right;
        bumps += u32::from(is_pressed && pressed_ms == 0);
        pressed_ms = if is_pressed { pressed_ms + 1 } else { 0 };
        longest_ms = longest_ms.max(pressed_ms);
        let now = robot.world().truth().pose;
        path_m += f64::hypot(now.x_m - pose.x_m, now.y_m - pose.y_m);
        pose = now;
    }
    assert!(bumps > 2, "{bumps} bumps");
    assert!(path_m > 4.0, "{path_m} m");
    assert!(longest_ms < 400, "{longest_ms} ms");
}

/// MOV R7, #16; MOV R6, #0; MOV R5, #0; DJNZ R5; DJNZ R6; DJNZ R7: 2.1 million cycles.
fn pause() -> [u8; 12] {
    [
        0x7F, 0x10, 0x7E, 0x00, 0x7D, 0x00, 0xDD, 0xFE, 0xDE, 0xFA, 0xDF, 0xF6,
    ]
}
