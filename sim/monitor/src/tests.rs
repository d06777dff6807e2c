//! Each rule is shown to hold its peace before its reaction time and to speak after it.

use rvac_protocol::message::ResetCause;

use super::wire::{WireDirection, packet_crc};
use super::{Charging, Drives, Monitor, Pins, Rule};

const SESSION: u16 = 0x1234;
const FORWARD: Drives = Drives {
    wheels: [400_000, 400_000],
    cleaners: [0; 3],
};
const BACKWARD: Drives = Drives {
    wheels: [-200_000, -200_000],
    cleaners: [0; 3],
};
const OFF: Drives = Drives {
    wheels: [0; 2],
    cleaners: [0; 3],
};

mod broken;
mod told;

/// A monitor, its clock, and a host and a robot that speak perfectly.
struct Scene {
    monitor: Monitor,
    now_ms: u64,
    number: u16,
    pins: Pins,
    /// The newest start of the robot.
    reset_ms: u64,
}

impl Scene {
    /// A robot that was armed a moment ago.
    fn armed() -> Self {
        let mut scene = Self {
            monitor: Monitor::new(),
            now_ms: 100,
            number: 0,
            pins: Pins::default(),
            reset_ms: 0,
        };
        scene.open_session(SESSION);
        scene.arm(false);
        scene
    }

    fn open_session(&mut self, session: u16) {
        self.robot(&format!(r#"{{"c":"hello","session":{session}}}"#));
    }

    fn robot(&mut self, json: &str) {
        for byte in json.bytes().chain([0x1F]) {
            self.monitor.said(self.now_ms, byte);
        }
    }

    fn host(&mut self, json: &str) {
        let crc = packet_crc(json.as_bytes(), WireDirection::ToRobot, SESSION);
        for byte in format!("{json}*{crc:08X}\u{1F}").bytes() {
            self.monitor.heard(self.now_ms, Some(byte));
        }
    }

    /// A packet without a CRC.
    fn typed(&mut self, json: &str) {
        for byte in json.bytes().chain([0x1F]) {
            self.monitor.heard(self.now_ms, Some(byte));
        }
    }

    fn arm(&mut self, undock: bool) {
        self.number += 1;
        self.host(&format!(r#"{{"c":"arm","n":{},"undock":{undock}}}"#, self.number));
    }

    fn drive(&mut self) {
        self.number += 1;
        let json = format!(
            r#"{{"c":"drive","v":0.2,"w":0,"ttl":250,"n":{},"t":{}}}"#,
            self.number, self.now_ms
        );
        self.host(&json);
    }

    /// Lets `ms` pass with the wheels turning as driven and gives the rules that were broken so far.
    fn pass(&mut self, ms: u32, drives: Drives) -> Vec<Rule> {
        for _ in 0..ms {
            self.now_ms += 1;
            self.pins.counts[0] += drives.wheels[0].signum();
            self.pins.counts[1] += drives.wheels[1].signum();
            self.monitor.judge(self.now_ms, &self.pins, &drives);
        }
        self.monitor
            .violations()
            .iter()
            .map(|violation| violation.rule)
            .collect()
    }

    /// As [`Self::pass`], under a lease that never ends.
    fn pass_driven(&mut self, ms: u32, drives: Drives) -> Vec<Rule> {
        for _ in 0..ms / 10 {
            self.drive();
            self.pass(10, drives);
        }
        self.drive();
        self.pass(ms % 10, drives)
    }
}

#[test]
fn a_lease_covers_its_time_and_the_reaction_time() {
    let mut scene = Scene::armed();
    scene.drive();
    assert_eq!(scene.pass(300, FORWARD), []);
    assert_eq!(scene.pass(1, FORWARD), [Rule::WheelsWithoutLease]);
    assert_eq!(
        scene.pass(1000, FORWARD),
        [Rule::WheelsWithoutLease],
        "one breach is one violation"
    );
}

#[test]
fn the_lease_of_a_brush_covers_no_other() {
    let cleaning = Drives {
        cleaners: [500_000, 0, 0],
        ..OFF
    };
    let mut scene = Scene::armed();
    scene.host(r#"{"c":"motor","motor":"brush main","throttle":0.5,"ttl":250,"n":9,"t":100}"#);
    assert_eq!(scene.pass(300, cleaning), []);
    assert_eq!(scene.pass(1, cleaning), [Rule::CleanersWithoutLease]);
    let suction = Drives {
        cleaners: [500_000, 0, 1],
        ..OFF
    };
    let mut scene = Scene::armed();
    scene.host(r#"{"c":"motor","motor":"brush main","throttle":0.5,"ttl":250,"n":9,"t":100}"#);
    assert_eq!(scene.pass(1, suction), [Rule::CleanersWithoutLease]);
}

#[test]
fn the_lease_of_a_wheel_does_not_cover_the_other() {
    let left = Drives {
        wheels: [400_000, 0],
        ..OFF
    };
    let mut scene = Scene::armed();
    scene.host(r#"{"c":"motor","motor":"wheel left","throttle":0.5,"ttl":250,"n":9,"t":100}"#);
    assert_eq!(scene.pass(300, left), []);
    let mut scene = Scene::armed();
    scene.host(r#"{"c":"motor","motor":"wheel left","throttle":0.5,"ttl":250,"n":9,"t":100}"#);
    assert_eq!(scene.pass(1, FORWARD), [Rule::WheelsWithoutLease]);
}

#[test]
fn nothing_runs_before_arm_after_stop_or_after_a_reset() {
    let mut scene = Scene::armed();
    scene.monitor.reset(scene.now_ms, ResetCause::Watchdog);
    assert_eq!(scene.pass(1, FORWARD), [Rule::WheelsWithoutLease, Rule::NotArmed]);

    let mut scene = Scene::armed();
    scene.host(r#"{"c":"stop"}"#);
    assert_eq!(scene.pass_driven(20, FORWARD), []);
    assert_eq!(scene.pass_driven(1, FORWARD), [Rule::NotArmed]);

    let mut scene = Scene::armed();
    for byte in b"{\"c\":\"stop\"}\x1f" {
        scene.monitor.heard(scene.now_ms, Some(*byte));
    }
    assert_eq!(
        scene.pass_driven(21, FORWARD),
        [Rule::NotArmed],
        "a stop without CRC counts in any mode"
    );
}

#[test]
fn a_repeated_or_refused_arm_is_no_arm() {
    let mut scene = Scene::armed();
    scene.host(r#"{"c":"stop"}"#);
    scene.host(r#"{"c":"arm","n":1,"undock":false}"#);
    assert_eq!(scene.pass_driven(21, FORWARD), [Rule::NotArmed]);

    let mut scene = Scene::armed();
    scene.host(r#"{"c":"stop"}"#);
    scene.arm(false);
    scene.robot(&format!(r#"{{"a":{},"err":"inhibited"}}"#, scene.number));
    assert_eq!(scene.pass_driven(21, FORWARD), [Rule::NotArmed]);
}

/// A run of 25 minutes: the robot refused to drive against what its bumper touched, in a packet with the number of the `arm`.
#[test]
fn a_refusal_with_the_number_of_an_arm_of_long_ago_is_of_another_packet() {
    let mut scene = Scene::armed();
    assert_eq!(scene.pass_driven(2_000, FORWARD), []);
    scene.robot(r#"{"a":1,"err":"inhibited"}"#);
    assert_eq!(scene.pass_driven(30, FORWARD), []);
}

#[test]
fn what_is_old_stale_or_has_a_wrong_crc_covers_nothing() {
    for json in [
        r#"{"c":"drive","v":0.2,"w":0,"ttl":250,"n":0,"t":100}"#,
        r#"{"c":"drive","v":0.2,"w":0,"ttl":250,"n":5,"t":9000}"#,
    ] {
        let mut scene = Scene::armed();
        scene.drive();
        scene.pass(400, OFF);
        scene.host(json);
        assert_eq!(scene.pass(1, FORWARD), [Rule::WheelsWithoutLease], "{json}");
    }
    let mut scene = Scene::armed();
    for byte in b"{\"c\":\"drive\",\"v\":0.2,\"w\":0,\"ttl\":250,\"n\":5,\"t\":100}*00000000\x1f" {
        scene.monitor.heard(scene.now_ms, Some(*byte));
    }
    assert_eq!(scene.pass(1, FORWARD), [Rule::WheelsWithoutLease]);
}

#[test]
fn three_resets_in_a_minute_need_a_clear() {
    let mut scene = Scene::armed();
    for _ in 0..3 {
        scene.monitor.reset(scene.now_ms, ResetCause::Watchdog);
        scene.pass(1000, OFF);
    }
    let reset_ms = scene.now_ms - 1000;
    scene.open_session(SESSION);
    scene.number = 0;
    scene.arm(false);
    let tick = scene.now_ms - reset_ms;
    scene.host(&format!(
        r#"{{"c":"drive","v":0.2,"w":0,"ttl":250,"n":3,"t":{tick}}}"#
    ));
    assert_eq!(scene.pass(1, FORWARD), [Rule::ResetLoop]);
}

/// It may stand against a wall; S7's ten seconds begin when somebody may move it, also where a button or `stop` was a moment before.
#[test]
fn a_bumper_that_is_pressed_at_rest_counts_from_the_arming_on() {
    for is_stopped in [true, false] {
        let mut scene = Scene::armed();
        scene.pins.bumper = true;
        for _ in 0..45 {
            scene.drive();
            scene.pass(200, OFF);
        }
        if is_stopped {
            scene.host(r#"{"c":"stop"}"#);
            scene.pass(2, OFF);
            scene.arm(false);
        }
        for _ in 0..8 {
            scene.pass_driven(200, BACKWARD);
            scene.pass(60, OFF);
        }
        let stuck = scene.pass(0, OFF).contains(&Rule::BumperStuck);
        assert_eq!(stuck, !is_stopped, "stopped in between: {is_stopped}");
    }
}

#[test]
fn each_physical_cause_has_its_reaction_time() {
    let with = |change: fn(&mut Pins)| {
        let mut pins = Pins::default();
        change(&mut pins);
        pins
    };
    let table = [
        (with(|pins| pins.bumper = true), FORWARD, 20, Rule::Bumper),
        (with(|pins| pins.bumper = true), BACKWARD, 3020, Rule::BumperStuck),
        (with(|pins| pins.cliff = true), FORWARD, 20, Rule::Cliff),
        (with(|pins| pins.wheel_drop = true), BACKWARD, 50, Rule::WheelDrop),
        (with(|pins| pins.docked = true), BACKWARD, 20, Rule::Docked),
    ];
    for (pins, drives, reaction_ms, rule) in table {
        let mut scene = Scene::armed();
        scene.pass_driven(2000, drives);
        scene.pins = Pins {
            counts: scene.pins.counts,
            ..pins
        };
        assert_eq!(
            scene.pass_driven(reaction_ms, drives),
            [],
            "{rule:?} within its time"
        );
        assert!(
            scene.pass_driven(2, drives).contains(&rule),
            "{rule:?} after its time"
        );
    }
}

#[test]
fn backing_off_bumper_and_cliff_is_allowed() {
    let mut scene = Scene::armed();
    scene.pins.bumper = true;
    scene.pins.cliff = true;
    assert_eq!(scene.pass_driven(1000, BACKWARD), []);
}

/// An edge in sight, and the body going back at this speed.
fn beside_an_edge(speed_mm_per_s: i32) -> Scene {
    let mut scene = Scene::armed();
    scene.pins.cliff = true;
    scene.pins.rims_mm_per_s = [-speed_mm_per_s; 2];
    scene.pins.speed_mm_per_s = -speed_mm_per_s;
    scene
}

#[test]
fn a_reverse_from_an_edge_is_slow() {
    assert_eq!(beside_an_edge(120).pass_driven(1_300, BACKWARD), []);
    let mut scene = beside_an_edge(130);
    assert_eq!(scene.pass_driven(100, BACKWARD), []);
    assert_eq!(scene.pass_driven(1, BACKWARD), [Rule::CliffSpeed]);
    let mut scene = beside_an_edge(130);
    scene.pins.rims_mm_per_s[0] = 0;
    assert_eq!(
        scene.pass_driven(101, BACKWARD),
        [Rule::CliffSpeed],
        "one wheel is enough"
    );
    assert_eq!(beside_an_edge(400).pass_driven(400, OFF), [], "it only coasts");
}

#[test]
fn a_reverse_from_an_edge_is_short_and_floor_begins_it_anew() {
    let mut scene = beside_an_edge(100);
    assert_eq!(scene.pass_driven(1_650, BACKWARD), []);
    assert_eq!(scene.pass_driven(1, BACKWARD), [Rule::CliffDistance]);
    for (gap_ms, rules) in [(49, 1), (60, 0)] {
        let mut scene = beside_an_edge(100);
        scene.pass_driven(1_500, BACKWARD);
        scene.pins.cliff = false;
        scene.pass_driven(gap_ms, BACKWARD);
        scene.pins.cliff = true;
        assert_eq!(
            scene.pass_driven(500, BACKWARD).len(),
            rules,
            "{gap_ms} ms of floor"
        );
    }
}

#[test]
fn no_wheel_goes_forward_beside_an_edge() {
    let turn = Drives {
        wheels: [-400_000, 300_000],
        ..OFF
    };
    assert_eq!(beside_an_edge(0).pass_driven(21, turn), [Rule::Cliff]);
}

#[test]
fn a_button_stops_until_the_next_arm() {
    let mut scene = Scene::armed();
    scene.pass_driven(100, FORWARD);
    scene.pins.button = true;
    assert_eq!(scene.pass_driven(49, FORWARD), []);
    assert_eq!(scene.pass_driven(2, FORWARD), [Rule::Button]);
    scene.pins.button = false;
    scene.arm(false);
    assert_eq!(
        scene.pass_driven(500, FORWARD).len(),
        1,
        "an arm after the press allows motion"
    );
}

#[test]
fn a_button_on_a_standing_robot_stops_nothing() {
    let mut scene = Scene::armed();
    scene.pins.button = true;
    scene.pass(100, OFF);
    assert_eq!(scene.pass_driven(200, FORWARD), []);
}

#[test]
fn an_undock_command_means_the_dock_that_the_robot_stands_on() {
    for away_ms in [0, 300, 3_000] {
        let mut scene = Scene::armed();
        scene.pins.docked = true;
        scene.pass(100, OFF);
        scene.pins.docked = false;
        scene.pass(away_ms, OFF);
        scene.arm(true);
        scene.pass_driven(300, BACKWARD);
        scene.pins.docked = true;
        let expected: &[Rule] = if away_ms > 1_000 {
            &[Rule::Docked, Rule::NotArmed]
        } else {
            &[]
        };
        assert_eq!(scene.pass_driven(25, BACKWARD), expected, "{away_ms}");
    }
}

#[test]
fn an_undock_command_allows_driving_on_the_dock() {
    let mut scene = Scene::armed();
    scene.pins.docked = true;
    scene.pass(100, OFF);
    scene.arm(true);
    assert_eq!(scene.pass_driven(1000, BACKWARD), []);
}

#[test]
fn wheels_wait_a_second_after_a_lift() {
    let mut scene = Scene::armed();
    scene.pins.wheel_drop = true;
    scene.pass(200, OFF);
    scene.pins.wheel_drop = false;
    scene.pass(900, OFF);
    assert_eq!(scene.pass_driven(1, FORWARD), [Rule::LiftedJustNow]);
}

#[test]
fn a_hard_driven_wheel_must_turn() {
    let mut scene = Scene::armed();
    scene.pass_driven(100, FORWARD);
    for _ in 0..301 {
        scene.drive();
        scene.now_ms += 1;
        scene.monitor.judge(scene.now_ms, &scene.pins, &FORWARD);
    }
    assert_eq!(scene.monitor.count(), 0);
    scene.drive();
    scene.now_ms += 2;
    for _ in 0..2 {
        scene.monitor.judge(scene.now_ms, &scene.pins, &FORWARD);
    }
    assert_eq!(scene.monitor.violations()[0].rule, Rule::Stall);
}

#[test]
fn brushes_do_not_start_against_a_pressed_bumper() {
    let mut scene = Scene::armed();
    scene.host(r#"{"c":"motor","motor":"vacuum","throttle":1,"ttl":1000,"n":9,"t":100}"#);
    scene.pins.bumper = true;
    scene.pass(100, OFF);
    let cleaning = Drives {
        cleaners: [0, 0, 1_000_000],
        ..OFF
    };
    assert_eq!(scene.pass(1, cleaning), [Rule::CleanersStart]);
}

#[test]
fn a_fall_is_a_violation_whatever_the_motors_do() {
    let mut scene = Scene::armed();
    scene.pins.fallen = true;
    assert_eq!(scene.pass(10, OFF), [Rule::Fallen]);
}

const TYPED_DRIVE: &str = r#"{"c":"drive","v":0.05,"w":0,"ttl":500}"#;

#[test]
fn hand_mode_ends_with_a_checked_packet_and_comes_back_after_silence() {
    let mut scene = Scene::armed();
    scene.typed(TYPED_DRIVE);
    assert_eq!(
        scene.pass(1, FORWARD),
        [Rule::WheelsWithoutLease],
        "checked mode refuses it"
    );
    scene.pass(2100, OFF);
    scene.typed(r#"{"c":"arm"}"#);
    scene.typed(TYPED_DRIVE);
    assert_eq!(scene.pass(10, FORWARD).len(), 1, "hand mode takes it");
}

#[test]
fn what_a_host_armed_ends_with_its_session() {
    type SessionEnd = fn(&mut Scene);
    let ends: [(&str, SessionEnd); 3] = [
        ("silence", |scene| drop(scene.pass(2_060, OFF))),
        ("by hand", |scene| {
            scene.host(r#"{"c":"hand"}"#);
            scene.pass(30, OFF);
        }),
        ("a new session", |scene| {
            scene.open_session(SESSION + 1);
            scene.open_session(0);
            scene.pass(30, OFF);
        }),
    ];
    for (name, end) in ends {
        let mut scene = Scene::armed();
        scene.drive();
        end(&mut scene);
        scene.typed(TYPED_DRIVE);
        assert_eq!(scene.pass(1, FORWARD), [Rule::NotArmed], "{name}");
    }
}

#[test]
fn what_a_person_armed_ends_ten_seconds_after_the_last_motion_and_with_a_session() {
    let mut scene = Scene::armed();
    scene.pass(2_100, OFF);
    scene.typed(r#"{"c":"arm"}"#);
    for _ in 0..3 {
        scene.pass(9_000, OFF);
        scene.typed(TYPED_DRIVE);
        assert_eq!(scene.pass(400, FORWARD), []);
    }
    scene.pass(9_900, OFF);
    scene.typed(TYPED_DRIVE);
    assert_eq!(scene.pass(1, FORWARD), [Rule::NotArmed]);

    let mut scene = Scene::armed();
    scene.pass(2_100, OFF);
    scene.typed(r#"{"c":"arm"}"#);
    scene.open_session(SESSION + 1);
    scene.open_session(SESSION);
    scene.pass(30, OFF);
    assert!(scene.pass_driven(10, FORWARD).contains(&Rule::NotArmed));
}

#[test]
fn an_arrival_at_the_dock_ends_what_was_armed() {
    let mut scene = Scene::armed();
    scene.pins.docked = true;
    scene.pass(60, OFF);
    scene.pins.docked = false;
    assert_eq!(scene.pass_driven(1, FORWARD), [Rule::NotArmed]);
}

#[test]
fn a_robot_that_is_told_to_leave_the_dock_may_do_so_for_twenty_seconds() {
    let mut scene = Scene::armed();
    scene.pins.docked = true;
    scene.arm(true);
    assert_eq!(scene.pass_driven(20_000, BACKWARD), []);
    assert_eq!(scene.pass_driven(300, BACKWARD), [Rule::NotArmed, Rule::Docked]);
}

#[test]
fn a_button_holds_a_robot_on_a_bad_dock_for_that_try_only() {
    let mut scene = Scene::armed();
    scene.pins.docked = true;
    scene.pins.charging = Charging {
        driven: false,
        ..CHARGING
    };
    scene.pass(1_100, OFF);
    scene.pass(100, BACKWARD);
    scene.pins.button = true;
    assert_eq!(scene.pass(49, BACKWARD), []);
    assert_eq!(scene.pass(30, BACKWARD), [Rule::Button]);
    scene.pins.button = false;
    scene.pass(4_000, OFF);
    assert_eq!(scene.pass(1_000, BACKWARD), [Rule::Button], "a new try");
}

#[test]
fn a_binary_drive_covers_its_lease() {
    let mut scene = Scene::armed();
    let body = [
        0x81, 0x40, 0x0D, 0x03, 0, 0x1F, 0, 0, 0, 250, 0, 7, 0, 100, 0, 0, 0,
    ];
    let crc = packet_crc(&body, WireDirection::ToRobot, SESSION).to_le_bytes();
    for byte in body.into_iter().chain(crc) {
        if matches!(byte, 0x1D..=0x1F) {
            scene.monitor.heard(scene.now_ms, Some(0x1D));
            scene.monitor.heard(scene.now_ms, Some(byte ^ 0x20));
        } else {
            scene.monitor.heard(scene.now_ms, Some(byte));
        }
    }
    scene.monitor.heard(scene.now_ms, Some(0x1F));
    assert_eq!(scene.pass(300, FORWARD), []);
    assert_eq!(scene.pass(1, FORWARD), [Rule::WheelsWithoutLease]);
}

/// A pack that may be charged.
const CHARGING: Charging = Charging {
    driven: true,
    supplied: true,
    current_ma: 1_000,
    pack_mv: 17_000,
    temperature_dc: 300,
};

#[test]
fn each_cause_against_charging_has_its_reaction_time() {
    let cases: [(Charging, Drives, u32, Rule); 7] = [
        (
            Charging {
                supplied: false,
                ..CHARGING
            },
            OFF,
            100,
            Rule::ChargeUnsupplied,
        ),
        (
            Charging {
                temperature_dc: 550,
                ..CHARGING
            },
            OFF,
            2_000,
            Rule::ChargeTemperature,
        ),
        (
            Charging {
                temperature_dc: -1,
                current_ma: 100,
                ..CHARGING
            },
            OFF,
            2_000,
            Rule::ChargeTemperature,
        ),
        (
            Charging {
                temperature_dc: 49,
                current_ma: 251,
                ..CHARGING
            },
            OFF,
            2_000,
            Rule::ChargeTemperature,
        ),
        (
            Charging {
                pack_mv: 21_001,
                ..CHARGING
            },
            OFF,
            2_000,
            Rule::ChargeVoltage,
        ),
        (
            Charging {
                current_ma: 1_401,
                ..CHARGING
            },
            OFF,
            200,
            Rule::ChargeCurrent,
        ),
        (CHARGING, BACKWARD, 100, Rule::ChargeDriving),
    ];
    for (charging, drives, reaction_ms, rule) in cases {
        let mut scene = Scene::armed();
        scene.pins.charging = charging;
        assert_eq!(scene.pass_driven(reaction_ms, drives), [], "{rule:?}");
        assert_eq!(scene.pass_driven(1, drives), [rule]);
    }
}

#[test]
fn a_charge_ends_in_time_and_a_rest_begins_another() {
    let mut scene = Scene::armed();
    let hours = |hours: f64| (hours * 3_600_000.0) as u32;
    scene.pins.charging = CHARGING;
    assert_eq!(scene.pass(hours(3.0), OFF), []);
    scene.pins.charging.driven = false;
    scene.pass(hours(0.4), OFF);
    scene.pins.charging.driven = true;
    assert_eq!(scene.pass(hours(0.6), OFF), []);
    scene.pins.charging.driven = false;
    scene.pass(hours(0.6), OFF);
    scene.pins.charging.driven = true;
    assert_eq!(scene.pass(hours(3.6), OFF), []);
    assert_eq!(scene.pass(1, OFF), [Rule::ChargeTime]);
}

#[test]
fn a_clock_that_starts_late_makes_no_command_old() {
    let mut scene = Scene::armed();
    scene.monitor.reset(scene.now_ms, ResetCause::Watchdog);
    scene.open_session(SESSION);
    scene.pass(600, OFF);
    scene.monitor.clock_started(scene.now_ms);
    let started_ms = scene.now_ms;
    scene.arm(false);
    scene.pass(300, OFF);
    scene.number += 1;
    let tick = scene.now_ms - started_ms - 100;
    let json = format!(
        r#"{{"c":"drive","v":0.2,"w":0,"ttl":250,"n":{},"t":{tick}}}"#,
        scene.number
    );
    scene.host(&json);
    assert_eq!(scene.pass(300, FORWARD), []);
}

#[test]
fn a_robot_may_back_off_a_dock_that_does_not_let_go_and_off_no_other() {
    let leaking = Charging {
        driven: false,
        ..CHARGING
    };
    let mut scene = Scene::armed();
    scene.monitor.reset(scene.now_ms, ResetCause::Watchdog);
    scene.pins.docked = true;
    scene.pins.charging = leaking;
    scene.pass(900, OFF);
    assert_ne!(scene.pass(50, BACKWARD), [], "not before a second of current");
    let mut scene = Scene::armed();
    scene.monitor.reset(scene.now_ms, ResetCause::Watchdog);
    scene.pins.docked = true;
    scene.pins.charging = leaking;
    scene.pass(1_100, OFF);
    assert_eq!(scene.pass(2_000, BACKWARD), []);
    assert_ne!(scene.pass(50, FORWARD), [], "backwards only");
}

#[test]
fn motors_on_a_pack_that_does_not_carry_them_have_their_reaction_time() {
    const CLEANING: Drives = Drives {
        wheels: [0; 2],
        cleaners: [500_000, 0, 0],
    };
    let sound = Charging {
        driven: false,
        ..CHARGING
    };
    let cases = [
        (
            Charging {
                pack_mv: 10_500,
                ..sound
            },
            500,
            Rule::PackEmpty,
        ),
        (
            Charging {
                temperature_dc: 551,
                ..sound
            },
            1_000,
            Rule::PackHot,
        ),
    ];
    for (pack, reaction_ms, rule) in cases {
        let mut scene = Scene::armed();
        scene.pins.charging = pack;
        assert_eq!(scene.pass_driven(reaction_ms, FORWARD), [], "{rule:?}");
        assert_eq!(scene.pass_driven(5, FORWARD), [rule]);
    }
    let mut scene = Scene::armed();
    scene.pins.charging.pack_mv = 11_500;
    assert_eq!(scene.pass_driven(3_000, FORWARD), [], "wheels may carry it home");
    assert!(scene.pass(2_010, CLEANING).contains(&Rule::PackWeak));
}

/// Drives the scene forward for so long at 0.2 m/s while each encoder changes by `counted` in a millisecond.
fn rolled(scene: &mut Scene, ms: u32, counted: i32) -> Vec<Rule> {
    scene.pins.rims_mm_per_s = [200; 2];
    for _ in 0..ms / 10 {
        scene.drive();
        for _ in 0..10 {
            let before = scene.pins.counts;
            scene.pins.counts = before.map(|count| count + counted - 1);
            scene.pass(1, FORWARD);
        }
    }
    scene
        .monitor
        .violations()
        .iter()
        .map(|violation| violation.rule)
        .collect()
}

#[test]
fn an_encoder_that_counts_against_its_rim_or_nothing_is_found() {
    for counted in [-1, 0] {
        let mut scene = Scene::armed();
        let early = rolled(&mut scene, 500, counted);
        assert!(!early.contains(&Rule::Encoder), "{counted}: {early:?}");
        let late = rolled(&mut scene, 300, counted);
        assert!(late.contains(&Rule::Encoder), "{counted}: {late:?}");
    }
    assert_eq!(rolled(&mut Scene::armed(), 2_000, 1), []);
}
