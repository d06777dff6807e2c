//! The map of the home: from observations and from hand-made rasters to knowledge, distances, rooms, doors and walls.

use brain::mapping::{Door, FAR_M, Keyframe, Rooms};
use brain::observation::{Cliffs, Contacts};
use brain::{
    Body, CELL_M, Cell, CellKnowledge, DistanceField, EditError, Map, NoGo, Observation, Point2, Pose2,
    PoseEstimate, ProximityLayout, ProximityResponse, Raster, RoomName, SensorLayout, StoredMap, Zone,
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

fn sensors() -> SensorLayout {
    let poses: Vec<Pose2> = [-90.0_f64, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0]
        .iter()
        .map(|degrees| {
            let heading_rad = degrees.to_radians();
            Pose2 {
                x_m: 0.165 * heading_rad.cos(),
                y_m: 0.165 * heading_rad.sin(),
                heading_rad,
            }
        })
        .collect();
    SensorLayout {
        proximity: ProximityLayout::new(&poses, RESPONSE),
        cliffs: Some([(0.095, 0.13), (0.155, 0.0), (0.095, -0.13)].map(|(x_m, y_m)| Point2 { x_m, y_m })),
        ..SensorLayout::default()
    }
}

fn at(x_m: f64, y_m: f64, heading_rad: f64) -> Pose2 {
    Pose2 {
        x_m,
        y_m,
        heading_rad,
    }
}

fn point(x_m: f64, y_m: f64) -> Point2 {
    Point2 { x_m, y_m }
}

/// A map that is fed pose by pose, 50 reports a second.
struct Fed {
    map: Map,
    time_us: u64,
}

impl Fed {
    fn new(sensors: SensorLayout) -> Self {
        Self {
            map: Map::new(BODY, sensors),
            time_us: 0,
        }
    }

    fn see(&mut self, pose: Pose2, observation: &Observation) {
        self.time_us += 20_000;
        let estimate = PoseEstimate {
            pose,
            odom: pose,
            sigma_m: 0.01,
            ..PoseEstimate::default()
        };
        let observation = Observation {
            time_us: self.time_us,
            ..observation.clone()
        };
        self.map.insert(&estimate, &observation);
    }

    fn knows(&mut self, x_m: f64, y_m: f64) -> CellKnowledge {
        self.map.refresh();
        self.map
            .knowledge()
            .get(Cell::under(point(x_m, y_m)))
            .copied()
            .unwrap_or_default()
    }
}

/// Levels of the seven sensors before a wall at `wall_y_m` to the left of a robot that drives along x.
fn along_wall(pose: Pose2, wall_y_m: f64) -> Observation {
    let proximity = sensors()
        .proximity
        .sensors()
        .iter()
        .map(|sensor| {
            let beam = pose * *sensor;
            let distance_m = (wall_y_m - beam.y_m) / beam.heading_rad.sin();
            let seen = beam.heading_rad.sin() > 1e-6;
            if seen {
                RESPONSE.level(distance_m) as f32
            } else {
                0.0
            }
        })
        .collect();
    Observation {
        proximity,
        ..Observation::default()
    }
}

fn drive_along_wall(fed: &mut Fed, believed: impl Fn(Pose2) -> Pose2) {
    for step in 0..300 {
        let pose = at(0.005 * f64::from(step), 0.0, 0.0);
        fed.see(believed(pose), &along_wall(pose, 0.25));
    }
}

#[test]
fn a_wall_along_the_path_is_one_row_of_cells_right_behind_its_surface() {
    let mut fed = Fed::new(sensors());
    drive_along_wall(&mut fed, |pose| pose);
    for column in 4..56 {
        let x_m = 0.025 * f64::from(column) + 0.01;
        assert_eq!(fed.knows(x_m, 0.26), CellKnowledge::Occupied, "wall at {x_m}");
        assert_eq!(fed.knows(x_m, 0.21), CellKnowledge::Free, "before it at {x_m}");
        assert_eq!(fed.knows(x_m, 0.30), CellKnowledge::Unknown, "behind it at {x_m}");
        assert_eq!(fed.knows(x_m, 0.0), CellKnowledge::Free, "the path at {x_m}");
    }
    let clear_m = fed.map.distance_field().at(point(0.7, 0.0));
    assert!((clear_m - 0.25).abs() < 0.02, "{clear_m} m to the wall");
    let away = fed.map.distance_field().gradient(point(0.7, 0.1));
    assert!(away.y_m < -0.8 && away.x_m.abs() < 0.2, "{away:?}");
}

#[test]
fn a_contact_is_an_obstacle_until_the_body_has_been_there() {
    let mut fed = Fed::new(SensorLayout::default());
    fed.see(at(0.0, 0.0, 0.0), &Observation::default());
    let hit = Observation {
        contacts: Contacts {
            left: true,
            right: true,
        },
        ..Observation::default()
    };
    fed.see(at(0.5, 0.0, 0.0), &hit);
    assert_eq!(fed.knows(0.69, 0.0), CellKnowledge::Occupied);
    assert_eq!(fed.knows(0.5, 0.0), CellKnowledge::Free);
    assert_eq!(fed.knows(0.69, 0.15), CellKnowledge::Unknown);
    for step in 0..30 {
        fed.see(
            at(0.5 + 0.013 * f64::from(step), 0.0, 0.0),
            &Observation::default(),
        );
    }
    assert_eq!(fed.knows(0.69, 0.0), CellKnowledge::Free, "it was moved away");
}

#[test]
fn a_cliff_stays_although_the_body_reaches_over_it() {
    let mut fed = Fed::new(sensors());
    let edge = Observation {
        cliffs: Cliffs {
            middle: true,
            ..Cliffs::default()
        },
        ..Observation::default()
    };
    fed.see(at(0.0, 0.0, 0.0), &edge);
    for step in 0..20 {
        fed.see(at(-0.013 * f64::from(step), 0.0, 0.0), &Observation::default());
    }
    assert_eq!(fed.knows(0.155, 0.001), CellKnowledge::Cliff);
    let floor = fed.map.reachable(point(-0.2, 0.0), 0.05);
    assert_eq!(floor.get(Cell::under(point(0.155, 0.001))), Some(&false));
}

#[test]
fn a_robot_that_is_lost_lifted_or_without_a_link_draws_nothing() {
    let mut fed = Fed::new(sensors());
    let lifted = Observation {
        wheel_drop: true,
        ..Observation::default()
    };
    fed.see(at(0.0, 0.0, 0.0), &lifted);
    let silent = Observation {
        link_up: false,
        ..Observation::default()
    };
    fed.see(at(0.1, 0.0, 0.0), &silent);
    fed.see(at(f64::NAN, 0.0, 0.0), &Observation::default());
    fed.see(at(1e300, 0.0, 0.0), &Observation::default());
    let lost = PoseEstimate {
        lost: true,
        ..PoseEstimate::default()
    };
    fed.map.insert(&lost, &Observation::default());
    fed.map.refresh();
    assert!(fed.map.knowledge().values().is_empty());
    assert!(fed.map.stored().is_empty());
}

#[test]
fn a_redrawn_map_is_the_map_of_the_corrected_poses() {
    let bent = |pose: Pose2| at(pose.x_m, 0.2 * pose.x_m, 0.2);
    let mut drifted = Fed::new(sensors());
    drive_along_wall(&mut drifted, bent);
    assert_ne!(drifted.knows(1.2, 0.26), CellKnowledge::Occupied);
    let keyframe = |step: u64| {
        let is = at(0.005 * step as f64, 0.0, 0.0);
        Keyframe {
            time_us: 20_000 * (step + 1),
            odom_from_base: bent(is),
            map_from_base: is,
        }
    };
    let keyframes: Vec<Keyframe> = (0..300)
        .step_by(20)
        .map(keyframe)
        .chain([keyframe(299)])
        .collect();
    drifted.map.redraw(&keyframes);
    drifted.map.finish_redraw();
    assert_eq!(drifted.map.redrawn(), 1);
    let mut right = Fed::new(sensors());
    drive_along_wall(&mut right, |pose| pose);
    right.map.refresh();
    let mut apart = 0;
    for (index, kind) in right.map.knowledge().values().iter().enumerate() {
        let cell = right.map.knowledge().cell(index);
        apart += usize::from(
            drifted
                .map
                .knowledge()
                .get(cell)
                .unwrap_or(&CellKnowledge::Unknown)
                != kind,
        );
    }
    let known = right.map.knowledge().values().iter();
    let known = known.filter(|kind| **kind != CellKnowledge::Unknown).count();
    // Not all of them: which reports are drawn depends on the estimated path.
    assert!(50 * apart <= known, "{apart} of {known} cells differ");
}

#[test]
fn a_stored_map_is_the_same_when_loaded() {
    let mut fed = Fed::new(sensors());
    drive_along_wall(&mut fed, |pose| pose);
    let corners = [(0.05, 0.0), (0.1, 0.0), (0.1, 0.05), (0.05, 0.05)];
    let forbidden = Zone::new(corners.map(|(x_m, y_m)| at(x_m, y_m, 0.0).position()).to_vec()).unwrap();
    fed.map.add_no_go(NoGo::zone(&forbidden).unwrap()).unwrap();
    fed.map.measure_dock(at(0.25, 0.5, -1.0));
    fed.map.refresh();
    let stored = fed.map.stored();
    // Three or four bytes each.
    let runs = stored.parts().cells.len();
    assert!(runs < 1000, "{runs} runs for 1.5 m of wall");
    let mut again = Map::new(BODY, sensors());
    again.load(&StoredMap::from_parts(stored.parts()).unwrap());
    for (index, kind) in fed.map.knowledge().values().iter().enumerate() {
        let cell = fed.map.knowledge().cell(index);
        assert_eq!(
            again.knowledge().get(cell).unwrap_or(&CellKnowledge::Unknown),
            kind
        );
    }
    assert_eq!(
        again.knowledge().get(Cell { x: 3, y: 0 }),
        Some(&CellKnowledge::NoGo)
    );
    let dock = again.dock().unwrap();
    assert!((dock.x_m - 0.25).abs() < 1e-6 && (dock.heading_rad + 1.0).abs() < 1e-6);
    assert_eq!(again.stored(), stored, "storing it again gives the same");
}

#[test]
fn a_reshaped_no_go_zone_forbids_only_its_new_floor_and_keeps_number_and_name() {
    let mut fed = Fed::new(sensors());
    drive_along_wall(&mut fed, |pose| pose);
    let zone = |x_m: f64| {
        let corners = [(x_m, 0.0), (x_m + 0.05, 0.0), (x_m + 0.05, 0.05), (x_m, 0.05)];
        let corners = corners.map(|(x_m, y_m)| at(x_m, y_m, 0.0).position());
        NoGo::zone(&Zone::new(corners.to_vec()).unwrap()).unwrap()
    };
    let name = RoomName::new("Cats").ok();
    fed.map.add_no_go(zone(0.05).with_name(name.clone())).unwrap();
    fed.map.add_no_go(zone(0.1)).unwrap();
    fed.map.reshape_no_go(1, zone(0.2)).unwrap();
    let kinds = |map: &Map| [3, 5, 9].map(|x| map.knowledge().get(Cell { x, y: 0 }).copied());
    let (free, shut) = (Some(CellKnowledge::Free), Some(CellKnowledge::NoGo));
    fed.map.refresh();
    assert_eq!(kinds(&fed.map), [free, shut, shut]);
    let known: Vec<_> = fed.map.annotations().no_go().collect();
    assert_eq!(known, [(1, &zone(0.2).with_name(name)), (2, &zone(0.1))]);
    assert_eq!(
        fed.map.reshape_no_go(1, zone(40.0)),
        Err(EditError::NoFloorThere),
        "far outside there is nothing to forbid"
    );
    assert_eq!(fed.map.reshape_no_go(3, zone(0.2)), Err(EditError::NoSuchNoGo));
    fed.map.refresh();
    assert_eq!(
        kinds(&fed.map),
        [free, shut, shut],
        "what is refused changes nothing"
    );
}

#[test]
fn incremental_distances_are_those_computed_at_once() {
    let mut fed = Fed::new(sensors());
    for step in 0..400_u32 {
        let angle = 0.05 * f64::from(step);
        let pose = at(1.2 * (0.4 * angle).cos(), 0.9 * (0.3 * angle).sin(), angle);
        let levels = (0..7).map(|sensor| f32::from(((step * 7 + sensor * 13) % 97) as u8) / 97.0);
        let observation = Observation {
            proximity: levels.collect(),
            ..Observation::default()
        };
        fed.see(pose, &observation);
        if step % 23 == 0 {
            fed.map.refresh();
        }
    }
    fed.map.refresh();
    assert!(fed.map.knowledge().values().contains(&CellKnowledge::Occupied));
    assert_eq!(fed.map.distance_field(), &DistanceField::new(fed.map.knowledge()));
}

#[test]
fn distances_are_those_of_brute_force() {
    let mut knowledge = Raster::filled(Cell { x: -5, y: 9 }, 50, 37, CellKnowledge::Free);
    for (x, y) in [(0, 10), (1, 10), (30, 40), (44, 45), (-5, 30)] {
        *knowledge.get_mut(Cell { x, y }).unwrap() = CellKnowledge::Occupied;
    }
    let field = DistanceField::new(&knowledge);
    let occupied: Vec<Cell> = (0..knowledge.values().len())
        .filter(|index| knowledge.values()[*index] == CellKnowledge::Occupied)
        .map(|index| knowledge.cell(index))
        .collect();
    for index in 0..knowledge.values().len() {
        let cell = knowledge.cell(index);
        let nearest_m = occupied
            .iter()
            .map(|other| CELL_M * f64::from(other.x - cell.x).hypot(f64::from(other.y - cell.y)))
            .fold(f64::INFINITY, f64::min);
        let expected_m = if nearest_m == 0.0 {
            -0.5 * CELL_M
        } else {
            (nearest_m - 0.5 * CELL_M).min(FAR_M)
        };
        let found_m = field.cell_m(cell);
        assert!(
            (found_m - expected_m).abs() <= 0.001,
            "{found_m} at {cell:?}, not {expected_m}"
        );
    }
    assert_eq!(field.cell_m(Cell { x: 900, y: 0 }), FAR_M);
    assert_eq!(field.at(point(-9.0, 900.0)), FAR_M);
}

/// Metres as a rectangle of cells of one kind.
fn paint(
    knowledge: &mut Raster<CellKnowledge>,
    (x_m, y_m): (f64, f64),
    (to_x_m, to_y_m): (f64, f64),
    kind: CellKnowledge,
) {
    for index in 0..knowledge.values().len() {
        let cell = knowledge.cell(index);
        let (x, y) = (
            (f64::from(cell.x) + 0.5) * CELL_M,
            (f64::from(cell.y) + 0.5) * CELL_M,
        );
        if (x_m..to_x_m).contains(&x) && (y_m..to_y_m).contains(&y) {
            knowledge.values_mut()[index] = kind;
        }
    }
}

/// Three rooms in a row along x, 4, 3 and 2.5 m long and 3 m deep, with doors of 0.8 m; the first has a table in it.
fn three_rooms(origin: (f64, f64)) -> Raster<CellKnowledge> {
    let cell = Cell::under(point(origin.0 - 0.5, origin.1 - 0.5));
    let mut home = Raster::filled(cell, 440, 170, CellKnowledge::Unknown);
    let mut draw = |from: (f64, f64), to: (f64, f64), kind| {
        paint(
            &mut home,
            (origin.0 + from.0, origin.1 + from.1),
            (origin.0 + to.0, origin.1 + to.1),
            kind,
        );
    };
    draw((-0.1, -0.1), (9.8, 3.1), CellKnowledge::Occupied);
    draw((0.0, 0.0), (4.0, 3.0), CellKnowledge::Free);
    draw((4.1, 0.0), (7.1, 3.0), CellKnowledge::Free);
    draw((7.2, 0.0), (9.7, 3.0), CellKnowledge::Free);
    draw((4.0, 1.0), (4.1, 1.8), CellKnowledge::Free);
    draw((7.1, 2.0), (7.2, 2.8), CellKnowledge::Free);
    draw((1.2, 1.2), (2.2, 1.8), CellKnowledge::Occupied);
    home
}

#[test]
fn doors_divide_rooms_and_furniture_does_not() {
    let rooms = Rooms::default().segmented(&three_rooms((0.0, 0.0)));
    let areas: Vec<f64> = rooms.rooms().iter().map(|room| room.area_m2).collect();
    assert_eq!(areas.len(), 3, "{areas:?}");
    for (found, expected) in areas.iter().zip([12.0, 9.0, 7.5]) {
        assert!((found - expected).abs() < 0.3, "{found} m2 instead of {expected}");
    }
    let doors: Vec<Door> = rooms.doors().to_vec();
    assert_eq!(doors.len(), 2, "{doors:?}");
    assert_eq!([doors[0].rooms, doors[1].rooms], [[1, 2], [2, 3]]);
    for (door, x_m, y_m) in [(doors[0], 4.05, 1.4), (doors[1], 7.15, 2.4)] {
        assert!(door.at.distance_m(point(x_m, y_m)) < 0.15, "{door:?}");
        assert!((door.width_m - 0.8).abs() < 0.08, "{door:?}");
    }
    assert_eq!(rooms.room_at(point(0.5, 0.5)), Some(1));
    assert_eq!(rooms.room_at(point(9.5, 0.5)), Some(3));
    assert_eq!(rooms.room_at(point(-0.05, 0.5)), None);
}

#[test]
fn rooms_keep_their_identities_when_the_home_is_mapped_again() {
    let mut half = three_rooms((0.0, 0.0));
    paint(&mut half, (-0.2, -0.2), (4.0, 3.2), CellKnowledge::Unknown);
    let before = Rooms::default().segmented(&half);
    assert_eq!(before.rooms().len(), 2);
    let (middle, last) = (before.room_at(point(5.5, 1.5)), before.room_at(point(8.5, 1.0)));
    // Mapped again with an error of 12 cm, and with the missing room.
    let after = before.segmented(&three_rooms((0.12, -0.12)));
    assert_eq!(after.room_at(point(5.5, 1.5)), middle);
    assert_eq!(after.room_at(point(8.5, 1.0)), last);
    assert_eq!(
        after.room_at(point(2.0, 0.5)),
        Some(3),
        "the new one gets a new identity"
    );
    let mut map = Map::new(BODY, SensorLayout::default());
    map.load(&StoredMap::from_raster(&half, None));
    let stored = map.stored();
    let mut again = Map::new(BODY, SensorLayout::default());
    again.load(&stored);
    assert_eq!(again.rooms(), map.rooms(), "rooms outlive the disk");
    assert_eq!(again.rooms().rooms().len(), 2);
}

#[test]
fn walls_are_straight_and_in_the_right_place() {
    let mut map = Map::new(BODY, SensorLayout::default());
    map.load(&StoredMap::from_raster(&three_rooms((0.0, 0.0)), None));
    let walls = map.walls();
    let longest = walls
        .iter()
        .map(|wall| wall.from.distance_m(wall.to))
        .fold(0.0, f64::max);
    assert!(longest > 9.0, "the outer wall is one: {longest} m");
    for (from, to) in [
        (point(0.5, -0.0125), point(9.0, -0.0125)),
        (point(-0.0125, 0.5), point(-0.0125, 2.5)),
        (point(4.0125, 2.0), point(4.0125, 2.8)),
    ] {
        let lies_on = |wall: &&brain::mapping::WallSegment| {
            let length_m = wall.from.distance_m(wall.to);
            [from, to].iter().all(|end| {
                let way_m = wall.from.distance_m(*end) + wall.to.distance_m(*end);
                way_m - length_m < 0.02
            })
        };
        assert!(walls.iter().any(|wall| lies_on(&wall)), "no wall from {from:?}");
    }
    for wall in &walls {
        let (dx, dy) = (wall.to.x_m - wall.from.x_m, wall.to.y_m - wall.from.y_m);
        assert!(dx.abs() < 0.06 || dy.abs() < 0.06, "askew: {wall:?}");
        assert!(wall.sigma_m < 0.02, "{wall:?}");
    }
}

#[test]
fn the_body_reaches_the_floor_into_which_it_fits() {
    let home = three_rooms((0.0, 0.0));
    let mut map = Map::new(BODY, SensorLayout::default());
    map.load(&StoredMap::from_raster(&home, None));
    let area_m2 = |clearance_m: f64| {
        let cells = map.reachable(point(0.5, 0.5), clearance_m);
        cells.values().iter().filter(|there| **there).count() as f64 * CELL_M * CELL_M
    };
    assert!(
        (area_m2(0.0) - 28.06).abs() < 0.3,
        "all three rooms: {}",
        area_m2(0.0)
    );
    assert!(area_m2(0.45) < 12.0, "too wide for a door: {}", area_m2(0.45));
    let beside = map.reachable(point(0.5, 0.5), 0.175);
    assert_eq!(beside.get(Cell::under(point(8.5, 1.0))), Some(&true));
    assert_eq!(
        beside.get(Cell::under(point(8.5, 0.1))),
        Some(&false),
        "too near the wall"
    );
    assert_eq!(
        beside.get(Cell::under(point(1.7, 1.5))),
        Some(&false),
        "in the table"
    );
}

#[test]
fn a_map_reports_its_confidence_and_the_share_of_contacts() {
    let mut seen = Fed::new(sensors());
    assert_eq!(seen.map.confidence(), None, "nothing is known");
    drive_along_wall(&mut seen, |pose| pose);
    seen.map.refresh();
    let seen = seen.map.confidence().expect("there is floor");
    assert!((seen.sigma_m - 0.01).abs() < 0.002, "{seen:?}");
    assert!(seen.touched < 0.1 && seen.driven < 1.0, "{seen:?}");
    let mut blind = Fed::new(SensorLayout::default());
    for lane in 0..8 {
        let y_m = 0.1 * f64::from(lane);
        (0..200).for_each(|step| blind.see(at(0.005 * f64::from(step), y_m, 0.0), &Observation::default()));
        for _ in 0..10 {
            let touching = Observation {
                contacts: Contacts {
                    left: true,
                    right: true,
                },
                ..Observation::default()
            };
            blind.see(at(1.0, y_m, 0.0), &touching);
            blind.see(at(0.95, y_m, 0.0), &Observation::default());
        }
    }
    blind.map.refresh();
    let blind = blind.map.confidence().expect("there is floor");
    assert!(blind.touched > 0.9 && blind.driven > 0.9, "{blind:?}");
}
