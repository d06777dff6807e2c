//! A robot on its first run in a room with things in its middle, which its lanes lead into until it has seen them.

use std::path::PathBuf;

use brain::command::StrategyName;
use rvac_sim::Household;
use rvac_sim::run::start_cleaning;
use scenarios::{household, scene_in, settings};

/// Longest job, seconds.
const JOB_S: u64 = 30 * 60;
/// Most touches of these three runs. They were 26 when this was written, and 52 with a robot that ran into whatever it saw.
const TOUCHES_MAX: u64 = 40;

#[test]
#[ignore = "campaign: whole runs; cargo xtask test --all"]
fn what_it_sees_ahead_it_mostly_does_not_touch() {
    let home = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/homes/chest-and-sofa.toml");
    let scene = scene_in(home);
    let mut touches = 0;
    for seed in [2, 3, 5] {
        let mut household = household(&scene, &settings(seed, 0));
        assert!(start_cleaning(&mut household, StrategyName::Systematic));
        let over = household.pass_until(JOB_S, Household::job_is_over);
        let report = household.report();
        assert!(over.is_some(), "the job never ends with seed {seed}");
        assert!(report.covered > 0.95, "{} with seed {seed}", report.covered);
        touches += u64::from(report.bumps);
    }
    assert!(touches <= TOUCHES_MAX, "{touches} touches");
}
