//! The strategies that do without a map, and the cleaning of a spot.

use brain::command::StrategyName;
use rvac_api::RequestBody;
use scenarios::{Table, Watched, generated_with, scene};

/// How long each cleans, seconds.
const CLEAN_S: u64 = 8 * 60;
const SPOT_S: u64 = 3 * 60;

#[test]
fn strategies_without_a_map() {
    let mut table = Table::of_outcomes(
        "strategies",
        &format!("strategies without a map, {CLEAN_S} s, and spots, {SPOT_S} s, seed 5"),
    );
    let scenes = [
        ("furnished-room ideal", scene("furnished-room", "ideal")),
        ("two-room-flat nominal", scene("two-room-flat", "nominal")),
        ("generated:14 bad", generated_with(14, "bad")),
    ];
    for (home, scene) in &scenes {
        for strategy in [
            StrategyName::Bounce,
            StrategyName::WallBounce,
            StrategyName::Statistical,
        ] {
            let mut watched = Watched::new(scene, 5);
            watched.clean(Some(strategy));
            watched.pass_s(CLEAN_S);
            table.row(&format!("{home} {}", strategy.name()), &watched);
        }
        let mut watched = Watched::somewhere(scene, 5);
        watched.start(RequestBody::Spot);
        watched.pass_s(SPOT_S);
        table.row(&format!("{home} spot"), &watched);
    }
    table.compare();
}

#[test]
fn without_a_map_until_the_job_is_over() {
    let mut table = Table::of_outcomes("strategies-job", "a whole job without a map, seed 6");
    let mut watched = Watched::new(&scene("furnished-room", "nominal"), 6);
    watched.clean(Some(StrategyName::Statistical));
    watched.finish(45 * 60);
    table.row("furnished-room nominal statistical", &watched);
    table.compare();
}
