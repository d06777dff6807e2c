//! The same seed is the same run, bit for bit; another seed is another run.

use brain::command::StrategyName;
use monitor::Bridges;
use rvac_sim::faults::{FaultCampaign, TrialSettings};
use rvac_sim::run::{RunSettings, run};
use rvac_sim::{Firmware, Host, Household};
use scenarios::{generated, household, scene, settings};

fn hash_of(seed: u64) -> (u64, String) {
    let scene = scene("two-room-flat", "nominal");
    let settings = settings(seed, 120_000);
    let mut household = household(&scene, &settings);
    let report = run(&mut household, &settings, |_| {}).expect("the robot answers");
    (household.robot().state_hash(), format!("{report:?}"))
}

#[test]
fn a_run_repeats_itself() {
    assert_eq!(hash_of(5), hash_of(5));
    assert_ne!(hash_of(5).0, hash_of(6).0);
}

/// A small one of the generated homes.
const SMALL_HOME: u32 = 14;

/// All that is known of a run at its end.
#[derive(PartialEq)]
struct Outcome {
    world: u64,
    figures: String,
    log: Vec<String>,
    map: Vec<u8>,
}

impl Outcome {
    fn says(&self, decision: &str) -> bool {
        self.log.iter().any(|line| line.contains(decision))
    }
}

/// Ten minutes of lanes.
fn planned_run(seed: u64, prepare: impl Fn(Household) -> Household) -> Outcome {
    let settings = RunSettings {
        strategy: StrategyName::Systematic,
        ..settings(seed, 600_000)
    };
    let mut household = prepare(household(&generated(SMALL_HOME), &settings));
    household.host_mut().expect("lives").keep_log();
    let report = run(&mut household, &settings, |_| {}).expect("the robot answers");
    let log = household.host().map(Host::log).unwrap_or_default();
    let log = log.iter().map(|entry| format!("{entry:?}")).collect();
    let brain = household.host().and_then(Host::brain).expect("a brain");
    Outcome {
        world: household.robot().state_hash(),
        figures: format!("{report:?}"),
        log,
        map: vthal_core::stored_map::encode(&brain.map().stored()),
    }
}

#[test]
fn a_first_run_that_plans_repeats_itself() {
    let first = planned_run(5, |household| household);
    assert!(first.says("lap (no-map)") && first.says("rest (gyro-drift)"));
    assert!(first == planned_run(5, |household| household));
    assert!(first.world != planned_run(6, |household| household).world);
}

#[test]
fn a_run_in_a_known_home_repeats_itself() {
    let first = planned_run(5, Household::with_known_map);
    assert!(first.says("plan (unswept-floor)") && !first.says("lap (no-map)"));
    assert!(first == planned_run(5, Household::with_known_map));
    assert!(first.world != planned_run(6, Household::with_known_map).world);
}

#[test]
fn a_trial_full_of_faults_repeats_itself() {
    let model = home::RobotModel::by_name("sr8730").unwrap();
    let campaign = FaultCampaign::load(model, Firmware::HostBuilt).unwrap();
    for seed in [4, 7] {
        let settings = TrialSettings {
            seed,
            duration_ms: 60_000,
            bridges: Bridges::Sound,
        };
        let first = campaign.trial(settings);
        assert_eq!(first, campaign.trial(settings));
        assert!(first.faults.iter().sum::<u32>() > 5, "there were faults");
    }
}
