//! Marks of the map as the numbers that the renderer reads.

use rvac_api::Pose;

use super::scene::{Places, Scene};

/// Numbers an instance of a mark has: place, heading, size, kind.
pub(super) const MARK_NUMBERS: usize = 5;

/// Kinds of marks, numbered as in the shader.
const BUMP: f32 = 0.0;
const CLIFF: f32 = 1.0;
const ROBOT: f32 = 2.0;
const TRUE_PLACE: f32 = 3.0;
const DOCK: f32 = 4.0;
const DOOR: f32 = 5.0;
const UNCERTAINTY: f32 = 6.0;
const SHADOW: f32 = 7.0;

/// Radius of a bump mark in CSS pixels.
const BUMP_RADIUS_PX: f64 = 4.5;

/// Size of the mark of the dock, of the robot's radius.
const DOCK_SHARE: f64 = 0.8;
/// The middle of the dock before its contacts, of the robot's radius: its plate lies before them and its tower stands behind them,
/// at a wall.
const DOCK_MIDDLE_SHARE: f64 = 0.3;

/// Radius of the mark in a door, of its width: a hint, and no obstacle to the eye.
const DOOR_SHARE: f64 = 0.25;

/// Bumps and cliffs, whose size is in device pixels.
pub(super) fn bump_marks(scene: &Scene, ratio: f64) -> Vec<f32> {
    let size = (BUMP_RADIUS_PX * ratio) as f32;
    let mark = |bump: &rvac_api::BumpMark| {
        let kind = if bump.contact { BUMP } else { CLIFF };
        [bump.x as f32, bump.y as f32, 0.0, size, kind]
    };
    scene.bumps.iter().flat_map(mark).collect()
}

/// What lies on the floor: doors, the dock, where the robot may be; in relief its shadow, because the dock has a height there.
pub(super) fn floor_marks(scene: &Scene, places: Places, in_relief: bool) -> Vec<f32> {
    let radius = scene.body_radius_m();
    let dock = scene
        .dock()
        .filter(|_| !in_relief)
        .map(|contacts| mark(dock_middle(contacts, radius), DOCK_SHARE * radius, DOCK));
    let doors = scene.doors().map(|door| {
        let at = Pose {
            x: door.x,
            y: door.y,
            ..Pose::default()
        };
        mark(at, DOOR_SHARE * door.width_m, DOOR)
    });
    let spread = scene.uncertainty_m();
    let spread = places
        .believed
        .filter(|_| spread > 0.0)
        .map(|pose| mark(pose, spread, UNCERTAINTY));
    let shadow = places
        .believed
        .filter(|_| in_relief)
        .map(|pose| mark(pose, radius, SHADOW));
    doors
        .chain([dock, spread, shadow].into_iter().flatten())
        .flatten()
        .collect()
}

/// The robot at its estimated pose, and the ring at the true one of a simulated robot.
pub(super) fn robot_marks(scene: &Scene, places: Places) -> Vec<f32> {
    let radius = scene.body_radius_m();
    let robot = places.believed.map(|pose| mark(pose, radius, ROBOT));
    let truth = places.truth.map(|pose| mark(pose, radius, TRUE_PLACE));
    [robot, truth].into_iter().flatten().flatten().collect()
}

fn dock_middle(contacts: Pose, radius_m: f64) -> Pose {
    let (sin, cos) = contacts.heading.sin_cos();
    Pose {
        x: contacts.x + DOCK_MIDDLE_SHARE * radius_m * cos,
        y: contacts.y + DOCK_MIDDLE_SHARE * radius_m * sin,
        ..contacts
    }
}

fn mark(pose: Pose, size: f64, kind: f32) -> [f32; MARK_NUMBERS] {
    [
        pose.x as f32,
        pose.y as f32,
        pose.heading as f32,
        size as f32,
        kind,
    ]
}
