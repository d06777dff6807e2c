//! What of a job is left when the pack is low, on a virtual clock.

use brain::command::StrategyName;
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{generated, household, settings};

/// A job in a known home, up to when it believes to have swept this share; none if it is over before.
fn swept(share: f64) -> Option<Household> {
    let mut household = household(&generated(6), &settings(3, 0)).with_known_map();
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    work_up_to(share - 0.02, &mut household)?;
    // Below half of its charge it looks now and then how far its dock is.
    household.robot_mut().world_mut().set_battery_charge(0.45);
    work_up_to(share, &mut household)?;
    Some(household)
}

/// Counting the share goes over the whole floor, so it is looked at every five seconds.
fn work_up_to(share: f64, household: &mut Household) -> Option<()> {
    (0..2 * 60 * 60 / 5).find_map(|_| {
        household.pass_ms(5_000);
        let brain = household.host().and_then(Host::brain).expect("a brain");
        let is_swept = brain.swept_share().is_some_and(|swept| swept.share >= share);
        is_swept.then_some(())
    })
}

fn reason(household: &Household) -> &'static str {
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.status().reason.name()
}

/// Reasons that it tells while its pack falls low and it goes home.
fn reasons_at_low_battery(household: &mut Household) -> Vec<&'static str> {
    household.robot_mut().world_mut().set_battery_charge(0.12);
    let mut reasons = Vec::new();
    for _ in 0..400 {
        household.pass_ms(1_000);
        reasons.push(reason(household));
    }
    reasons.dedup();
    reasons
}

#[test]
#[ignore = "campaign: hours of work and charge; cargo xtask test --all"]
fn a_job_whose_rest_is_crumbs_is_over_when_the_pack_is_low_and_any_other_waits_for_charge() {
    let much = reasons_at_low_battery(&mut swept(0.93).expect("it sweeps so much"));
    assert!(much.contains(&"recharging"), "{much:?}");
    // When only crumbs are left differs by a hundredth from run to run, and a job may be finished before the pack is low.
    let jobs = [0.94, 0.951, 0.96, 0.965].into_iter().filter_map(swept);
    let little: Vec<Vec<&str>> = jobs.map(|mut job| reasons_at_low_battery(&mut job)).collect();
    let over = |reasons: &Vec<&str>| reasons.contains(&"crumbs-left");
    assert!(little.iter().any(over), "{little:?}");
    for reasons in little.iter().filter(|reasons| over(reasons)) {
        assert!(!reasons.contains(&"recharging"), "{reasons:?}");
    }
}
