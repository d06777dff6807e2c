//! Messages in Foxglove's own forms, which its panels draw without being told how: the robot as a disc that moves through
//! the frame `map`, and the lines of the log.
//!
//! Names and fields are those of <https://docs.foxglove.dev/docs/sdk/schemas>. Times are host time since the daemon's
//! start, as everywhere in a recording.

use rvac_api::{LogEntry, LogLevel, Pose};
use serde_json::{Value, json};

/// Frame of the map: where the brain believes things to be.
const MAP: &str = "map";
/// Frame of the robot: x forward, y left, origin on the floor between the wheels.
const ROBOT: &str = "robot";
/// Height of the disc; no measure of any robot, only so that it looks like one.
const DRAWN_HEIGHT_M: f64 = 0.08;

/// Host time of something that carries it in seconds, in microseconds.
pub(super) fn time_us(t_s: f64) -> u64 {
    // Saturating; microseconds of a century fit into the 53 bits of a float.
    (t_s * 1e6).round() as u64
}

/// A `foxglove.PoseInFrame`.
pub(super) fn pose_in_frame(pose: Pose) -> Value {
    json!({
        "timestamp": timestamp(time_us(pose.t)),
        "frame_id": MAP,
        "pose": {"position": position(pose), "orientation": orientation(pose)},
    })
}

/// A `foxglove.FrameTransform` from the map to the robot.
pub(super) fn frame_transform(pose: Pose) -> Value {
    json!({
        "timestamp": timestamp(time_us(pose.t)),
        "parent_frame_id": MAP,
        "child_frame_id": ROBOT,
        "translation": position(pose),
        "rotation": orientation(pose),
    })
}

/// A `foxglove.SceneUpdate` with a robot of this radius, looking along x.
pub(super) fn robot(time_us: u64, radius_m: f64) -> Value {
    let diameter_m = 2.0 * radius_m;
    let body = json!({
        "pose": {"position": {"x": 0.0, "y": 0.0, "z": 0.5 * DRAWN_HEIGHT_M}, "orientation": upright()},
        "size": {"x": diameter_m, "y": diameter_m, "z": DRAWN_HEIGHT_M},
        "bottom_scale": 1.0,
        "top_scale": 1.0,
        "color": {"r": 0.2, "g": 0.5, "b": 0.9, "a": 0.8},
    });
    let forward = json!({
        "pose": {"position": {"x": 0.0, "y": 0.0, "z": DRAWN_HEIGHT_M}, "orientation": upright()},
        "shaft_length": 0.6 * radius_m,
        "shaft_diameter": 0.1 * radius_m,
        "head_length": 0.4 * radius_m,
        "head_diameter": 0.3 * radius_m,
        "color": {"r": 1.0, "g": 1.0, "b": 1.0, "a": 1.0},
    });
    json!({
        "deletions": [],
        "entities": [{
            "timestamp": timestamp(time_us),
            "frame_id": ROBOT,
            "id": "robot",
            // For ever.
            "lifetime": {"sec": 0, "nsec": 0},
            "frame_locked": true,
            "metadata": [],
            "arrows": [forward],
            "cubes": [],
            "spheres": [],
            "cylinders": [body],
            "lines": [],
            "triangles": [],
            "texts": [],
            "models": [],
        }],
    })
}

/// A `foxglove.Log`.
pub(super) fn log(entry: &LogEntry) -> Value {
    let level = match entry.level {
        LogLevel::Debug => 1,
        LogLevel::Info => 2,
        LogLevel::Warn => 3,
        LogLevel::Error => 4,
    };
    json!({
        "timestamp": timestamp(time_us(entry.t)),
        "level": level,
        "message": entry.text,
        "name": entry.part,
        "file": "",
        "line": 0,
    })
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
    *stamp = timestamp(then_ns.saturating_add_signed(by_ns) / 1000);
}

fn timestamp(time_us: u64) -> Value {
    json!({"sec": time_us / 1_000_000, "nsec": time_us % 1_000_000 * 1000})
}

/// Micrometres are enough for an eye and half as long to write.
fn position(pose: Pose) -> Value {
    json!({"x": rounded(pose.x), "y": rounded(pose.y), "z": 0.0})
}

fn orientation(pose: Pose) -> Value {
    let half = 0.5 * pose.heading;
    json!({"x": 0.0, "y": 0.0, "z": rounded(half.sin()), "w": rounded(half.cos())})
}

fn upright() -> Value {
    json!({"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0})
}

fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
