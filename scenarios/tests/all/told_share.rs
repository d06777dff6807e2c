//! What a robot on its first run tells of the share that it has swept, beside the truth.

use brain::command::StrategyName;
use rvac_sim::Household;
use rvac_sim::run::start_cleaning;
use scenarios::{generated, household, settings};

/// Longest job, seconds.
const JOB_S: u64 = 60 * 60;
/// How far off the told share may be. It counts floor along walls otherwise than the truth does.
const OFF_MAX: f64 = 0.06;

/// A small home whose walls show gaps that lead nowhere: floor was hoped for behind them, and counted.
const HOME: u32 = 28;

fn after_first_run(seed: u64) -> Household {
    let mut household = household(&generated(HOME), &settings(seed, 0));
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    let over = household.pass_until(JOB_S, Household::job_is_over);
    assert!(over.is_some(), "the job never ends with seed {seed}");
    household
}

#[test]
#[ignore = "campaign: whole runs; cargo xtask test --all"]
fn a_first_run_that_swept_nearly_all_says_so() {
    for seed in [1, 2] {
        let report = after_first_run(seed).report();
        let told = report
            .figures
            .and_then(|figures| figures.reported_share)
            .expect("a robot that plans tells its share");
        assert!(report.covered > 0.9, "{} with seed {seed}", report.covered);
        assert!(
            (told - report.covered).abs() < OFF_MAX,
            "it told {told} of {} with seed {seed}",
            report.covered
        );
    }
}
