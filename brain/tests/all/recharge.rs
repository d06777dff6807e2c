//! Home for charge and on with the job, by scripts.

use crate::script::{Stage, check, check_with, config};
use brain::{BehaviorState, Brain, BrainConfig, Inhibits, JobCommand, JobKind, StrategyName};

/// A job that was put off for the pack's sake, on the dock.
const ON_THE_DOCK: &str = "up
     charge 0.5
     clean
     wait 6          => cleaning
     charge 0.1      => docking battery-low
     wait 1
     docked          => docked recharging
     ";

#[test]
fn a_job_goes_on_when_the_pack_is_charged_and_announces_itself() {
    let stage = check(&format!(
        "{ON_THE_DOCK}
         wait 60         => docked recharging
         charge 0.89     => docked recharging
         charge 0.9      => starting charged
         wait 2          => starting charged
         undocked
         wait 2          => cleaning charged"
    ));
    assert_eq!(stage.tones.iter().filter(|tone| tone.pitch_hz > 0).count(), 6);
    assert_eq!(stage.brain.status().strategy, Some(StrategyName::Bounce));
    assert!(stage.brain.job().time_s > 2.0, "the figures go on");
}

#[test]
fn a_job_that_waits_says_when_the_charger_has_stopped_and_goes_on_once_it_charges_again() {
    check(&format!(
        "{ON_THE_DOCK}
         wait 60                => docked recharging
         inhibit charger-fault  => docked charger-fault
         wait 600               => docked charger-fault
         free charger-fault     => docked recharging
         charge 0.9             => starting charged"
    ));
}

#[test]
fn a_person_decides_over_a_job_that_waits_for_charge() {
    for (line, end) in [
        ("charge 0.4\n resume", "starting command"),
        ("resume", "docked recharging"),
        ("pause\n charge 0.95\n wait 5", "paused command"),
        ("stop\n charge 0.95\n wait 5", "docked command"),
        ("dock\n charge 0.95\n wait 5", "docked command"),
        ("pause\n dock\n charge 0.95\n wait 5", "docked command"),
        ("charge 0.95\n dock\n wait 5", "docked command"),
        ("undocked\n wait 2", "starting dock-missed"),
        ("undocked\n wait 6", "docking dock-missed"),
        ("lift\n charge 0.95\n wait 1", "docked recharging"),
    ] {
        check(&format!("{ON_THE_DOCK}\n {} => {end}", line.replace('\n', "\n ")));
    }
}

#[test]
fn a_job_that_ran_out_of_time_or_was_sent_home_does_not_go_on() {
    let short = BrainConfig {
        task_budget_s: 10.0,
        ..config()
    };
    check_with(
        short,
        "up\n charge 0.5\n clean\n wait 16 => docking task-budget\n docked => docked docked\n charge 1 => docked docked",
    );
    check(
        "up\n charge 0.5\n clean\n wait 4\n dock => docking command\n docked => docked docked\n charge 1 => docked docked",
    );
}

#[test]
fn contacts_that_open_again_at_once_are_tried_a_few_times() {
    let slip = "docked => docked docked\n undocked\n wait 2 => starting dock-missed\n wait 4 => docking\n";
    check(&format!(
        "up\n dock\n wait 4 => docking\n {slip} {slip} {slip} docked => docked docked\n undocked\n wait 2 => idle dock-contact-lost"
    ));
    check("up\n dock\n wait 4\n docked\n wait 31\n undocked\n wait 2 => idle dock-contact-lost");
}

/// A job that waits for charge on a dock whose beams it receives.
const IN_THE_BEAMS: &str = "beams\n wait 40 => docked recharging\n";

#[test]
fn a_dock_without_power_is_told_once_and_the_job_goes_on_when_power_returns() {
    check(&format!(
        "{ON_THE_DOCK} {IN_THE_BEAMS} undocked\n silence\n wait 1 => docked recharging
         wait 2 => docked dock-power-lost\n wait 3600 => docked dock-power-lost
         docked\n beams\n wait 6 => docked recharging\n charge 0.9 => starting charged"
    ));
    // It is charged well enough already.
    check(&format!(
        "{ON_THE_DOCK} {IN_THE_BEAMS} undocked\n silence\n wait 3 => docked dock-power-lost\n charge 0.9 => starting charged"
    ));
    check(
        "up\n docked => docked\n beams\n wait 3\n undocked\n silence\n wait 3 => idle dock-power-lost
         docked\n wait 1 => idle dock-power-lost\n wait 5 => docked docked",
    );
}

#[test]
fn who_took_it_off_its_dock_is_told_by_what_was_sensed() {
    for (what, end) in [
        ("push -0.1\n undocked", "paused pushed-off"),
        ("lift\n undocked", "paused lifted-off"),
        // A switch that hung on the contacts for long sticks, and says nothing.
        ("lift\n wait 5\n silence\n undocked", "docked dock-power-lost"),
        ("lift\n wait 5\n push -0.1\n undocked", "paused pushed-off"),
        (
            "lift\n wait 5\n put\n wait 2\n lift\n undocked",
            "paused lifted-off",
        ),
        ("silence\n undocked", "docked dock-power-lost"),
        ("undocked", "starting dock-missed"),
    ] {
        check(&format!(
            "{ON_THE_DOCK} {IN_THE_BEAMS} {}\n wait 3 => {end}",
            what.replace('\n', "\n ")
        ));
    }
    let pushed = format!("{ON_THE_DOCK} {IN_THE_BEAMS} push -0.1\n undocked\n wait 3 => paused pushed-off\n");
    check(&format!(
        "{pushed} push 0.1\n docked => docked recharging\n charge 0.9 => starting charged"
    ));
}

/// Gives how often the state changes in a minute in which the contacts open and close again.
fn changes_in_a_minute(stage: &mut Stage, period_s: f64) -> u32 {
    let mut changes = 0;
    let mut before = stage.brain.status();
    for step in 0..50 * 60_u32 {
        let phase_s = f64::from(step) * 0.02 % period_s;
        stage.observation.docked = phase_s < 0.5 * period_s;
        stage.step(&[]);
        changes += u32::from(stage.brain.status() != before);
        before = stage.brain.status();
    }
    changes
}

#[test]
fn contacts_that_flicker_are_told_at_most_once() {
    for (period_s, most) in [(0.4, 0), (1.0, 0), (3.0, 0), (6.0, 1), (20.0, 3)] {
        let mut stage = check(&format!("{ON_THE_DOCK} wait 40"));
        let changes = changes_in_a_minute(&mut stage, period_s);
        assert!(changes <= most, "{changes} changes with a period of {period_s} s");
        assert_eq!(stage.brain.status().state, BehaviorState::Docked);
    }
}

#[test]
fn a_person_who_sends_it_to_the_dock_ends_the_job_that_waits() {
    check(
        "up\n charge 0.5\n clean\n wait 4\n charge 0.1 => docking battery-low\n dock => docking command
         docked => docked docked\n charge 0.95\n wait 5 => docked docked",
    );
    check("up\n charge 0.5\n docked\n clean => starting\n dock => docked command\n wait 9 => docked command");
    check("up\n dock\n wait 4 => docking command\n dock => docking command");
}

/// Pause keeps the job, whatever the pack says meanwhile; Stop ends it, also when somebody then carries the robot home.
#[test]
fn a_person_who_stops_it_on_the_way_home_for_charge_is_obeyed() {
    let on_the_way = "up\n charge 0.5\n clean\n wait 6\n charge 0.1 => docking battery-low\n wait 1\n";
    check(&format!(
        "{on_the_way} pause => paused command\n charge 0.95\n wait 60 => paused command\n resume => starting command"
    ));
    check(&format!(
        "{on_the_way} stop => idle command\n docked\n charge 0.95\n wait 60 => docked"
    ));
}

#[test]
fn home_is_where_current_flows() {
    let there =
        "up\n charge 0.5\n current missing\n dock\n wait 4 => docking command\n docked => docking command\n";
    check(&format!(
        "{there} wait 5 => docking\n current flows => docked docked"
    ));
    check(&format!(
        "{there} wait 5 => docking\n current withheld => docked docked"
    ));
    check(&format!("{there} lift => paused wheel-drop"));
    // The contacts open before anything flows.
    check(&format!(
        "{there} wait 5\n undocked => starting dock-missed\n wait 4 => docking"
    ));
    let dry = "docked => docking\n wait 21 => starting no-charge-current\n undocked\n wait 4 => docking\n";
    let stage = check(&format!(
        "up\n charge 0.5\n current missing\n dock\n wait 4 => docking\n {dry} {dry}
         docked => docking
         wait 21 => docked no-charge-current
         wait 60 => docked no-charge-current
         current flows => docked docked"
    ));
    assert!(stage.backed_m <= 0.15);
}

#[test]
fn a_job_does_not_wait_for_charge_on_a_dead_dock() {
    let dry = "docked => docking\n wait 21 => starting no-charge-current\n undocked\n wait 4 => docking\n";
    check(&format!(
        "up\n charge 0.5\n current missing\n clean\n wait 4\n charge 0.1 => docking battery-low\n {dry} {dry}
         docked\n wait 21 => paused no-charge-current"
    ));
}

#[test]
fn a_lost_dock_leaves_the_job_with_a_person() {
    let short = BrainConfig {
        dock_budget_s: 15.0,
        ..config()
    };
    check_with(
        short,
        "up\n charge 0.5\n clean\n wait 4\n charge 0.1 => docking battery-low\n wait 16 => paused dock-not-found\n resume => starting command",
    );
    let carried = "up\n charge 0.5\n clean\n wait 4\n charge 0.1 => docking\n lift => paused wheel-drop\n put\n docked => docked recharging";
    check(&format!("{carried}\n charge 0.95 => starting charged"));
}

#[test]
fn an_outage_on_the_dock_changes_nothing() {
    check(&format!(
        "{ON_THE_DOCK}\n down => disconnected link-lost\n wait 20\n up => docked recharging"
    ));
}

fn taken_up(before: &Stage) -> Stage {
    let checkpoint = before.brain.checkpoint();
    let mut stage = Stage::new(config());
    stage.brain = Brain::new(config(), 9);
    stage.brain.restore(&checkpoint);
    stage.observation = before.observation.clone();
    stage.observation.inhibits = Inhibits::from_names(["docked", "not-armed"]);
    stage
}

#[test]
fn a_restart_on_the_dock_keeps_the_job_and_what_was_learnt() {
    let before = check(ON_THE_DOCK);
    let job = before.brain.checkpoint().job.expect("it waits");
    assert_eq!(job.goes_on, Some(JobKind::Clean(StrategyName::Bounce)));
    let mut stage = taken_up(&before);
    stage.step(&[]);
    assert_eq!(stage.brain.status().state, BehaviorState::Docked);
    assert_eq!(stage.brain.status().reason.name(), "recharging");
    assert_eq!(stage.brain.job().swept_m2, before.brain.job().swept_m2);
    assert_eq!(stage.brain.energy(), before.brain.energy());
    stage.observation.battery_charge = Some(0.95);
    stage.step(&[]);
    assert_eq!(stage.brain.status().state, BehaviorState::Starting);
    assert_eq!(stage.brain.status().reason.name(), "charged");
    assert!(stage.brain.admit(&JobCommand::Pause).is_ok());
}

/// Whatever sends it home: nobody asked for the floor on the way to be swept.
#[test]
fn brushes_rest_on_the_way_to_the_dock() {
    let short = BrainConfig {
        task_budget_s: 10.0,
        ..config()
    };
    let works = "up\n charge 0.5\n clean\n wait 6 => cleaning\n";
    for (config, sent_home) in [
        (config(), "charge 0.1 => docking battery-low"),
        (config(), "dock => docking command"),
        (config(), "charge 0.1 => docking\n dock => docking command"),
        (short, "wait 10 => docking task-budget"),
    ] {
        let mut stage = check_with(config, &format!("{works} {sent_home}"));
        let mut swept_steps = 0;
        for _ in 0..50 * 20 {
            stage.step(&[]);
            swept_steps += u32::from(stage.cleaners);
        }
        assert_eq!(stage.brain.status().state, BehaviorState::Docking, "{sent_home}");
        assert_eq!(swept_steps, 0, "{sent_home}");
    }
}

#[test]
fn brushes_rest_over_floor_that_was_swept_before() {
    let mut stage = check(&format!(
        "{ON_THE_DOCK}\n charge 0.95 => starting charged\n wait 2"
    ));
    stage.observation.docked = false;
    let mut swept_again = 0;
    for _ in 0..50 * 60 {
        let here = stage.brain.pose().position();
        let was_swept = stage.brain.map().is_swept(here);
        stage.step(&[]);
        if stage.cleaners {
            swept_again = u32::from(was_swept);
            break;
        }
    }
    assert!(stage.cleaners, "it cleans in the end: {:?}", stage.brain.status());
    assert_eq!(swept_again, 0);
}
