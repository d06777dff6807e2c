//! What is broken in the machine, what motors draw, and how fast they turn.

use super::{BACKWARD, Drives, FORWARD, OFF, Pins, Rule, Scene};
use crate::{Charging, WheelLoad};
use rvac_protocol::message::ResetCause;

/// What happens to the pins.
type Change = fn(&mut Pins);

#[test]
fn a_broken_machine_switches_everything_off_in_its_time() {
    let table: [(Change, u32, Rule); 3] = [
        (|pins| pins.hardware.clock_fails = true, 12, Rule::Clock),
        (|pins| pins.hardware.pulses_damaged = true, 22, Rule::Pulses),
        (|pins| pins.hardware.image_damaged = true, 60_002, Rule::Memory),
    ];
    for (breaks, allowed_ms, rule) in table {
        let mut scene = Scene::armed();
        scene.pass_driven(200, FORWARD);
        breaks(&mut scene.pins);
        assert_eq!(scene.pass_driven(allowed_ms, FORWARD), [], "{rule:?}");
        assert_eq!(scene.pass_driven(1, FORWARD), [rule]);
    }
}

#[test]
fn a_broken_machine_charges_nothing_and_may_rest() {
    let mut scene = Scene::armed();
    scene.pins.hardware.clock_fails = true;
    assert_eq!(scene.pass(1_000, OFF), []);
    scene.pins.charging = Charging {
        driven: true,
        supplied: true,
        temperature_dc: 250,
        ..Charging::default()
    };
    assert_eq!(scene.pass(13, OFF), [Rule::Clock]);
}

#[test]
fn no_reset_mends_an_image() {
    let mut scene = Scene::armed();
    scene.pins.hardware.image_damaged = true;
    scene.pass(60_100, OFF);
    scene.monitor.reset(scene.now_ms, ResetCause::Watchdog);
    assert!(scene.pass(1, FORWARD).contains(&Rule::Memory));
}

fn drawing(current_ma: i32) -> Scene {
    let mut scene = Scene::armed();
    scene.pins.loads = Some([
        WheelLoad::default(),
        WheelLoad {
            current_ma,
            held_ma: 2_500,
        },
    ]);
    scene
}

#[test]
fn a_wheel_draws_no_more_than_any_limit_and_not_for_long_what_a_held_one_draws() {
    assert_eq!(drawing(1_990).pass_driven(5_000, FORWARD), []);
    let mut scene = drawing(2_010);
    assert_eq!(scene.pass_driven(162, FORWARD), []);
    assert_eq!(scene.pass_driven(1, FORWARD), [Rule::Current]);
    let mut scene = drawing(1_000);
    if let Some([left, _]) = &mut scene.pins.loads {
        *left = WheelLoad {
            current_ma: 1_190,
            held_ma: 1_200,
        };
    }
    assert_eq!(scene.pass_driven(2_102, FORWARD), []);
    assert_eq!(scene.pass_driven(1, FORWARD), [Rule::Current]);
    assert_eq!(drawing(2_500).pass(5_000, OFF), [], "it is off");
}

/// A robot whose rims turn at this speed while its host asks for 0.2 m/s.
fn turning(rim_mm_per_s: i32) -> Scene {
    let mut scene = Scene::armed();
    scene.pass_driven(1_000, FORWARD);
    scene.pins.rims_mm_per_s = [200, rim_mm_per_s];
    scene
}

#[test]
fn a_driven_wheel_is_not_much_faster_than_what_was_asked() {
    assert_eq!(turning(420).pass_driven(3_000, FORWARD), []);
    for rim_mm_per_s in [421, -421] {
        let mut scene = turning(rim_mm_per_s);
        assert_eq!(scene.pass_driven(352, FORWARD), []);
        assert_eq!(scene.pass_driven(1, FORWARD), [Rule::TooFast]);
    }
    assert!(
        !turning(800).pass(1_000, OFF).contains(&Rule::TooFast),
        "somebody pushes it"
    );
}

#[test]
fn what_was_asked_of_late_and_what_has_no_speed_counts() {
    let mut scene = Scene::armed();
    scene.number += 1;
    let fast = format!(
        r#"{{"c":"drive","v":-0.5,"w":0,"ttl":250,"n":{},"t":{}}}"#,
        scene.number, scene.now_ms
    );
    scene.host(&fast);
    scene.pins.rims_mm_per_s = [-700; 2];
    assert_eq!(scene.pass_driven(1_000, BACKWARD), [], "it slows down");
    assert!(scene.pass_driven(3_000, BACKWARD).contains(&Rule::TooFast));

    let mut scene = Scene::armed();
    scene.host(r#"{"c":"motor","motor":"wheel left","throttle":0.5,"ttl":1000,"n":9,"t":100}"#);
    scene.pins.rims_mm_per_s = [700, 0];
    let left = Drives {
        wheels: [400_000, 0],
        ..OFF
    };
    assert_eq!(scene.pass(900, left), []);
}
