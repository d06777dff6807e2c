//! Rules that stop the robot, each at 200 phases of the loop, with the worst reaction against the limit of SAFETY.md.

use crate::rig;
use crate::rig::limits;
use crate::rig::{Rig, clear, drive, motor, movement, worst_reaction};
use rvac_protocol::message::{
    Bumpers, Cliffs, Command, Currents, Event, Inhibit, MotionPhase, Motor, MotorCommand, MoveEnd, Refusal,
    WheelDrops,
};
use rvac_units::{Current, Throttle};

const LEFT: Bumpers = Bumpers {
    left: true,
    right: false,
};
const BOTH: Bumpers = Bumpers {
    left: true,
    right: true,
};
const MIDDLE: Cliffs = Cliffs {
    left: false,
    middle: true,
    right: false,
};
const HANGING: WheelDrops = WheelDrops {
    left: false,
    right: true,
};

fn press(rig: &mut Rig, bumpers: Bumpers) {
    rig.cord.board_mut().bumpers.0 = bumpers;
}

fn see(rig: &mut Rig, missing: Cliffs) {
    rig.cord.board_mut().cliffs.missing = missing;
}

fn hang(rig: &mut Rig, drops: WheelDrops) {
    rig.cord.board_mut().wheel_drops.0 = drops;
}

fn cleaning(start: u32) -> Rig {
    let mut rig = Rig::driving(start);
    let main = motor(Motor::BrushMain, 0.8);
    rig.repeated.extend([main, motor(Motor::Vacuum, 1.0)]);
    rig.run(1_000);
    assert!(!rig.cleaners_off());
    rig
}

#[test]
fn s1_silence_stops_wheels_brushes_and_suction_in_300_ms() {
    worst_reaction(
        limits::S1_SILENCE,
        Rig::driving,
        |rig| rig.host_dead = true,
        Rig::wheels_off,
    );
    worst_reaction(
        limits::S1_SILENCE,
        cleaning,
        |rig| rig.host_dead = true,
        Rig::cleaners_off,
    );
}

/// A command with a lease of this length.
fn leased(part: Motor, lease_ms: u16) -> Command {
    match motor(part, 1.0) {
        Command::Motor(motor) => Command::Motor(MotorCommand { lease_ms, ..motor }),
        other => other,
    }
}

#[test]
fn s1_the_lease_of_brushes_and_suction_ends_with_its_ttl() {
    for part in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
        for lease_ms in [1, 2, 9, 10, 11, 250, 1_000] {
            for phase in 0..20 {
                let mut rig = Rig::armed(u32::MAX - 500 + phase);
                rig.run(phase);
                rig.send(leased(part, lease_ms));
                let mut ran_ms = 0;
                for _ in 0..2_500 {
                    rig.run(1);
                    ran_ms += u32::from(!rig.cleaners_off());
                }
                let lease_ms = u32::from(lease_ms);
                assert!(ran_ms <= lease_ms, "{part:?} ran {ran_ms} of {lease_ms} ms");
                assert!(ran_ms + 10 >= lease_ms, "{part:?} ran {ran_ms} of {lease_ms} ms");
            }
        }
    }
}

#[test]
fn s1_a_lease_that_is_renewed_in_time_has_no_gap() {
    let mut rig = Rig::armed(0);
    let parts = [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum];
    for passed in 0..10_000 {
        // As the daemon does, with two of three renewals lost.
        if passed % 900 == 0 {
            for part in parts {
                rig.send(leased(part, 1_000));
            }
        }
        rig.run(1);
        let board = rig.cord.board();
        let runs =
            [&board.brush_main, &board.brush_sides, &board.vacuum].map(|brush| brush.duty != Throttle::ZERO);
        assert!(passed < 20 || runs == [true; 3], "{runs:?} at {passed} ms");
    }
}

#[test]
fn s1_a_fresh_command_goes_on_after_a_lost_link() {
    let mut rig = Rig::driving(0);
    rig.host_dead = true;
    rig.run(400);
    assert!(rig.has(Inhibit::LinkLost) && rig.wheels_off());
    rig.host_dead = false;
    rig.run(300);
    assert!(
        !rig.has(Inhibit::LinkLost) && !rig.wheels_off(),
        "{:?}",
        rig.names()
    );
}

/// A robot that was told to stand, and stands, has lost nothing when that lease is over.
#[test]
fn s1_a_lease_to_stand_still_may_run_out() {
    let mut rig = Rig::armed(0);
    rig.send(drive(0.0, 0.0));
    for _ in 0..1_000 {
        rig.run(1);
        assert!(!rig.has(Inhibit::LinkLost), "{:?}", rig.names());
    }
}

#[test]
fn s1_a_move_ends_when_the_link_is_silent() {
    let mut rig = Rig::armed(0);
    assert_eq!(rig.ask(movement(3.0, None)), Ok(()));
    rig.run(1_000);
    assert!(!rig.wheels_off());
    rig.host_dead = true;
    let took_ms = rig.run_until(1_100, Rig::wheels_off);
    assert!(took_ms <= 1_050, "{took_ms} ms");
}

#[test]
fn s4_nothing_moves_before_arming() {
    let mut rig = Rig::connected(5);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
    assert_eq!(rig.try_motion(motor(Motor::Vacuum, 1.0)), Err(Refusal::Inhibited));
    assert_eq!(rig.ask(movement(0.1, None)), Err(Refusal::Inhibited));
    assert!(rig.has(Inhibit::NotArmed) && rig.wheels_off());
}

#[test]
fn s4_three_resets_in_a_row_are_latched_until_a_minute_has_passed() {
    let mut rig = Rig::switched_on_with(u32::MAX - 30_000, |board| board.reset.recent = 3);
    rig.connect();
    rig.arm();
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
    assert_eq!(rig.ask(clear(Inhibit::ResetLoop)), Err(Refusal::CauseRemains));
    rig.run(60_000);
    assert_eq!(rig.cord.board().reset.recent, 0);
    assert_eq!(rig.ask(clear(Inhibit::ResetLoop)), Ok(()));
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Ok(()));
    let two = Rig::switched_on_with(0, |board| board.reset.recent = 2);
    assert!(!two.has(Inhibit::ResetLoop));
}

#[test]
fn s5_the_watchdog_is_fed_in_every_pass_whose_clock_moves() {
    let mut rig = Rig::connected(u32::MAX - 100);
    let before = rig.cord.board().watchdog.0;
    rig.run(1_000);
    assert_eq!(rig.cord.board().watchdog.0 - before, 1_000);
    let stopped = rig.cord.board().watchdog.0;
    for _ in 0..1_000 {
        rig.cord.step();
    }
    assert_eq!(rig.cord.board().watchdog.0, stopped, "fed by a dead clock");
}

#[test]
fn s6_a_press_brakes_within_20_ms() {
    worst_reaction(
        limits::S6_STOP,
        Rig::driving,
        |rig| press(rig, LEFT),
        Rig::wheels_off,
    );
}

#[test]
fn s6_only_motion_away_is_allowed_until_release() {
    let mut rig = Rig::driving(0);
    rig.repeated.clear();
    press(&mut rig, LEFT);
    rig.run(20);
    assert!(rig.edges.contains(&Event::Bump(LEFT)));
    assert_eq!(rig.cord.phase(), MotionPhase::Reflex);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
    assert_eq!(
        rig.try_motion(drive(0.0, 0.5)),
        Err(Refusal::Inhibited),
        "towards it"
    );
    assert_eq!(rig.try_motion(drive(0.0, -0.5)), Ok(()), "away from it");
    assert_eq!(rig.try_motion(drive(-0.2, 0.0)), Ok(()));
    rig.run(100);
    assert!(!rig.wheels_off());
    press(&mut rig, BOTH);
    rig.run(5);
    assert_eq!(rig.try_motion(drive(0.0, -0.5)), Err(Refusal::Inhibited));
    press(&mut rig, Bumpers::default());
    rig.run(20);
    assert!(rig.has(Inhibit::Bumper), "release is debounced");
    rig.run(20);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Ok(()));
}

#[test]
fn s6_a_released_bumper_does_not_set_the_robot_off_again() {
    let mut rig = Rig::driving(0);
    rig.repeated.clear();
    press(&mut rig, BOTH);
    rig.run(30);
    press(&mut rig, Bumpers::default());
    rig.run(150);
    assert!(rig.wheels_off());
}

#[test]
fn s7_a_bumper_pressed_for_ten_seconds_is_stuck_and_latched() {
    let mut rig = cleaning(0);
    press(&mut rig, BOTH);
    rig.run(9_900);
    assert!(!rig.has(Inhibit::BumperStuck));
    rig.run(150);
    assert!(rig.has(Inhibit::BumperStuck) && rig.cleaners_off());
    assert_eq!(rig.ask(clear(Inhibit::BumperStuck)), Err(Refusal::CauseRemains));
    press(&mut rig, Bumpers::default());
    rig.run(100);
    assert!(rig.has(Inhibit::BumperStuck), "latched");
    assert_eq!(rig.ask(clear(Inhibit::BumperStuck)), Ok(()));
    assert!(!rig.has(Inhibit::BumperStuck));
}

/// People put it down against a wall, and it stops where it touches one.
#[test]
fn s7_a_robot_at_rest_may_stand_against_a_wall() {
    let mut rig = Rig::connected(0);
    press(&mut rig, BOTH);
    rig.run(60_000);
    assert!(!rig.has(Inhibit::BumperStuck), "{:?}", rig.names());
    rig.arm();
    rig.run(9_900);
    assert!(!rig.has(Inhibit::BumperStuck), "{:?}", rig.names());
    rig.run(200);
    assert!(rig.has(Inhibit::BumperStuck), "{:?}", rig.names());
}

#[test]
fn s7_a_bumper_pressed_while_backing_for_three_seconds_is_stuck() {
    let mut rig = Rig::driving(0);
    press(&mut rig, BOTH);
    rig.run(20);
    rig.repeated = vec![drive(-0.04, 0.0)];
    let start_m = rig.distances[0];
    let took_ms = rig.run_until(3_200, |rig| rig.has(Inhibit::BumperStuck));
    assert!(took_ms > 2_900, "{took_ms} ms");
    rig.run(2);
    assert!(rig.wheels_off());
    let distance_m = start_m - rig.distances[0];
    assert!(
        (0.05..0.14).contains(&distance_m),
        "{distance_m} m: not by distance"
    );
}

#[test]
fn s7_a_bumper_pressed_over_15_cm_of_backing_is_stuck() {
    let mut rig = Rig::driving(0);
    press(&mut rig, BOTH);
    rig.run(200);
    rig.repeated = vec![drive(-0.3, 0.0)];
    let start_m = rig.distances[0];
    let took_ms = rig.run_until(2_000, |rig| rig.has(Inhibit::BumperStuck));
    assert!(took_ms < 1_500, "{took_ms} ms");
    rig.run(500);
    assert!(rig.wheels_off());
    let distance_m = start_m - rig.distances[0];
    assert!((0.14..0.18).contains(&distance_m), "{distance_m} m");
    assert_eq!(rig.ask(clear(Inhibit::BumperStuck)), Err(Refusal::CauseRemains));
    press(&mut rig, Bumpers::default());
    rig.run(100);
    assert_eq!(rig.ask(clear(Inhibit::BumperStuck)), Ok(()));
    press(&mut rig, BOTH);
    rig.run(100);
    assert!(
        !rig.has(Inhibit::BumperStuck),
        "the way counts anew after a person"
    );
}

#[test]
fn s7_a_contact_that_comes_and_goes_begins_no_new_way() {
    let backed_off_m = |between: rvac_protocol::message::Command| {
        let mut rig = Rig::driving(0);
        let start_m = rig.distances[0];
        for _ in 0..6 {
            press(&mut rig, BOTH);
            rig.run(30);
            rig.repeated = vec![drive(-0.1, 0.0)];
            rig.run(900);
            press(&mut rig, Bumpers::default());
            rig.repeated = vec![between];
            rig.run(1_500);
        }
        (rig.has(Inhibit::BumperStuck), start_m - rig.distances[0])
    };
    let (stuck, distance_m) = backed_off_m(drive(0.0, 0.0));
    assert!(stuck && (0.13..0.18).contains(&distance_m), "{distance_m} m");
    let (stuck, distance_m) = backed_off_m(drive(0.2, 0.0));
    assert!(!stuck, "{distance_m} m in sum, driven forward in between");
}

#[test]
fn s7_a_robot_pushed_back_by_its_bumper_is_not_backing_off() {
    let mut rig = Rig::connected(0);
    press(&mut rig, BOTH);
    for _ in 0..4_000 {
        rig.distances = rig.distances.map(|way| way - 0.000_1);
        rig.run(1);
    }
    assert!(!rig.has(Inhibit::BumperStuck), "{:?}", rig.names());
}

#[test]
fn s8_a_cliff_stops_within_20_ms() {
    worst_reaction(
        limits::S8_STOP,
        Rig::driving,
        |rig| see(rig, MIDDLE),
        Rig::wheels_off,
    );
}

#[test]
fn s8_only_a_slow_short_reverse_leads_away() {
    let mut rig = Rig::driving(0);
    rig.repeated.clear();
    see(&mut rig, MIDDLE);
    rig.run(200);
    assert!(rig.edges.contains(&Event::Cliff(MIDDLE)));
    assert_eq!(rig.try_motion(drive(0.05, 0.0)), Err(Refusal::Inhibited));
    assert_eq!(rig.try_motion(drive(0.0, 0.5)), Err(Refusal::Inhibited));
    let start_m = rig.distances[0];
    rig.repeated = vec![drive(-0.3, 0.0)];
    let mut fastest_m_per_s: f64 = 0.0;
    for _ in 0..1_000 {
        rig.run(1);
        fastest_m_per_s = fastest_m_per_s.max(-rig.rims[0]);
    }
    assert!((0.07..=0.115).contains(&fastest_m_per_s), "{fastest_m_per_s} m/s");
    assert!(!rig.has(Inhibit::CliffTrapped));
    rig.run(2_000);
    assert!(rig.has(Inhibit::CliffTrapped) && rig.wheels_off());
    let distance_m = start_m - rig.distances[0];
    assert!((0.13..0.17).contains(&distance_m), "{distance_m} m");
    assert_eq!(rig.ask(clear(Inhibit::CliffTrapped)), Err(Refusal::CauseRemains));
    see(&mut rig, Cliffs::default());
    rig.run(100);
    assert_eq!(rig.ask(clear(Inhibit::CliffTrapped)), Ok(()));
}

#[test]
fn s8_three_cliffs_in_five_seconds_are_a_trap() {
    let mut rig = Rig::driving(0);
    for _ in 0..2 {
        see(&mut rig, MIDDLE);
        rig.run(200);
        see(&mut rig, Cliffs::default());
        rig.run(1_000);
        assert!(!rig.has(Inhibit::CliffTrapped) && !rig.wheels_off());
    }
    see(&mut rig, MIDDLE);
    rig.run(20);
    assert!(rig.has(Inhibit::CliffTrapped));
}

/// Shows floor under the middle sensor for a moment, over and over, until it was missing so often.
fn flicker(rig: &mut Rig, times: u32) {
    for _ in 0..times {
        see(rig, MIDDLE);
        rig.run(20);
        see(rig, Cliffs::default());
        rig.run(70);
    }
}

#[test]
fn s8_an_edge_that_flickers_while_the_robot_stops_is_one_cliff() {
    let mut rig = Rig::driving(0);
    flicker(&mut rig, 3);
    rig.run(1_000);
    flicker(&mut rig, 3);
    assert!(!rig.has(Inhibit::CliffTrapped), "two edges");
    rig.run(1_000);
    flicker(&mut rig, 1);
    assert!(rig.has(Inhibit::CliffTrapped), "three edges");
}

#[test]
fn s8_an_edge_that_flickers_on_is_a_trap_within_a_second() {
    let mut rig = Rig::driving(0);
    flicker(&mut rig, 12);
    assert!(rig.has(Inhibit::CliffTrapped));
}

#[test]
fn s8_floor_that_shows_up_on_the_way_back_leads_no_farther() {
    let mut rig = Rig::driving(0);
    see(&mut rig, MIDDLE);
    rig.run(200);
    let start_m = rig.distances[0];
    rig.repeated = vec![drive(-0.1, 0.0)];
    see(&mut rig, Cliffs::default());
    rig.run(70);
    see(&mut rig, MIDDLE);
    rig.run(3_000);
    assert!(rig.has(Inhibit::CliffTrapped) && rig.wheels_off());
    let distance_m = start_m - rig.distances[0];
    assert!((0.1..0.17).contains(&distance_m), "{distance_m} m");
}

#[test]
fn s8_cliffs_that_are_far_apart_are_no_trap() {
    let mut rig = Rig::driving(0);
    for _ in 0..5 {
        see(&mut rig, MIDDLE);
        rig.run(200);
        see(&mut rig, Cliffs::default());
        rig.run(2_500);
        assert!(!rig.has(Inhibit::CliffTrapped));
    }
}

#[test]
fn s9_a_stuck_receiver_counts_as_a_cliff_within_a_second() {
    for level in [0, 300, 600, 1_023] {
        let stick = |rig: &mut Rig| rig.cord.board_mut().cliffs.stuck_left = Some(level);
        worst_reaction(limits::S9_BLIND, Rig::driving, stick, |rig| {
            rig.wheels_off() && rig.cord.cliffs().left
        });
    }
}

#[test]
fn s9_a_receiver_that_sees_light_without_its_emitter_is_named_faulty() {
    let mut rig = Rig::driving(0);
    rig.cord.board_mut().cliffs.stuck_left = Some(700);
    rig.run(1_000);
    assert!(rig.has(Inhibit::CliffSensorFault));
    rig.cord.board_mut().cliffs.stuck_left = None;
    rig.run(1_100);
    assert!(!rig.has(Inhibit::CliffSensorFault));
}

#[test]
fn s10_a_hanging_wheel_switches_everything_off_within_50_ms() {
    let off = |rig: &Rig| rig.wheels_off() && rig.cleaners_off();
    worst_reaction(limits::S10_OFF, cleaning, |rig| hang(rig, HANGING), off);
}

#[test]
fn s10_after_a_second_of_standing_a_new_command_is_needed() {
    let mut rig = cleaning(0);
    rig.repeated.clear();
    hang(&mut rig, HANGING);
    rig.run(200);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
    hang(&mut rig, WheelDrops::default());
    rig.run(900);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
    rig.run(1_500);
    assert!(rig.wheels_off() && rig.cleaners_off(), "nothing starts by itself");
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Ok(()));
    assert_eq!(rig.try_motion(motor(Motor::BrushMain, 0.5)), Ok(()));
}

#[test]
fn s11_over_current_and_standstill_switch_the_wheel_off() {
    let overload = |rig: &mut Rig| {
        rig.cord.board_mut().currents.0 = Currents {
            wheel_right: Current(-1_600),
            ..Currents::default()
        };
    };
    worst_reaction(limits::S11_OVER_CURRENT, Rig::driving, overload, Rig::wheels_off);
    let block = |rig: &mut Rig| rig.mechanics.blocked[0] = true;
    worst_reaction(limits::S11_STANDSTILL, Rig::driving, block, Rig::wheels_off);
    let mut rig = Rig::driving(0);
    block(&mut rig);
    rig.run(400);
    assert!(rig.has(Inhibit::WheelStall) && rig.edges.contains(&Event::Stall(Motor::WheelLeft)));
    assert_eq!(rig.ask(clear(Inhibit::WheelStall)), Ok(()));
}

#[test]
fn s11_a_blocked_brush_reverses_once_and_is_then_latched() {
    let mut rig = Rig::armed(0);
    rig.cord.board_mut().brush_main.pulses = Some(0);
    rig.repeated = vec![motor(Motor::BrushMain, 0.8)];
    let took_ms = rig.run_until(500, |rig| rig.cord.board().brush_main.duty.millionths() < 0);
    assert!(took_ms >= 250, "{took_ms} ms");
    assert!(!rig.has(Inhibit::BrushStall));
    let back_ms = rig.run_until(700, |rig| rig.cord.board().brush_main.duty.millionths() > 0);
    assert!((480..=520).contains(&back_ms), "{back_ms} ms");
    rig.run_until(500, |rig| rig.has(Inhibit::BrushStall));
    rig.run(1);
    assert!(rig.cleaners_off());
    rig.repeated.clear();
    assert_eq!(rig.ask(clear(Inhibit::BrushStall)), Ok(()));
}

#[test]
fn s12_a_wheel_that_turns_by_itself_is_latched_within_250_ms() {
    let short = |rig: &mut Rig| {
        rig.repeated = vec![drive(0.05, 0.0)];
        rig.run(1_000);
        rig.mechanics.stuck_duty = Some(900_000);
        rig.rims[0] = 0.4;
    };
    worst_reaction(limits::S12_FOUND, Rig::driving, short, |rig| {
        rig.has(Inhibit::Runaway)
    });
    let mut rig = Rig::driving(0);
    short(&mut rig);
    rig.run(300);
    assert!(rig.wheels_off());
    assert_eq!(rig.ask(clear(Inhibit::Runaway)), Err(Refusal::CauseRemains));
    rig.mechanics.stuck_duty = None;
    rig.run(1_000);
    assert_eq!(rig.ask(clear(Inhibit::Runaway)), Ok(()));
}

#[test]
fn s13_a_swapped_encoder_is_found_within_500_ms() {
    let resting = |start: u32| {
        let mut rig = Rig::armed(start);
        rig.mechanics.swapped = true;
        rig.repeated = vec![drive(0.25, 0.0)];
        rig
    };
    let found = |rig: &Rig| {
        assert!(!rig.has(Inhibit::Runaway), "it is the encoder: {:?}", rig.names());
        rig.has(Inhibit::EncoderFault) && rig.wheels_off()
    };
    let swap = |rig: &mut Rig| {
        rig.mechanics.swapped = true;
        let counts = &mut rig.cord.board_mut().encoders.0;
        (counts.left, counts.right) = (-counts.left, -counts.right);
    };
    worst_reaction(limits::S13_FOUND, Rig::driving, swap, found);
    let mut rig = resting(0);
    rig.run_until(2_000, |rig| rig.rims[0] > 0.05);
    rig.run(600);
    assert!(found(&rig), "{:?}", rig.names());
}

#[test]
fn s13_an_encoder_that_shows_a_fraction_of_the_speed_is_a_fault() {
    let mut rig = Rig::driving(0);
    rig.mechanics.silent = true;
    for _ in 0..500 {
        rig.run(1);
        if rig.now().0.is_multiple_of(25) {
            rig.cord.board_mut().encoders.0.left += 1;
            rig.cord.board_mut().encoders.0.right += 1;
        }
    }
    assert!(
        rig.has(Inhibit::EncoderFault) && rig.wheels_off(),
        "{:?}",
        rig.names()
    );
    rig.repeated.clear();
    assert_eq!(rig.ask(clear(Inhibit::EncoderFault)), Ok(()));
}

#[test]
fn s15_a_robot_that_crawls_is_reported_within_two_seconds() {
    let mut rig = Rig::armed(0);
    rig.repeated = vec![motor(Motor::WheelLeft, 0.5), motor(Motor::WheelRight, 0.5)];
    rig.mechanics.blocked = [true, true];
    let mut took_ms = 0;
    while !rig.has(Inhibit::NotMoving) && took_ms < 2_500 {
        rig.run(1);
        took_ms += 1;
        if took_ms % 100 == 0 {
            rig.distances = rig.distances.map(|way| way + 0.000_6);
        }
    }
    assert!(
        took_ms <= 2_100 && !rig.has(Inhibit::WheelStall),
        "{took_ms} ms {:?}",
        rig.names()
    );
    rig.repeated.clear();
    rig.run(1_100);
    assert!(!rig.has(Inhibit::NotMoving), "a new try is allowed");
}

#[test]
fn s15_a_turn_that_the_gyro_does_not_see_is_no_progress() {
    let mut rig = Rig::armed(0);
    rig.follow_gyro();
    rig.repeated = vec![drive(0.0, 1.0)];
    rig.run_until(3_000, |rig| rig.has(Inhibit::NotMoving));
    rig.run(1);
    assert!(rig.wheels_off());
}

#[test]
fn s19_docking_stops_and_disarms_and_only_undock_leads_off() {
    let mut rig = Rig::driving(0);
    rig.cord.board_mut().dock_contacts.0 = true;
    let took_ms = rig.run_until(20, Rig::wheels_off);
    assert!(took_ms <= 20);
    rig.repeated.clear();
    assert!(!rig.cord.is_armed() && rig.has(Inhibit::Docked));
    assert_eq!(rig.ask(rig::arm(false)), Err(Refusal::Inhibited));
    assert_eq!(rig.try_motion(drive(-0.1, 0.0)), Err(Refusal::Inhibited));
    assert_eq!(rig.ask(rig::arm(true)), Ok(()));
    rig.repeated = vec![drive(-0.1, 0.0)];
    rig.run(500);
    assert!(!rig.wheels_off(), "{:?}", rig.names());
    rig.cord.board_mut().dock_contacts.0 = false;
    rig.run(1_500);
    assert!(!rig.wheels_off() && rig.cord.is_armed());
    rig.cord.board_mut().dock_contacts.0 = true;
    rig.run(20);
    assert!(rig.wheels_off() && !rig.cord.is_armed(), "a new arrival");
}

/// A robot that stands elsewhere has no dock to leave: its arrival there is one from the first contact on.
#[test]
fn s19_a_robot_told_to_leave_a_dock_it_is_not_on_stops_when_it_arrives() {
    for before_ms in [0, 500, 900, 5_000] {
        let mut rig = Rig::driving(0);
        assert_eq!(rig.ask(rig::arm(true)), Ok(()));
        rig.run(before_ms);
        rig.cord.board_mut().dock_contacts.0 = true;
        let took_ms = rig.run_until(40, |rig| rig.has(Inhibit::Docked) && rig.wheels_off());
        assert!(took_ms <= 20, "{before_ms}: {took_ms} ms {:?}", rig.names());
        assert!(!rig.cord.is_armed(), "{before_ms}");
    }
}

/// The firmware of 2016 stored throttles that came while docked, and they became live when the robot was lifted off.
#[test]
fn s19_a_robot_lifted_off_the_dock_stays_still() {
    let mut rig = Rig::switched_on_with(0, |board| board.dock_contacts.0 = true);
    rig.connect();
    rig.run(100);
    assert_eq!(rig.ask(rig::arm(false)), Err(Refusal::Inhibited));
    rig.repeated = vec![
        drive(0.2, 0.0),
        motor(Motor::WheelLeft, 0.5),
        motor(Motor::BrushMain, 0.5),
    ];
    rig.run(500);
    rig.cord.board_mut().dock_contacts.0 = false;
    for _ in 0..5_000 {
        rig.run(1);
        assert!(rig.wheels_off() && rig.cleaners_off());
    }
}

#[test]
fn s27_the_newest_motion_rules_and_a_person_outranks_it() {
    let mut rig = Rig::armed(0);
    assert_eq!(rig.ask(movement(2.0, None)), Ok(()));
    rig.run(500);
    assert_eq!(rig.try_motion(drive(0.0, 0.5)), Ok(()));
    rig.run(100);
    assert_eq!(rig.move_ends(), [MoveEnd::Replaced]);
    assert_eq!(rig.cord.phase(), MotionPhase::Drive);
    assert_eq!(rig.try_motion(motor(Motor::WheelLeft, 0.4)), Ok(()));
    assert_eq!(rig.cord.phase(), MotionPhase::Motor);
    rig.cord.board_mut().buttons.down = 2;
    rig.run(50);
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Inhibited));
}

#[test]
fn s28_a_button_stops_within_50_ms_and_until_arming() {
    let off = |rig: &Rig| rig.wheels_off() && rig.cleaners_off();
    worst_reaction(
        limits::S28_STOP,
        cleaning,
        |rig| rig.cord.board_mut().buttons.down = 4,
        off,
    );
    let mut rig = cleaning(0);
    rig.cord.board_mut().buttons.down = 1;
    rig.run(100);
    assert!(rig.has(Inhibit::ButtonStop) && off(&rig));
    assert_eq!(rig.ask(rig::arm(false)), Err(Refusal::CauseRemains));
    rig.cord.board_mut().buttons.down = 0;
    rig.run(500);
    assert!(off(&rig), "the host goes on asking in vain");
    for pressed in [true, false] {
        assert!(rig.edges.contains(&Event::Button { button: 0, pressed }));
    }
    rig.arm();
    rig.run(200);
    assert!(!rig.wheels_off());
}

/// The lease ends between the press and the moment in which it is believed.
#[test]
fn s28_a_press_in_the_last_moment_of_motion_counts() {
    let fallen_silent = || {
        let mut rig = cleaning(0);
        rig.repeated.clear();
        rig
    };
    let end_ms = fallen_silent().run_until(3_000, |rig| rig.wheels_off() && rig.cleaners_off());
    for before_ms in 1..=12 {
        let mut rig = fallen_silent();
        rig.run(end_ms - before_ms);
        rig.cord.board_mut().buttons.down = 4;
        rig.run(40);
        assert!(rig.has(Inhibit::ButtonStop), "pressed {before_ms} ms before");
    }
}

#[test]
fn s28_a_button_of_a_resting_robot_is_an_event_only() {
    let mut rig = Rig::armed(0);
    rig.cord.board_mut().buttons.down = 1;
    rig.run(100);
    assert!(!rig.has(Inhibit::ButtonStop));
    assert!(rig.edges.contains(&Event::Button {
        button: 0,
        pressed: true
    }));
}

#[test]
fn s29_brushes_start_only_on_the_floor_with_a_free_bumper() {
    let mut rig = Rig::armed(0);
    press(&mut rig, LEFT);
    rig.run(50);
    for brush in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
        assert_eq!(rig.try_motion(motor(brush, 1.0)), Err(Refusal::Inhibited));
    }
    press(&mut rig, Bumpers::default());
    rig.run(50);
    for brush in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
        assert_eq!(rig.try_motion(motor(brush, 1.0)), Ok(()));
    }
    press(&mut rig, LEFT);
    rig.run(50);
    assert_eq!(
        rig.try_motion(motor(Motor::Vacuum, 1.0)),
        Ok(()),
        "it runs already"
    );
    assert_eq!(rig.try_motion(motor(Motor::BrushLeft, 1.0)), Err(Refusal::Absent));
}

#[test]
fn stop_is_obeyed_and_needs_arming() {
    use rvac_protocol::message::Command;
    worst_reaction(
        limits::STOP_OFF,
        cleaning,
        |rig| rig.send(Command::Stop),
        |rig| rig.wheels_off() && rig.cleaners_off(),
    );
    let mut rig = Rig::driving(0);
    rig.send(Command::Stop);
    rig.run(300);
    assert!(rig.wheels_off() && rig.has(Inhibit::Stopped));
    rig.arm();
    rig.run(200);
    assert!(!rig.wheels_off());
}

#[test]
fn a_hardware_fault_stops_everything_and_is_latched() {
    let mut rig = cleaning(0);
    rig.cord.hardware_fault(cordlib::board::HardwareFault::Internal);
    assert!(rig.wheels_off() && rig.cleaners_off());
    rig.run(500);
    assert!(rig.wheels_off() && rig.has(Inhibit::InternalFault));
}
