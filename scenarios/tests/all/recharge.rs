//! A job that one charge is not enough for, with a charge that takes as long as it does: what stops a charger after an hour
//! shows in no charge that is hastened.

use brain::command::StrategyName;
use brain::{BehaviorState, Brain};
use rvac_sim::Household;
use rvac_sim::run::start_cleaning;
use scenarios::{brain, generated, household, settings};

/// Longest charge, seconds.
const CHARGE_S: u64 = 4 * 60 * 60;

/// Lets time pass until something is so, at most this many seconds; gives the seconds that it took.
fn until(is_so: impl Fn(&Brain) -> bool, at_most_s: u64, household: &mut Household) -> u64 {
    let passed_s = household.pass_until(at_most_s, |household| is_so(brain(household)));
    passed_s.unwrap_or_else(|| panic!("not within {at_most_s} s: {:?}", brain(household).status()))
}

#[test]
#[ignore = "campaign: hours on the charger; cargo xtask test --all"]
fn a_pack_is_charged_in_its_own_time_and_the_job_goes_on() {
    for seed in [1, 2, 3] {
        let mut household = household(&generated(28), &settings(seed, 0)).with_known_map();
        household.robot_mut().world_mut().set_battery_charge(0.2);
        assert!(start_cleaning(&mut household, StrategyName::Systematic));
        let on_the_dock =
            |brain: &Brain| brain.awaits_charge() && brain.status().state == BehaviorState::Docked;
        until(on_the_dock, 600, &mut household);
        let there_rad = brain(&household).pose().heading_rad;
        let goes_on = |brain: &Brain| brain.status().state == BehaviorState::Cleaning;
        let sets_out = |brain: &Brain| brain.status().state == BehaviorState::Starting;
        let charging_s = until(sets_out, CHARGE_S, &mut household);
        let turned_rad = brain(&household).pose().heading_rad - there_rad;
        assert!(
            turned_rad.abs() < 0.01,
            "it stood for two hours and believes to have turned by {turned_rad} rad"
        );
        until(goes_on, 30, &mut household);
        assert!(
            charging_s > 60 * 60,
            "a charge with 1 A is not over in {charging_s} s"
        );
        let charge = household.robot().world().truth().battery_charge;
        assert!(charge > 0.85, "it set out with {charge}");
        assert!(!household.job_is_over());
        household.pass_ms(120_000);
        let figures = household.report().figures.expect("it has a host");
        assert!(
            figures.pose_error_max_m < 0.3,
            "its gyro's bias wandered for two hours, and it was wrong by {} m",
            figures.pose_error_max_m
        );
        assert_eq!(household.robot().monitor().violations().len(), 0);
    }
}
