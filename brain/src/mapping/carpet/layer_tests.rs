//! Surfaces in the map: drawn, redrawn, stored and loaded.

use super::{SurfaceKind, SurfaceObservation};
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
/// Distance from the robot back to the floor that caused the load.
const BEHIND_MM: u8 = 75;

/// A robot that drives along x repeatedly, and a rug from 1 m to 2 m.
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

    /// Drives three metres; `believed` is the pose estimate.
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
                true => SurfaceKind::Carpet,
                false => SurfaceKind::Hard,
            };
            let behind_mm = BEHIND_MM;
            self.map
                .note_surface(self.time_us, SurfaceObservation { kind, behind_mm });
        }
    }

    fn kind_at(&self, x_m: f64, y_m: f64) -> Option<SurfaceKind> {
        self.map.surface_kind(Cell::under(Point2 { x_m, y_m }))
    }

    /// Number of carpet cells and of hard cells.
    fn counts(&self) -> [usize; 2] {
        [SurfaceKind::Carpet, SurfaceKind::Hard].map(|wanted| {
            self.map
                .surface_kinds()
                .filter(|(_, kind)| *kind == wanted)
                .count()
        })
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
fn a_rug_is_drawn_under_the_brush_where_it_was_detected() {
    let mut walker = Walker::new();
    walker.drive(0.0, rug, same);
    for (x_m, kind) in [
        (0.90, SurfaceKind::Hard),
        (1.10, SurfaceKind::Carpet),
        (1.90, SurfaceKind::Carpet),
        (2.10, SurfaceKind::Hard),
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
fn surfaces_do_not_affect_navigation() {
    let (mut with, mut without) = (Walker::new(), Walker::new());
    with.drive(0.0, rug, same);
    without.drive(0.0, nowhere, same);
    let (with, without) = (&mut with.map, &mut without.map);
    with.refresh();
    without.refresh();
    assert_eq!(with.knowledge(), without.knowledge());
    assert_eq!(with.revision(), without.revision());
    assert_eq!(with.stored().knowledge(), without.stored().knowledge());
    let mut unknown = Map::new(BODY, SensorLayout::default());
    unknown.note_surface(
        0,
        SurfaceObservation {
            kind: SurfaceKind::Carpet,
            behind_mm: 0,
        },
    );
    assert_eq!(unknown.surface_kinds().count(), 0, "where no body was");
}

#[test]
fn a_removed_rug_is_forgotten_after_two_passes() {
    let mut walker = Walker::new();
    for _ in 0..5 {
        walker.drive(0.0, rug, same);
    }
    let [before, _] = walker.counts();
    walker.drive(0.0, nowhere, same);
    walker.drive(0.0, nowhere, same);
    let [after, _] = walker.counts();
    assert!(before > 300, "{before} cells");
    assert_eq!(walker.kind_at(1.5, 0.0), Some(SurfaceKind::Hard));
    walker.drive(0.0, nowhere, same);
    assert!(walker.counts()[0] <= after);
    let revision = walker.map.surface_revision();
    walker.drive(0.0, rug, same);
    assert_ne!(walker.map.surface_revision(), revision, "clients notice");
}

#[test]
fn a_redrawn_map_has_its_rugs_at_the_corrected_poses() {
    let aside = |pose: Pose2| Pose2 {
        y_m: pose.y_m + 0.5,
        ..pose
    };
    let mut walker = Walker::new();
    walker.drive(0.0, rug, aside);
    assert_eq!(walker.kind_at(1.5, 0.5), Some(SurfaceKind::Carpet));
    let before = walker.counts();
    walker.map.redraw(&[Keyframe {
        time_us: STEP_US,
        odom_from_base: aside(Pose2::IDENTITY),
        map_from_base: Pose2::IDENTITY,
    }]);
    walker.map.finish_redraw();
    assert_eq!(walker.kind_at(1.5, 0.0), Some(SurfaceKind::Carpet));
    assert_eq!(walker.kind_at(1.5, 0.5), None);
    assert_eq!(walker.counts(), before);
    walker.map.roll_back(
        0,
        &[Keyframe {
            time_us: STEP_US,
            odom_from_base: Pose2::IDENTITY,
            map_from_base: Pose2::IDENTITY,
        }],
    );
    walker.map.finish_redraw();
    assert_eq!(walker.counts(), [0, 0], "what was rolled back is gone");
}

#[test]
fn a_surface_detected_during_a_redraw_is_in_the_map() {
    let mut walker = Walker::new();
    walker.map.redraw(&[Keyframe {
        time_us: 1,
        odom_from_base: Pose2::IDENTITY,
        map_from_base: Pose2::IDENTITY,
    }]);
    walker.drive(0.0, rug, same);
    let mut calm = Walker::new();
    calm.drive(0.0, rug, same);
    walker.map.finish_redraw();
    assert_eq!(walker.counts(), calm.counts());
}

#[test]
fn rugs_are_stored_and_loaded_and_forgotten_like_others() {
    let mut walker = Walker::new();
    walker.drive(0.0, rug, same);
    let stored = walker.map.stored();
    let mut again = Walker::new();
    again.map.load(&stored);
    assert_eq!(again.counts(), walker.counts());
    assert_eq!(again.map.stored(), stored, "storing it again gives the same");
    again.drive(0.0, nowhere, same);
    again.drive(0.0, nowhere, same);
    assert_eq!(again.kind_at(1.5, 0.0), Some(SurfaceKind::Hard));
    again.map.start_anew();
    assert!(again.counts()[1] > 0, "a new job forgets nothing of the home");
}
