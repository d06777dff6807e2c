//! Wide halls, in which no beam tells the place for tens of metres.

use brain::command::StrategyName;
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{household, says, scene, settings};

fn estimate(household: &Household) -> brain::PoseEstimate {
    household
        .host()
        .and_then(Host::brain)
        .expect("a brain")
        .estimate()
}

/// Seconds until it tells this, an hour at most; it may not be lost meanwhile.
fn until_told(household: &mut Household, what: &str) -> u32 {
    let told_s = (0..3_600).find(|_| {
        household.pass_ms(1_000);
        assert!(!estimate(household).lost, "lost in a home that it knows");
        says(household, what)
    });
    told_s.unwrap_or_else(|| panic!("{what} is never told"))
}

#[test]
fn a_robot_whose_place_becomes_vague_goes_to_walls_and_is_not_lost() {
    let mut household = household(&scene("empty-halls", "nominal"), &settings(1, 0)).with_known_map();
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    household.host_mut().expect("lives").keep_log();
    until_told(&mut household, "take-fix");
    assert!(estimate(&household).sigma_m > 0.25);
    until_told(&mut household, "fix-taken");
    assert!(estimate(&household).sigma_m < 0.1);
}
