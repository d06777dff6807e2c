//! A robot that is lifted in the middle of its job and put down in another room.

use crate::flat;
use brain::command::StrategyName;
use home::Pose;
use rvac_api::RequestBody;
use rvac_sim::Household;
use rvac_sim::run::start_cleaning;

/// How near it has to know its place again, metres.
const NEAR_M: f64 = 0.2;

/// The robot's estimated pose in the plan.
fn believed(household: &Household, map_from_plan: Pose) -> Pose {
    let pose = household.host().unwrap().pose();
    map_from_plan
        .inverse()
        .then(Pose::new(pose.x, pose.y, pose.heading))
}

fn is_lost(household: &Household) -> bool {
    household.host().unwrap().brain().unwrap().estimate().lost
}

fn swept_m2(household: &Household) -> f64 {
    household.host().unwrap().brain().unwrap().map().swept_m2()
}

#[test]
fn it_follows_walls_until_it_knows_where_it_is_and_writes_down_nothing_until_then() {
    let mut household = flat::household(&flat::scene(), None, 4);
    let truth = household.robot().world().truth().pose;
    let pose = household.host().unwrap().pose();
    let map_from_plan = Pose::new(pose.x, pose.y, pose.heading).then(truth.inverse());

    start_cleaning(&mut household, StrategyName::Systematic);
    household.pass_ms(60_000);
    let docked = household.robot().world().docked_pose().unwrap();
    household.robot_mut().world_mut().lift();
    household.pass_ms(3_000);
    let (x_m, y_m) = docked.point(-1.2, 1.0);
    let there = Pose::new(x_m, y_m, docked.heading_rad + 2.0);
    household.robot_mut().world_mut().put_down_at(there);
    household.pass_ms(3_000);
    household.ask(RequestBody::Resume);
    household.pass_ms(1_000);
    assert!(is_lost(&household));

    let swept_before_m2 = swept_m2(&household);
    let seconds = (0..240).find(|_| {
        let was_lost = is_lost(&household);
        assert!(!was_lost || (swept_m2(&household) - swept_before_m2).abs() < 1e-9);
        household.pass_ms(1_000);
        !is_lost(&household)
    });
    let log: Vec<String> = household
        .host()
        .unwrap()
        .log()
        .iter()
        .map(|entry| entry.text.clone())
        .collect();
    assert!(seconds.is_some(), "{log:#?}");
    assert!(log.iter().any(|text| text.contains("place-unknown")), "{log:#?}");

    household.pass_ms(30_000);
    let off_m = believed(&household, map_from_plan).distance_m(household.robot().world().truth().pose);
    assert!(off_m < NEAR_M, "{off_m} m off after {seconds:?} s\n{log:#?}");
    assert!(swept_m2(&household) > swept_before_m2 + 0.5, "lanes went on");
    assert!(household.robot().monitor().violations().is_empty());
}
