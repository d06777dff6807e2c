//! From the core's types to those of the interface to clients: the only place where a struct exists twice.

use brain::{Brain, CELL_M, CellKnowledge, JobFigures, MapPart, Mark, MarkKind, Pose2};
use rvac_api::{
    BatteryReading, BumpMark, ChargerReading, DoorView, HomeView, MapDelta, MapSnapshot, Pose, Rle,
    RobotDescription, RoomView, WallView,
};
use rvac_protocol::message::{Battery, ChargeState, ChargerStatus, LogLevel};

use crate::device::{Description, Shape};

/// A pose of the map frame at `time_us`.
pub(crate) fn pose(pose: Pose2, time_us: u64) -> Pose {
    Pose {
        x: pose.x_m,
        y: pose.y_m,
        heading: pose.heading_rad,
        t: seconds(time_us),
    }
}

/// Microseconds to the interface's seconds.
pub(crate) fn seconds(time_us: u64) -> f64 {
    time_us as f64 / 1e6
}

/// A robot's description.
pub(crate) fn robot(description: &Description) -> RobotDescription {
    let Shape::Circle { radius_m } = description.shape;
    RobotDescription {
        device: description.identity.device.clone(),
        radius_m,
        swath_m: description.swath_m,
        speed_max_m_per_s: description.drive.speed_max_m_per_s,
        turn_max_rad_per_s: description.drive.turn_max_rad_per_s,
        proximity: description.sensors.proximity,
        parts: description
            .parts
            .iter()
            .map(|part| part.name())
            .chain((description.sensors.dock_receivers > 0).then_some("dock"))
            .map(str::to_owned)
            .collect(),
    }
}

/// The whole map under the number `map`.
pub(crate) fn map_snapshot(map: u32, part: &MapPart<'_>) -> MapSnapshot {
    let delta = map_delta(map, part);
    MapSnapshot {
        map,
        cell_m: CELL_M,
        swept: delta.swept,
        path_mm: delta.path_mm,
        bumps: delta.bumps,
    }
}

/// A part of the map under the number `map`.
pub(crate) fn map_delta(map: u32, part: &MapPart<'_>) -> MapDelta {
    MapDelta {
        map,
        swept: part.swept.iter().flat_map(|cell| [cell.x, cell.y]).collect(),
        path_mm: part
            .path
            .iter()
            .flat_map(|point| [point.x_mm, point.y_mm])
            .collect(),
        bumps: part.marks.iter().map(bump).collect(),
    }
}

fn bump(mark: &Mark) -> BumpMark {
    BumpMark {
        x: mark.at.x_m,
        y: mark.at.y_m,
        contact: mark.kind == MarkKind::Contact,
    }
}

/// What is known of the home.
pub(crate) fn home(brain: &Brain) -> HomeView {
    let (map, estimate) = (brain.map(), brain.estimate());
    let (knowledge, rooms) = (map.knowledge(), map.rooms());
    let origin = knowledge.origin();
    let cells = knowledge.values().iter().map(|kind| cell_number(*kind));
    let labels = (0..knowledge.values().len()).map(|index| {
        let label = rooms.labels().get(knowledge.cell(index));
        label.copied().map_or(0, u32::from)
    });
    HomeView {
        revision: map.revision(),
        cell_m: CELL_M,
        x: origin.x,
        y: origin.y,
        width: u32::try_from(knowledge.width()).unwrap_or(u32::MAX),
        height: u32::try_from(knowledge.height()).unwrap_or(u32::MAX),
        cells: runs(cells),
        room_cells: runs(labels),
        rooms: rooms
            .rooms()
            .iter()
            .map(|room| RoomView {
                id: room.id,
                area_m2: room.area_m2,
                x: room.middle.x_m,
                y: room.middle.y_m,
            })
            .collect(),
        doors: rooms
            .doors()
            .iter()
            .map(|door| DoorView {
                rooms: door.rooms,
                x: door.at.x_m,
                y: door.at.y_m,
                width_m: door.width_m,
            })
            .collect(),
        walls: map
            .walls()
            .iter()
            .map(|wall| WallView {
                from: [wall.from.x_m, wall.from.y_m],
                to: [wall.to.x_m, wall.to.y_m],
                sigma_m: wall.sigma_m,
            })
            .collect(),
        dock: map.dock().map(|dock| pose(dock, 0)),
        pose_sigma_m: estimate.sigma_m,
        lost: estimate.lost,
    }
}

fn cell_number(kind: CellKnowledge) -> u32 {
    match kind {
        CellKnowledge::Unknown => 0,
        CellKnowledge::Free => 1,
        CellKnowledge::Occupied => 2,
        CellKnowledge::Cliff => 3,
        CellKnowledge::NoGo => 4,
    }
}

/// Equal values side by side as pairs of value and number.
fn runs(values: impl Iterator<Item = u32>) -> Rle {
    let mut runs = Rle::new();
    let mut last: Option<u32> = None;
    for value in values {
        match runs.last_mut() {
            Some(length) if last == Some(value) => *length += 1,
            _ => runs.extend([value, 1]),
        }
        last = Some(value);
    }
    runs
}

/// Battery readings.
pub(crate) fn battery(battery: &Battery) -> BatteryReading {
    BatteryReading {
        charge: battery.charge.as_f64(),
        voltage_v: battery.voltage.as_v(),
        current_a: battery.current.as_a(),
        temperature_c: battery.temperature.map(rvac_units::Temperature::as_celsius),
        state: charge_state(battery.state).to_owned(),
        charger: battery.charger.map(charger),
    }
}

fn charger(status: ChargerStatus) -> ChargerReading {
    ChargerReading {
        phase: status.phase.name().to_owned(),
        end: status.end.map(|end| end.name().to_owned()),
        fault: status.fault.map(|fault| fault.name().to_owned()),
    }
}

fn charge_state(state: ChargeState) -> &'static str {
    match state {
        ChargeState::Discharging => "discharging",
        ChargeState::Charging => "charging",
        ChargeState::Full => "full",
        ChargeState::Fault => "fault",
    }
}

/// Level of a firmware's log line.
pub(crate) fn log_level(level: LogLevel) -> rvac_api::LogLevel {
    match level {
        LogLevel::Debug => rvac_api::LogLevel::Debug,
        LogLevel::Info => rvac_api::LogLevel::Info,
        LogLevel::Warn => rvac_api::LogLevel::Warn,
        LogLevel::Error => rvac_api::LogLevel::Error,
    }
}

/// Status of the brain, without what only the core knows (inhibits, driver).
pub(crate) fn status(status: brain::Status, job: JobFigures) -> rvac_api::Status {
    rvac_api::Status {
        state: status.state.name().to_owned(),
        reason: status.reason.name().to_owned(),
        strategy: status.strategy.map(|strategy| strategy.name().to_owned()),
        inhibits: Vec::new(),
        job_s: job.time_s,
        swept_m2: job.swept_m2,
        path_m: job.path_m,
        bumps: job.bumps,
        driver: None,
    }
}
