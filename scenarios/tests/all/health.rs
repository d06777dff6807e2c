//! How worn parts are, in a whole system on a virtual clock: hair around the brush is noticed, a clean brush is left in peace.

use rvac_api::{ComponentHealth, RequestBody};
use rvac_sim::{Host, Household};
use scenarios::{cleaning, scene};
use vthal_core::CoreConfig;
use vthal_core::health::Health;

/// Time in which the robot, which turns at each wall, drives straight for more than ten minutes.
const LEARNS_MS: u64 = 25 * 60_000;

/// In the middle of a job, with a host that keeps its log.
fn at_work() -> Household {
    let mut household = cleaning(&scene("furnished-room", "nominal"), 1);
    household.host_mut().expect("lives").keep_log();
    household
}

fn brush(household: &Household) -> ComponentHealth {
    let host = household.host().expect("lives");
    let mut parts = host.health().into_iter();
    parts
        .find(|part| part.component == "brush-main")
        .expect("is told")
}

fn warned(household: &Household) -> bool {
    let log = household.host().expect("lives").log();
    log.iter()
        .any(|entry| entry.text.contains("The main brush runs hard"))
}

#[test]
#[ignore = "campaign: whole runs; cargo xtask test --all"]
fn hair_around_the_brush_is_told_until_somebody_says_that_it_is_gone() {
    let mut household = at_work();
    household.pass_ms(LEARNS_MS);
    let learnt = brush(&household);
    assert_eq!(learnt.verdict, "fine", "{learnt:?}");
    assert!(!warned(&household));

    household.robot_mut().world_mut().wind_brush(1.6);
    household.pass_ms(LEARNS_MS);
    let wound = brush(&household);
    assert_eq!(wound.verdict, "hard", "{wound:?}");
    assert!((wound.share.expect("is known") - 1.6).abs() < 0.1, "{wound:?}");
    assert!(warned(&household));

    household.ask(RequestBody::ResetHealth {
        component: "wheel-left".to_owned(),
    });
    assert_eq!(
        brush(&household).verdict,
        "hard",
        "the reset of a wheel is none of the brush"
    );
    let kept = household
        .host()
        .and_then(Host::kept_health)
        .expect("is on the disk");
    household.kill_host().expect("lives");
    let config = CoreConfig {
        health: Health::try_from(kept).expect("can be read"),
        ..Host::config(1, brain::StrategyName::Bounce)
    };
    let host = Host::start(household.now_us(), config);
    household.revive_host(host);
    assert_eq!(
        brush(&household).verdict,
        "hard",
        "the next daemon has forgotten it"
    );

    household.ask(RequestBody::ResetHealth {
        component: "brush-main".to_owned(),
    });
    let reset = brush(&household);
    assert_eq!((reset.verdict.as_str(), reset.minutes), ("learning", 0));
}

#[test]
#[ignore = "campaign: whole runs; cargo xtask test --all"]
fn a_clean_robot_is_not_told_to_be_cleaned() {
    let mut household = at_work();
    household.pass_ms(3 * LEARNS_MS);
    let host = household.host().expect("lives");
    let (by_hours, by_load): (Vec<_>, Vec<_>) = host
        .health()
        .into_iter()
        .partition(|part| part.verdict == "unmeasured");
    assert_eq!(by_load.len(), 3, "both wheels and the main brush");
    for part in by_load {
        assert_eq!(part.verdict, "fine", "{part:?}");
        assert!((part.share.expect("is known") - 1.0).abs() < 0.15, "{part:?}");
    }
    for part in by_hours {
        let hours = part.hours.as_ref().expect("they are counted");
        assert!(hours.worked_h < hours.usual_h, "{part:?}");
    }
}
