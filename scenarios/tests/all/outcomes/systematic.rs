//! `systematic` in homes that the robot does not know, and in homes that it knows.

use brain::command::StrategyName;
use rvac_api::{CleaningPattern, JobOrder, RequestBody};
use rvac_sim::Scene;
use scenarios::{JOB_S, Table, Watched, generated_with, scene};

/// A name for people, and the scene.
fn scenes(homes: &[(&str, &str)]) -> Vec<(String, Scene)> {
    let named = |(home, noise): &(&str, &str)| {
        let scene = match home.strip_prefix("generated:") {
            Some(number) => generated_with(number.parse().expect("a number"), noise),
            None => scene(home, noise),
        };
        (format!("{home} {noise}"), scene)
    };
    homes.iter().map(named).collect()
}

fn first_runs(name: &'static str, homes: &[(&str, &str)]) {
    let mut table = Table::of_outcomes(
        name,
        "systematic, first run of a robot that knows nothing, seed 2",
    );
    for (what, scene) in scenes(homes) {
        let mut watched = Watched::new(&scene, 2);
        watched.clean(Some(StrategyName::Systematic));
        watched.finish(JOB_S);
        table.row(&what, &watched);
    }
    table.compare();
}

fn known_homes(name: &'static str, homes: &[(&str, &str)]) {
    let mut table = Table::of_outcomes(name, "systematic with a perfect map, seed 3");
    for (what, scene) in scenes(homes) {
        let mut watched = Watched::new(&scene, 3).knowing_home();
        watched.clean(Some(StrategyName::Systematic));
        watched.finish(JOB_S);
        table.row(&what, &watched);
    }
    table.compare();
}

#[test]
fn first_runs_in_homes_of_the_project() {
    first_runs(
        "first-runs-project",
        &[
            ("furnished-room", "ideal"),
            ("two-room-flat", "nominal"),
            ("stairs", "bad"),
        ],
    );
}

#[test]
fn first_runs_in_generated_homes() {
    first_runs(
        "first-runs-generated",
        &[("generated:14", "nominal"), ("generated:6", "bad")],
    );
}

#[test]
fn known_homes_of_the_project() {
    known_homes(
        "known-homes-project",
        &[
            ("furnished-room", "bad"),
            ("two-room-flat", "nominal"),
            ("stairs", "ideal"),
        ],
    );
}

#[test]
fn known_generated_homes() {
    known_homes(
        "known-homes-generated",
        &[("generated:14", "bad"), ("generated:6", "nominal")],
    );
}

#[test]
fn rings_along_walls_in_a_known_home() {
    let mut table = Table::of_outcomes(
        "contour",
        "systematic by rings along walls with a perfect map, seed 4",
    );
    for (what, scene) in scenes(&[("two-room-flat", "nominal")]) {
        let mut watched = Watched::new(&scene, 4).knowing_home();
        watched.start(RequestBody::Clean(JobOrder {
            pattern: Some(CleaningPattern::Contour),
            ..JobOrder::default()
        }));
        watched.finish(JOB_S);
        table.row(&what, &watched);
    }
    table.compare();
}
