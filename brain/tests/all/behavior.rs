//! The state machine, by scripts.

use crate::script::{check, check_with, config};
use brain::observation::{Cliffs, Contacts};
use brain::{BehaviorState, BrainConfig, JobCommand, Motion};

#[test]
fn a_job_from_start_to_stop() {
    let stage = check(
        "wait 0.1      => disconnected start-up
         up            => idle link-restored
         clean         => starting command
         wait 2.5      => starting
         wait 0.5      => cleaning command
         wait 5        => cleaning
         stop          => idle command",
    );
    assert!(!stage.cleaners);
    assert!(stage.brain.job().path_m > 1.0, "{:?}", stage.brain.job());
    assert!(stage.brain.job().swept_m2 > 0.3, "{:?}", stage.brain.job());
}

#[test]
fn the_start_is_announced_by_three_beeps_and_two_seconds() {
    let stage = check("up\n clean => starting\n wait 2.6 => starting");
    assert_eq!(stage.tones.iter().filter(|tone| tone.pitch_hz > 0).count(), 3);
    assert_eq!(stage.arms, 0, "armed before the announcement was over");
    assert_eq!(stage.motion, Motion::Rest);
}

#[test]
fn pause_keeps_the_job_and_resume_announces_itself() {
    let stage = check(
        "up
         clean
         wait 4        => cleaning
         pause         => paused command
         wait 1        => paused
         resume        => starting command
         wait 3.2      => cleaning
         pause         => paused
         stop          => idle command
         resume        => idle",
    );
    assert_eq!(stage.tones.iter().filter(|tone| tone.pitch_hz > 0).count(), 6);
}

#[test]
fn a_lifted_robot_pauses_and_offers_to_go_on_when_it_stands() {
    let script = "up
         clean
         wait 4        => cleaning
         lift          => paused wheel-drop";
    assert!(!check(script).brain.status().resumable);
    let stage = check(&format!("{script}\n put => paused wheel-drop"));
    assert!(stage.brain.status().resumable);
    check(&format!(
        "{script}\n put\n resume => starting command\n wait 3.2 => cleaning"
    ));
}

#[test]
fn a_button_or_a_foreign_stop_pauses() {
    check(
        "up\n clean\n wait 4 => cleaning\n inhibit button-stop => paused button-stop\n resume\n wait 3.2 => cleaning",
    );
    check("up\n clean\n wait 4 => cleaning\n inhibit stopped => paused stopped");
}

#[test]
fn starts_are_refused_by_name() {
    for (situation, reason) in [
        ("down", "link-lost"),
        ("inhibit link-late", "link-late"),
        ("lift", "wheel-drop"),
        ("inhibit wheel-stall", "wheel-stall"),
        ("inhibit from-the-future", "unknown-inhibit"),
        ("charge 0.1", "battery-low"),
    ] {
        let stage = check(&format!("up\n {situation}"));
        let refusal = stage.brain.admit(&JobCommand::Spot).expect_err(situation);
        assert_eq!(refusal.name(), reason, "{situation}");
        check(&format!("up\n {situation}\n spot\n wait 4"))
            .brain
            .status()
            .state
            .moves()
            .then(|| panic!("{situation}"));
    }
}

#[test]
fn faults_stand_until_gone_and_acknowledged() {
    check(
        "up
         clean
         wait 4              => cleaning
         inhibit wheel-stall => error wheel-stall
         resume              => error wheel-stall
         clear               => error wheel-stall
         free wheel-stall    => paused wheel-stall
         resume              => starting",
    );
    check(
        "up\n inhibit runaway => error runaway\n free runaway => error runaway\n clear\n wait 0.1 => idle runaway",
    );
    check("up\n clean\n wait 4\n inhibit cliff-sensor => cleaning\n wait 2.1 => error cliff-sensor");
    check("up\n clean\n wait 4\n inhibit cliff-sensor\n wait 1\n free cliff-sensor\n wait 5 => cleaning");
}

#[test]
fn short_outages_are_bridged_and_long_ones_announced() {
    check(
        "up\n clean\n wait 4 => cleaning\n down => disconnected link-lost\n wait 2\n up => cleaning link-restored",
    );
    check("up\n clean\n wait 4\n down\n wait 6\n up => starting continued\n wait 3.2 => cleaning");
    check("up\n clean\n wait 4\n down\n pause => disconnected command\n up => paused link-restored");
    check("up\n clean\n wait 4\n down\n stop => disconnected\n up => idle link-restored");
    check("up\n clean\n wait 4\n inhibit not-armed => starting not-armed\n wait 3.2 => cleaning");
    check("up\n clean\n wait 4\n inhibit link-lost => cleaning\n wait 1 => cleaning");
}

#[test]
fn a_link_that_cannot_be_relied_upon_is_named_and_bridged() {
    check(
        "up
         clean
         wait 4               => cleaning
         inhibit clock-frozen => disconnected clock-frozen
         down                 => disconnected clock-frozen
         wait 2
         free clock-frozen    => disconnected link-lost
         up                   => cleaning link-restored",
    );
    check(
        "up
         clean
         wait 4
         down                 => disconnected link-lost
         inhibit link-garbled => disconnected link-garbled
         pause                => disconnected command
         free link-garbled    => disconnected command
         up                   => paused link-restored",
    );
    // Nobody knows how long a clock that has jumped was away.
    check(
        "up
         clean
         wait 4
         inhibit clock-jumped => disconnected clock-jumped
         wait 1
         free clock-jumped    => starting continued
         wait 3.2             => cleaning",
    );
}

#[test]
fn a_deaf_firmware_ends_the_start() {
    check("deaf\n up\n clean => starting\n wait 5 => starting\n wait 1.2 => paused arm-refused");
}

#[test]
fn a_person_drives_under_a_lease() {
    let stage = check("up\n drive 0.2 0.5 => manual command\n drive 0.2 0.5 => manual");
    assert_eq!(
        stage.motion,
        Motion::Drive {
            speed_m_per_s: 0.2,
            turn_rad_per_s: 0.5
        }
    );
    check("up\n drive 0.2 0 => manual\n wait 0.30 => manual\n wait 0.1 => idle lease-ended");
    check("up\n drive 0.2 0\n release => idle released");
    check("up\n clean\n wait 4\n drive 0.2 0 => manual\n release => paused released");
    let stage = check("up\n drive 99 -99\n drive 99 -99");
    assert_eq!(
        stage.motion,
        Motion::Drive {
            speed_m_per_s: 0.35,
            turn_rad_per_s: -1.5
        }
    );
    let stage = check("up\n drive 0.2 0\n press left\n drive 0.2 0 => manual");
    assert_eq!(stage.motion, Motion::Halt, "towards a pressed bumper");
}

#[test]
fn after_a_safety_stop_the_stick_must_be_centred() {
    let over = "up\n drive 0.2 0 => manual\n wait 1 => idle lease-ended";
    check(&format!(
        "{over}\n drive 0.2 0 => idle lease-ended\n drive 0 0 => manual\n drive 0.2 0 => manual"
    ));
    check(
        "up\n drive 0.2 0\n drive 0.2 0\n inhibit button-stop => idle button-stop\n drive 0.1 0 => idle button-stop",
    );
    check(
        "up\n drive 0.2 0\n stop => idle command\n drive 0.2 0 => idle command\n release\n drive 0.2 0 => manual",
    );
    check("up\n drive 0.2 0\n lift => idle wheel-drop\n put\n drive 0.2 0 => idle");
}

#[test]
fn spot_ends_by_itself() {
    check("up\n spot => starting\n wait 3.2 => spot\n wait 40 => idle finished");
}

#[test]
fn the_dock_ends_the_search_and_undocking_begins_the_job() {
    check("up\n dock => starting\n wait 3.2 => docking\n docked => docked docked\n dock => docked");
    let stage = check(
        "up\n docked => docked\n clean => starting\n wait 3.0 => cleaning\n undocked\n wait 1 => cleaning",
    );
    assert!(
        stage.brain.pose().x_m < -0.1,
        "it leaves backwards: {:?}",
        stage.brain.pose()
    );
    check("up\n clean\n wait 4 => cleaning\n docked => cleaning\n undocked\n wait 6 => cleaning");
    check("up\n docked => docked\n undocked => docked\n wait 3 => idle dock-contact-lost");
}

#[test]
fn budgets_end_in_a_named_way() {
    let short = BrainConfig {
        task_budget_s: 10.0,
        dock_budget_s: 15.0,
        ..config()
    };
    check_with(
        short,
        "up
         clean
         wait 3.2    => cleaning
         wait 10     => docking task-budget
         wait 16     => idle dock-not-found",
    );
    check("up\n charge 0.5\n clean\n wait 4 => cleaning\n charge 0.1 => docking battery-low");
}

#[test]
fn wheels_that_do_not_turn_lead_to_stuck_and_a_person_leads_out() {
    let stuck =
        "up\n clean\n wait 4 => cleaning\n block\n wait 2.5 => cleaning\n wait 25 => stuck not-moving";
    check(stuck);
    check(&format!(
        "{stuck}\n unblock\n resume => starting command\n wait 10 => cleaning"
    ));
    check(&format!("{stuck}\n lift => paused wheel-drop"));
}

#[test]
fn a_bump_backs_off_and_turns_away() {
    let mut stage = check("up\n clean\n wait 4 => cleaning\n press left");
    assert!(
        matches!(stage.motion, Motion::Drive { speed_m_per_s, turn_rad_per_s: 0.0 } if speed_m_per_s < 0.0)
    );
    stage.observation.contacts.left = false;
    let turned = (0..100).any(|_| {
        stage.step(&[]);
        matches!(stage.motion, Motion::Drive { turn_rad_per_s, .. } if turn_rad_per_s < 0.0)
    });
    assert!(turned, "right, away from the left");
    assert_eq!(stage.brain.job().bumps, 1);
    assert_eq!(stage.brain.map().snapshot().hazards.len(), 1);
}

#[test]
fn a_contact_that_never_lets_go_is_not_backed_from_for_ever() {
    let stage = check("up\n clean\n wait 4 => cleaning\n press both\n wait 20 => stuck contact-held");
    assert!(
        (0.1..=0.15).contains(&stage.backed_m),
        "{} m back",
        stage.backed_m
    );
    let mut stage = check(
        "up\n clean\n wait 4\n press both\n wait 20 => stuck\n resume => starting\n wait 20 => stuck contact-held",
    );
    assert!(stage.backed_m <= 0.15, "{} m back in two jobs", stage.backed_m);
    stage.observation.contacts = Contacts::default();
    stage.step(&[JobCommand::Resume]);
    for _ in 0..50 * 10 {
        stage.step(&[]);
    }
    assert_eq!(stage.brain.status().state, BehaviorState::Cleaning);
    assert_eq!(stage.backed_m, 0.0, "driving forward makes it good");
}

/// A robot that stands against something, or beside its dock, when it is sent off.
#[test]
fn a_bumper_pressed_before_the_start_is_left_or_told() {
    for side in ["left", "both"] {
        let mut stage = check(&format!("up\n press {side}\n clean\n wait 3.5 => cleaning"));
        stage.observation.contacts = Contacts::default();
        for _ in 0..50 * 20 {
            stage.step(&[]);
        }
        assert_eq!(stage.brain.status().state, BehaviorState::Cleaning, "{side}");
        let held = check(&format!(
            "up\n press {side}\n clean\n wait 40 => stuck contact-held"
        ));
        assert!(
            held.backed_m > 0.05 && held.backed_m <= 0.15,
            "{side}: {} m back",
            held.backed_m
        );
    }
}

/// Backing straight along an edge never leaves it.
#[test]
fn an_edge_on_one_side_is_left_by_a_turn_with_no_wheel_going_forward() {
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        let mut stage = check(&format!("up\n clean\n wait 6 => cleaning\n cliff {side}"));
        let before = (stage.brain.pose().heading_rad, stage.backed_m);
        let mut turned_rad = 0.0;
        for _ in 0..50 * 4 {
            stage.step(&[]);
            turned_rad = (sign * (stage.brain.pose().heading_rad - before.0)).sin();
            if turned_rad > 0.3 {
                break;
            }
        }
        assert!(turned_rad > 0.3, "{side}: {turned_rad} rad away from the edge");
        assert!(
            stage.backed_m - before.1 < 0.1,
            "{side}: {} m back",
            stage.backed_m
        );
        stage.observation.cliffs = Cliffs::default();
        for _ in 0..50 * 10 {
            stage.step(&[]);
        }
        assert_eq!(stage.brain.status().state, BehaviorState::Cleaning, "{side}");
    }
}

/// A robot that may not back any farther turns away from what one bumper touches, and waits for a person where both touch.
#[test]
fn without_a_way_back_a_contact_on_one_side_is_left_by_a_turn() {
    let spent = "up\n drive -0.3 0 => manual\n wait 0.35 => manual\n drive -0.3 0\n wait 0.35\n drive -0.3 0\n wait 0.35\n release";
    check(&format!(
        "{spent}\n press both\n clean\n wait 20 => stuck contact-held"
    ));
    for side in ["left", "right"] {
        let mut stage = check(&format!("{spent}\n press {side}\n clean\n wait 3.5 => cleaning"));
        let before_m = stage.backed_m;
        stage.observation.contacts = Contacts::default();
        for _ in 0..50 * 20 {
            stage.step(&[]);
        }
        assert_eq!(stage.brain.status().state, BehaviorState::Cleaning, "{side}");
        assert!(stage.backed_m <= before_m, "{side}: {} m back", stage.backed_m);
        check(&format!(
            "{spent}\n press {side}\n clean\n wait 40 => stuck contact-held"
        ));
    }
}

#[test]
fn contacts_that_close_without_a_dock_are_left_by_a_hand_s_breadth_at_a_time() {
    let stage = check(
        "up\n clean\n wait 4 => cleaning\n docked => cleaning\n wait 1 => cleaning\n docked\n wait 1\n docked\n wait 1 => cleaning",
    );
    assert!(
        (0.1..=0.15).contains(&stage.backed_m),
        "{} m back",
        stage.backed_m
    );
}

#[test]
fn a_person_may_drive_back_and_the_brain_goes_no_further() {
    let back = "drive -0.3 0 => manual\n wait 0.35 => manual\n".repeat(4);
    let stage = check(&format!("up\n {back}"));
    let way_m = -stage.brain.pose().x_m;
    assert!(way_m > 0.3, "{way_m} m");
    let stage = check(&format!(
        "up\n {back} release\n press both\n clean\n wait 20 => stuck contact-held"
    ));
    let further_m = -stage.brain.pose().x_m - way_m;
    assert!(further_m < 0.01, "{further_m} m");
}

#[test]
fn a_robot_with_a_gyro_rests_for_it_now_and_then() {
    let mut stage = check("up\n clean\n wait 4 => cleaning");
    stage.observation.gyro_heading_rad = Some(0.0);
    let mut rests = Vec::new();
    for _ in 0..130 * 50 {
        let actions = stage.step(&[]);
        if actions
            .decisions
            .iter()
            .any(|decision| (decision.kind.name(), decision.cause.name()) == ("rest", "gyro-drift"))
        {
            rests.push(stage.observation.time_us);
        }
    }
    assert_eq!(rests.len(), 2, "{rests:?}");
    assert!(matches!(stage.motion, Motion::Drive { .. }), "and drives on");
}
