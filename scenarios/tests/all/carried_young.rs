//! A robot that people carry elsewhere during its first run, whose map is young.

use brain::command::StrategyName;
use home::Pose;
use rvac_api::{NoGoShape, RequestBody};
use rvac_sim::Household;
use rvac_sim::run::start_cleaning;
use scenarios::{brain, generated, household, settings};

/// A first run in a generated home after so many seconds.
fn first_run(home: u32, for_s: u64) -> Household {
    let mut household = household(&generated(home), &settings(1, 0));
    if let Some(host) = household.host_mut() {
        host.keep_log();
    }
    household.pass_ms(2_000);
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    household.pass_ms(for_s * 1_000);
    household
}

/// Somebody carries the robot to `place` and sends it on.
fn carry(household: &mut Household, place: Pose) {
    household.robot_mut().world_mut().lift();
    household.pass_ms(5_000);
    household.robot_mut().world_mut().put_down_at(place);
    household.pass_ms(2_000);
    household.ask(RequestBody::Resume);
}

fn has_begun_anew(household: &Household) -> bool {
    let log = household.host().expect("the host lives").log();
    log.iter().any(|entry| entry.text.starts_with("begin-map-anew"))
}

/// Where the robot believes to be, against the truth, metres.
fn off_m(household: &Household) -> f64 {
    let (believed, truth) = (brain(household).pose(), household.truth_in_map());
    (believed.x_m - truth.x_m).hypot(believed.y_m - truth.y_m)
}

/// A place of the home that the robot has not seen within its first minutes.
fn far_place(home: u32) -> Pose {
    let scene = generated(home);
    let (plan, dock) = (scene.home(), scene.home().dock().expect("the home has a dock"));
    let raster = (0..120).flat_map(|x| (0..120).map(move |y| (0.1 * f64::from(x), 0.1 * f64::from(y))));
    let (x_m, y_m) = raster
        .filter(|&(x_m, y_m)| plan.clearance_m(x_m, y_m) > 0.3)
        .max_by(|a, b| {
            let far_m = |at: &(f64, f64)| (at.0 - dock.x_m).hypot(at.1 - dock.y_m);
            far_m(a).total_cmp(&far_m(b))
        })
        .expect("the home has floor");
    Pose::new(x_m, y_m, 1.0)
}

#[test]
fn a_map_of_a_minute_is_begun_anew_where_the_robot_was_put_down() {
    for (home, after_s) in [(1, 20), (3, 60), (4, 60)] {
        let mut household = first_run(home, after_s);
        carry(&mut household, far_place(home));
        household.pass_ms(600_000);
        assert!(has_begun_anew(&household), "home {home} after {after_s} s");
        assert!(
            !brain(&household).estimate().lost,
            "home {home} after {after_s} s"
        );
        assert!(
            off_m(&household) < 0.3,
            "home {home}: {} m off",
            off_m(&household)
        );
        let swept_m2 = brain(&household).map().swept_m2();
        assert!(swept_m2 > 8.0, "home {home}: {swept_m2} m2");
    }
}

#[test]
fn a_robot_that_is_put_back_where_it_was_goes_on_in_its_map() {
    for home in [1, 7] {
        let mut household = first_run(home, 420);
        let there = household.robot().world().truth().pose;
        carry(&mut household, there.then(Pose::new(-0.05, 0.0, 0.6)));
        household.pass_ms(600_000);
        assert!(!has_begun_anew(&household), "home {home}");
        assert!(
            off_m(&household) < 0.3,
            "home {home}: {} m off",
            off_m(&household)
        );
    }
}

#[test]
fn a_map_in_which_people_have_drawn_is_not_begun_anew() {
    let home = 3;
    let mut household = first_run(home, 180);
    let at = brain(&household).pose();
    household.ask(RequestBody::AddNoGo {
        shape: NoGoShape::Wall([[at.x_m - 0.2, at.y_m - 0.2], [at.x_m, at.y_m]]),
        name: None,
    });
    household.pass_ms(1_000);
    assert!(!brain(&household).map().annotations().is_empty());
    carry(&mut household, far_place(home));
    household.pass_ms(600_000);
    assert!(!has_begun_anew(&household));
    assert!(!brain(&household).map().annotations().is_empty());
}
