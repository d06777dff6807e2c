//! A robot cleans a home that it does not know, comes home, and cleans it again: the second job rests on the map that the first
//! one made, without a restart in between.

use brain::BehaviorState;
use brain::command::StrategyName;
use home::Pose;
use rvac_api::RequestBody;
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{household, scene, settings};

const HOME: &str = "furnished-room";
const MINUTE_MS: u64 = 60_000;
const HOUR_S: u64 = 60 * 60;

/// A household whose robot has cleaned the home for the first time.
fn after_first_run() -> Household {
    let mut household = household(&scene(HOME, "nominal"), &settings(3, 0));
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    household.host_mut().expect("lives").keep_log();
    household.pass_until(HOUR_S, Household::job_is_over);
    household
}

fn is_docked(household: &Household) -> bool {
    household.host().and_then(Host::state) == Some(BehaviorState::Docked)
}

/// How often the brain decided so.
fn decisions(household: &Household, what: &str) -> usize {
    let log = household.host().map(Host::log).unwrap_or_default();
    let of_what = |text: &str| text.split(' ').next() == Some(what);
    log.iter().filter(|entry| of_what(&entry.text)).count()
}

fn agreement(household: &Household) -> Option<f64> {
    household.host().and_then(Host::brain)?.map_agreement()
}

/// How far the believed place is from the true one.
fn off_m(household: &Household) -> f64 {
    let start = scene(HOME, "nominal").home().start();
    let truth = start.inverse().then(household.robot().world().truth().pose);
    let believed = household.host().map(Host::pose).unwrap_or_default();
    Pose::new(believed.x, believed.y, believed.heading).distance_m(truth)
}

#[test]
fn the_job_after_a_first_run_that_ended_on_the_dock_follows_the_map_just_made() {
    let mut household = after_first_run();
    assert!(household.pass_until(HOUR_S / 3, is_docked).is_some());
    assert_eq!((decisions(&household, "lap"), agreement(&household)), (1, None));
    household.pass_ms(10_000);
    start_cleaning(&mut household, StrategyName::Systematic);
    let mut all_off_m: Vec<f64> = Vec::new();
    for _ in 0..5 {
        household.pass_ms(MINUTE_MS);
        all_off_m.push(off_m(&household));
    }
    assert_eq!(
        household.host().and_then(Host::state),
        Some(BehaviorState::Cleaning)
    );
    assert_eq!(decisions(&household, "lap"), 1, "no second lap");
    let explained = agreement(&household);
    assert!(explained.is_some_and(|share| share > 0.8), "{explained:?}");
    // The map of a first run is itself off by as much here and there.
    all_off_m.sort_by(f64::total_cmp);
    assert!(all_off_m[2] < 0.1 && all_off_m[4] < 0.35, "{all_off_m:?} m");
}

#[test]
fn a_first_run_that_somebody_ended_leaves_no_map_to_be_followed() {
    let mut household = household(&scene(HOME, "nominal"), &settings(3, 0));
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    household.host_mut().expect("lives").keep_log();
    household.pass_ms(2 * MINUTE_MS);
    household.ask(RequestBody::Dock);
    assert!(household.pass_until(HOUR_S, is_docked).is_some());
    household.pass_ms(10_000);
    start_cleaning(&mut household, StrategyName::Systematic);
    household.pass_ms(MINUTE_MS);
    assert_eq!((decisions(&household, "lap"), agreement(&household)), (2, None));
}

/// How much of the home the running job has swept in truth, and the least and most that its robot says of it.
fn shares(household: &Household) -> Option<(f64, f64, f64)> {
    let told = household.host().and_then(Host::brain)?.swept_share()?;
    Some((household.report().covered, told.share_low, told.share))
}

/// How far a share may be from the truth: the edges of furniture and what lies behind legs differ between map and home, and in a
/// first run the robot does not know yet how much floor there is: after a lap that does not close it hopes for more than there is until it
/// has looked. It may say that it has swept less than it has, but hardly more. In a known home it was 0.030 at most in three phases.
const SHARE_OFF: f64 = 0.05;
const FIRST_SHARE_SHORT: f64 = 0.2;

/// How often a robot said how much it has swept, and how often that was too little.
#[derive(Debug)]
struct Looks {
    all: u32,
    short: u32,
}

/// Compares what the robot says with the truth twice a minute.
fn compared(household: &mut Household, minutes: u32, share_short: f64) -> Looks {
    let mut looks = Looks { all: 0, short: 0 };
    for _ in 0..2 * minutes {
        household.pass_ms(MINUTE_MS / 2);
        let Some((truth, low, share)) = shares(household) else {
            continue;
        };
        println!("in truth {truth:.3}, told {low:.3} to {share:.3}");
        assert!(low <= share && share <= 1.0);
        assert!(truth >= low - SHARE_OFF, "{truth} is less than {low}");
        looks.all += 1;
        looks.short += u32::from(truth > share + share_short);
    }
    looks
}

#[test]
fn the_share_that_a_robot_says_it_has_swept_is_the_true_one() {
    let mut household = household(&scene(HOME, "nominal"), &settings(4, 0)).with_known_map();
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    assert_eq!(shares(&household), None, "it has no plan yet");
    let looks = compared(&mut household, 6, SHARE_OFF);
    assert!(looks.all >= 8 && looks.short == 0, "{looks:?}");
}

#[test]
#[ignore = "campaign: whole runs; cargo xtask test --all"]
fn in_a_first_run_it_is_so_by_and_large() {
    let mut looks = Looks { all: 0, short: 0 };
    for seed in [1, 2, 3] {
        let mut household = household(&scene(HOME, "nominal"), &settings(seed, 0));
        assert!(start_cleaning(&mut household, StrategyName::Systematic));
        let run = compared(&mut household, 16, FIRST_SHARE_SHORT);
        assert!(run.all >= 8, "{run:?} with seed {seed}");
        looks.all += run.all;
        looks.short += run.short;
    }
    // Four looks of one run that hoped for a room behind its lap until it had looked; in three other phases none.
    assert!(looks.short * 4 <= looks.all, "{looks:?}");
}
