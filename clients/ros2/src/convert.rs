//! What the daemon tells, in messages of ROS 2.

use rvac_api::{Activity, BatteryReading, DeviceTable, Estimate, HomeView, PlannedPath, Status};

use crate::frames::Links;
use crate::messages::{
    BatteryState, COVARIANCE, DiagnosticArray, DiagnosticStatus, Header, KeyValue, MapMetaData,
    OccupancyGrid, Odometry, Path, PoseStamped, PoseWithCovariance, PoseWithCovarianceStamped,
    TransformStamped, Transforms, Twist, TwistWithCovariance, Vector3,
};
use crate::place::Place;

/// Frames of REP-105, perhaps with the robot's name before them.
#[derive(Clone, Debug)]
pub(crate) struct FrameNames {
    pub(crate) map: String,
    pub(crate) odom: String,
    pub(crate) base: String,
}

impl FrameNames {
    pub(crate) fn with_prefix(prefix: &str) -> Self {
        Self {
            map: format!("{prefix}map"),
            odom: format!("{prefix}odom"),
            base: format!("{prefix}base_link"),
        }
    }
}

/// Both links, as `/tf` wants them.
pub(crate) fn transforms(names: &FrameNames, links: Links, odom: &Header) -> Transforms {
    let map = Header {
        frame_id: names.map.clone(),
        ..odom.clone()
    };
    let link = |header: Header, child: &str, place: Place| TransformStamped {
        header,
        child_frame_id: child.to_owned(),
        transform: place.message(),
    };
    Transforms {
        transforms: vec![
            link(map, &names.odom, links.map_to_odom),
            link(odom.clone(), &names.base, links.odom_to_base),
        ],
    }
}

/// `/odom`. Drift is what `odom` may have, so only the latest step is uncertain there; how sure the place in the map is stands in `/pose`.
pub(crate) fn odometry(names: &FrameNames, links: Links, header: Header) -> Odometry {
    /// Standard deviations of the speeds that two poses give: a few millimetres and half a degree in a twentieth of a second.
    const FORWARD_M_PER_S: f64 = 0.03;
    const TURN_RAD_PER_S: f64 = 0.1;
    Odometry {
        header,
        child_frame_id: names.base.clone(),
        pose: PoseWithCovariance {
            pose: links.odom_to_base.message(),
            covariance: covariance(0.01, 0.02),
        },
        twist: TwistWithCovariance {
            twist: Twist {
                linear: Vector3::flat(links.forward_m_per_s, 0.0),
                angular: Vector3 {
                    x: 0.0,
                    y: 0.0,
                    z: links.turn_rad_per_s,
                },
            },
            covariance: covariance(FORWARD_M_PER_S, TURN_RAD_PER_S),
        },
    }
}

/// The place in the map and how sure it is, as `amcl_pose` tells it.
pub(crate) fn pose(links: Links, estimate: &Estimate, header: Header) -> PoseWithCovarianceStamped {
    PoseWithCovarianceStamped {
        header,
        pose: PoseWithCovariance {
            pose: links.map_to_odom.then(links.odom_to_base).message(),
            covariance: covariance(estimate.sigma_m, estimate.sigma_rad),
        },
    }
}

/// On the floor: x, y and the turn about the vertical; the rest cannot change.
fn covariance(place_m: f64, heading_rad: f64) -> [f64; COVARIANCE] {
    const X: usize = 0;
    const Y: usize = 7;
    const YAW: usize = 35;
    let mut matrix = [0.0; COVARIANCE];
    matrix[X] = place_m * place_m;
    matrix[Y] = place_m * place_m;
    matrix[YAW] = heading_rad * heading_rad;
    matrix
}

/// `/map`: 0 free, 100 occupied, -1 unknown. What people forbade counts as occupied: no planner shall lead the robot there.
pub(crate) fn grid(home: &HomeView, header: Header) -> OccupancyGrid {
    const FREE: u32 = 1;
    const OCCUPIED: [u32; 3] = [2, 3, 4];
    let count = home.width as usize * home.height as usize;
    let mut data: Vec<i8> = bridge::rle::cells(&home.cells, count)
        .map(|cell| match cell {
            FREE => 0,
            cell if OCCUPIED.contains(&cell) => 100,
            _ => -1,
        })
        .collect();
    data.resize(count, -1);
    let corner = Place {
        x_m: f64::from(home.x) * home.cell_m,
        y_m: f64::from(home.y) * home.cell_m,
        heading_rad: 0.0,
    };
    OccupancyGrid {
        info: MapMetaData {
            map_load_time: header.stamp.clone(),
            #[expect(clippy::cast_possible_truncation, reason = "some centimetres")]
            resolution: home.cell_m as f32,
            width: home.width,
            height: home.height,
            origin: corner.message(),
        },
        header,
        data,
    }
}

/// `/plan`: the corners of the way, each looking towards the next.
pub(crate) fn plan(path: &PlannedPath, header: &Header) -> Path {
    let corners: Vec<[f64; 2]> = path
        .points_mm
        .chunks_exact(2)
        .map(|corner| match corner {
            [x, y] => [f64::from(*x) / 1e3, f64::from(*y) / 1e3],
            _ => [0.0; 2],
        })
        .collect();
    let mut heading_rad = 0.0;
    let poses = corners.iter().enumerate().map(|(index, [x, y])| {
        if let Some([next_x, next_y]) = corners.get(index + 1) {
            heading_rad = (next_y - y).atan2(next_x - x);
        }
        let place = Place {
            x_m: *x,
            y_m: *y,
            heading_rad,
        };
        PoseStamped {
            header: header.clone(),
            pose: place.message(),
        }
    });
    Path {
        poses: poses.collect(),
        header: header.clone(),
    }
}

/// `/battery_state`. What is not measured is not a number, as the message asks for it.
#[expect(clippy::cast_possible_truncation, reason = "the message has single precision")]
pub(crate) fn battery(reading: &BatteryReading, header: Header) -> BatteryState {
    let fault = reading
        .charger
        .as_ref()
        .and_then(|charger| charger.fault.as_ref());
    BatteryState {
        header,
        voltage: reading.voltage_v as f32,
        temperature: reading.temperature_c.map_or(f32::NAN, |celsius| celsius as f32),
        current: reading.current_a as f32,
        charge: f32::NAN,
        capacity: f32::NAN,
        design_capacity: f32::NAN,
        percentage: reading.charge as f32,
        power_supply_status: supply_status(&reading.state),
        power_supply_health: supply_health(reading, fault.map(String::as_str)),
        power_supply_technology: 0,
        present: true,
        cell_voltage: Vec::new(),
        cell_temperature: Vec::new(),
        location: "robot".to_owned(),
        serial_number: String::new(),
    }
}

/// `POWER_SUPPLY_STATUS_...`
fn supply_status(state: &str) -> u8 {
    match state {
        "charging" => 1,
        "discharging" => 2,
        "fault" => 3,
        "full" => 4,
        _ => 0,
    }
}

/// `POWER_SUPPLY_HEALTH_...`: good, overheat, cold, or an unspecified failure.
fn supply_health(reading: &BatteryReading, fault: Option<&str>) -> u8 {
    match fault {
        Some(fault) if fault.contains("hot") => 2,
        Some(fault) if fault.contains("cold") => 6,
        Some(_) => 5,
        None if reading.state == "fault" => 5,
        None => 1,
    }
}

/// `/diagnostics`: what the robot does and why, the link, and each thing that keeps it from moving.
pub(crate) fn diagnostics(
    status: Option<&Status>,
    device: Option<&DeviceTable>,
    header: Header,
) -> DiagnosticArray {
    let mut all = Vec::new();
    if let Some(status) = status {
        all.push(of_status(status));
    }
    if let Some(device) = device {
        all.push(of_link(device));
    }
    if all.is_empty() {
        all.push(part(
            "robot",
            Level::Stale,
            "the robot's daemon is away",
            Vec::new(),
        ));
    }
    DiagnosticArray { header, status: all }
}

/// Levels of `diagnostic_msgs/DiagnosticStatus`.
#[derive(Clone, Copy)]
enum Level {
    Ok = 0,
    Warn = 1,
    Error = 2,
    Stale = 3,
}

fn part(name: &str, level: Level, message: &str, values: Vec<(&str, String)>) -> DiagnosticStatus {
    DiagnosticStatus {
        level: level as u8,
        name: format!("vacuum: {name}"),
        message: message.to_owned(),
        hardware_id: String::new(),
        values: values
            .into_iter()
            .map(|(key, value)| KeyValue {
                key: key.to_owned(),
                value,
            })
            .collect(),
    }
}

fn of_status(status: &Status) -> DiagnosticStatus {
    let activity = Activity::from_name(&status.state);
    let level = match activity {
        Some(Activity::Disconnected) => Level::Stale,
        Some(activity) if activity.needs_help() => Level::Error,
        Some(_) if status.inhibits.is_empty() => Level::Ok,
        _ => Level::Warn,
    };
    let values = vec![
        ("state", status.state.clone()),
        ("reason", status.reason.clone()),
        ("inhibits", status.inhibits.join(" ")),
        ("driver", status.driver.clone().unwrap_or_default()),
        ("strategy", status.strategy.clone().unwrap_or_default()),
        ("swept_m2", format!("{:.2}", status.swept_m2)),
        ("path_m", format!("{:.1}", status.path_m)),
        ("bumps", status.bumps.to_string()),
        (
            "room",
            status
                .room
                .as_ref()
                .map(rvac_api::RoomHere::title)
                .unwrap_or_default(),
        ),
    ];
    part(
        "robot",
        level,
        &format!("{} ({})", status.state, status.reason),
        values,
    )
}

fn of_link(device: &DeviceTable) -> DiagnosticStatus {
    let link = &device.link;
    let (level, message) = if link.up {
        (Level::Ok, "telemetry is fresh")
    } else {
        (Level::Error, "no telemetry")
    };
    let values = vec![
        ("age_ms", link.age_ms.to_string()),
        ("bad_share", format!("{:.4}", link.bad_share)),
        ("resets", link.resets.to_string()),
        ("bumpers", format!("{:?}", device.bumpers)),
        ("cliffs", format!("{:?}", device.cliffs)),
        ("wheel_drops", format!("{:?}", device.wheel_drops)),
    ];
    part("link", level, message, values)
}
