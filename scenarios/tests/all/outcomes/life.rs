//! A life of runs: each daemon begins with what the one before has kept.

use brain::command::StrategyName;
use rvac_sim::{Host, Scene};
use scenarios::{Table, Watched, generated, scene, usual};
use vthal_core::learnt::Learnings;
use vthal_core::{CoreConfig, KeptFloor, stored_map};

const RUNS: u64 = 5;
/// Longest run, seconds.
const RUN_S: u64 = 20 * 60;

/// What a daemon finds on the disk of the one before.
fn after(watched: &Watched, scene: &Scene, seed: u64) -> CoreConfig {
    let bytes = stored_map::encode(&watched.brain().map().stored());
    let home = stored_map::decode(&bytes).expect("a map that was stored");
    let learnt = watched.household().host().and_then(Host::kept_learnt);
    CoreConfig {
        floors: vec![KeptFloor {
            home: Some(home),
            ..KeptFloor::new(1)
        }],
        learnt: learnt
            .and_then(|learnt| Learnings::try_from(learnt).ok())
            .unwrap_or_default(),
        ..usual(scene, seed)
    }
}

fn life(name: &'static str, (what, scene): (&str, &Scene)) {
    let mut table = Table::of_outcomes(name, "runs of one life, each on the map that the last one kept");
    let mut config = usual(scene, 1);
    for run in 1..=RUNS {
        let mut watched = Watched::with_config(scene, run, config);
        watched.clean(Some(StrategyName::Systematic));
        watched.finish(RUN_S);
        table.row(&format!("{what}, run {run}"), &watched);
        config = after(&watched, scene, run + 1);
    }
    table.compare();
}

#[test]
fn a_life_in_the_two_room_flat() {
    life(
        "life-two-room-flat",
        ("two-room-flat nominal", &scene("two-room-flat", "nominal")),
    );
}

#[test]
fn a_life_in_a_generated_home() {
    life("life-generated", ("generated:14 nominal", &generated(14)));
}
