//! What is felt of the floor, in the map: drawn, drawn again, stored and taken up.

use super::{FloorFelt, FloorKind};
use crate::mapping::{Cell, Keyframe, Map};
use crate::model::config::{Body, SensorLayout};
use crate::model::geometry::{Point2, Pose2};
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

const BODY: Body = Body {
    radius_m: 0.17,
    swath_m: 0.26,
    track_m: 0.24,
};
const STEP_US: u64 = 50_000;
const STEP_M: f64 = 0.0126;
/// Where the loads are of, behind the robot.
const BEHIND_MM: u8 = 75;

/// A robot that drives along x, again and again, and a rug from 1 m to 2 m.
struct Walker {
    map: Map,
    time_us: u64,
}

impl Walker {
    fn new() -> Self {
        Self {
            map: Map::new(BODY, SensorLayout::default()),
            time_us: 0,
        }
    }

    /// Drives three metres; `believed` is where it takes itself to be.
    fn drive(&mut self, y_m: f64, is_rug: impl Fn(f64) -> bool, believed: impl Fn(Pose2) -> Pose2) {
        for step in 0..240 {
            let x_m = STEP_M * f64::from(step);
            self.time_us += STEP_US;
            let pose = believed(Pose2 {
                x_m,
                y_m,
                heading_rad: 0.0,
            });
            let estimate = PoseEstimate {
                pose,
                odom: pose,
                sigma_m: 0.01,
                ..PoseEstimate::default()
            };
            let observation = Observation {
                time_us: self.time_us,
                ..Observation::default()
            };
            self.map.insert(&estimate, &observation);
            let kind = match is_rug(x_m - 0.001 * f64::from(BEHIND_MM)) {
                true => FloorKind::Carpet,
                false => FloorKind::Hard,
            };
            let behind_mm = BEHIND_MM;
            self.map.note_floor(self.time_us, FloorFelt { kind, behind_mm });
        }
    }

    fn kind_at(&self, x_m: f64, y_m: f64) -> Option<FloorKind> {
        self.map.floor_kind(Cell::under(Point2 { x_m, y_m }))
    }

    /// Cells that are carpet and cells that are hard.
    fn counts(&self) -> [usize; 2] {
        [FloorKind::Carpet, FloorKind::Hard]
            .map(|wanted| self.map.floor_kinds().filter(|(_, kind)| *kind == wanted).count())
    }
}

fn rug(x_m: f64) -> bool {
    (1.0..2.0).contains(&x_m)
}

fn nowhere(_: f64) -> bool {
    false
}

fn same(pose: Pose2) -> Pose2 {
    pose
}

#[test]
fn a_rug_lies_under_the_brush_where_it_was_felt_and_nowhere_else() {
    let mut walker = Walker::new();
    walker.drive(0.0, rug, same);
    for (x_m, kind) in [
        (0.90, FloorKind::Hard),
        (1.10, FloorKind::Carpet),
        (1.90, FloorKind::Carpet),
        (2.10, FloorKind::Hard),
    ] {
        assert_eq!(walker.kind_at(x_m, 0.0), Some(kind), "at {x_m} m");
        assert_eq!(
            walker.kind_at(x_m, 0.11),
            Some(kind),
            "at the brush's end, {x_m} m"
        );
        assert_eq!(walker.kind_at(x_m, 0.16), None, "beside the brush, {x_m} m");
    }
}

#[test]
fn nothing_that_robots_drive_by_comes_of_it() {
    let (mut with, mut without) = (Walker::new(), Walker::new());
    with.drive(0.0, rug, same);
    without.drive(0.0, nowhere, same);
    let (with, without) = (&mut with.map, &mut without.map);
    with.refresh();
    without.refresh();
    assert_eq!(with.knowledge(), without.knowledge());
    assert_eq!(with.revision(), without.revision());
    assert_eq!(with.stored().knowledge(), without.stored().knowledge());
    let mut unfelt = Map::new(BODY, SensorLayout::default());
    unfelt.note_floor(
        0,
        FloorFelt {
            kind: FloorKind::Carpet,
            behind_mm: 0,
        },
    );
    assert_eq!(unfelt.floor_kinds().count(), 0, "where no body was");
}

#[test]
fn a_rug_that_is_taken_away_is_forgotten_after_two_passes() {
    let mut walker = Walker::new();
    for _ in 0..5 {
        walker.drive(0.0, rug, same);
    }
    let [before, _] = walker.counts();
    walker.drive(0.0, nowhere, same);
    walker.drive(0.0, nowhere, same);
    let [after, _] = walker.counts();
    assert!(before > 300, "{before} cells");
    assert_eq!(walker.kind_at(1.5, 0.0), Some(FloorKind::Hard));
    walker.drive(0.0, nowhere, same);
    assert!(walker.counts()[0] <= after);
    let revision = walker.map.floor_revision();
    walker.drive(0.0, rug, same);
    assert_ne!(walker.map.floor_revision(), revision, "clients are told of it");
}

#[test]
fn a_map_drawn_again_has_its_rugs_at_the_better_poses() {
    let aside = |pose: Pose2| Pose2 {
        y_m: pose.y_m + 0.5,
        ..pose
    };
    let mut walker = Walker::new();
    walker.drive(0.0, rug, aside);
    assert_eq!(walker.kind_at(1.5, 0.5), Some(FloorKind::Carpet));
    let before = walker.counts();
    walker.map.redraw(&[Keyframe {
        time_us: STEP_US,
        was: aside(Pose2::IDENTITY),
        is: Pose2::IDENTITY,
    }]);
    walker.map.finish_redraw();
    assert_eq!(walker.kind_at(1.5, 0.0), Some(FloorKind::Carpet));
    assert_eq!(walker.kind_at(1.5, 0.5), None);
    assert_eq!(walker.counts(), before);
    walker.map.withdraw(
        0,
        &[Keyframe {
            time_us: STEP_US,
            was: Pose2::IDENTITY,
            is: Pose2::IDENTITY,
        }],
    );
    walker.map.finish_redraw();
    assert_eq!(walker.counts(), [0, 0], "what was withdrawn is gone");
}

#[test]
fn what_is_felt_while_the_map_is_drawn_again_is_in_it() {
    let mut walker = Walker::new();
    walker.map.redraw(&[Keyframe {
        time_us: 1,
        was: Pose2::IDENTITY,
        is: Pose2::IDENTITY,
    }]);
    walker.drive(0.0, rug, same);
    let mut calm = Walker::new();
    calm.drive(0.0, rug, same);
    walker.map.finish_redraw();
    assert_eq!(walker.counts(), calm.counts());
}

#[test]
fn rugs_are_stored_and_taken_up_and_forgotten_as_others_are() {
    let mut walker = Walker::new();
    walker.drive(0.0, rug, same);
    let stored = walker.map.stored();
    let mut again = Walker::new();
    again.map.take_up(&stored);
    assert_eq!(again.counts(), walker.counts());
    assert_eq!(again.map.stored(), stored, "storing it again gives the same");
    again.drive(0.0, nowhere, same);
    again.drive(0.0, nowhere, same);
    assert_eq!(again.kind_at(1.5, 0.0), Some(FloorKind::Hard));
    again.map.start_anew();
    assert!(again.counts()[1] > 0, "a new job forgets nothing of the home");
}
