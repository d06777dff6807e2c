//! Motors, encoders, switches, the judge and the clock of reactions.

use monitor::{Bridges, Rule};
use pic32::board::{Contact, EmulatedRobot, EmulatedSettings, Hold, MotorOutput, Reaction, reaction};
use rvac_protocol::message::ResetCause;

use crate::program::{CLR, FOREVER, NOP, SET, T0, T1, T2, branch, li, lw, oc, store, sw, timer};
use crate::rig::{LAT, PORT, TRISC, TRISD, TRISE, TRISG, pass_ms, robot, robot_with, stores, world};

/// PWM of 20 kHz on both wheels, MODE high; `duties` are counts of 4000, `phases` levels of left and right PHASE.
fn drive(duties: [u32; 2], phases: [bool; 2]) -> Vec<u32> {
    let phase = |high: bool| if high { SET } else { CLR };
    stores(&[
        (TRISE + LAT + SET, 1 << 7),
        (TRISG + LAT + SET, 1 << 6),
        (TRISC + LAT + phase(phases[0]), 1 << 1),
        (TRISG + LAT + phase(phases[1]), 1 << 7),
        (TRISE + CLR, 1 << 7),
        (TRISG + CLR, 1 << 6 | 1 << 7),
        (TRISC + CLR, 1 << 1),
        (TRISD + CLR, 1 << 0 | 1 << 3),
        (timer(3) + 32, 3999),
        (oc(1) + 32, duties[0]),
        (oc(4) + 32, duties[1]),
        (oc(1), 0x800E),
        (oc(4), 0x800E),
        (timer(3), 0x8000),
    ])
}

fn driving(duties: [u32; 2], phases: [bool; 2]) -> EmulatedRobot {
    robot(&[drive(duties, phases), FOREVER.to_vec()].concat())
}

#[test]
fn duty_and_phase_drive_the_robot_both_ways() {
    // Forward is low on the left and high on the right.
    for (phases, way) in [([false, true], 1.0), ([true, false], -1.0)] {
        let mut robot = driving([2400, 2400], phases);
        pass_ms(&mut robot, 1000);
        assert!((robot.duty(MotorOutput::WheelLeft) - 0.6 * way).abs() < 1e-3);
        let truth = robot.world().truth();
        let pose = truth.pose;
        assert!(truth.path_m > 0.15, "{} m", truth.path_m);
        assert!(truth.speed_m_per_s * way > 0.2, "{} m/s", truth.speed_m_per_s);
        assert!(
            pose.heading_rad.abs() < 0.05,
            "straight: {} rad",
            pose.heading_rad
        );
    }
    let mut robot = driving([2000, 2000], [true, true]);
    pass_ms(&mut robot, 1000);
    assert!(
        robot.world().truth().turn_rad_per_s > 0.5,
        "left backward, right forward: a left turn"
    );
}

#[test]
fn a_mode_line_that_is_low_coasts_and_wants_more_duty() {
    let coast = stores(&[(TRISE + LAT + CLR, 1 << 7), (TRISG + LAT + CLR, 1 << 6)]);
    let mut robot = robot(&[drive([2000, 2000], [false, true]), coast, FOREVER.to_vec()].concat());
    pass_ms(&mut robot, 500);
    assert_eq!(
        robot.world().truth().path_m,
        0.0,
        "half duty is within the dead band"
    );
}

#[test]
fn encoder_edges_count_what_the_wheels_turn() {
    let mut robot = driving([2000, 1800], [false, true]);
    let pins = robot.wiring().wheels.map(|wheel| wheel.encoder);
    for pin in pins.into_iter().flatten() {
        robot.machine_mut().watch(pin);
    }
    pass_ms(&mut robot, 800);
    let sensors = *robot.world().sensors();
    for (side, count) in [sensors.count_left, sensors.count_right].into_iter().enumerate() {
        let edges: Vec<_> = pins[side].map(|pin| robot.machine_mut().take_edges(pin)).concat();
        // The last edges of the last tick may still be scheduled.
        assert!(
            (edges.len() as i32 - count).abs() <= 1,
            "{} edges, {count} counts",
            edges.len()
        );
        assert!(count > 50);
    }
}

#[test]
fn the_judge_sees_wheels_that_nobody_allowed_to_turn() {
    let mut robot = driving([2000, 2000], [false, true]);
    pass_ms(&mut robot, 100);
    let rules: Vec<Rule> = robot
        .monitor()
        .violations()
        .iter()
        .map(|violation| violation.rule)
        .collect();
    assert!(
        rules.contains(&Rule::WheelsWithoutLease) && rules.contains(&Rule::NotArmed),
        "{rules:?}"
    );
    let mut still = driving([0, 0], [false, true]);
    pass_ms(&mut still, 100);
    assert_eq!(still.monitor().violations(), []);
}

#[test]
fn a_reset_lets_go_of_every_pin() {
    let mut robot = driving([2000, 2000], [false, true]);
    pass_ms(&mut robot, 50);
    robot
        .machine_mut()
        .memory_mut()
        .write(0x1FC0_0000, &u32::MAX.to_le_bytes())
        .expect("boot flash");
    robot.reset(ResetCause::Watchdog);
    assert_eq!(robot.resets(), 1);
    let enable = robot.wiring().wheels[0].enable;
    assert!(!enable.is_on(robot.machine().output(enable.pin)));
}

/// Both wheels forward while RG9 (left bumper) is high, else compare 0. Nothing else is done, so it reacts at once.
fn bumper_loop() -> Vec<u32> {
    let andi = |to: u32, from: u32, value: u32| 0x3000_0000 | from << 21 | to << 16 | value;
    let beq_zero = |register: u32, by: i16| 0x1000_0000 | register << 21 | by as u16 as u32;
    let mut code = drive([2000, 2000], [false, true]);
    code.extend(li(T0, TRISG + PORT));
    code.extend(li(T2, oc(1) + 32));
    let body = [
        lw(T1, 0, T0),
        NOP,
        andi(T1, T1, 1 << 9),
        beq_zero(T1, 2),
        NOP,
        0x2409_0000 | 2000, // addiu T1, zero, 2000: pressed is 0 already
        sw(T1, 0, T2),
        sw(T1, 0x600, T2), // OC4RS
    ];
    code.extend(body);
    code.extend([branch(-(body.len() as i16) - 1), NOP]);
    code
}

#[test]
fn reactions_are_known_to_better_than_a_tenth_of_a_millisecond() {
    let mut robot = robot(&bumper_loop());
    robot.watch_motors();
    pass_ms(&mut robot, 20);
    let (mut slowest, mut fastest) = (0, u64::MAX);
    for press in 0..200_u64 {
        // All phases of the millisecond and of the PWM.
        let event = robot.cycle() + 80_000 + press * 397;
        robot.hold_contact(Contact::BumperLeft, Hold::On, event);
        robot.hold_contact(Contact::BumperLeft, Hold::Off, event + 400_000);
        pass_ms(&mut robot, 12);
        let drives = robot.drives(MotorOutput::WheelLeft);
        let Reaction::Stopped(cycles) = reaction(drives, event) else {
            panic!("press {press} at {event}: {drives:?}");
        };
        slowest = slowest.max(cycles);
        fastest = fastest.min(cycles);
    }
    // The compare register is taken over at the end of the present period of 4000 counts, of which 2000 are driven; reading
    // and deciding take some 30 cycles of flash with wait states.
    assert!(fastest < 300, "{fastest}");
    assert!((2_000..4_000 + 2_000).contains(&slowest), "{slowest}");
}

#[test]
fn deaf_bridges_go_on() {
    let settings = EmulatedSettings {
        bridges: Bridges::DeafToBrake,
        ..EmulatedSettings::default()
    };
    let mut robot = robot_with(&bumper_loop(), world(None), &settings);
    pass_ms(&mut robot, 20);
    robot.hold_contact(Contact::BumperLeft, Hold::On, 0);
    pass_ms(&mut robot, 50);
    assert!(robot.duty(MotorOutput::WheelLeft) > 0.4 && robot.wheels_driven());
    assert!(
        robot
            .monitor()
            .violations()
            .iter()
            .any(|violation| violation.rule == Rule::Bumper)
    );
}

#[test]
fn brushes_and_suction_are_plain_switches_and_a_bridge() {
    let code = [
        stores(&[
            (crate::rig::DDPCON + CLR, 1 << 3),
            (crate::rig::TRISA + LAT + SET, 1 << 4),
            (crate::rig::TRISA + CLR, 1 << 4),
            (TRISD + LAT + SET, 1 << 5),
            (TRISD + CLR, 1 << 5 | 1 << 1),
            (TRISC + LAT + SET, 1 << 2),
            (TRISC + CLR, 1 << 2),
            (timer(3) + 32, 3999),
            (oc(2) + 32, 4000),
            (oc(2), 0x800E),
            (timer(3), 0x8000),
        ]),
        store(0xA000_0000, 1),
        FOREVER.to_vec(),
    ]
    .concat();
    let mut robot = robot(&code);
    let encoder = robot.wiring().brush_encoder.pin;
    robot.machine_mut().watch(encoder);
    pass_ms(&mut robot, 1000);
    assert_eq!(robot.duty(MotorOutput::BrushSides), 1.0);
    assert_eq!(robot.duty(MotorOutput::Vacuum), 1.0);
    assert_eq!(robot.duty(MotorOutput::BrushMain), -1.0, "PHASE high is backward");
    let pulses = robot.machine_mut().take_edges(encoder).len() / 2;
    assert!((98..=100).contains(&pulses), "{pulses} pulses at full drive");
}
