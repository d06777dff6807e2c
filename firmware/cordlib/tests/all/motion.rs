//! Motion control on ideal mechanics: where the robot ends, and how it says so.

use crate::rig::{LIMITS, Rig, drive, motor, movement};
use rvac_protocol::message::{Command, Motor, MoveEnd, Refusal};

fn finish(rig: &mut Rig, command: Command) -> MoveEnd {
    assert_eq!(rig.ask(command), Ok(()));
    for _ in 0..30_000 {
        if let Some(end) = rig.move_ends().first() {
            let end = *end;
            rig.edges.clear();
            rig.run(300);
            return end;
        }
        rig.follow_gyro();
        rig.run(1);
    }
    panic!("the move never ended: {:?}", rig.names());
}

fn turned_rad(rig: &Rig) -> f64 {
    (rig.distances[1] - rig.distances[0]) / LIMITS.track.as_m()
}

fn length_m(rig: &Rig) -> f64 {
    f64::midpoint(rig.distances[0], rig.distances[1])
}

fn check(command: Command, want_m: f64, want_rad: f64) {
    let mut rig = Rig::armed(u32::MAX - 2_000);
    assert_eq!(finish(&mut rig, command), MoveEnd::Done);
    let (length_m, turned_rad) = (length_m(&rig), turned_rad(&rig));
    println!("asked {want_m} m {want_rad} rad, made {length_m:.4} m {turned_rad:.4} rad");
    assert!(
        (length_m - want_m).abs() < 0.003,
        "{length_m} m instead of {want_m} m"
    );
    assert!(
        (turned_rad - want_rad).abs() < 0.02,
        "{turned_rad} rad instead of {want_rad} rad"
    );
    assert!(rig.wheels_off());
}

#[test]
fn straight_moves_end_where_they_should() {
    check(movement(1.0, None), 1.0, 0.0);
    check(movement(-0.3, None), -0.3, 0.0);
    check(movement(0.02, None), 0.02, 0.0);
}

#[test]
fn turns_on_the_spot_end_where_they_should() {
    use core::f64::consts::{FRAC_PI_2, PI};
    check(movement(FRAC_PI_2, Some(0.0)), 0.0, FRAC_PI_2);
    check(movement(-PI, Some(0.0)), 0.0, -PI);
    check(movement(0.1, Some(0.0)), 0.0, 0.1);
}

#[test]
fn arcs_end_where_they_should() {
    check(movement(0.5, Some(0.5)), 0.5, 1.0);
    check(movement(0.4, Some(-0.2)), 0.4, -2.0);
    check(movement(-0.4, Some(0.4)), -0.4, -1.0);
    check(movement(0.2, Some(0.115)), 0.2, 0.2 / 0.115);
}

#[test]
fn the_gyro_corrects_a_turn_on_slipping_wheels() {
    let mut rig = Rig::armed(0);
    rig.follow_gyro();
    assert_eq!(rig.ask(movement(core::f64::consts::FRAC_PI_2, Some(0.0))), Ok(()));
    let slipping = 0.9;
    while rig.move_ends().is_empty() {
        let turned = turned_rad(&rig) * slipping;
        rig.cord.board_mut().gyro.0 = Some(rvac_protocol::message::Gyro {
            heading: rvac_units::Angle::from_rad(turned),
            rate: rvac_units::AngularSpeed::ZERO,
        });
        rig.run(1);
    }
    rig.run(300);
    let turned_rad = turned_rad(&rig) * slipping;
    assert!(
        (turned_rad - core::f64::consts::FRAC_PI_2).abs() < 0.035,
        "{turned_rad} rad"
    );
}

#[test]
fn a_move_of_no_length_is_done_at_once() {
    let mut rig = Rig::armed(0);
    assert_eq!(finish(&mut rig, movement(0.0, None)), MoveEnd::Done);
}

#[test]
fn a_move_that_gets_nowhere_times_out() {
    let mut rig = Rig::armed(0);
    assert_eq!(rig.ask(movement(0.05, None)), Ok(()));
    let mut held_ms = 0;
    while rig.move_ends().is_empty() && held_ms < 10_000 {
        rig.rims = [0.0; 2];
        rig.distances = rig
            .distances
            .map(|way| if held_ms % 200 == 0 { way + 0.000_51 } else { way });
        held_ms += 1;
        rig.run(1);
    }
    assert!(
        matches!(rig.move_ends()[..], [MoveEnd::TimedOut | MoveEnd::Inhibited]),
        "{:?} {:?}",
        rig.move_ends(),
        rig.names()
    );
    assert!(rig.wheels_off());
}

#[test]
fn a_bump_ends_a_move_as_inhibited() {
    let mut rig = Rig::armed(0);
    assert_eq!(rig.ask(movement(1.0, None)), Ok(()));
    rig.run(500);
    rig.cord.board_mut().bumpers.0.right = true;
    rig.run(100);
    assert_eq!(rig.move_ends(), [MoveEnd::Inhibited]);
}

#[test]
fn drive_reaches_and_holds_its_speed_with_a_ramp() {
    let mut rig = Rig::armed(0);
    rig.repeated = vec![drive(0.25, 0.0)];
    let mut fastest_change: f64 = 0.0;
    let mut before = 0.0;
    for _ in 0..1_000 {
        rig.run(10);
        fastest_change = fastest_change.max((rig.rims[0] - before) / 0.01);
        before = rig.rims[0];
    }
    assert!((rig.rims[0] - 0.25).abs() < 0.01, "{:?} m/s", rig.rims);
    assert!(fastest_change < 1.5, "{fastest_change} m/s²");
    let distance_m = rig.distances[0];
    rig.run(4_000);
    let mean = (rig.distances[0] - distance_m) / 4.0;
    assert!((mean - 0.25).abs() < 0.002, "mean {mean} m/s");
    rig.repeated = vec![drive(0.1, 1.0)];
    rig.run(2_000);
    let turn = (rig.rims[1] - rig.rims[0]) / LIMITS.track.as_m();
    assert!((turn - 1.0).abs() < 0.08, "{turn} rad/s");
    rig.repeated = vec![drive(0.0, 0.0)];
    rig.run(1_000);
    assert!(rig.wheels_off());
}

#[test]
fn slow_speeds_are_held_too() {
    let mut rig = Rig::armed(0);
    rig.repeated = vec![drive(0.02, 0.0)];
    rig.run(2_000);
    let start_m = rig.distances[0];
    rig.run(5_000);
    let mean = (rig.distances[0] - start_m) / 5.0;
    assert!((mean - 0.02).abs() < 0.002, "mean {mean} m/s, {:?}", rig.names());
}

#[test]
fn out_of_range_is_refused_and_not_clamped() {
    let mut rig = Rig::armed(0);
    assert_eq!(rig.try_motion(drive(0.36, 0.0)), Err(Refusal::Range));
    assert_eq!(rig.try_motion(drive(0.0, -1.6)), Err(Refusal::Range));
    assert_eq!(rig.ask(movement(5.0, Some(0.05))), Err(Refusal::Range));
    assert!(rig.wheels_off());
}

#[test]
fn a_direct_duty_ramps_up_and_never_jumps_into_reverse() {
    let mut rig = Rig::armed(0);
    rig.repeated = vec![motor(Motor::WheelLeft, 0.8)];
    rig.run(400);
    assert_eq!(rig.duties(), (800_000, 0));
    rig.repeated = vec![motor(Motor::WheelLeft, -0.8)];
    let mut last = 800_000;
    for _ in 0..1_000 {
        rig.run(1);
        let (now, _) = rig.duties();
        assert!(now >= 0 || rig.rims[0] < 0.1, "reversed at {} m/s", rig.rims[0]);
        assert!(now - last > -300_000 || now == 0, "jump from {last} to {now}");
        last = now;
    }
    assert_eq!(rig.duties(), (-800_000, 0));
}
