//! What stops the charger for good: each fault by its name, how fast, and when it can be cleared.

use crate::dock::Dock;
use crate::rig::{keep, limits};
use cordlib::board::ThermistorFault;
use rvac_protocol::message::{ChargeFault, ChargePhase};

/// Milliseconds until the condition holds, step by step.
fn reaction_ms(dock: &mut Dock, limit_ms: u32, condition: impl Fn(&Dock) -> bool) -> u32 {
    for step in 0..=limit_ms / dock.step_ms {
        if condition(dock) {
            return step * dock.step_ms;
        }
        dock.step();
    }
    panic!("not within {limit_ms} ms: {:?}", dock.charger.status());
}

/// Worst time until the switch is off, over fifty phases of the averages and both ends of the clock, at one pass a
/// millisecond.
fn worst_ms(limit_ms: u32, cause: impl Fn(&mut Dock), fault: ChargeFault) -> u32 {
    let mut worst_ms = 0;
    for phase in 0..50_u32 {
        let mut dock = Dock::charging(if phase % 2 == 0 {
            u32::MAX - 40_500
        } else {
            phase * 77_777
        });
        dock.step_ms = 1;
        dock.run_s(f64::from(phase * 37) / 1_000.0);
        cause(&mut dock);
        worst_ms = worst_ms.max(reaction_ms(&mut dock, limit_ms, Dock::is_off));
        reaction_ms(&mut dock, 2_000, |dock| dock.fault() == Some(fault));
    }
    println!("{}: worst {worst_ms} ms, limit {limit_ms} ms", fault.name());
    worst_ms
}

#[test]
fn over_current_is_cut_within_100_ms() {
    // A sensor that shows too much: the fast cut of the duty changes nothing.
    let shows_too_much = |dock: &mut Dock| dock.shown_ma = Some(1_300);
    keep(
        limits::S18_OVER_CURRENT,
        worst_ms(100, shows_too_much, ChargeFault::OverCurrent),
    );
}

#[test]
fn old_readings_are_a_fault_after_200_ms() {
    keep(
        limits::S18_STALE,
        worst_ms(201, |dock| dock.age_ms = 1, ChargeFault::Stale),
    );
}

#[test]
fn a_hot_pack_gets_no_current_after_two_seconds() {
    let heat = |dock: &mut Dock| {
        // Fast, but no jump: from 40 degrees on.
        dock.warm_to(400);
        for tenths in (400..=560).step_by(40) {
            dock.temperature = Ok(tenths);
            if tenths < 560 {
                dock.run_s(1.0);
            }
        }
    };
    for phase in 0..20 {
        let mut dock = Dock::charging(phase * 313);
        dock.run_s(f64::from(phase) / 20.0);
        heat(&mut dock);
        reaction_ms(&mut dock, 2_000, Dock::is_off);
    }
}

#[test]
fn a_thermistor_that_breaks_cuts_the_current() {
    let open = |dock: &mut Dock| dock.temperature = Err(ThermistorFault::Open);
    keep(
        limits::S18_THERMISTOR,
        worst_ms(202, open, ChargeFault::ThermistorOpen),
    );
    let shorted = |dock: &mut Dock| dock.temperature = Err(ThermistorFault::Shorted);
    keep(
        limits::S18_THERMISTOR,
        worst_ms(202, shorted, ChargeFault::ThermistorShorted),
    );
    let jump = |dock: &mut Dock| dock.temperature = Ok(330);
    worst_ms(2_002, jump, ChargeFault::ThermistorJump);
    let mut dock = Dock::charging(0);
    dock.warm_to(-205);
    dock.run_s(2.0);
    assert_eq!(dock.fault(), Some(ChargeFault::ThermistorRange));
}

#[test]
fn a_thermistor_that_never_moves_is_found_in_three_quarters_of_an_hour() {
    let mut dock = Dock::charging(0);
    dock.dither = false;
    let took_s = dock.run_until(
        3_600,
        |dock, second| dock.pack_mv = 15_000 + (second / 9) as i32,
        |dock| dock.fault().is_some(),
    );
    assert_eq!(dock.fault(), Some(ChargeFault::ThermistorFrozen));
    assert!((2_690..=2_705).contains(&took_s), "{took_s} s");
}

#[test]
fn a_supply_above_30_volts_is_a_fault() {
    worst_ms(202, |dock| dock.input_mv = Some(30_500), ChargeFault::Adapter);
}

#[test]
fn a_jump_of_the_voltage_is_a_fault() {
    worst_ms(2_002, |dock| dock.pack_mv -= 1_300, ChargeFault::VoltageJump);
    let mut dock = Dock::charging(0);
    dock.pack_mv -= 900;
    dock.run_s(5.0);
    assert_eq!(dock.fault(), None, "less than a volt is none");
}

#[test]
fn a_shorted_switch_is_found_within_a_second_whatever_the_phase() {
    for pack_mv in [15_000, 16_500] {
        let mut dock = Dock::at(pack_mv, 0);
        dock.step_ms = 1;
        dock.run_s(0.9);
        dock.leak_ma = 1_400;
        let took_ms = reaction_ms(&mut dock, 1_101, |dock| {
            dock.fault() == Some(ChargeFault::Shorted)
        });
        keep(limits::S18_SHORTED, took_ms);
        assert!(took_ms >= 900, "{took_ms} ms");
    }
    // While it charges the switch is noticed when it is to open.
    let mut dock = Dock::charging(0);
    dock.leak_ma = 1_400;
    dock.run_s(3.0);
    assert_eq!(
        dock.fault(),
        Some(ChargeFault::Shorted),
        "through over-current to its real name"
    );
    assert!(!dock.charger.clear(), "the current still flows");
    dock.leak_ma = 0;
    dock.run_s(1.0);
    assert!(dock.charger.clear());
}

#[test]
fn no_battery_and_dying_batteries_are_told_apart() {
    for (pack_mv, fault) in [
        (2_000, ChargeFault::NoBattery),
        (9_000, ChargeFault::DeepDischarge),
    ] {
        let mut dock = Dock::at(pack_mv, 0);
        dock.run_s(4.0);
        assert_eq!(dock.fault(), Some(fault), "{pack_mv} mV");
        assert!(dock.is_off());
    }
    // A pack that is unplugged while it charges: the supply's voltage at the terminals.
    let mut dock = Dock::charging(0);
    dock.pack_mv = 24_000;
    dock.run_s(3.0);
    assert!(dock.is_off() && dock.fault().is_some());
    // Contacts without a pack: the voltage shoots up as soon as current is given.
    let mut dock = Dock::at(15_000, 0);
    dock.run_s(4.3);
    assert!(!dock.is_off());
    dock.pack_mv = 20_500;
    dock.run_s(2.0);
    assert_eq!(dock.fault(), Some(ChargeFault::NoBattery));
}

#[test]
fn a_deeply_discharged_pack_that_does_not_recover_is_given_up_after_an_hour() {
    let mut dock = Dock::at(11_000, 0);
    dock.run_s(10.0);
    let took_s = dock.run_until(4_000, |_, _| {}, |dock| dock.fault().is_some());
    assert_eq!(dock.fault(), Some(ChargeFault::Precharge));
    assert!((3_580..=3_610).contains(&took_s), "{took_s} s");
    let mut dock = Dock::at(11_000, 0);
    dock.run_s(30.0);
    dock.lift_to(9_000);
    dock.run_s(2.0);
    assert_eq!(dock.fault(), Some(ChargeFault::DeepDischarge));
}

#[test]
fn a_dock_that_gives_nothing_is_asked_three_times() {
    let mut dock = Dock::at(15_000, 0);
    dock.full_ma = 20;
    dock.run_s(30.0);
    assert_eq!((dock.phase(), dock.fault()), (ChargePhase::Idle, None));
    assert!(!dock.asks());
    dock.run_s(284.0);
    assert_eq!(dock.phase(), ChargePhase::Fast, "again after five minutes");
    dock.run_s(400.0);
    assert_eq!(dock.fault(), Some(ChargeFault::NoCurrent));
}

#[test]
fn a_sensor_that_shows_current_at_rest_is_not_believed() {
    let mut dock = Dock::at(15_000, 0);
    dock.shown_ma = Some(130);
    dock.run_s(30.0);
    assert_eq!(dock.fault(), Some(ChargeFault::CurrentOffset));
    // Off the dock the zero is learned.
    let mut dock = Dock::at(15_000, 0);
    dock.docked = false;
    dock.adapter = false;
    dock.shown_ma = Some(130);
    dock.run_s(10.0);
    (dock.docked, dock.adapter) = (true, true);
    dock.run_s(30.0);
    assert_eq!(dock.fault(), None);
    assert_eq!(dock.charger.pack().map(|(_, ma)| ma.abs() < 10), Some(true));
}

#[test]
fn contacts_that_come_and_go_are_a_fault_and_a_single_gap_is_none() {
    let mut dock = Dock::charging(0);
    for _ in 0..5 {
        dock.adapter = false;
        dock.run_s(0.1);
        dock.adapter = true;
        dock.run_s(120.0);
    }
    assert_eq!(dock.fault(), None);
    for _ in 0..12 {
        dock.adapter = false;
        dock.run_s(0.1);
        dock.adapter = true;
        dock.run_s(3.0);
    }
    assert_eq!(dock.fault(), Some(ChargeFault::Contact));
}

#[test]
fn a_fault_stays_until_it_is_cleared_with_its_cause_gone() {
    let mut dock = Dock::charging(0);
    dock.temperature = Err(ThermistorFault::Open);
    dock.run_s(2.0);
    assert!(!dock.charger.clear(), "the wire is still broken");
    dock.temperature = Ok(250);
    dock.run_s(3_600.0);
    assert_eq!(dock.phase(), ChargePhase::Fault, "nothing clears itself");
    assert!(dock.charger.clear());
    dock.run_s(30.0);
    assert_eq!(dock.phase(), ChargePhase::Fast);
}

#[test]
fn a_reset_between_the_faults_of_a_day_forgets_none() {
    let fail = |dock: &mut Dock| {
        dock.temperature = Err(ThermistorFault::Open);
        dock.run_s(2.0);
        assert!(dock.fault().is_some());
        dock.temperature = Ok(250);
        dock.run_s(60.0);
    };
    for before in 0..=3 {
        let mut dock = Dock::charging(0);
        for number in 0..3 {
            if number == before {
                dock.reset_well();
                dock.run_s(60.0);
            }
            fail(&mut dock);
            if number < 2 {
                assert!(dock.charger.clear());
                dock.run_s(60.0);
            }
        }
        if before == 3 {
            dock.reset_well();
            dock.run_s(60.0);
            assert!(dock.fault().is_some(), "the fault itself is kept");
        }
        assert!(!dock.charger.clear(), "reset before fault {before}");
        assert_eq!(dock.fault(), Some(ChargeFault::Repeated));
        dock.reset_well();
        dock.run_s(60.0);
        assert!(!dock.charger.clear());
        dock.step_ms = 50;
        dock.run_s(24.0 * 3_600.0);
        assert!(dock.charger.clear(), "a day is a day");
    }
}

#[test]
fn resets_do_not_lengthen_the_hour_of_a_pack_that_does_not_recover() {
    let mut dock = Dock::at(11_000, 0);
    let mut flowed_s = 0;
    dock.run_until(
        20_000,
        |dock, second| {
            flowed_s += u32::from(!dock.is_off());
            if second % 303 == 302 {
                dock.reset();
            }
        },
        |dock| dock.fault().is_some(),
    );
    assert_eq!(dock.fault(), Some(ChargeFault::Precharge));
    assert!(flowed_s <= 3_600, "{flowed_s} s of current");
}

#[test]
fn a_fault_whose_cause_shows_at_rest_is_not_cleared_while_it_does() {
    let mut dock = Dock::at(15_000, 0);
    dock.shown_ma = Some(130);
    dock.run_s(30.0);
    assert_eq!(dock.fault(), Some(ChargeFault::CurrentOffset));
    assert!(!dock.charger.clear(), "it still shows");
    dock.shown_ma = None;
    dock.run_s(1.0);
    assert!(dock.charger.clear());
}

#[test]
fn the_third_fault_within_a_day_must_wait_until_the_first_is_a_day_old() {
    let mut dock = Dock::charging(0);
    let fail = |dock: &mut Dock| {
        dock.temperature = Err(ThermistorFault::Open);
        dock.run_s(2.0);
        assert!(dock.fault().is_some());
        dock.temperature = Ok(250);
        dock.run_s(60.0);
    };
    for _ in 0..2 {
        fail(&mut dock);
        assert!(dock.charger.clear());
        dock.run_s(60.0);
        assert_eq!(dock.phase(), ChargePhase::Fast);
    }
    fail(&mut dock);
    assert!(!dock.charger.clear());
    assert_eq!(dock.fault(), Some(ChargeFault::Repeated));
    dock.step_ms = 50;
    dock.run_s(23.0 * 3_600.0);
    assert!(!dock.charger.clear());
    dock.run_s(3_600.0);
    assert!(dock.charger.clear());
}
