//! A robot among stairs that nobody has told it of, on a virtual clock.

use brain::command::StrategyName;
use rvac_sim::run::start_cleaning;
use scenarios::{generated, household, settings};

/// The lap along the walls of this home leads into a corner between stairs. Three edges in five seconds latch the firmware (S8), and
/// then a person must come: with these seeds it did within ten minutes before every job knew of that rule.
#[test]
#[ignore = "campaign: whole runs; cargo xtask test --all"]
fn a_lap_among_stairs_is_no_trap() {
    for seed in [4, 5, 6] {
        let mut household = household(&generated(33), &settings(seed, 0));
        assert!(start_cleaning(&mut household, StrategyName::Systematic));
        household.pass_ms(14 * 60_000);
        let report = household.report();
        let figures = report.figures.as_ref().expect("a host");
        assert_eq!(figures.state, "cleaning", "seed {seed}");
        assert_eq!(report.monitor_violations, 0, "seed {seed}");
    }
}
