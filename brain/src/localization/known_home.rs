//! Tests with a robot with bad wheels and a bad gyro that drives in a flat with a known map.

use super::{Localization, MapCorrection};
use crate::mapping::{CELL_M, Cell, CellKnowledge, Map, Raster, StoredMap};
use crate::model::config::{
    Body, BrainConfig, BumperLayout, ProximityLayout, ProximityResponse, SensorLayout, Speeds,
};
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::observation::{Contacts, Observation};
use crate::model::random::Random;

const RADIUS_M: f64 = 0.175;
pub(super) const TRACK_M: f64 = 0.23;
const STEP_S: f64 = 0.02;
const SPEED_M_PER_S: f64 = 0.25;
const TURN_RAD_PER_S: f64 = 1.2;
/// Errors of wheels and gyro.
const DISTANCE_FACTOR: f64 = 1.012;
const GYRO_SCALE: f64 = 1.008;
const GYRO_BIAS_RAD_PER_S: f64 = 4.0e-4;

pub(super) fn config() -> BrainConfig {
    let poses: Vec<Pose2> = (-3..=3)
        .map(|number| {
            let heading_rad = f64::from(number) * core::f64::consts::FRAC_PI_6;
            Pose2 {
                x_m: 0.165 * heading_rad.cos(),
                y_m: 0.165 * heading_rad.sin(),
                heading_rad,
            }
        })
        .collect();
    let body = Body {
        radius_m: RADIUS_M,
        swath_m: 0.3,
        track_m: TRACK_M,
    };
    let speeds = Speeds {
        cruise_m_per_s: SPEED_M_PER_S,
        max_m_per_s: 0.35,
        turn_max_rad_per_s: 1.5,
    };
    let mut config = BrainConfig::new(body, speeds);
    config.sensors = SensorLayout {
        proximity: ProximityLayout::new(
            &poses,
            ProximityResponse {
                range_m: 0.25,
                half_angle_rad: 0.09,
                half_level_m: 0.06,
                skin_m: 0.01,
                near_m: None,
            },
        ),
        bumper: BumperLayout {
            half_arc_rad: core::f64::consts::FRAC_PI_2,
            overlap_rad: 0.2,
        },
        cliffs: None,
    };
    config
}

/// Two rooms of different size with a door, a cupboard and a table leg.
pub(super) fn flat() -> Map {
    let solid = |x_m: f64, y_m: f64| {
        let outside = !(0.1..=6.1).contains(&x_m) || !(0.1..=3.6).contains(&y_m);
        let wall = (3.6..3.7).contains(&x_m) && !(1.2..2.1).contains(&y_m);
        let short = x_m > 3.6 && y_m > 2.9;
        let cupboard = (0.9..2.2).contains(&x_m) && y_m > 3.1;
        let leg = (1.8..1.9).contains(&x_m) && (1.0..1.1).contains(&y_m);
        outside || wall || short || cupboard || leg
    };
    let mut knowledge = Raster::filled(Cell { x: 0, y: 0 }, 250, 150, CellKnowledge::Free);
    for index in 0..knowledge.values().len() {
        let cell = knowledge.cell(index);
        let middle = |number: i32| (f64::from(number) + 0.5) * CELL_M;
        if solid(middle(cell.x), middle(cell.y)) {
            knowledge.values_mut()[index] = CellKnowledge::Occupied;
        }
    }
    let mut map = Map::new(config().body, config().sensors);
    map.load(&StoredMap::from_raster(&knowledge, None));
    map
}

/// The true robot: drives until it touches something, then turns by a random angle.
pub(super) struct SimulatedRobot<'map> {
    map: &'map Map,
    pub(super) pose: Pose2,
    random: Random,
    turn_left_rad: f64,
    view: Observation,
}

impl<'map> SimulatedRobot<'map> {
    pub(super) fn new(map: &'map Map, pose: Pose2) -> Self {
        Self::seeded(map, pose, 11)
    }

    /// One that turns by other random angles and has other noise.
    pub(super) fn seeded(map: &'map Map, pose: Pose2, seed: u64) -> Self {
        Self {
            map,
            pose,
            random: Random::new(seed),
            turn_left_rad: 0.0,
            view: Observation {
                gyro_heading_rad: Some(0.0),
                proximity: vec![0.0; 7],
                ..Observation::default()
            },
        }
    }

    fn clear_m(&self, at: Point2) -> f64 {
        self.map.distance_field().at(at)
    }

    pub(super) fn step(&mut self) -> &Observation {
        let (distance_m, turn_rad) = if self.turn_left_rad == 0.0 {
            (SPEED_M_PER_S * STEP_S, 0.0)
        } else {
            let most = TURN_RAD_PER_S * STEP_S;
            let turn_rad = self.turn_left_rad.clamp(-most, most);
            self.turn_left_rad -= turn_rad;
            (0.0, turn_rad)
        };
        self.drive(distance_m, turn_rad)
    }

    /// One step of this distance and turn, unless an obstacle blocks it.
    pub(super) fn drive(&mut self, distance_m: f64, turn_rad: f64) -> &Observation {
        self.view.time_us += 20_000;
        let next = self.pose.after_arc(distance_m, turn_rad);
        let touches = self.clear_m(next.position()) < RADIUS_M;
        if touches {
            self.turn_left_rad = self.random.between(1.2, 3.0) * if self.random.coin() { 1.0 } else { -1.0 };
        } else {
            self.pose = next;
            let rim_m = 0.5 * TRACK_M * turn_rad;
            self.view.travel_left_m += distance_m / DISTANCE_FACTOR - rim_m;
            self.view.travel_right_m += distance_m / DISTANCE_FACTOR + rim_m;
        }
        let counted_rad = turn_rad * GYRO_SCALE + GYRO_BIAS_RAD_PER_S * STEP_S;
        self.view.gyro_heading_rad = self.view.gyro_heading_rad.map(|before| before + counted_rad);
        self.view.contacts = Contacts {
            left: touches,
            right: touches,
        };
        self.sense();
        &self.view
    }

    fn sense(&mut self) {
        let layout = config().sensors.proximity;
        for (number, sensor) in layout.sensors().iter().enumerate() {
            let beam = self.pose * *sensor;
            let mut distance_m = 0.0;
            while distance_m < layout.response.range_m {
                let at = beam.transform(Point2 {
                    x_m: distance_m,
                    y_m: 0.0,
                });
                let clear_m = self.clear_m(at);
                if clear_m < 0.09 * distance_m + 0.002 {
                    break;
                }
                distance_m += clear_m.max(0.005);
            }
            let noise = 1.0 + 0.08 * self.random.normal();
            self.view.proximity[number] = (layout.response.level(distance_m) * noise) as f32;
        }
    }

    pub(super) fn off_m(&self, localization: &Localization) -> f64 {
        self.pose.position().distance_m(localization.pose().position())
    }
}

pub(super) const START: Pose2 = Pose2 {
    x_m: 0.6,
    y_m: 0.5,
    heading_rad: 0.3,
};

pub(super) fn placed(map: &Map, at: Pose2) -> Localization {
    let mut localization = Localization::new(TRACK_M, 0.5);
    localization.place_at(at);
    localization.start_monte_carlo(map, &config(), 5);
    localization
}

pub(super) fn take(localization: &mut Localization, view: &Observation) {
    let advance = localization.update(view);
    localization.refine(view, advance);
}

#[test]
fn in_a_known_home_the_pose_does_not_drift() {
    let map = flat();
    let mut truth = SimulatedRobot::new(&map, START);
    let mut localization = placed(&map, START);
    let mut odometry = Localization::new(TRACK_M, 0.5);
    odometry.place_at(START);
    let (mut squares, mut counted_squares) = (0.0, 0.0);
    let steps = 60 * 50 * 10;
    for _ in 0..steps {
        let view = truth.step().clone();
        take(&mut localization, &view);
        odometry.update(&view);
        squares += truth.off_m(&localization) * truth.off_m(&localization);
        counted_squares += truth.off_m(&odometry) * truth.off_m(&odometry);
    }
    let rmse_m = (squares / f64::from(steps)).sqrt();
    let counted_rmse_m = (counted_squares / f64::from(steps)).sqrt();
    assert!(rmse_m < 0.04, "{rmse_m} m");
    assert!(counted_rmse_m > 0.2, "{counted_rmse_m} m");
    let estimate = localization.estimate();
    assert!(!estimate.lost && estimate.sigma_m < 0.2, "{estimate:?}");
    let checkpoint = localization.checkpoint().unwrap();
    let scale = (1.0 + checkpoint.gyro_scale) * GYRO_SCALE - 1.0;
    assert!(scale.abs() < 0.003, "the gyro's scale is still off by {scale}");
}

#[test]
fn in_an_unknown_home_line_slam_keeps_the_pose_and_redraws_the_map() {
    let home = flat();
    let mut truth = SimulatedRobot::new(&home, START);
    let mut localization = Localization::new(TRACK_M, 0.5);
    localization.place_at(START);
    localization.start_line_slam(&config());
    let mut odometry = Localization::new(TRACK_M, 0.5);
    odometry.place_at(START);
    let mut drawn = Map::new(config().body, config().sensors);
    let (mut squares, mut counted_squares) = (0.0, 0.0);
    let steps = 60 * 50 * 20;
    for _ in 0..steps {
        let view = truth.step().clone();
        take_and_draw(&mut localization, &mut drawn, &view);
        odometry.update(&view);
        squares += truth.off_m(&localization) * truth.off_m(&localization);
        counted_squares += truth.off_m(&odometry) * truth.off_m(&odometry);
    }
    let rmse_m = (squares / f64::from(steps)).sqrt();
    let counted_rmse_m = (counted_squares / f64::from(steps)).sqrt();
    assert!(rmse_m < 0.1, "{rmse_m} m");
    assert!(counted_rmse_m > 3.0 * rmse_m, "{counted_rmse_m} m by odometry");
    let scale = (1.0 + localization.odometry.gyro().0) * GYRO_SCALE - 1.0;
    assert!(scale.abs() < 0.003, "the gyro's scale is still off by {scale}");
    drawn.finish_redraw();
    assert!(drawn.redrawn() > 2, "{} times", drawn.redrawn());
    let mut off_m = Vec::new();
    for (index, kind) in drawn.knowledge().values().iter().enumerate() {
        if *kind == CellKnowledge::Occupied {
            let cell = drawn.knowledge().cell(index);
            off_m.push(home.distance_field().cell_m(cell).abs());
        }
    }
    let mean_m = off_m.iter().sum::<f64>() / off_m.len() as f64;
    assert!(
        off_m.len() > 300 && mean_m < 0.065,
        "{} cells, {mean_m} m",
        off_m.len()
    );
}

/// One step of a robot that draws what it sees, as the brain does it.
fn take_and_draw(localization: &mut Localization, map: &mut Map, view: &Observation) {
    let advance = localization.update(view);
    if let Some(MapCorrection::Redraw { keyframes }) = localization.refine(view, advance) {
        map.redraw(&keyframes);
    }
    map.insert(&localization.estimate(), view);
    localization.learn(map, &config(), view.time_us);
}

#[test]
fn an_unknown_room_of_a_known_home_is_learned() {
    let home = flat();
    let mut half = home.knowledge().clone();
    for index in 0..half.values().len() {
        if half.cell(index).x > 146 {
            half.values_mut()[index] = CellKnowledge::Unknown;
        }
    }
    let mut map = Map::new(config().body, config().sensors);
    map.load(&StoredMap::from_raster(&half, None));
    let mut truth = SimulatedRobot::new(&home, START);
    let mut localization = placed(&map, START);
    let steps = 60 * 50 * 25;
    let (mut squares, mut beyond) = (0.0, 0);
    for _ in 0..steps {
        let view = truth.step().clone();
        take_and_draw(&mut localization, &mut map, &view);
        squares += truth.off_m(&localization) * truth.off_m(&localization);
        beyond += u32::from(truth.pose.x_m > 4.0);
        assert!(!localization.estimate().lost);
    }
    let rmse_m = (squares / f64::from(steps)).sqrt();
    assert!(beyond > steps / 10, "it was in the other room");
    assert!(rmse_m < 0.06, "{rmse_m} m");
}

/// A map with the same knowledge.
fn same(map: &Map) -> Map {
    let mut same = Map::new(config().body, config().sensors);
    same.load(&map.stored());
    same
}

/// A robot that is lifted after twenty minutes of its first run: its localization, its map and its last observation.
fn lifted_in_first_run(home: &Map) -> (Localization, Map, Observation) {
    let mut truth = SimulatedRobot::new(home, START);
    let mut localization = Localization::new(TRACK_M, 0.5);
    localization.place_at(START);
    localization.start_line_slam(&config());
    let mut map = Map::new(config().body, config().sensors);
    for _ in 0..60 * 50 * 20 {
        let view = truth.step().clone();
        take_and_draw(&mut localization, &mut map, &view);
    }
    let mut held = truth.view.clone();
    held.wheel_drop = true;
    for _ in 0..100 {
        held.time_us += 20_000;
        take_and_draw(&mut localization, &mut map, &held);
    }
    (localization, map, held)
}

#[test]
fn a_robot_carried_away_in_its_first_run_relocalizes_in_its_own_map() {
    let home = flat();
    let mut offs_m = Vec::new();
    for (x_m, y_m, heading_rad) in [(4.6, 0.8, -2.0), (1.2, 2.0, 1.0), (2.8, 0.6, 3.0)] {
        let mut truth = SimulatedRobot::new(
            &home,
            Pose2 {
                x_m,
                y_m,
                heading_rad,
            },
        );
        truth.random = Random::new(5);
        let (mut localization, map, held) = lifted_in_first_run(&home);
        truth.view = held;
        truth.view.wheel_drop = false;
        let mut map = same(&map);
        // Half of the home looks like the other half, so the pose counts when it lasts.
        let (mut steps, mut known) = (0, 0);
        while known < 1_000 {
            let view = truth.step().clone();
            take_and_draw(&mut localization, &mut map, &view);
            assert!(
                steps > 0 || localization.estimate().lost,
                "it knows that it was carried"
            );
            steps += 1;
            known = if localization.estimate().lost {
                0
            } else {
                known + 1
            };
            assert!(steps < 15_000, "not found within five minutes");
        }
        offs_m.push(truth.off_m(&localization));
    }
    offs_m.sort_by(f64::total_cmp);
    assert!(offs_m[1] < 0.2 && offs_m[2] < 0.21, "{offs_m:?} m");
}

#[test]
fn a_kidnapped_robot_is_lost_and_relocalizes() {
    let map = flat();
    let mut truth = SimulatedRobot::new(&map, START);
    let mut localization = placed(&map, START);
    for _ in 0..2_000 {
        take(&mut localization, truth.step());
    }
    let mut held = truth.view.clone();
    held.wheel_drop = true;
    for _ in 0..100 {
        held.time_us += 20_000;
        take(&mut localization, &held);
    }
    truth.view.time_us = held.time_us;
    truth.pose = Pose2 {
        x_m: 4.6,
        y_m: 0.8,
        heading_rad: -2.0,
    };
    take(&mut localization, truth.step());
    assert!(localization.estimate().lost);
    let mut steps = 0;
    while localization.estimate().lost && steps < 9_000 {
        take(&mut localization, truth.step());
        steps += 1;
    }
    assert!(steps < 9_000, "not found within three minutes");
    assert!(
        truth.off_m(&localization) < 0.15,
        "{} m",
        truth.off_m(&localization)
    );
}

#[test]
fn a_wrong_initial_pose_is_noticed() {
    let map = flat();
    let mut truth = SimulatedRobot::new(&map, START);
    let wrong = Pose2 {
        x_m: 4.8,
        y_m: 1.5,
        heading_rad: 2.0,
    };
    let mut localization = placed(&map, wrong);
    let noticed = (0..6_000).any(|_| {
        take(&mut localization, truth.step());
        localization.estimate().lost
    });
    assert!(noticed);
}

#[test]
fn equal_checkpoints_continue_bit_identically() {
    let map = flat();
    let mut truth = SimulatedRobot::new(&map, START);
    let mut before = placed(&map, START);
    for _ in 0..3_000 {
        take(&mut before, truth.step());
    }
    let checkpoint = before.checkpoint().unwrap();
    let resumed = || {
        let mut localization = placed(&map, before.pose());
        localization.resume_tracking(checkpoint);
        localization
    };
    let (mut one, mut other) = (resumed(), resumed());
    for _ in 0..3_000 {
        let view = truth.step().clone();
        take(&mut one, &view);
        take(&mut other, &view);
        assert_eq!(one.estimate(), other.estimate());
    }
    assert!(truth.off_m(&one) < 0.15, "{} m", truth.off_m(&one));
}

#[test]
fn nothing_from_outside_upsets_the_filter() {
    let map = flat();
    let mut localization = placed(&map, START);
    let mut random = Random::new(3);
    let odd = [f64::NAN, f64::INFINITY, -1.0, 0.0, 0.5, 1e300];
    let mut pick = || odd[(random.between(0.0, 6.0) as usize).min(5)];
    for step in 0..2_000 {
        let view = Observation {
            time_us: step * 20_000,
            travel_left_m: pick(),
            travel_right_m: pick(),
            gyro_heading_rad: Some(pick()),
            proximity: (0..(step % 9)).map(|_| pick() as f32).collect(),
            wheel_drop: step % 100 > 20,
            ..Observation::default()
        };
        take(&mut localization, &view);
        let pose = localization.pose();
        assert!((pose.x_m + pose.y_m + normalize_rad(pose.heading_rad)).is_finite());
    }
}

#[test]
fn a_map_drawn_by_odometry_alone_is_not_used() {
    let home = flat();
    let mut truth = SimulatedRobot::new(&home, START);
    let mut odometry = Localization::new(TRACK_M, 0.5);
    odometry.place_at(START);
    let mut drawn = Map::new(config().body, config().sensors);
    for _ in 0..60 * 50 * 5 {
        let view = truth.step().clone();
        odometry.update(&view);
        drawn.insert(&odometry.estimate(), &view);
    }
    drawn.refresh();
    let solid = drawn
        .knowledge()
        .values()
        .iter()
        .filter(|kind| **kind == CellKnowledge::Occupied);
    assert!(solid.count() > 100, "there is something to compare with");
    assert_eq!(placed(&drawn, START).checkpoint(), None);
    assert!(placed(&home, START).checkpoint().is_some());
}
