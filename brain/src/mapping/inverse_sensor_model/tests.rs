//! Sightings in a home that earlier runs have left.

use crate::mapping::derived::Derived;
use crate::mapping::home::HomeMap;
use crate::mapping::kept_home::KeptHome;
use crate::mapping::occupancy_grid::Flag;
use crate::mapping::sighting::Sighting;
use crate::mapping::{CELL_M, Cell};
use crate::model::config::{Body, ProximityLayout, ProximityResponse, SensorLayout};
use crate::model::geometry::Pose2;
use crate::model::gradual::{StepBudget, at_once};

const RADIUS_M: f64 = 0.175;
const RESPONSE: ProximityResponse = ProximityResponse {
    range_m: 0.25,
    half_angle_rad: 0.02,
    half_level_m: 0.06,
    skin_m: 0.01,
    near_m: None,
};
/// First column of the wall.
const WALL: i32 = 80;
/// Columns before it that an earlier run took for wall.
const THICKER: i32 = 3;
/// The row in which the robot looks.
const ROW: i32 = 40;

/// A robot with one sensor, straight ahead, in a home with a wall that is too thick.
fn home() -> HomeMap {
    let body = Body {
        radius_m: RADIUS_M,
        swath_m: 0.29,
        track_m: 0.23,
    };
    let ahead = Pose2 {
        x_m: 0.165,
        ..Pose2::IDENTITY
    };
    let sensors = SensorLayout {
        proximity: ProximityLayout::new(&[ahead], RESPONSE),
        ..SensorLayout::default()
    };
    let mut home = HomeMap::new(body, sensors);
    for y in 0..80 {
        for x in 0..WALL + 4 {
            let occupancy = if x < WALL - THICKER { -60 } else { 60 };
            home.grid
                .change(Cell { x, y }, |evidence| evidence.occupancy = occupancy);
        }
    }
    home.derived = at_once(Derived::compute(&mut home.grid, &mut StepBudget::unlimited()));
    home
}

/// Draws what a robot before the wall sees from this place, `times` times.
fn look(home: &mut HomeMap, x_m: f64, times: u32) {
    let budget = &mut StepBudget::unlimited();
    let kept = at_once(KeptHome::of(&home.grid, &home.derived.knowledge, budget));
    let wall_m = f64::from(WALL) * CELL_M;
    let mut sighting = Sighting {
        pose: Pose2 {
            x_m,
            y_m: (f64::from(ROW) + 0.5) * CELL_M,
            heading_rad: 0.0,
        },
        ..Sighting::default()
    };
    sighting.levels[0] = (255.0 * RESPONSE.level(wall_m - x_m - 0.165)) as u8;
    for _ in 0..times {
        home.sensor_model.draw(&sighting, Some(&kept), &mut home.grid);
    }
}

fn occupancy(home: &HomeMap, x: i32) -> i8 {
    home.grid.at(Cell { x, y: ROW }).occupancy
}

#[test]
fn hits_behind_what_is_taken_for_a_wall_count_against_it_and_the_wall_stays() {
    let mut home = home();
    look(&mut home, f64::from(WALL) * CELL_M - 0.28, 20);
    assert!(
        occupancy(&home, WALL - THICKER) < 0,
        "{}",
        occupancy(&home, WALL - THICKER)
    );
    assert!(occupancy(&home, WALL) >= 60, "{}", occupancy(&home, WALL));
}

#[test]
fn the_rim_of_the_body_says_nothing_of_a_wall_and_the_body_within_it_does() {
    let rim_m = f64::from(WALL - THICKER) * CELL_M;
    let mut beside = home();
    look(&mut beside, rim_m - RADIUS_M + 0.05, 5);
    assert!(
        !beside
            .grid
            .at(Cell {
                x: WALL - THICKER,
                y: ROW
            })
            .has(Flag::Driven)
    );
    let mut within = home();
    look(&mut within, rim_m - RADIUS_M + 0.13, 5);
    assert!(
        within
            .grid
            .at(Cell {
                x: WALL - THICKER,
                y: ROW
            })
            .has(Flag::Driven)
    );
}
