//! Docks as they are in homes: the mains fail, contacts are dirty or dead, somebody takes the robot away.

use brain::BehaviorState;
use brain::command::StrategyName;
use home::{DockContacts, Pose};
use rvac_api::{JobOrder, JobPart, LogEntry, LogLevel, RequestBody, RunJob, RunResult};
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{brain, household, off_the_dock, scene, settings};

/// Longest way home that ends without the dock, seconds.
const GIVES_UP_S: u64 = 6 * 60;

fn told(household: &Household) -> (BehaviorState, &'static str) {
    let status = brain(household).status();
    (status.state, status.reason.name())
}

/// A robot that waits on its dock for charge in the middle of a job.
fn recharging() -> Household {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(1, 0)).with_known_map();
    household.robot_mut().world_mut().set_battery_charge(0.2);
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    let waits = |household: &Household| told(household) == (BehaviorState::Docked, "recharging");
    assert!(
        household.pass_until(900, waits).is_some(),
        "{:?}",
        told(&household)
    );
    household.pass_ms(40_000);
    household
}

/// Gives how often the state was entered anew within so many milliseconds.
fn changes(household: &mut Household, ms: u64) -> usize {
    let mut changes = 0;
    let mut before = told(household);
    for _ in 0..ms / 100 {
        household.pass_ms(100);
        changes += usize::from(told(household) != before);
        before = told(household);
    }
    changes
}

#[test]
fn a_job_waits_through_a_power_cut() {
    let mut household = recharging();
    let world = household.robot_mut().world_mut();
    world.set_dock_power(false);
    assert_eq!(changes(&mut household, 1_000), 0, "a second is nothing");
    household.robot_mut().world_mut().set_dock_power(true);
    assert_eq!(changes(&mut household, 30_000), 0);
    household.robot_mut().world_mut().set_dock_power(false);
    assert_eq!(changes(&mut household, 600_000), 1, "told once");
    assert_eq!(told(&household), (BehaviorState::Docked, "dock-power-lost"));
    household.robot_mut().world_mut().set_dock_power(true);
    // It was gone twice, so the contacts must hold for ten seconds.
    household.pass_ms(12_000);
    assert_eq!(told(&household), (BehaviorState::Docked, "recharging"));
    assert_eq!(household.robot().monitor().violations().len(), 0);
}

#[test]
fn a_robot_that_is_lifted_off_its_dock_says_so_and_goes_on_when_it_is_back() {
    let mut household = recharging();
    let there = household.robot().world().truth().pose;
    household.robot_mut().world_mut().lift();
    household.pass_ms(5_000);
    assert_eq!(told(&household), (BehaviorState::Paused, "lifted-off"));
    household.robot_mut().world_mut().put_down_at(there);
    household.pass_ms(5_000);
    assert_eq!(told(&household), (BehaviorState::Docked, "recharging"));
}

#[test]
fn a_person_who_sends_it_home_ends_the_job_that_waits() {
    let mut household = recharging();
    household.ask(RequestBody::Dock);
    household.robot_mut().world_mut().set_battery_charge(0.97);
    household.pass_ms(30_000);
    assert_eq!(told(&household), (BehaviorState::Docked, "command"));
}

/// A charge in the middle is no end of the job, and what follows is no new run.
#[test]
fn a_job_with_a_charge_in_the_middle_is_one_run_of_the_history() {
    let mut household = recharging();
    household.robot_mut().world_mut().set_charging_speed(20.0);
    let cleans = |household: &Household| told(household).0 == BehaviorState::Cleaning;
    assert!(
        household.pass_until(2 * 60 * 60, cleans).is_some(),
        "{:?}",
        told(&household)
    );
    household.pass_ms(20_000);
    household.ask(RequestBody::Stop);
    household.pass_ms(6_000);
    let [record] = household.host().expect("lives").runs() else {
        panic!("one run: {:?}", household.host().map(Host::runs));
    };
    assert!(matches!(record.run.job, RunJob::Clean { .. }), "{:?}", record.run);
    assert_eq!(
        (record.run.result, record.run.reason.as_str()),
        (RunResult::Stopped, "command")
    );
    let recharged = record.stops.iter().filter(|stop| stop.reason == "recharging");
    assert_eq!(recharged.count(), 1, "{:?}", record.stops);
}

/// Whoever stops it on its way home stops the way home: the job was done.
#[test]
fn a_job_that_was_done_stays_finished_when_a_person_stops_its_way_home() {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(1, 0)).with_known_map();
    household.pass_ms(4_000);
    let corners = vec![[-1.4, -0.4], [-0.8, -0.4], [-0.8, 0.4], [-1.4, 0.4]];
    household.ask(RequestBody::Clean(JobOrder {
        parts: vec![JobPart::Zone(corners)],
        passes: 1,
        avoid: Vec::new(),
        power: None,
        pattern: None,
    }));
    let goes_home = |household: &Household| told(household) == (BehaviorState::Docking, "finished");
    assert!(
        household.pass_until(600, goes_home).is_some(),
        "{:?}",
        told(&household)
    );
    household.ask(RequestBody::Stop);
    household.pass_ms(6_000);
    assert_eq!(told(&household), (BehaviorState::Idle, "command"));
    let runs = household.host().expect("lives").runs();
    let run = &runs.last().expect("a run").run;
    assert_eq!(
        (run.result, run.reason.as_str()),
        (RunResult::Finished, "finished")
    );
}

/// Sends a robot home to a dock that something is wrong with; gives the seconds until it rests, and what it says.
fn sent_home(wear: impl Fn(&mut home::World)) -> (u64, BehaviorState, &'static str) {
    sent_home_while(wear, |_, _| {})
}

/// The same while something happens: it is told the seconds since the robot was sent.
fn sent_home_while(
    wear: impl Fn(&mut home::World),
    mut happens: impl FnMut(&mut Household, u64),
) -> (u64, BehaviorState, &'static str) {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(2, 0)).with_known_map();
    let before: Pose = off_the_dock(&scene);
    let world = household.robot_mut().world_mut();
    world.put_down_at(before);
    world.set_battery_charge(0.5);
    wear(world);
    household.pass_ms(4_000);
    household.ask(RequestBody::Dock);
    household.pass_ms(5_000);
    let rests = |household: &Household| {
        !matches!(
            told(household).0,
            BehaviorState::Docking | BehaviorState::Starting
        )
    };
    let mut seconds = 0;
    while seconds < 1_200 && !rests(&household) {
        happens(&mut household, seconds);
        household.pass_ms(1_000);
        seconds += 1;
    }
    household.pass_ms(12_000);
    assert_eq!(household.robot().monitor().violations().len(), 0);
    let (state, reason) = told(&household);
    (seconds, state, reason)
}

#[test]
fn docking_ends_after_a_few_tries_and_says_why() {
    let dead = |world: &mut home::World| world.set_dock_contacts(DockContacts::Dead);
    let (seconds, state, reason) = sent_home(dead);
    assert_eq!((state, reason), (BehaviorState::Idle, "dock-no-contact"));
    assert!(seconds < GIVES_UP_S, "{seconds} s");
}

#[test]
fn contacts_that_carry_no_current_now_and_then_are_tried_again() {
    let dirty = |world: &mut home::World| world.set_dock_contacts(DockContacts::Dirty(0.2));
    let (seconds, state, reason) = sent_home(dirty);
    assert_eq!((state, reason), (BehaviorState::Docked, "docked"));
    assert!(seconds < GIVES_UP_S, "{seconds} s");
}

/// The dock stops the wheels before the brain hears of it. That is how docking ends, and nothing to warn of.
#[test]
fn a_dock_that_is_driven_to_is_no_warning() {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(2, 0)).with_known_map();
    household.host_mut().expect("lives").keep_log();
    household
        .robot_mut()
        .world_mut()
        .put_down_at(off_the_dock(&scene));
    household
        .robot_mut()
        .world_mut()
        .set_dock_contacts(DockContacts::Dirty(0.5));
    household.pass_ms(4_000);
    household.ask(RequestBody::Dock);
    let is_docked = |household: &Household| told(household) == (BehaviorState::Docked, "docked");
    assert!(
        household.pass_until(600, is_docked).is_some(),
        "{:?}",
        told(&household)
    );
    household.pass_ms(5_000);
    let log = household.host().expect("lives").log();
    let refused = |entry: &&LogEntry| entry.text.starts_with("the robot refused");
    assert!(
        log.iter().any(|entry| refused(&entry)),
        "it touched the dock while it drove"
    );
    let warned = log.iter().filter(|entry| entry.level == LogLevel::Warn);
    let warned: Vec<&LogEntry> = warned.filter(refused).collect();
    assert!(warned.is_empty(), "{warned:?}");
}

/// What happens to a dock while a robot drives home: the first is what is wrong from the start, the second happens then, and the last is what
/// the robot may say in the end.
type Fate = (
    &'static str,
    fn(&mut home::World),
    fn(&mut Household, u64),
    &'static [(BehaviorState, &'static str)],
);

const DOCKED: (BehaviorState, &str) = (BehaviorState::Docked, "docked");

const FATES: [Fate; 5] = [
    (
        "the mains come back",
        |world| world.set_dock_power(false),
        |household, second| {
            if second == 45 {
                household.robot_mut().world_mut().set_dock_power(true);
            }
        },
        &[DOCKED],
    ),
    (
        "the mains fail before it touches",
        |_| {},
        |household, second| {
            if second == 8 {
                household.robot_mut().world_mut().set_dock_power(false);
            }
        },
        &[
            (BehaviorState::Idle, "no-beam"),
            (BehaviorState::Idle, "dock-no-contact"),
        ],
    ),
    (
        "somebody presses Dock again and again",
        |world| world.set_dock_contacts(DockContacts::Dead),
        |household, second| {
            if second % 15 == 14 {
                household.ask(RequestBody::Dock);
            }
        },
        &[(BehaviorState::Idle, "dock-no-contact")],
    ),
    (
        "somebody carries the dock to another wall",
        |_| {},
        |household, second| {
            if second == 4 {
                let world = household.robot_mut().world_mut();
                let dock = world.home().dock().expect("a dock");
                let (x_m, y_m) = dock.point(0.0, 0.9);
                world.put_dock(Pose::new(x_m, y_m, dock.heading_rad));
            }
        },
        &[DOCKED, (BehaviorState::Idle, "no-beam")],
    ),
    (
        "somebody pauses it between two tries and lets it go on",
        |world| world.set_dock_contacts(DockContacts::Dead),
        |household, second| {
            if second == 50 {
                household.ask(RequestBody::Pause);
                household.pass_ms(2_000);
                household.ask(RequestBody::Resume);
                household.pass_ms(4_000);
            }
        },
        &[(BehaviorState::Idle, "dock-no-contact")],
    ),
];

#[test]
fn whatever_happens_to_a_dock_meanwhile_docking_ends_soon_and_says_why() {
    for (what, wear, happens, ends) in FATES {
        let (seconds, state, reason) = sent_home_while(wear, happens);
        assert!(
            ends.contains(&(state, reason)),
            "{what}: {state:?} {reason} after {seconds} s"
        );
        assert!(seconds < GIVES_UP_S, "{what}: {seconds} s");
    }
}
