//! The same seed is the same run, bit for bit; another seed is another run.

use monitor::Bridges;
use rvac_sim::Firmware;
use rvac_sim::faults::{Campaign, TrialSettings};
use rvac_sim::run::{household, run};
use scenarios::{scene, settings};

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

#[test]
fn a_trial_full_of_faults_repeats_itself() {
    let model = home::RobotModel::by_name("sr8730").unwrap();
    let campaign = Campaign::load(model, Firmware::HostBuilt).unwrap();
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
