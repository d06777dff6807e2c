//! A home TOML as it is in the file.

use serde::Deserialize;

use crate::point::Point;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawPlan {
    pub(super) format: String,
    pub(super) version: u32,
    pub(super) name: Option<String>,
    #[serde(default = "usual_cell_m")]
    pub(super) cell_m: f64,
    #[serde(default, rename = "room")]
    pub(super) rooms: Vec<RawRoom>,
    #[serde(default, rename = "wall")]
    pub(super) walls: Vec<RawWall>,
    #[serde(default, rename = "door")]
    pub(super) doors: Vec<RawDoor>,
    #[serde(default)]
    pub(super) furniture: Vec<RawFurniture>,
    #[serde(default, rename = "rug")]
    pub(super) rugs: Vec<RawRug>,
    #[serde(default, rename = "threshold")]
    pub(super) thresholds: Vec<RawThreshold>,
    #[serde(default, rename = "cliff")]
    pub(super) cliffs: Vec<RawRoom>,
    #[serde(default, rename = "mirror")]
    pub(super) mirrors: Vec<RawWall>,
    #[serde(default, rename = "visitor")]
    pub(super) visitors: Vec<RawVisitor>,
    #[serde(default, rename = "walker")]
    pub(super) walkers: Vec<RawWalker>,
    pub(super) dock: Option<RawDock>,
    pub(super) start: Option<RawDock>,
}

fn usual_cell_m() -> f64 {
    0.02
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawRoom {
    #[expect(
        dead_code,
        reason = "for people who read the file; the simulator needs no names of rooms"
    )]
    pub(super) name: Option<String>,
    pub(super) polygon: Vec<Point>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawWall {
    pub(super) from: Point,
    pub(super) to: Point,
    #[serde(default = "usual_wall_m")]
    pub(super) thickness_m: f64,
}

fn usual_wall_m() -> f64 {
    0.1
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "kebab-case")]
pub(super) enum DoorState {
    Open,
    Closed,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawDoor {
    pub(super) from: Point,
    pub(super) to: Point,
    #[serde(default = "usual_door_m")]
    pub(super) thickness_m: f64,
    pub(super) state: DoorState,
    #[serde(default)]
    pub(super) schedule: Vec<RawDoorEvent>,
}

fn usual_door_m() -> f64 {
    0.12
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawDoorEvent {
    pub(super) at_s: f64,
    pub(super) state: DoorState,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawFurniture {
    #[expect(dead_code, reason = "for people who read the file")]
    pub(super) name: Option<String>,
    pub(super) polygon: Option<Vec<Point>>,
    #[serde(default)]
    pub(super) legs: Vec<Point>,
    #[serde(default = "usual_leg_m")]
    pub(super) leg_diameter_m: f64,
}

fn usual_leg_m() -> f64 {
    0.05
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawRug {
    pub(super) polygon: Vec<Point>,
    #[serde(default = "usual_drag_n")]
    pub(super) drag_n: f64,
    #[serde(default = "usual_slip")]
    pub(super) slip: f64,
    #[serde(default)]
    pub(super) bias_deg_per_m: f64,
    #[serde(default)]
    pub(super) black: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawVisitor {
    pub(super) position: Point,
    pub(super) diameter_m: f64,
    pub(super) from_s: f64,
    pub(super) until_s: f64,
}

fn usual_drag_n() -> f64 {
    1.0
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "kebab-case")]
pub(super) enum RawWalkerKind {
    Person,
    Pet,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawWalker {
    pub(super) kind: RawWalkerKind,
    pub(super) goals: Vec<Point>,
    #[serde(default)]
    pub(super) rest_s: f64,
    pub(super) from_s: f64,
    pub(super) until_s: f64,
}

fn usual_slip() -> f64 {
    0.02
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawThreshold {
    pub(super) from: Point,
    pub(super) to: Point,
    pub(super) width_m: f64,
    pub(super) height_m: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RawDock {
    pub(super) position: Point,
    pub(super) heading_deg: f64,
}
