//! What the daemon tells, in Foxglove's own forms, which its panels draw without configuration. Frames as in the recordings: `map`, and `robot`
//! with x forward and y left.

use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{
    ArrowPrimitive, Color, CylinderPrimitive, Duration, FrameTransform, Grid, LinePrimitive, Log,
    PackedElementField, Point3, Pose, PoseInFrame, Quaternion, SceneEntity, SceneUpdate, Timestamp, Vector2,
    Vector3, line_primitive, log,
};
use rvac_api::{HomeView, LogEntry, LogLevel, PlannedPath, RobotDescription};

const MAP: &str = "map";
const ROBOT: &str = "robot";
/// Height of the disc; not of any robot, only to look like one.
const DRAWN_HEIGHT_M: f64 = 0.08;
/// Bytes of a cell: red, green, blue, alpha.
const CELL_BYTES: u32 = 4;

const BODY: Color = colour(0.25, 0.3, 0.36);
const FORWARD: Color = colour(1.0, 0.72, 0.2);
const WAY: Color = colour(0.13, 0.55, 0.95);

const fn colour(r: f64, g: f64, b: f64) -> Color {
    Color { r, g, b, a: 1.0 }
}

/// The robot's place in the map.
pub(crate) fn pose(pose: rvac_api::Pose, at: Timestamp) -> PoseInFrame {
    PoseInFrame {
        timestamp: Some(at),
        frame_id: MAP.to_owned(),
        pose: Some(Pose {
            position: Some(place(pose.x, pose.y, 0.0)),
            orientation: Some(turned(pose.heading)),
        }),
    }
}

/// From the map to the robot.
pub(crate) fn transform(pose: rvac_api::Pose, at: Timestamp) -> FrameTransform {
    FrameTransform {
        timestamp: Some(at),
        parent_frame_id: MAP.to_owned(),
        child_frame_id: ROBOT.to_owned(),
        translation: Some(place(pose.x, pose.y, 0.0)),
        rotation: Some(turned(pose.heading)),
    }
}

/// A disc with an arrow where it looks.
pub(crate) fn robot(robot: &RobotDescription, at: Timestamp) -> SceneUpdate {
    let edge_m = 2.0 * robot.radius_m;
    let disc = CylinderPrimitive {
        pose: Some(still(0.0, DRAWN_HEIGHT_M / 2.0)),
        size: Some(place(edge_m, edge_m, DRAWN_HEIGHT_M)),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Some(BODY),
    };
    let arrow = ArrowPrimitive {
        pose: Some(still(0.0, DRAWN_HEIGHT_M + 0.01)),
        shaft_length: robot.radius_m * 0.5,
        shaft_diameter: 0.03,
        head_length: robot.radius_m * 0.4,
        head_diameter: 0.08,
        color: Some(FORWARD),
    };
    scene(SceneEntity {
        frame_id: ROBOT.to_owned(),
        frame_locked: true,
        cylinders: vec![disc],
        arrows: vec![arrow],
        ..entity("robot", at)
    })
}

/// The way that it means to take, as a line.
pub(crate) fn plan(path: &PlannedPath, at: Timestamp) -> SceneUpdate {
    let corner = |corner: &[i32]| match corner {
        [x, y] => Point3 {
            x: f64::from(*x) / 1e3,
            y: f64::from(*y) / 1e3,
            z: 0.02,
        },
        _ => Point3::default(),
    };
    let line = LinePrimitive {
        r#type: line_primitive::Type::LineStrip.into(),
        pose: Some(still(0.0, 0.0)),
        thickness: 2.0,
        scale_invariant: true,
        points: path.points_mm.chunks_exact(2).map(corner).collect(),
        color: Some(WAY),
        ..LinePrimitive::default()
    };
    scene(SceneEntity {
        frame_id: MAP.to_owned(),
        lines: vec![line],
        ..entity("plan", at)
    })
}

/// The home, a colour for each kind of cell; what is not known is transparent.
pub(crate) fn map(home: &HomeView, at: Timestamp) -> Grid {
    let count = home.width as usize * home.height as usize;
    let mut data: Vec<u8> = bridge::rle::cells(&home.cells, count).flat_map(painted).collect();
    data.resize(count * CELL_BYTES as usize, 0);
    Grid {
        timestamp: Some(at),
        frame_id: MAP.to_owned(),
        pose: Some(Pose {
            position: Some(place(
                f64::from(home.x) * home.cell_m,
                f64::from(home.y) * home.cell_m,
                -0.01,
            )),
            orientation: Some(turned(0.0)),
        }),
        column_count: home.width,
        cell_size: Some(Vector2 {
            x: home.cell_m,
            y: home.cell_m,
        }),
        row_stride: home.width * CELL_BYTES,
        cell_stride: CELL_BYTES,
        fields: (0..)
            .zip(["red", "green", "blue", "alpha"])
            .map(channel)
            .collect(),
        data: data.into(),
    }
}

/// The kinds of cells of [`HomeView::cells`].
fn painted(cell: u32) -> [u8; CELL_BYTES as usize] {
    match cell {
        1 => [226, 232, 240, 255],
        2 => [51, 65, 85, 255],
        3 => [217, 119, 6, 255],
        4 => [220, 80, 80, 160],
        _ => [0; 4],
    }
}

fn channel((offset, name): (u32, &str)) -> PackedElementField {
    PackedElementField {
        name: name.to_owned(),
        offset,
        r#type: NumericType::Uint8.into(),
    }
}

/// A line of the daemon's log.
pub(crate) fn line(entry: &LogEntry, at: Timestamp) -> Log {
    let level = match entry.level {
        LogLevel::Debug => log::Level::Debug,
        LogLevel::Info => log::Level::Info,
        LogLevel::Warn => log::Level::Warning,
        LogLevel::Error => log::Level::Error,
    };
    Log {
        timestamp: Some(at),
        level: level.into(),
        message: entry.text.clone(),
        name: entry.part.clone(),
        ..Log::default()
    }
}

fn scene(entity: SceneEntity) -> SceneUpdate {
    SceneUpdate {
        deletions: Vec::new(),
        entities: vec![entity],
    }
}

/// It stays until the next one of its name.
fn entity(id: &str, at: Timestamp) -> SceneEntity {
    SceneEntity {
        timestamp: Some(at),
        id: id.to_owned(),
        lifetime: Some(Duration::default()),
        ..SceneEntity::default()
    }
}

const fn place(x: f64, y: f64, z: f64) -> Vector3 {
    Vector3 { x, y, z }
}

fn still(x: f64, z: f64) -> Pose {
    Pose {
        position: Some(place(x, 0.0, z)),
        orientation: Some(turned(0.0)),
    }
}

/// About the vertical, radians counter-clockwise.
fn turned(heading_rad: f64) -> Quaternion {
    let (z, w) = (heading_rad / 2.0).sin_cos();
    Quaternion { x: 0.0, y: 0.0, z, w }
}

#[cfg(test)]
mod tests {
    use foxglove::messages::Timestamp;
    use rvac_api::HomeView;

    use super::map;

    #[test]
    fn a_cell_has_its_colour_and_what_is_missing_is_transparent() {
        let home = HomeView {
            cell_m: 0.05,
            x: -2,
            y: 4,
            width: 3,
            height: 2,
            cells: vec![1, 2, 2, 1],
            ..HomeView::default()
        };
        let grid = map(&home, Timestamp::new(1, 0));
        assert_eq!(grid.row_stride, 12);
        assert_eq!(grid.data.len(), 24);
        assert_eq!(
            &grid.data[..12],
            [[226, 232, 240, 255], [226, 232, 240, 255], [51, 65, 85, 255]].as_flattened()
        );
        assert!(grid.data[12..].iter().all(|byte| *byte == 0));
        let corner = grid
            .pose
            .and_then(|pose| pose.position)
            .expect("a grid has a corner");
        assert!((corner.x + 0.1).abs() < 1e-12 && (corner.y - 0.2).abs() < 1e-12);
    }
}
