//! A robot in two rooms that its infrared sensors cannot tell apart.

use super::super::Localization;
use super::super::known_home::{START, SimulatedRobot, TRACK_M, config, take};
use crate::mapping::{CELL_M, Cell, CellKnowledge, Map, Raster, StoredMap};
use crate::model::geometry::{Point2, Pose2};
use crate::model::observation::{BeaconSignal, BeaconStrength, Observation};
use crate::model::random::Random;

/// Distance between the two rooms, metres.
const APART_M: f64 = 4.0;
const BEACONS: [Point2; 2] = [Point2 { x_m: 0.5, y_m: 3.0 }, Point2 { x_m: 7.0, y_m: 0.5 }];

/// Two equal rooms with a column each, without a connection.
fn twins() -> Map {
    let solid = |x_m: f64, y_m: f64| {
        let in_room = |x_m: f64| {
            let column = (1.6..1.9).contains(&x_m) && (1.0..1.3).contains(&y_m);
            let shelf = x_m < 0.9 && y_m > 2.6;
            (0.1..3.4).contains(&x_m) && (0.1..3.4).contains(&y_m) && !column && !shelf
        };
        !in_room(x_m) && !in_room(x_m - APART_M)
    };
    let mut knowledge = Raster::filled(Cell { x: 0, y: 0 }, 300, 140, CellKnowledge::Free);
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

/// Received strengths: 20 dB less for ten times the distance, and packets that fade.
fn receive(view: &Observation, at: Point2, random: &mut Random) -> Observation {
    let strength = |(number, beacon): (usize, &Point2)| {
        let away_m = beacon.distance_m(at).max(0.3);
        BeaconSignal::Strength(BeaconStrength {
            beacon: number as u16,
            dbm: -59.0 - 20.0 * away_m.log10() + 4.0 * random.normal(),
        })
    };
    Observation {
        beacons: BEACONS.iter().enumerate().map(strength).collect(),
        ..view.clone()
    }
}

fn in_second(pose: Pose2) -> Pose2 {
    Pose2 {
        x_m: pose.x_m + APART_M,
        ..pose
    }
}

/// Drives in both rooms, is carried to the second one, and drives on. Returns the error there in metres, unless the robot is lost.
fn off_after_lifting_m(hears: impl Fn(&Observation, Point2, &mut Random) -> Observation) -> Option<f64> {
    let map = twins();
    let mut random = Random::new(5);
    let mut localization = Localization::new(TRACK_M, 0.5);
    localization.place_at(START);
    localization.start_monte_carlo(&map, &config(), 5);
    let mut truth = SimulatedRobot::new(&map, START);
    let drive = |truth: &mut SimulatedRobot<'_>, localization: &mut Localization, random: &mut Random| {
        for _ in 0..50 * 240 {
            let view = truth.step().clone();
            take(localization, &hears(&view, truth.pose.position(), random));
        }
    };
    drive(&mut truth, &mut localization, &mut random);
    truth.pose = in_second(truth.pose);
    localization.place_at(in_second(localization.pose()));
    drive(&mut truth, &mut localization, &mut random);
    for _ in 0..100 {
        let view = truth.drive(0.0, 0.0).clone();
        take(
            &mut localization,
            &Observation {
                wheel_drop: true,
                ..view
            },
        );
    }
    truth.pose = in_second(START);
    drive(&mut truth, &mut localization, &mut random);
    (!localization.estimate().lost).then(|| truth.off_m(&localization))
}

#[test]
fn signal_strengths_tell_equal_rooms_apart() {
    let by_sight = off_after_lifting_m(|view, _, _| view.clone());
    assert!(
        by_sight.is_none_or(|off_m| off_m > 1.0),
        "there is no telling: {by_sight:?}"
    );
    let by_strength = off_after_lifting_m(receive);
    assert!(by_strength.is_some_and(|off_m| off_m < 0.1), "{by_strength:?}");
}

#[test]
fn signal_strengths_give_no_pose() {
    let map = twins();
    let mut random = Random::new(7);
    let mut truth = SimulatedRobot::new(&map, START);
    let placed = || {
        let mut localization = Localization::new(TRACK_M, 0.5);
        localization.place_at(START);
        localization
    };
    let (mut listens, mut counts) = (placed(), placed());
    for _ in 0..50 * 120 {
        let view = Observation {
            gyro_heading_rad: None,
            ..truth.step().clone()
        };
        take(&mut listens, &receive(&view, truth.pose.position(), &mut random));
        take(&mut counts, &view);
        assert_eq!(listens.pose(), counts.pose());
    }
    assert!(!listens.beacons.are_heard() && !listens.knows_heading(truth.drive(0.0, 0.0).time_us));
}
