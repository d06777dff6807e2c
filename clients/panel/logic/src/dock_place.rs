//! The dock that a person moves by hand.

use rvac_api::{HomeView, Pose};

use crate::point::MapPoint;
use crate::words::Words;

/// Pose of a robot on the dock: x and y in metres, heading in radians towards the dock's back.
pub type DockPose = [f64; 3];

/// Poses that differ by less are the same, metres and radians: the robot may round them.
const SAME: f64 = 0.005;

/// Between the body of a docked robot and the tower of the dock, metres.
const DOCK_GAP_M: f64 = 0.01;

/// The contacts of the dock, which look at the robot: a robot of this radius that stands on it has the pose `docked` and faces them.
#[must_use]
pub fn dock_contacts(docked: Pose, radius_m: f64) -> Pose {
    let reach_m = radius_m + DOCK_GAP_M;
    let (sin, cos) = docked.heading.sin_cos();
    Pose {
        x: docked.x + reach_m * cos,
        y: docked.y + reach_m * sin,
        heading: docked.heading + core::f64::consts::PI,
        ..docked
    }
}

/// Pose of a robot on the dock that was drawn by two places: the robot's place, and a place that it faces.
#[must_use]
pub fn dock_pose(robot: MapPoint, faces: MapPoint) -> DockPose {
    let heading = (faces.y - robot.y).atan2(faces.x - robot.x);
    [robot.x, robot.y, heading]
}

/// The pose on the dock that the robot reported.
#[must_use]
pub fn known_dock(home: &HomeView) -> Option<DockPose> {
    home.dock.map(|dock| [dock.x, dock.y, dock.heading])
}

pub(crate) fn is_same_dock(one: DockPose, other: DockPose) -> bool {
    let turn = one[2] - other[2];
    (one[0] - other[0]).hypot(one[1] - other[1]) < SAME && turn.sin().atan2(turn.cos()).abs() < SAME
}

/// Outline of a robot on the dock and its heading, as corners of a line.
#[must_use]
pub fn dock_border([x, y, heading]: DockPose, radius_m: f64) -> Vec<[f64; 2]> {
    const CORNERS: u32 = 32;
    let at = |bearing: f64, way_m: f64| [x + way_m * bearing.cos(), y + way_m * bearing.sin()];
    let around = |corner| heading + std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
    // From the middle to the front, and once round from there.
    core::iter::once([x, y])
        .chain((0..=CORNERS).map(|corner| at(around(corner), radius_m)))
        .collect()
}

/// What is known of the dock's position; nothing while it is unknown.
#[must_use]
pub fn dock_text(words: &Words, home: &HomeView) -> Option<&'static str> {
    home.dock?;
    Some(if home.dock_reported {
        words.home.dock_reported
    } else {
        words.home.dock_felt
    })
}

#[cfg(test)]
mod tests {
    use super::{dock_border, dock_contacts, dock_pose, dock_text, is_same_dock};
    use crate::MapPoint;
    use crate::words::Language;
    use core::f64::consts::{FRAC_PI_2, PI};
    use rvac_api::{HomeView, Pose};

    #[test]
    fn the_second_place_is_what_the_robot_looks_at() {
        let [x, y, heading] = dock_pose(MapPoint::new(1.0, 2.0), MapPoint::new(1.0, 3.5));
        assert_eq!((x, y), (1.0, 2.0));
        assert!((heading - FRAC_PI_2).abs() < 1e-9);
    }

    #[test]
    fn headings_on_both_sides_of_the_turn_are_the_same() {
        assert!(is_same_dock([1.0, 2.0, PI], [1.001, 2.0, -PI]));
        assert!(!is_same_dock([1.0, 2.0, 0.0], [1.0, 2.0, PI]));
        assert!(!is_same_dock([1.0, 2.0, 0.0], [1.1, 2.0, 0.0]));
    }

    #[test]
    fn the_dock_stands_before_the_robot_and_not_under_it() {
        let docked = Pose {
            x: 1.0,
            y: 2.0,
            heading: FRAC_PI_2,
            ..Pose::default()
        };
        let dock = dock_contacts(docked, 0.175);
        assert!(
            (dock.x - 1.0).abs() < 1e-9 && (dock.y - 2.185).abs() < 1e-9,
            "{dock:?}"
        );
        assert!((dock.heading - FRAC_PI_2 - PI).abs() < 1e-9);
    }

    #[test]
    fn the_outline_shows_the_body_and_where_it_looks() {
        let border = dock_border([1.0, 2.0, FRAC_PI_2], 0.2);
        assert_eq!(border.first(), Some(&[1.0, 2.0]));
        assert!((border[1][0] - 1.0).abs() < 1e-9 && (border[1][1] - 2.2).abs() < 1e-9);
        for [x, y] in border.iter().skip(1) {
            assert!(((x - 1.0).hypot(y - 2.0) - 0.2).abs() < 1e-9);
        }
    }

    #[test]
    fn a_dock_that_a_person_has_reported_is_shown_as_such() {
        let words = Language::English.words();
        let mut home = HomeView::default();
        assert_eq!(dock_text(words, &home), None);
        home.dock = Some(Pose::default());
        let felt = dock_text(words, &home);
        home.dock_reported = true;
        assert!(felt.is_some() && dock_text(words, &home) != felt);
    }
}
