//! What the map of the home costs: `cargo run --release -p brain --example map_cost`.
//!
//! Processor time, as Linux counts it for the thread, so that other work on the machine does not matter.
//!
//! A robot with seven proximity sensors drives lanes through a hall of 12 x 12 m with pillars, 50 reports a second.

use std::fs;

use brain::{
    Body, CELL_M, Cell, CellKnowledge, DistanceField, Map, Observation, Point2, Pose2, PoseEstimate,
    ProximityLayout, ProximityResponse, Raster, SensorLayout, StoredMap,
};

const BODY: Body = Body {
    radius_m: 0.175,
    swath_m: 0.30,
    track_m: 0.23,
};
const RESPONSE: ProximityResponse = ProximityResponse {
    range_m: 0.25,
    half_angle_rad: 0.087,
    half_level_m: 0.06,
    skin_m: 0.01,
    near_m: None,
};
const HALL_CELLS: i32 = 480;
const STEP_M: f64 = 0.005;
const REPORTS_PER_S: f64 = 50.0;

fn hall() -> DistanceField {
    let mut hall = Raster::filled(
        Cell { x: -8, y: -8 },
        HALL_CELLS as usize + 16,
        HALL_CELLS as usize + 16,
        CellKnowledge::Occupied,
    );
    for y in 0..HALL_CELLS {
        for x in 0..HALL_CELLS {
            let is_pillar = x % 96 > 70 && y % 80 > 60;
            if let Some(kind) = hall.get_mut(Cell { x, y })
                && !is_pillar
            {
                *kind = CellKnowledge::Free;
            }
        }
    }
    DistanceField::new(&hall)
}

fn sensors() -> SensorLayout {
    let poses: Vec<Pose2> = [-90.0_f64, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0]
        .map(|degrees| {
            let heading_rad = degrees.to_radians();
            let (sin, cos) = heading_rad.sin_cos();
            Pose2 {
                x_m: 0.165 * cos,
                y_m: 0.165 * sin,
                heading_rad,
            }
        })
        .to_vec();
    SensorLayout {
        proximity: ProximityLayout::new(&poses, RESPONSE),
        ..SensorLayout::default()
    }
}

fn level(hall: &DistanceField, beam: Pose2) -> f32 {
    let mut way_m = 0.0;
    while way_m < RESPONSE.range_m {
        let clear_m = hall.at(beam.transform(Point2 { x_m: way_m, y_m: 0.0 }));
        if clear_m < 0.004 {
            return RESPONSE.level(way_m) as f32;
        }
        way_m += clear_m;
    }
    0.0
}

/// Lanes up and down, 25 cm apart, not through pillars.
fn way(hall: &DistanceField) -> Vec<(Pose2, Observation)> {
    let layout = sensors();
    let mut reports = Vec::new();
    let edge_m = f64::from(HALL_CELLS) * CELL_M;
    let steps = ((edge_m - 0.4) / STEP_M) as u32;
    for lane in 0..46 {
        let heading_rad = if lane % 2 == 0 { 0.0 } else { core::f64::consts::PI };
        for step in 0..steps {
            let along_m = 0.2 + STEP_M * f64::from(step);
            let x_m = if lane % 2 == 0 { along_m } else { edge_m - along_m };
            let pose = Pose2 {
                x_m,
                y_m: 0.2 + 0.25 * f64::from(lane),
                heading_rad,
            };
            if hall.at(pose.position()) < BODY.radius_m {
                continue;
            }
            let proximity = layout.proximity.sensors().iter();
            let observation = Observation {
                time_us: reports.len() as u64 * 20_000,
                proximity: proximity.map(|sensor| level(hall, pose * *sensor)).collect(),
                ..Observation::default()
            };
            reports.push((pose, observation));
        }
    }
    reports
}

fn processor_s() -> f64 {
    let counted = fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = counted
        .split(' ')
        .next()
        .and_then(|word| word.parse::<f64>().ok());
    nanoseconds.unwrap_or(f64::NAN) * 1e-9
}

fn main() {
    let hall = hall();
    let reports = way(&hall);
    let mut map = Map::new(BODY, sensors());
    let started_s = processor_s();
    for (pose, observation) in &reports {
        let estimate = PoseEstimate {
            pose: *pose,
            sigma_m: 0.02,
            ..PoseEstimate::default()
        };
        map.insert(&estimate, observation);
    }
    let simulated_s = reports.len() as f64 / REPORTS_PER_S;
    let per_s = (processor_s() - started_s) * 1e6 / simulated_s;
    println!("insert, refresh and survey: {per_s:.0} us per simulated second over {simulated_s:.0} s");
    let mib = map.memory_bytes() as f64 / f64::from(1 << 20);
    println!("memory: {mib:.1} MiB");
    let timed = |what: &str, work: &mut dyn FnMut()| {
        let started_s = processor_s();
        work();
        println!("{what}: {:.1} ms", (processor_s() - started_s) * 1e3);
    };
    timed("survey of rooms", &mut || map.survey());
    timed("walls", &mut || println!("{} walls", map.walls().len()));
    timed("reachable", &mut || {
        let reached = map.reachable(Point2 { x_m: 0.3, y_m: 0.3 }, BODY.radius_m);
        println!(
            "{} cells",
            reached.values().iter().filter(|there| **there).count()
        );
    });
    timed("distance field at once", &mut || {
        let same = DistanceField::new(map.knowledge()) == *map.distance_field();
        println!("the same as piece by piece: {same}");
    });
    let mut stored = StoredMap::default();
    timed("storing", &mut || stored = map.stored());
    println!("stored: {} runs", stored.parts().cells.len());
    timed("taking up", &mut || Map::new(BODY, sensors()).take_up(&stored));
    timed("drawing again", &mut || {
        map.redraw(&[brain::Keyframe {
            time_us: 0,
            was: Pose2::IDENTITY,
            is: Pose2::IDENTITY,
        }]);
        map.finish_redraw();
    });
}
