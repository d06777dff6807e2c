//! Telemetry, clock, tones, lights, counters, and what a panic leaves behind.

use crate::rig;
use crate::rig::{Rig, motor};
use cordlib::board::{Board, WheelDrive};
use rvac_protocol::message::{
    Beep, Bumpers, Command, Event, Inhibit, Led, LedPattern, Motor, Parameter, Report, Sequence,
};
use rvac_units::{Frequency, Ratio};

fn beep(pitch_hz: i32, duration_ms: u16) -> Command {
    Command::Beep(Beep {
        pitch: Frequency(pitch_hz),
        duration_ms,
        volume: Ratio::ONE,
    })
}

fn set(parameter: Parameter, value: i32) -> Command {
    Command::Set {
        sequence: Sequence(0),
        parameter,
        value,
    }
}

fn states(rig: &Rig) -> usize {
    rig.reports
        .iter()
        .filter(|report| matches!(report, Report::State(_)))
        .count()
}

#[test]
fn state_comes_every_20_ms_across_the_wrap_and_at_the_period_that_is_set() {
    let mut rig = Rig::connected(u32::MAX - 1_500);
    rig.reports.clear();
    rig.run(2_000);
    let count = states(&rig);
    assert!((95..=101).contains(&count), "{count} reports in 2 s");
    rig.ask(set(Parameter::StatePeriod, 100)).expect("a valid period");
    rig.reports.clear();
    rig.run(2_000);
    let count = states(&rig);
    assert!((19..=21).contains(&count), "{count} reports in 2 s");
    rig.ask(set(Parameter::StatePeriod, 0)).expect("none");
    rig.run(100);
    rig.reports.clear();
    rig.run(1_000);
    assert_eq!(states(&rig), 0);
    rig.send(Command::State);
    rig.run(60);
    assert_eq!(states(&rig), 1, "when asked");
}

#[test]
fn state_tells_what_the_board_senses() {
    let mut rig = Rig::driving(0);
    let board = rig.cord.board_mut();
    board.buttons.down = 0;
    board.bumpers.0 = Bumpers {
        left: false,
        right: true,
    };
    rig.run(100);
    let state = rig.last_state();
    assert!(state.count_left > 100 && state.count_right > 100);
    assert!(state.bumpers.right && !state.bumpers.left);
    assert_eq!(state.proximity[3], 3);
    assert!(state.inhibits.contains(Inhibit::Bumper));
    assert!(rig.now().since(state.tick) < 60);
}

#[test]
fn info_carries_the_loop_frequency_and_both_bandwidths() {
    let mut rig = Rig::driving(u32::MAX - 1_000);
    rig.run(3_000);
    let info = rig
        .reports
        .iter()
        .rev()
        .find_map(|report| match report {
            Report::Info(info) => Some(info.clone()),
            _ => None,
        })
        .expect("an info report");
    assert_eq!(info.main_steps_hz, 1_000);
    assert_eq!(info.firmware_version.as_str(), "0.1.0");
    assert_eq!(info.cordlib_version.as_str(), env!("CARGO_PKG_VERSION"));
    assert!(
        (500..5_000).contains(&info.bandwidth_in),
        "{} B/s in",
        info.bandwidth_in
    );
    assert!(
        (5_000..23_000).contains(&info.bandwidth_out),
        "{} B/s out",
        info.bandwidth_out
    );
}

#[test]
fn edges_are_lossless_and_come_once_and_in_order() {
    let mut rig = Rig::connected(0);
    rig.edges.clear();
    for pressed in [true, false, true, false, true, false] {
        rig.cord.board_mut().bumpers.0.left = pressed;
        rig.run(120);
    }
    rig.run(300);
    let bumps: Vec<bool> = rig
        .edges
        .iter()
        .filter_map(|edge| match edge {
            Event::Bump(bumpers) => Some(bumpers.left),
            _ => None,
        })
        .collect();
    assert_eq!(bumps, [true, false, true, false, true, false]);
    assert!(
        rig.inhibit_edges()
            .iter()
            .any(|set| set.contains(Inhibit::Bumper))
    );
}

#[test]
fn packets_leave_whole_through_a_narrow_queue() {
    let mut rig = Rig::connected(0);
    rig.cord.board_mut().link.room = 3;
    let before = rig.host.counters();
    rig.run(5_000);
    let after = rig.host.counters();
    assert_eq!(after.bad_crc, before.bad_crc);
    assert_eq!(after.malformed, before.malformed);
    assert!(after.accepted > before.accepted + 20);
}

#[test]
fn tones_play_in_order_for_their_time() {
    let mut rig = Rig::connected(0);
    rig.send(beep(440, 100));
    rig.send(beep(0, 50));
    rig.send(beep(880, 100));
    rig.run(60);
    assert_eq!(rig.cord.board().beeper.tone, Some(Frequency(440)));
    rig.run(75);
    assert_eq!(rig.cord.board().beeper.tone, None, "a pause");
    rig.run(60);
    assert_eq!(rig.cord.board().beeper.tone, Some(Frequency(880)));
    rig.run(150);
    assert_eq!(rig.cord.board().beeper.tone, None);
    assert_eq!(rig.cord.board().beeper.played, [440, 880]);
}

#[test]
fn a_full_queue_of_tones_drops_the_newest() {
    let mut rig = Rig::connected(0);
    for pitch_hz in 1..=20 {
        rig.send(beep(100 + pitch_hz, 20));
        rig.run(2);
    }
    rig.run(1_000);
    let played = &rig.cord.board().beeper.played;
    assert!(played.len() >= 9 && played.len() < 20, "{played:?}");
    assert!(played.is_sorted(), "{played:?}");
}

#[test]
fn lights_are_steady_or_blink_once_a_second() {
    let mut rig = Rig::connected(0);
    let light = |led, pattern| {
        Command::Led(Led {
            led,
            pattern,
            brightness: Ratio::ONE,
        })
    };
    rig.send(light(1, LedPattern::On));
    rig.send(light(2, LedPattern::Blink));
    rig.send(light(9, LedPattern::On));
    rig.run(50);
    let mut changes = 0;
    let mut last = rig.cord.board().lights.0[2];
    for _ in 0..4_000 {
        rig.run(1);
        let now = rig.cord.board().lights.0[2];
        changes += u32::from(now != last);
        last = now;
    }
    assert_eq!(changes, 8);
    assert_eq!(rig.cord.board().lights.0[1], Ratio::ONE);
}

#[test]
fn time_goes_on_through_the_wrap() {
    let mut rig = Rig::switched_on(u32::MAX - 999);
    rig.run(3_000);
    assert_eq!(rig.cord.time_ms(), u64::from(u32::MAX) + 2_001);
    let seconds = (f64::from(u32::MAX) + 2_001.0) / 1e3 + 0.000_25;
    assert!((rig.cord.time_s() - seconds).abs() < 1e-6);
}

#[test]
fn what_a_panic_leaves_is_switched_off_by_the_board_alone() {
    let mut rig = Rig::driving(0);
    rig.repeated.push(motor(Motor::Vacuum, 1.0));
    rig.run(500);
    assert!(!rig.wheels_off() && !rig.cleaners_off());
    let board: &mut Board<rig::parts::Memory> = rig.cord.board_mut();
    board.all_off();
    assert_eq!(
        (board.wheels.left, board.wheels.right),
        (WheelDrive::Brake, WheelDrive::Brake)
    );
    assert!(rig.cleaners_off() && rig.cord.board().beeper.tone.is_none());
}

#[test]
fn a_late_pass_neither_doubles_nor_loses_anything() {
    let mut rig = Rig::driving(0);
    rig.cord.board_mut().clock.0 += 400;
    rig.cord.step();
    assert!(rig.wheels_off(), "the lease ended meanwhile");
    assert!(rig.has(Inhibit::LinkLost));
}

#[test]
fn hand_mode_drives_slowly_by_typed_packets() {
    let mut rig = Rig::switched_on(0);
    rig.host_dead = true;
    rig.type_in(r#"{"c":"arm","n":1,"undock":false}"#);
    assert!(rig.cord.is_armed());
    rig.type_in(r#"{"c":"drive","v":0.3,"w":0,"ttl":1000}"#);
    rig.run(400);
    assert!((rig.rims[0] - 0.1).abs() < 0.02, "{:?}", rig.rims);
    rig.run(200);
    assert!(rig.wheels_off(), "at most half a second of lease");
}
