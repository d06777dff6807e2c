//! The battery in the whole firmware: S16, S17, S18 and S19 on the rig, and what the host is told.

use crate::rig;
use crate::rig::limits;
use crate::rig::{Rig, clear, drive, motor, worst_reaction};
use cordlib::board::{
    ChargeDrive, ChargerReadings, DockRequest, HardwareFault, TemperatureRange, ThermistorFault,
};
use rvac_protocol::message::{
    ChargeFault, ChargePhase, ChargeState, Command, Inhibit, Motor, Refusal, Report, ResetCause, Sequence,
};
use rvac_units::Temperature;

pub(crate) const PACK: ChargerReadings = ChargerReadings {
    pack_mv: 15_000,
    input_mv: 15_000,
    current_ma: 0,
    temperature: Ok(TemperatureRange::exact(Temperature(250))),
    age_ms: 0,
    adapter: false,
};

fn show(rig: &mut Rig, readings: ChargerReadings) {
    rig.cord.board_mut().charger.readings = Some(readings);
}

/// Driving and cleaning with a sound pack.
fn cleaning(start: u32) -> Rig {
    cleaning_with(start, PACK)
}

fn cleaning_with(start: u32, readings: ChargerReadings) -> Rig {
    let mut rig = Rig::armed(start);
    show(&mut rig, readings);
    rig.repeated = vec![
        drive(0.2, 0.0),
        motor(Motor::BrushMain, 1.0),
        motor(Motor::Vacuum, 1.0),
    ];
    rig.run(1_500);
    assert!(!rig.wheels_off() && !rig.cleaners_off(), "{:?}", rig.names());
    rig
}

fn docked(rig: &mut Rig, readings: ChargerReadings) {
    rig.cord.board_mut().dock_contacts.0 = true;
    show(
        rig,
        ChargerReadings {
            adapter: true,
            ..readings
        },
    );
}

/// The current follows the switch, as a supply of 1.5 A makes it.
pub(crate) fn feed(rig: &mut Rig, milliseconds: u32) {
    for _ in 0..milliseconds {
        let board = rig.cord.board_mut();
        let current_ma = match board.charger.drive {
            ChargeDrive::Off => 0,
            ChargeDrive::Duty(duty) => (1_500.0 * duty.as_f64()) as i32,
        };
        if let Some(readings) = &mut board.charger.readings {
            readings.current_ma = current_ma;
        }
        rig.run(1);
    }
}

/// On the dock, with current flowing.
pub(crate) fn charging(start: u32) -> Rig {
    let mut rig = Rig::connected(start);
    show(&mut rig, PACK);
    rig.run(1_000);
    docked(&mut rig, PACK);
    feed(&mut rig, 8_000);
    assert!(
        matches!(rig.cord.charge_drive(), ChargeDrive::Duty(_)),
        "{:?}",
        rig.names()
    );
    rig
}

fn reported(rig: &Rig) -> rvac_protocol::message::Battery {
    rig.reports
        .iter()
        .rev()
        .find_map(|report| match report {
            Report::Info(info) => info.battery,
            _ => None,
        })
        .expect("an info with a battery")
}

#[test]
fn s16_each_level_of_a_falling_voltage_has_its_time_and_its_effect() {
    let fall = |pack_mv: i32| move |rig: &mut Rig| show(rig, ChargerReadings { pack_mv, ..PACK });
    let low = |rig: &Rig| rig.has(Inhibit::BatteryLow);
    worst_reaction(limits::S16_LOW, cleaning, fall(13_100), low);
    worst_reaction(limits::S16_WEAK, cleaning, fall(11_900), Rig::cleaners_off);
    worst_reaction(limits::S16_EMPTY, cleaning, fall(10_700), |rig| {
        rig.wheels_off() && rig.cleaners_off()
    });
}

#[test]
fn s16_low_tells_weak_carries_home_and_empty_holds() {
    let mut rig = cleaning(0);
    show(
        &mut rig,
        ChargerReadings {
            pack_mv: 13_100,
            ..PACK
        },
    );
    rig.run(11_000);
    assert!(rig.has(Inhibit::BatteryLow) && !rig.wheels_off() && !rig.cleaners_off());
    show(
        &mut rig,
        ChargerReadings {
            pack_mv: 11_900,
            ..PACK
        },
    );
    rig.run(2_500);
    assert!(rig.has(Inhibit::BatteryWeak) && !rig.wheels_off() && rig.cleaners_off());
    assert_eq!(rig.try_motion(motor(Motor::Vacuum, 1.0)), Err(Refusal::Inhibited));
    show(
        &mut rig,
        ChargerReadings {
            pack_mv: 10_700,
            ..PACK
        },
    );
    rig.run(600);
    assert!(rig.has(Inhibit::BatteryEmpty) && rig.wheels_off());
    // Without load the voltage comes back; that is no charge.
    show(
        &mut rig,
        ChargerReadings {
            pack_mv: 14_400,
            ..PACK
        },
    );
    rig.run(30_000);
    assert!(rig.has(Inhibit::BatteryEmpty) && rig.wheels_off());
    docked(
        &mut rig,
        ChargerReadings {
            pack_mv: 14_400,
            ..PACK
        },
    );
    rig.run(11_000);
    assert!(
        !rig.has(Inhibit::BatteryEmpty) && !rig.has(Inhibit::BatteryLow),
        "charged: {:?}",
        rig.names()
    );
}

#[test]
fn s16_a_dip_of_the_voltage_is_nothing() {
    let mut rig = cleaning(0);
    for _ in 0..10 {
        show(
            &mut rig,
            ChargerReadings {
                pack_mv: 10_500,
                ..PACK
            },
        );
        rig.run(300);
        show(&mut rig, PACK);
        rig.run(500);
    }
    assert!(!rig.wheels_off() && !rig.cleaners_off(), "{:?}", rig.names());
}

fn warm_to(rig: &mut Rig, tenths: i16) {
    let temperature = Ok(TemperatureRange::exact(Temperature(tenths)));
    show(rig, ChargerReadings { temperature, ..PACK });
}

/// Cleaning with a pack that is as warm as it may be.
fn warm(start: u32) -> Rig {
    let temperature = Ok(TemperatureRange::exact(Temperature(530)));
    cleaning_with(start, ChargerReadings { temperature, ..PACK })
}

fn cool_down(rig: &mut Rig, from: i16) {
    for tenths in (470..=from).rev().step_by(20) {
        warm_to(rig, tenths);
        rig.run(2_000);
    }
    rig.run(11_000);
}

#[test]
fn s17_a_hot_pack_stops_motors_within_a_second_until_it_has_cooled() {
    let off = |rig: &Rig| rig.wheels_off() && rig.cleaners_off();
    worst_reaction(limits::S17_HOT, warm, |rig| warm_to(rig, 556), off);
    let mut rig = warm(0);
    warm_to(&mut rig, 556);
    rig.run(2_000);
    assert!(rig.has(Inhibit::BatteryHot) && !rig.has(Inhibit::BatteryOverheated));
    cool_down(&mut rig, 540);
    assert!(!rig.has(Inhibit::BatteryHot), "it has cooled");
}

#[test]
fn s17_an_overheated_pack_is_latched_until_it_has_cooled_and_somebody_clears_it() {
    let mut rig = warm(0);
    for tenths in [570, 605, 590] {
        warm_to(&mut rig, tenths);
        rig.run(2_000);
    }
    assert_eq!(
        rig.ask(clear(Inhibit::BatteryOverheated)),
        Err(Refusal::CauseRemains)
    );
    cool_down(&mut rig, 580);
    assert!(rig.has(Inhibit::BatteryOverheated), "latched");
    assert_eq!(rig.ask(clear(Inhibit::BatteryOverheated)), Ok(()));
}

#[test]
fn s17_a_temperature_that_cannot_be_measured_is_latched_within_two_seconds() {
    let off = |rig: &Rig| rig.wheels_off() && rig.has(Inhibit::Thermistor);
    for fault in [ThermistorFault::Open, ThermistorFault::Shorted] {
        let broken = ChargerReadings {
            temperature: Err(fault),
            ..PACK
        };
        worst_reaction(limits::S17_UNMEASURED, cleaning, |rig| show(rig, broken), off);
    }
    // A converter that stands still shows the same reading for ever.
    let mut rig = cleaning(0);
    for age_ms in 1..=2_000 {
        show(&mut rig, ChargerReadings { age_ms, ..PACK });
        rig.run(1);
    }
    assert!(off(&rig));
    assert_eq!(rig.ask(clear(Inhibit::Thermistor)), Err(Refusal::CauseRemains));
    show(&mut rig, PACK);
    rig.run(200);
    assert_eq!(rig.ask(clear(Inhibit::Thermistor)), Ok(()));
}

#[test]
fn s18_charging_is_told_from_the_first_current_to_the_fault() {
    let mut rig = charging(0);
    assert_eq!(rig.cord.board().charger.request, DockRequest::Current);
    feed(&mut rig, 1_500);
    let battery = reported(&rig);
    assert_eq!(battery.state, ChargeState::Charging);
    assert_eq!(
        battery.charger.map(|charger| charger.phase),
        Some(ChargePhase::Fast)
    );
    assert!(battery.current.0 > 100 && battery.temperature == Some(Temperature(250)));
    assert_eq!(rig.last_state().charge, ChargeState::Charging);
    show(
        &mut rig,
        ChargerReadings {
            temperature: Err(ThermistorFault::Open),
            adapter: true,
            ..PACK
        },
    );
    rig.run(3_000);
    assert!(rig.has(Inhibit::ChargerFault));
    let battery = reported(&rig);
    let status = battery.charger.expect("a charger");
    assert_eq!(
        (status.phase, status.fault),
        (ChargePhase::Fault, Some(ChargeFault::ThermistorOpen))
    );
    assert_eq!((battery.state, battery.temperature), (ChargeState::Fault, None));
    assert_eq!(rig.ask(clear(Inhibit::ChargerFault)), Err(Refusal::CauseRemains));
    docked(&mut rig, PACK);
    rig.run(500);
    assert_eq!(rig.ask(clear(Inhibit::ChargerFault)), Ok(()));
    rig.run(20);
    assert!(!rig.has(Inhibit::ChargerFault));
}

#[test]
fn s18_a_charger_fault_forbids_no_motion_off_the_dock() {
    let mut rig = Rig::connected(0);
    show(&mut rig, PACK);
    rig.run(500);
    docked(
        &mut rig,
        ChargerReadings {
            current_ma: 140,
            ..PACK
        },
    );
    rig.run(25_000);
    assert!(rig.has(Inhibit::ChargerFault));
    show(&mut rig, PACK);
    rig.cord.board_mut().dock_contacts.0 = false;
    rig.run(5_000);
    assert!(rig.has(Inhibit::ChargerFault), "it stays");
    rig.arm();
    rig.repeated = vec![drive(0.2, 0.0)];
    rig.run(500);
    assert!(!rig.wheels_off(), "{:?}", rig.names());
}

#[test]
fn s18_the_host_may_ask_for_a_charge_and_forbid_it() {
    let charge = |wanted| Command::Charge {
        sequence: Sequence(0),
        wanted,
    };
    let mut rig = Rig::connected(0);
    show(
        &mut rig,
        ChargerReadings {
            pack_mv: 16_000,
            ..PACK
        },
    );
    rig.run(500);
    assert_eq!(rig.ask(charge(true)), Err(Refusal::Inhibited), "off the dock");
    docked(
        &mut rig,
        ChargerReadings {
            pack_mv: 16_000,
            ..PACK
        },
    );
    feed(&mut rig, 10_000);
    assert_eq!(rig.cord.charge_drive(), ChargeDrive::Off, "full enough");
    assert_eq!(rig.ask(charge(true)), Ok(()));
    feed(&mut rig, 8_000);
    assert_ne!(rig.cord.charge_drive(), ChargeDrive::Off);
    assert_eq!(rig.ask(charge(false)), Ok(()));
    feed(&mut rig, 10);
    assert_eq!(rig.cord.charge_drive(), ChargeDrive::Off);
}

#[test]
fn s19_current_ends_before_the_first_motor_runs() {
    let mut rig = charging(0);
    rig.ask(rig::arm(true)).expect("undocking is allowed");
    assert_eq!(rig.cord.charge_drive(), ChargeDrive::Off);
    rig.repeated = vec![drive(-0.1, 0.0)];
    let mut ran = false;
    for _ in 0..500 {
        feed(&mut rig, 1);
        let driven = !rig.wheels_off();
        assert!(!driven || rig.cord.board().charger.drive == ChargeDrive::Off);
        ran |= driven;
    }
    assert!(ran, "{:?}", rig.names());
}

#[test]
fn s19_what_was_sent_while_it_charged_moves_nothing_later() {
    let mut rig = charging(0);
    for command in [
        drive(0.3, 0.0),
        motor(Motor::WheelLeft, 1.0),
        motor(Motor::Vacuum, 1.0),
    ] {
        assert_eq!(rig.try_motion(command), Err(Refusal::Inhibited));
    }
    rig.cord.board_mut().dock_contacts.0 = false;
    show(&mut rig, PACK);
    for _ in 0..2_000 {
        rig.run(1);
        assert!(rig.wheels_off() && rig.cleaners_off());
    }
}

#[test]
fn a_hardware_fault_ends_charging_until_it_is_gone_and_cleared() {
    for fault in HardwareFault::ALL {
        let mut rig = charging(0);
        rig.cord.board_mut().checks.0.push(fault);
        feed(&mut rig, 2);
        assert_eq!(rig.cord.board().charger.drive, ChargeDrive::Off);
        for _ in 0..5 {
            assert_eq!(rig.ask(clear(fault.inhibit())), Err(Refusal::CauseRemains));
            for _ in 0..8_000 {
                feed(&mut rig, 1);
                assert_eq!(rig.cord.board().charger.drive, ChargeDrive::Off);
            }
            assert!(rig.has(fault.inhibit()));
        }
        rig.cord.board_mut().checks.0.clear();
        feed(&mut rig, 8_000);
        assert_eq!(rig.cord.board().charger.drive, ChargeDrive::Off, "still latched");
        assert_eq!(rig.ask(clear(fault.inhibit())), Ok(()));
        feed(&mut rig, 8_000);
        assert_ne!(rig.cord.board().charger.drive, ChargeDrive::Off);
    }
}

#[test]
fn a_fault_that_is_reported_once_ends_charging_until_it_is_cleared() {
    let mut rig = charging(0);
    rig.cord.hardware_fault(HardwareFault::Memory);
    assert_eq!(rig.cord.board().charger.drive, ChargeDrive::Off);
    feed(&mut rig, 10_000);
    assert_eq!(rig.cord.board().charger.drive, ChargeDrive::Off);
    assert!(rig.has(Inhibit::Memory));
    rig.reset(ResetCause::Watchdog);
    rig.connect();
    feed(&mut rig, 10_000);
    assert_eq!(
        rig.cord.board().charger.drive,
        ChargeDrive::Off,
        "a reset does not clear it"
    );
    assert_eq!(rig.ask(clear(Inhibit::Memory)), Ok(()));
    feed(&mut rig, 8_000);
    assert_ne!(rig.cord.board().charger.drive, ChargeDrive::Off);
}

#[test]
fn a_clock_fault_has_its_own_name() {
    let mut rig = cleaning(0);
    rig.cord.hardware_fault(HardwareFault::Clock);
    assert!(rig.wheels_off() && rig.cleaners_off() && rig.has(Inhibit::Clock));
}

#[test]
fn a_machine_whose_pack_is_never_measured_has_no_battery_to_worry_about() {
    let mut rig = Rig::armed(0);
    rig.run(5_000);
    assert!(rig.names().is_empty(), "{:?}", rig.names());
    assert!(
        !rig.reports
            .iter()
            .any(|report| matches!(report, Report::Info(info) if info.battery.is_some()))
    );
}

/// Before the first average there is no estimate, and a daemon that reads 0 % refuses to start.
#[test]
fn no_charge_is_told_before_it_is_known() {
    let mut rig = Rig::switched_on_with(0, |board| board.charger.readings = Some(PACK));
    rig.connect();
    rig.run(3_000);
    let mut reported = rig.reports.iter().filter_map(|report| match report {
        Report::Info(info) => Some(info.battery),
        _ => None,
    });
    assert_eq!(
        reported.next(),
        Some(None),
        "the first info comes with the session"
    );
    let later: Vec<f64> = reported
        .flatten()
        .map(|battery| battery.charge.as_f64())
        .collect();
    assert!(
        !later.is_empty() && later.iter().all(|&charge| charge > 0.4),
        "{later:?}"
    );
}
