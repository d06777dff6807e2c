//! Parts that a board has but nobody has calibrated are absent: told so, not believed, and what needs them is refused.

use crate::rig;
use crate::rig::{Rig, drive, motor, movement};
use cordlib::Cord;
use cordlib::board::{Board, ChargeDrive, ChargerReadings, TemperatureRange};
use rvac_protocol::message::{
    Bumpers, Capabilities, Cliffs, Currents, Event, Inhibit, Motor, MotorSet, Refusal, Report,
};
use rvac_units::{Current, Temperature};

fn everything() -> Capabilities {
    Board::<rig::parts::Memory>::capabilities()
}

/// A rig on which only this is fitted, armed.
fn with(fitted: Capabilities) -> Rig {
    let mut rig = Rig::switched_on_as(0, |parameters| parameters.fitted = Some(fitted));
    rig.connect();
    rig.arm();
    rig
}

#[test]
fn the_handshake_tells_what_is_there_and_no_more_than_the_board_can_have() {
    let mut fitted = Capabilities {
        encoders: false,
        buttons: 0,
        cliffs: 0,
        leds: 200,
        ..everything()
    };
    let mut rig = Rig::switched_on_as(0, |parameters| parameters.fitted = Some(fitted));
    rig.connect();
    rig.run(2_000);
    fitted.leds = everything().leds;
    let table = rig.described.expect("a description");
    assert_eq!(table.capabilities, fitted);
    assert_eq!(table.limits.count_nm, 0, "the way of a count is not known");
}

#[test]
fn without_encoders_a_wheel_runs_by_hand_and_nothing_else_moves() {
    let mut rig = with(Capabilities {
        encoders: false,
        ..everything()
    });
    assert_eq!(rig.try_motion(drive(0.1, 0.0)), Err(Refusal::Absent));
    assert_eq!(rig.ask(movement(0.1, None)), Err(Refusal::Absent));
    rig.repeated = vec![motor(Motor::WheelLeft, 0.5)];
    rig.run(1_000);
    assert!(rig.rims[0] > 0.1 && rig.rims[1] == 0.0, "{:?}", rig.rims);
    let state = rig.last_state();
    assert_eq!(
        (state.count_left, state.count_right),
        (0, 0),
        "counts mean nothing yet"
    );
    // The lease ends it as ever.
    rig.repeated.clear();
    rig.run(300);
    assert!(rig.wheels_off());
}

#[test]
fn without_encoders_rules_that_need_a_speed_rest_and_the_others_hold() {
    let fitted = Capabilities {
        encoders: false,
        ..everything()
    };
    // Duty that would be a runaway, an encoder fault or no progress, if speeds were known.
    let mut rig = with(fitted);
    rig.repeated = vec![motor(Motor::WheelLeft, 0.6), motor(Motor::WheelRight, -0.6)];
    rig.run(5_000);
    assert!(!rig.wheels_off() && rig.names().is_empty(), "{:?}", rig.names());
    // S11: an encoder that has counted before must count while the wheel is driven hard.
    rig.mechanics.blocked = [true, false];
    let took_ms = rig.run_until(400, |rig| rig.has(Inhibit::WheelStall));
    assert!(took_ms <= 310, "{took_ms} ms");
    // One that never did tells nothing: the current does.
    let mut rig = with(fitted);
    rig.mechanics.silent = true;
    rig.repeated = vec![motor(Motor::WheelLeft, 0.6)];
    rig.run(2_000);
    assert!(!rig.has(Inhibit::WheelStall));
    rig.cord.board_mut().currents.0 = Currents {
        wheel_left: Current(1_600),
        ..Currents::default()
    };
    rig.run_until(120, |rig| rig.has(Inhibit::WheelStall));
}

#[test]
fn without_encoders_a_cliff_is_the_end_of_the_way() {
    let mut rig = with(Capabilities {
        encoders: false,
        ..everything()
    });
    rig.repeated = vec![motor(Motor::WheelLeft, 0.5), motor(Motor::WheelRight, 0.5)];
    rig.run(500);
    rig.cord.board_mut().cliffs.missing = Cliffs {
        middle: true,
        ..Cliffs::default()
    };
    rig.run(50);
    assert!(rig.wheels_off() && rig.has(Inhibit::CliffTrapped));
    assert_eq!(
        rig.try_motion(motor(Motor::WheelLeft, -0.5)),
        Err(Refusal::Inhibited),
        "neither way nor speed back could be limited"
    );
}

#[test]
fn without_encoders_a_reversal_rests_first() {
    let mut rig = with(Capabilities {
        encoders: false,
        ..everything()
    });
    rig.repeated = vec![motor(Motor::WheelLeft, 0.8)];
    rig.run(1_000);
    rig.repeated = vec![motor(Motor::WheelLeft, -0.8)];
    let mut rested_ms = 0;
    for _ in 0..1_000 {
        rig.run(1);
        let duty = rig.duties().0;
        rested_ms += u32::from(duty == 0);
        assert!(duty >= 0 || rested_ms >= 350, "{rested_ms} ms");
    }
    assert!(rig.duties().0 < 0);
}

#[test]
fn a_button_of_unknown_number_stops_all_the_same() {
    let mut rig = with(Capabilities {
        buttons: 0,
        ..everything()
    });
    rig.repeated = vec![drive(0.2, 0.0)];
    rig.run(1_000);
    assert!(!rig.wheels_off());
    rig.cord.board_mut().buttons.any = true;
    let took_ms = rig.run_until(60, Rig::wheels_off);
    assert!(took_ms <= 50 && rig.has(Inhibit::ButtonStop));
    rig.run(100);
    assert!(
        !rig.edges.iter().any(|edge| matches!(edge, Event::Button { .. })),
        "which one is not known"
    );
    assert_eq!(rig.last_state().buttons, 0);
    assert_eq!(rig.ask(rig::arm(false)), Err(Refusal::CauseRemains));
}

#[test]
fn readings_without_calibration_are_not_believed() {
    let mut rig = with(Capabilities {
        cliffs: 0,
        currents: false,
        gyro: false,
        bumpers: 0,
        ..everything()
    });
    rig.repeated = vec![drive(0.2, 0.0)];
    let board = rig.cord.board_mut();
    board.cliffs.missing = Cliffs {
        left: true,
        middle: true,
        right: true,
    };
    board.bumpers.0 = Bumpers {
        left: true,
        right: true,
    };
    board.currents.0 = Currents {
        wheel_left: Current(30_000),
        wheel_right: Current(30_000),
        brush_main: Current(30_000),
    };
    rig.follow_gyro();
    rig.run(2_000);
    assert!(!rig.wheels_off() && rig.names().is_empty(), "{:?}", rig.names());
    let state = rig.last_state();
    assert_eq!((state.gyro, state.currents, state.pack), (None, None, None));
}

#[test]
fn a_charger_that_was_not_checked_never_switches_on_and_still_measures() {
    let mut rig = Rig::switched_on_as(0, |parameters| {
        parameters.fitted = Some(Capabilities {
            charger: false,
            ..everything()
        });
    });
    rig.connect();
    let board = rig.cord.board_mut();
    board.dock_contacts.0 = true;
    board.charger.readings = Some(ChargerReadings {
        pack_mv: 14_000,
        input_mv: 14_000,
        current_ma: 0,
        temperature: Ok(TemperatureRange::exact(Temperature(250))),
        age_ms: 0,
        adapter: true,
    });
    for _ in 0..20_000 {
        rig.run(1);
        assert_eq!(rig.cord.board().charger.drive, ChargeDrive::Off);
    }
    assert_eq!(rig.last_state().pack.map(|pack| pack.voltage.0), Some(14_000));
    let refused = rig.ask(rvac_protocol::message::Command::Charge {
        sequence: rvac_protocol::message::Sequence(0),
        wanted: true,
    });
    assert_eq!(refused, Err(Refusal::Absent));
    let _: &Cord<rig::parts::Memory> = &rig.cord;
}

#[test]
fn a_pack_that_nobody_measured_has_no_charge_to_tell() {
    for measured in [true, false] {
        let mut rig = Rig::switched_on_as(0, |parameters| parameters.pack.measured = measured);
        rig.cord.board_mut().charger.readings = Some(ChargerReadings {
            pack_mv: 16_800,
            input_mv: 16_800,
            current_ma: 0,
            temperature: Ok(TemperatureRange::exact(Temperature(250))),
            age_ms: 0,
            adapter: false,
        });
        rig.connect();
        rig.run(5_000);
        let told = rig
            .reports
            .iter()
            .any(|report| matches!(report, Report::Info(info) if info.battery.is_some()));
        assert_eq!(told, measured);
        let pack = rig.last_state().pack;
        assert_eq!(
            pack.map(|pack| pack.voltage.0),
            Some(16_800),
            "the voltage is told"
        );
    }
}

#[test]
fn motors_without_stall_detection_are_told_when_a_session_opens() {
    let told = |rig: &Rig, what: &str| {
        rig.reports.iter().any(|report| {
            matches!(report, Report::Log { text, .. } if text.as_str() == format!("no stall detection: {what}"))
        })
    };
    for (currents, pulses, guarded) in [(true, None, true), (false, Some(0), true), (false, None, false)] {
        let fitted = Capabilities {
            currents,
            ..everything()
        };
        let mut rig = Rig::switched_on_as(0, |parameters| parameters.fitted = Some(fitted));
        rig.cord.board_mut().brush_main.pulses = pulses;
        rig.connect();
        rig.run(1_000);
        assert!(told(&rig, "brush-sides") && told(&rig, "vacuum") && !told(&rig, "wheels"));
        assert_eq!(!told(&rig, "brush-main"), guarded, "{currents} {pulses:?}");
        let gaps = rig.described.expect("a description").motors;
        assert!(gaps.unguarded.brush_sides && gaps.unguarded.vacuum && !gaps.unguarded.wheels);
        // The board of this test gets its pulses after it was switched on.
        assert_eq!(gaps.unguarded.brush_main, !currents);
        assert_eq!(gaps.unmeasured, MotorSet::default());
    }
}
