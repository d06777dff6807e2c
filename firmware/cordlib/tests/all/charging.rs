//! The charger against its table: how a charge begins, what its current is, and which stop ends it when.

use crate::dock::Dock;
use cordlib::PackParameters;
use cordlib::board::ChargeDrive;
use cordlib::charge::{ChargeController, MotorActivity};
use rvac_protocol::message::{ChargeEnd, ChargePhase};

const MINUTE_S: u32 = 60;
const HOUR_S: u32 = 3_600;
/// A voltage that rises all the time, so that no plateau is seen, and never falls: 0.4 V an hour.
fn rising(dock: &mut Dock, second: u32) {
    dock.pack_mv = 15_000 + (second / 9) as i32;
}

#[test]
fn a_charge_begins_after_a_second_on_the_dock_and_asks_for_current_first() {
    let mut dock = Dock::at(15_000, u32::MAX - 2_000);
    dock.docked = false;
    dock.adapter = false;
    dock.run_s(5.0);
    assert!(dock.is_off() && !dock.asks());
    (dock.docked, dock.adapter) = (true, true);
    dock.run_s(0.9);
    assert!(!dock.asks());
    dock.run_s(1.2);
    assert!(dock.asks() && dock.is_off(), "the dock must hear first");
    dock.run_s(2.5);
    assert!(!dock.is_off());
    assert_eq!(dock.phase(), ChargePhase::Fast);
}

#[test]
fn a_full_enough_pack_is_not_charged_unless_somebody_wants_it() {
    let mut dock = Dock::at(15_650, 0);
    dock.run_s(60.0);
    assert_eq!(dock.phase(), ChargePhase::Idle);
    dock.charger.want(true);
    dock.run_s(3.0);
    assert_eq!(dock.phase(), ChargePhase::Fast);
    dock.charger.want(false);
    dock.run_s(0.1);
    assert!(dock.is_off());
    assert_eq!(dock.end(), Some(ChargeEnd::Stopped));
    dock.pack_mv = 14_000;
    dock.run_s(f64::from(HOUR_S));
    assert_eq!(dock.phase(), ChargePhase::Idle, "until it docks anew");
    dock.docked = false;
    dock.run_s(1.0);
    dock.docked = true;
    dock.run_s(4.0);
    assert_eq!(dock.phase(), ChargePhase::Fast);
}

#[test]
fn the_current_rises_slowly_to_its_limit_and_stays_below_one_ampere() {
    for full_ma in [1_050, 1_500, 3_000] {
        let mut dock = Dock::at(15_000, 0);
        dock.full_ma = full_ma;
        let (mut before_ma, mut most_ma, mut steepest) = (0, 0, 0);
        for _ in 0..120 {
            dock.run_s(0.5);
            steepest = steepest.max(dock.current_ma() - before_ma);
            before_ma = dock.current_ma();
            most_ma = most_ma.max(before_ma);
        }
        assert!(
            (900..=1_000).contains(&dock.current_ma()),
            "{full_ma}: {}",
            dock.current_ma()
        );
        assert!(
            most_ma <= 1_000 && steepest <= 110,
            "{full_ma}: {most_ma} mA, {steepest} mA in 0.5 s"
        );
    }
}

#[test]
fn the_duty_always_leaves_a_twentieth_of_the_envelope_quiet() {
    let mut dock = Dock::at(15_000, 0);
    dock.full_ma = 400;
    dock.run_s(120.0);
    let ChargeDrive::Duty(duty) = dock.output.drive else {
        panic!("a weak supply is used");
    };
    assert!((900_000..=950_000).contains(&duty.millionths()), "{duty:?}");
}

#[test]
fn a_supply_that_jumps_is_cut_before_it_is_a_fault() {
    let mut dock = Dock::charging(0);
    for full_ma in [2_400, 1_300, 2_900, 1_500] {
        dock.full_ma = full_ma;
        dock.run_s(0.08);
        assert!(dock.current_ma() < 1_250, "{full_ma}: {}", dock.current_ma());
        dock.run_s(60.0);
        assert_eq!(dock.fault(), None);
        assert!(
            (800..=1_000).contains(&dock.current_ma()),
            "{full_ma}: {}",
            dock.current_ma()
        );
    }
}

#[test]
fn a_deeply_discharged_pack_is_woken_with_a_tenth() {
    let mut dock = Dock::at(11_000, 0);
    dock.run_s(60.0);
    assert_eq!(dock.phase(), ChargePhase::Precharge);
    assert!((150..=230).contains(&dock.current_ma()), "{}", dock.current_ma());
    dock.lift_to(12_100);
    dock.run_s(2.0);
    assert_eq!(dock.phase(), ChargePhase::Fast);
    dock.run_s(30.0);
    assert!(dock.current_ma() > 900);
}

#[test]
fn the_window_of_temperatures_holds_a_charge_back_and_slows_it() {
    let mut dock = Dock::at(15_000, 0);
    dock.temperature = Ok(420);
    dock.run_s(600.0);
    assert_eq!(dock.phase(), ChargePhase::Idle, "too warm, and no fault");
    dock.docked = false;
    dock.warm_to(-30);
    dock.docked = true;
    dock.run_s(600.0);
    assert_eq!(dock.phase(), ChargePhase::Idle, "too cold");
    dock.warm_to(20);
    dock.run_s(60.0);
    assert!(
        (80..=130).contains(&dock.current_ma()),
        "cool: {}",
        dock.current_ma()
    );
    dock.warm_to(80);
    dock.run_s(60.0);
    assert!(dock.current_ma() > 900);
    dock.warm_to(-20);
    dock.run_s(3.0);
    assert!(dock.is_off(), "it waits for warmth");
    assert_eq!((dock.phase(), dock.fault()), (ChargePhase::Fast, None));
}

#[test]
fn a_fast_rise_of_temperature_ends_it_and_the_rest_is_topped_off() {
    let mut dock = Dock::charging(u32::MAX - 300_000);
    dock.run_until(20 * MINUTE_S, rising, |dock| dock.pack_mv >= 15_130);
    assert_eq!(dock.end(), None);
    let from_mv = dock.pack_mv;
    let took_s = dock.run_until(
        10 * MINUTE_S,
        |dock, second| {
            dock.pack_mv = from_mv + (second / 9) as i32;
            dock.temperature = Ok(250 + (second / 6) as i16);
        },
        |dock| dock.end().is_some(),
    );
    assert_eq!(
        (dock.end(), dock.phase()),
        (Some(ChargeEnd::TemperatureSlope), ChargePhase::TopOff)
    );
    assert!(
        (120..=220).contains(&took_s),
        "one degree a minute is seen within the window: {took_s} s"
    );
    let took_s = dock.run_until(HOUR_S, |_, _| {}, |dock| dock.phase() == ChargePhase::Maintain);
    assert!(
        (1_795..=1_810).contains(&took_s),
        "half an hour of topping off: {took_s} s"
    );
}

#[test]
fn a_slow_rise_of_temperature_does_not_end_it() {
    let mut dock = Dock::charging(0);
    dock.run_until(
        18 * MINUTE_S,
        |dock, second| {
            rising(dock, second);
            // 0.6 degrees a minute.
            dock.temperature = Ok(250 + (second / 10) as i16);
        },
        |dock| dock.temperature.is_ok_and(|tenths| tenths >= 355),
    );
    assert_eq!(dock.end(), None);
}

#[test]
fn the_first_minutes_of_warming_mean_nothing() {
    let mut dock = Dock::charging(0);
    dock.run_until(
        140,
        |dock, second| {
            rising(dock, second);
            dock.temperature = Ok(250 + (second / 4) as i16);
        },
        |dock| dock.temperature.is_ok_and(|tenths| tenths >= 284),
    );
    assert_eq!(
        dock.end(),
        None,
        "1.5 degrees a minute for two minutes, at the beginning"
    );
}

#[test]
fn a_fall_of_the_voltage_ends_it_when_it_lasts_and_not_in_the_first_ten_minutes() {
    let fall = |dock: &mut Dock, second: u32, from_s: u32| {
        rising(dock, second);
        if second >= from_s {
            dock.pack_mv = 15_000 + (from_s / 9) as i32 - 100;
        }
    };
    let mut dock = Dock::charging(0);
    // It falls after five minutes and stays low: the peak of before the ten minutes means nothing.
    dock.run_until(
        20 * MINUTE_S,
        |dock, second| fall(dock, second, 300),
        |dock| dock.seconds() >= 1_000,
    );
    assert_eq!(dock.end(), None);
    let mut dock = Dock::charging(0);
    let took_s = dock.run_until(
        20 * MINUTE_S,
        |dock, second| fall(dock, second, 900),
        |dock| dock.end().is_some(),
    );
    assert_eq!(
        (dock.end(), dock.phase()),
        (Some(ChargeEnd::NegativeDeltaV), ChargePhase::TopOff)
    );
    assert!((960..=1_080).contains(&took_s), "{took_s} s");
}

#[test]
fn a_dip_of_the_voltage_does_not_end_it() {
    let mut dock = Dock::charging(0);
    dock.run_until(
        30 * MINUTE_S,
        |dock, second| {
            rising(dock, second);
            if (900..930).contains(&(second % 1_000)) {
                dock.pack_mv -= 300;
            }
        },
        |dock| dock.seconds() >= 1_700,
    );
    assert_eq!(dock.end(), None);
}

#[test]
fn a_fall_of_the_voltage_with_the_current_is_no_sign() {
    let mut dock = Dock::charging(0);
    dock.run_until(
        40 * MINUTE_S,
        |dock, second| {
            rising(dock, second);
            if second >= 1_200 {
                // The supply weakens: less current over the pack's resistance.
                dock.full_ma = 700;
                dock.pack_mv -= 100;
            }
        },
        |dock| dock.seconds() >= 1_500,
    );
    assert_eq!(dock.end(), None);
}

#[test]
fn a_voltage_that_stands_ends_it_after_ninety_minutes() {
    let mut dock = Dock::charging(0);
    let took_s = dock.run_until(2 * HOUR_S, |_, _| {}, |dock| dock.end().is_some());
    assert_eq!(
        (dock.end(), dock.phase()),
        (Some(ChargeEnd::ZeroDeltaV), ChargePhase::Maintain)
    );
    assert!((5_330..=5_400).contains(&took_s), "{took_s} s");
}

#[test]
fn a_slow_rise_by_fifteen_degrees_ends_it() {
    let mut dock = Dock::charging(0);
    dock.run_until(
        HOUR_S,
        |dock, second| {
            rising(dock, second);
            dock.temperature = Ok(250 + (second / 12) as i16);
        },
        |dock| dock.end().is_some(),
    );
    assert_eq!(
        (dock.end(), dock.temperature),
        (Some(ChargeEnd::TemperatureRise), Ok(400))
    );
}

#[test]
fn fifty_degrees_end_it_and_the_pack_rests() {
    let mut dock = Dock::at(15_000, 0);
    dock.temperature = Ok(385);
    dock.run_s(40.0);
    dock.run_until(
        HOUR_S,
        |dock, second| {
            rising(dock, second);
            dock.temperature = Ok(385 + (second / 12) as i16);
        },
        |dock| dock.end().is_some(),
    );
    assert_eq!(
        (dock.end(), dock.phase()),
        (Some(ChargeEnd::Hot), ChargePhase::Idle)
    );
    dock.temperature = Ok(350);
    dock.run_s(1_500.0);
    assert_eq!(dock.phase(), ChargePhase::Idle, "not before half an hour");
    dock.run_s(600.0);
    assert_eq!(dock.phase(), ChargePhase::Fast);
}

#[test]
fn a_voltage_that_no_sound_pack_has_ends_it() {
    let mut dock = Dock::charging(0);
    let mut mv = 15_000;
    dock.run_until(
        600,
        |dock, _| {
            mv += 50;
            dock.pack_mv = mv;
        },
        |dock| dock.end().is_some(),
    );
    assert_eq!(dock.end(), Some(ChargeEnd::Voltage));
    assert!((20_390..=20_500).contains(&dock.pack_mv), "{}", dock.pack_mv);
}

#[test]
fn more_charge_than_the_pack_holds_ends_it() {
    let mut dock = Dock::charging(0);
    let took_s = dock.run_until(3 * HOUR_S, rising, |dock| dock.end().is_some());
    assert_eq!(dock.end(), Some(ChargeEnd::Charge));
    // 2.6 Ah at 0.95 A.
    assert!((9_700..=9_950).contains(&took_s), "{took_s} s");
}

#[test]
fn three_and_a_half_hours_end_it_also_across_the_wrap_of_the_clock() {
    for start in [0, u32::MAX - 5_000_000] {
        let mut dock = Dock::at(15_000, start);
        dock.full_ma = 600;
        dock.run_s(40.0);
        let took_s = dock.run_until(4 * HOUR_S, rising, |dock| dock.end().is_some());
        assert_eq!(
            (dock.end(), dock.phase()),
            (Some(ChargeEnd::Time), ChargePhase::Idle)
        );
        assert!((12_540..=12_600).contains(&took_s), "{took_s} s");
    }
}

/// Resets at moments that suit none of the firmware's periods.
#[test]
fn no_number_of_resets_makes_a_charge_longer() {
    for every_s in [47, 301, 12_000] {
        let mut dock = Dock::at(14_700, 0);
        dock.full_ma = 600;
        dock.run_s(40.0);
        let (mut flowed_s, mut resets) = (0, 0);
        dock.run_until(
            20 * HOUR_S,
            |dock, second| {
                dock.pack_mv = 14_700 + (second / 60) as i32;
                if second % every_s == every_s - 1 {
                    dock.reset();
                    resets += 1;
                }
                flowed_s += u32::from(!dock.is_off());
            },
            |dock| matches!(dock.end(), Some(ChargeEnd::Time | ChargeEnd::Charge)),
        );
        assert!(resets > 0 && flowed_s <= 12_600, "{flowed_s} s, {resets} resets");
        assert!(flowed_s > 12_500 || every_s < 1_000, "{flowed_s} s of current");
    }
}

#[test]
fn a_reset_near_the_longest_time_ends_the_charge_where_it_would_have_ended() {
    let mut dock = Dock::at(14_700, 0);
    dock.full_ma = 600;
    dock.run_s(40.0);
    dock.run_until(
        12_500,
        |dock, second| dock.pack_mv = 14_700 + (second / 60) as i32,
        |dock| dock.seconds() >= 12_500,
    );
    assert_eq!(dock.end(), None);
    dock.reset();
    let mut flowed_s = 0;
    dock.run_until(
        1_000,
        |dock, _| flowed_s += u32::from(!dock.is_off()),
        |dock| dock.end() == Some(ChargeEnd::Time),
    );
    assert!(flowed_s <= 200, "{flowed_s} s more");
}

#[test]
fn a_reset_does_not_end_the_rest_after_a_charge() {
    let mut dock = Dock::charging(0);
    dock.charger.want(false);
    dock.run_s(5.0);
    dock.reset_well();
    dock.run_s(600.0);
    assert!(dock.is_off() && !dock.asks(), "the host wanted none");
    dock.charger.want(true);
    dock.run_s(20.0);
    assert!(!dock.is_off());
}

#[test]
fn interruptions_do_not_set_back_what_was_counted() {
    let mut dock = Dock::at(15_000, 0);
    dock.full_ma = 600;
    dock.run_s(40.0);
    let mut interrupted_s = 0;
    let took_s = dock.run_until(
        6 * HOUR_S,
        |dock, second| {
            dock.pack_mv = 15_000 + (second / 40) as i32;
            // Twenty minutes away from the dock once in two hours.
            let away = second % 7_200 >= 6_000;
            interrupted_s += u32::from(away);
            (dock.docked, dock.adapter) = (!away, !away);
        },
        |dock| dock.end() == Some(ChargeEnd::Time),
    );
    let flowed_s = took_s - interrupted_s;
    assert!((12_500..=12_650).contains(&flowed_s), "{flowed_s} s of current");
}

#[test]
fn current_stops_in_the_same_pass_when_the_supply_goes_or_a_motor_runs() {
    let mut dock = Dock::charging(0);
    dock.adapter = false;
    dock.step();
    assert!(dock.is_off());
    dock.adapter = true;
    dock.run_s(0.9);
    assert!(dock.is_off(), "the contacts must hold for a second");
    dock.run_s(30.0);
    assert!(dock.current_ma() > 900);
    dock.motors = MotorActivity::Running;
    dock.step();
    assert!(dock.is_off());
    dock.motors = MotorActivity::Idle;
    dock.run_s(1.0);
    dock.docked = false;
    dock.step();
    assert!(dock.is_off() && !dock.asks());
    assert_eq!(dock.end(), Some(ChargeEnd::Undocked));
}

#[test]
fn a_charger_after_a_reset_checks_everything_anew() {
    let dock = Dock::charging(0);
    let mut again = Dock::at(dock.pack_mv, 77);
    again.temperature = Ok(450);
    again.run_s(60.0);
    assert!(
        again.is_off(),
        "a warm pack is not charged on because it was before"
    );
    again.warm_to(410);
    assert!(again.is_off());
    again.warm_to(300);
    again.run_s(10.0);
    assert!(!again.is_off());
}

#[test]
fn a_full_pack_gets_pulses_that_make_up_for_the_drain_for_twenty_hours_a_week() {
    let mut dock = Dock::charging(u32::MAX - 9_000_000);
    dock.run_until(
        2 * HOUR_S,
        |_, _| {},
        |dock| dock.phase() == ChargePhase::Maintain,
    );
    dock.pack_mv = 16_500;
    assert_eq!(mean_over(&mut dock, 1_800), 0.0, "it cools down first");
    let pulsed_ma = mean_over(&mut dock, 2 * HOUR_S);
    assert!((10.0..22.0).contains(&pulsed_ma), "{pulsed_ma} mA");
    mean_over(&mut dock, 19 * HOUR_S);
    assert_eq!(mean_over(&mut dock, 5 * HOUR_S), 0.0, "enough for this week");
}

/// Mean current over some seconds.
fn mean_over(dock: &mut Dock, seconds: u32) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..u64::from(seconds) * 1_000 / u64::from(dock.step_ms) {
        dock.step();
        sum += f64::from(dock.current_ma());
        count += 1.0;
    }
    sum / count
}

#[test]
fn a_pack_that_lost_its_charge_on_the_dock_is_charged_again() {
    let mut dock = Dock::charging(0);
    dock.run_until(
        2 * HOUR_S,
        |_, _| {},
        |dock| dock.phase() == ChargePhase::Maintain,
    );
    assert!(dock.charger.is_full());
    dock.pack_mv = 15_500;
    mean_over(&mut dock, HOUR_S);
    assert_eq!(
        dock.phase(),
        ChargePhase::Maintain,
        "not so soon after the last one"
    );
    let took_s = dock.run_until(3 * HOUR_S, |_, _| {}, |dock| dock.phase() == ChargePhase::Fast);
    assert!(took_s < 2 * HOUR_S, "{took_s} s");
}

#[test]
fn a_pack_that_is_always_full_at_once_is_left_alone_longer_each_time() {
    let mut dock = Dock::charging(0);
    dock.run_until(
        2 * HOUR_S,
        |_, _| {},
        |dock| dock.phase() == ChargePhase::Maintain,
    );
    dock.step_ms = 40;
    // A dead cell: the voltage never reaches what a full pack has.
    dock.pack_mv = 15_400;
    let mut waits_s = Vec::new();
    for _ in 0..3 {
        let wait_s = dock.run_until(20 * HOUR_S, |_, _| {}, |dock| dock.phase() == ChargePhase::Fast);
        waits_s.push(wait_s);
        let from = dock.seconds();
        dock.run_until(
            HOUR_S,
            |dock, _| dock.temperature = Ok(250 + ((dock.seconds() - from) / 6) as i16),
            |dock| dock.phase() == ChargePhase::Maintain || dock.phase() == ChargePhase::TopOff,
        );
        dock.temperature = Ok(250);
        dock.run_until(HOUR_S, |_, _| {}, |dock| dock.phase() == ChargePhase::Maintain);
    }
    assert!(
        waits_s[1] > waits_s[0] + HOUR_S && waits_s[2] > waits_s[1] + 3 * HOUR_S,
        "{waits_s:?}"
    );
}

#[test]
fn fifty_days_on_the_dock_do_not_blind_it() {
    let mut dock = Dock::at(16_500, u32::MAX - 40_000_000);
    dock.step_ms = 1_000;
    dock.run_s(50.0 * 86_400.0);
    assert_eq!(dock.phase(), ChargePhase::Idle);
    dock.step_ms = 20;
    dock.pack_mv = 15_000;
    dock.run_s(40.0);
    assert_eq!(dock.phase(), ChargePhase::Fast);
    let took_s = dock.run_until(2 * HOUR_S, |_, _| {}, |dock| dock.end().is_some());
    assert_eq!(dock.end(), Some(ChargeEnd::ZeroDeltaV));
    assert!((5_330..=5_400).contains(&took_s), "{took_s} s");
}

#[test]
fn a_doubtful_thermistor_counts_as_cold_in_the_cold_and_as_hot_in_the_heat() {
    let charges = |tenths: i16, doubt: i16| {
        let mut dock = Dock::at(15_000, 0);
        dock.temperature = Ok(tenths);
        dock.doubt = doubt;
        dock.run_s(60.0);
        dock.current_ma()
    };
    // 8 degrees, known to 2, gets the full current; known to 5 a tenth; known to 10 none.
    assert!(charges(80, 20) > 900);
    assert!((80..=130).contains(&charges(80, 50)), "{}", charges(80, 50));
    assert_eq!(charges(80, 100), 0);
    assert!(charges(350, 20) > 900);
    assert_eq!(charges(350, 60), 0, "it may be 41 degrees");
}

#[test]
fn full_current_ends_at_five_degrees_and_all_current_at_zero() {
    let mut dock = Dock::charging(0);
    dock.warm_to(55);
    dock.run_s(20.0);
    assert!(dock.current_ma() > 900, "{}", dock.current_ma());
    dock.warm_to(48);
    dock.run_s(20.0);
    assert!((80..=130).contains(&dock.current_ma()), "{}", dock.current_ma());
    dock.warm_to(-2);
    dock.run_s(3.0);
    assert_eq!(dock.current_ma(), 0);
    // It comes back a degree above the limit, not at it.
    dock.warm_to(5);
    dock.run_s(20.0);
    assert_eq!(dock.current_ma(), 0);
    dock.warm_to(12);
    dock.run_s(20.0);
    assert!((80..=130).contains(&dock.current_ma()), "{}", dock.current_ma());
}

#[test]
fn a_temperature_that_is_not_known_to_three_degrees_is_not_told() {
    let mut dock = Dock::at(15_000, 0);
    dock.dither = false;
    dock.run_s(2.0);
    assert_eq!(dock.charger.temperature_cc(), Some(2_500));
    dock.doubt = 30;
    dock.run_s(2.0);
    assert_eq!(dock.charger.temperature_cc(), Some(2_500));
    dock.doubt = 31;
    dock.run_s(2.0);
    assert_eq!(dock.charger.temperature_cc(), None);
}

#[test]
fn the_current_of_another_charger_is_no_fault_and_is_told_as_charging() {
    let mut dock = Dock::at(15_000, 0);
    dock.charger = ChargeController::observing(PackParameters::NIMH_12);
    dock.leak_ma = 800;
    dock.run_s(600.0);
    assert_eq!(dock.charger.status().fault, None);
    assert!(dock.is_off() && dock.charger.charges());
    assert_eq!(
        dock.charger.pack().map(|(_, current_ma)| current_ma / 50),
        Some(16)
    );
    dock.leak_ma = 0;
    dock.run_s(2.0);
    assert!(!dock.charger.charges());
    // Its readings may be a second old, and no older than two.
    dock.age_ms = 1_000;
    dock.step();
    assert!(dock.charger.pack().is_some());
    dock.run_s(1.5);
    assert_eq!(dock.charger.pack(), None);
}
