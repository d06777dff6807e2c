//! Messages in Foxglove's own forms, which its panels draw without configuration: the robot as a disc that moves through
//! the frame `map`, and the lines of the log.
//!
//! Names and fields are those of <https://docs.foxglove.dev/docs/sdk/schemas>. Times are host time since the daemon's
//! start, as everywhere in a recording.

use rvac_api::{LogEntry, LogLevel, Pose};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use serde_json::{Value, json};

use super::schemas::list;

/// Frame of the map: the brain's map frame.
const MAP: &str = "map";
/// Frame of the robot: x forward, y left, origin on the floor between the wheels.
const ROBOT: &str = "robot";
/// Height of the disc; not of any robot, only to look like one.
const DRAWN_HEIGHT_M: f64 = 0.08;

/// Host time of something that carries it in seconds, in microseconds.
pub(super) fn time_us(t_s: f64) -> u64 {
    // Saturating; microseconds of a century fit into the 53 bits of a float.
    (t_s * 1e6).round() as u64
}

/// Where something is at a moment.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct PoseInFrame {
    timestamp: Timestamp,
    frame_id: &'static str,
    pose: Placed,
}

/// Where a frame is in another one at a moment.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct FrameTransform {
    timestamp: Timestamp,
    parent_frame_id: &'static str,
    child_frame_id: &'static str,
    translation: Vector3,
    rotation: Quaternion,
}

/// What there is to be drawn.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct SceneUpdate {
    #[schemars(schema_with = "list")]
    deletions: Nothing,
    entities: [SceneEntity; 1],
}

/// A line of the log.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct Log<'entry> {
    timestamp: Timestamp,
    #[schemars(schema_with = "levels")]
    level: u8,
    message: &'entry str,
    name: &'entry str,
    file: &'static str,
    line: u32,
}

/// An empty list.
type Nothing = [(); 0];

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "time")]
struct Timestamp {
    sec: u64,
    #[schemars(range(max = 999_999_999))]
    nsec: u32,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "duration")]
struct Duration {
    sec: i32,
    #[schemars(range(max = 999_999_999))]
    nsec: u32,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "foxglove.Pose")]
struct Placed {
    position: Vector3,
    orientation: Quaternion,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "foxglove.Vector3")]
struct Vector3 {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "foxglove.Quaternion")]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "foxglove.Color")]
struct Color {
    r: f64,
    g: f64,
    b: f64,
    a: f64,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "foxglove.SceneEntity")]
struct SceneEntity {
    timestamp: Timestamp,
    frame_id: &'static str,
    id: &'static str,
    lifetime: Duration,
    frame_locked: bool,
    #[schemars(schema_with = "list")]
    metadata: Nothing,
    arrows: [ArrowPrimitive; 1],
    #[schemars(schema_with = "list")]
    cubes: Nothing,
    #[schemars(schema_with = "list")]
    spheres: Nothing,
    cylinders: [CylinderPrimitive; 1],
    #[schemars(schema_with = "list")]
    lines: Nothing,
    #[schemars(schema_with = "list")]
    triangles: Nothing,
    #[schemars(schema_with = "list")]
    texts: Nothing,
    #[schemars(schema_with = "list")]
    models: Nothing,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "foxglove.ArrowPrimitive")]
struct ArrowPrimitive {
    pose: Placed,
    shaft_length: f64,
    shaft_diameter: f64,
    head_length: f64,
    head_diameter: f64,
    color: Color,
}

#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = "foxglove.CylinderPrimitive")]
struct CylinderPrimitive {
    pose: Placed,
    size: Vector3,
    bottom_scale: f64,
    top_scale: f64,
    color: Color,
}

/// Names of the levels.
fn levels(_: &mut SchemaGenerator) -> Schema {
    let names = ["UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"];
    let level = |(number, name)| json!({"title": name, "const": number});
    let levels: Vec<Value> = (0..).zip(names).map(level).collect();
    json_schema!({"title": "foxglove.LogLevel", "oneOf": levels})
}

/// The pose of the robot in the map.
pub(super) fn pose_in_frame(pose: Pose) -> PoseInFrame {
    PoseInFrame {
        timestamp: timestamp(time_us(pose.t)),
        frame_id: MAP,
        pose: Placed {
            position: position(pose),
            orientation: orientation(pose),
        },
    }
}

/// From the map to the robot.
pub(super) fn frame_transform(pose: Pose) -> FrameTransform {
    FrameTransform {
        timestamp: timestamp(time_us(pose.t)),
        parent_frame_id: MAP,
        child_frame_id: ROBOT,
        translation: position(pose),
        rotation: orientation(pose),
    }
}

/// A robot of this radius, facing along x.
pub(super) fn robot(time_us: u64, radius_m: f64) -> SceneUpdate {
    SceneUpdate {
        deletions: [],
        entities: [SceneEntity {
            timestamp: timestamp(time_us),
            frame_id: ROBOT,
            id: "robot",
            // For ever.
            lifetime: Duration { sec: 0, nsec: 0 },
            frame_locked: true,
            metadata: [],
            arrows: [forward(radius_m)],
            cubes: [],
            spheres: [],
            cylinders: [body(2.0 * radius_m)],
            lines: [],
            triangles: [],
            texts: [],
            models: [],
        }],
    }
}

fn body(diameter_m: f64) -> CylinderPrimitive {
    CylinderPrimitive {
        pose: upright(0.5 * DRAWN_HEIGHT_M),
        size: Vector3 {
            x: diameter_m,
            y: diameter_m,
            z: DRAWN_HEIGHT_M,
        },
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Color {
            r: 0.2,
            g: 0.5,
            b: 0.9,
            a: 0.8,
        },
    }
}

fn forward(radius_m: f64) -> ArrowPrimitive {
    ArrowPrimitive {
        pose: upright(DRAWN_HEIGHT_M),
        shaft_length: 0.6 * radius_m,
        shaft_diameter: 0.1 * radius_m,
        head_length: 0.4 * radius_m,
        head_diameter: 0.3 * radius_m,
        color: Color {
            r: 1.0,
            g: 1.0,
            b: 1.0,
            a: 1.0,
        },
    }
}

/// As Foxglove's form.
pub(super) fn log(entry: &LogEntry) -> Log<'_> {
    Log {
        timestamp: timestamp(time_us(entry.t)),
        level: match entry.level {
            LogLevel::Debug => 1,
            LogLevel::Info => 2,
            LogLevel::Warn => 3,
            LogLevel::Error => 4,
        },
        message: &entry.text,
        name: &entry.part,
        file: "",
        line: 0,
    }
}

/// A message of one of these forms, stamped so much later; `None` for what is none.
pub(super) fn moved(topic: &str, data: &[u8], by_ns: i64) -> Option<Vec<u8>> {
    if ![super::POSE, super::TRANSFORM, super::ROBOT, super::LOG].contains(&topic) {
        return None;
    }
    let mut message: Value = serde_json::from_slice(data).ok()?;
    let of_entities = message.get_mut("entities").and_then(Value::as_array_mut);
    for stamped in of_entities.into_iter().flatten() {
        move_stamp(stamped, by_ns);
    }
    move_stamp(&mut message, by_ns);
    serde_json::to_vec(&message).ok()
}

fn move_stamp(stamped: &mut Value, by_ns: i64) {
    let Some(stamp) = stamped.get_mut("timestamp") else {
        return;
    };
    let part = |name: &str| stamp[name].as_u64().unwrap_or_default();
    let then_ns = part("sec")
        .saturating_mul(1_000_000_000)
        .saturating_add(part("nsec"));
    *stamp = json!(timestamp(then_ns.saturating_add_signed(by_ns) / 1000));
}

fn timestamp(time_us: u64) -> Timestamp {
    Timestamp {
        sec: time_us / 1_000_000,
        // Below a thousand million.
        nsec: (time_us % 1_000_000 * 1000) as u32,
    }
}

/// Micrometres are enough for an eye and half as long to write.
fn position(pose: Pose) -> Vector3 {
    Vector3 {
        x: rounded(pose.x),
        y: rounded(pose.y),
        z: 0.0,
    }
}

fn orientation(pose: Pose) -> Quaternion {
    let half = 0.5 * pose.heading;
    Quaternion {
        x: 0.0,
        y: 0.0,
        z: rounded(half.sin()),
        w: rounded(half.cos()),
    }
}

/// Above the origin, not turned.
fn upright(height_m: f64) -> Placed {
    Placed {
        position: Vector3 {
            x: 0.0,
            y: 0.0,
            z: height_m,
        },
        orientation: Quaternion {
            x: 0.0,
            y: 0.0,
            z: 0.0,
            w: 1.0,
        },
    }
}

fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
