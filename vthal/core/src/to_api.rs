//! From the core's types to those of the interface to clients: the only place where a struct exists twice.

use brain::{Brain, CELL_M, Hazard, HazardKind, JobFigures, MapDoubt, MapPart, Pose2, SweptShare};
use rvac_api::{
    BatteryReading, BumpMark, ChargerReading, Estimate, MapDelta, MapSnapshot, PlannedPath, Pose,
    RobotDescription,
};

use crate::device::{Battery, ChargeState, Charger, Description};
use crate::lacking::Lacking;
use crate::swept_sigma::SweptSigma;

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
pub(crate) fn robot(description: &Description, lacking: &[Lacking]) -> RobotDescription {
    RobotDescription {
        device: description.identity.device.clone(),
        radius_m: description.shape.circumscribed_radius_m(),
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
        unguarded: description.unguarded.iter().copied().map(str::to_owned).collect(),
        unmeasured: description
            .unmeasured
            .iter()
            .copied()
            .map(str::to_owned)
            .collect(),
        lacking: lacking
            .iter()
            .map(|one| rvac_api::Lacking {
                ability: one.ability.name().to_owned(),
                values: one.values.clone(),
            })
            .collect(),
    }
}

/// The whole map under the number `map`.
pub(crate) fn map_snapshot(map: u32, part: &MapPart<'_>, sigma: &SweptSigma) -> MapSnapshot {
    let delta = map_delta(map, part, sigma);
    MapSnapshot {
        map,
        cell_m: CELL_M,
        swept: delta.swept,
        swept_sigma: delta.swept_sigma,
        path_mm: delta.path_mm,
        bumps: delta.bumps,
    }
}

/// A part of the map under the number `map`.
pub(crate) fn map_delta(map: u32, part: &MapPart<'_>, sigma: &SweptSigma) -> MapDelta {
    MapDelta {
        map,
        swept: part.swept.iter().flat_map(|cell| [cell.x, cell.y]).collect(),
        swept_sigma: sigma.of_last(part.swept.len()),
        path_mm: part
            .path
            .iter()
            .flat_map(|point| [point.x_mm, point.y_mm])
            .collect(),
        bumps: part.hazards.iter().map(bump).collect(),
    }
}

/// A place of a contact or cliff.
pub(crate) fn bump(mark: &Hazard) -> BumpMark {
    BumpMark {
        x: mark.at.x_m,
        y: mark.at.y_m,
        contact: mark.kind == HazardKind::Contact,
    }
}

/// How certain the robot is of its position and of its coverage.
pub(crate) fn estimate(brain: &Brain, swept: Option<SweptShare>) -> Estimate {
    let estimate = brain.estimate();
    Estimate {
        sigma_m: estimate.sigma_m,
        sigma_rad: estimate.sigma_rad,
        lost: estimate.lost,
        agreement: brain.map_agreement(),
        covered: swept.map(|swept| swept.share),
        covered_low: swept.map(|swept| swept.share_low),
        map_doubt: brain.map_doubt().map(map_doubt),
    }
}

const fn map_doubt(doubt: MapDoubt) -> rvac_api::MapDoubt {
    match doubt {
        MapDoubt::MappedNotMet => rvac_api::MapDoubt::MappedNotMet,
        MapDoubt::MetNotMapped => rvac_api::MapDoubt::MetNotMapped,
        MapDoubt::PlaceNotInMap => rvac_api::MapDoubt::PlaceNotInMap,
    }
}

/// Corners of a planned path that are sent at most: some 500 lanes with their links.
const CORNERS_MAX: usize = 4_000;

/// Where the robot means to drive; of a very long path its beginning.
pub(crate) fn planned_path(brain: &Brain) -> PlannedPath {
    let path = brain.planned_path();
    let millimetres = |metres: f64| (1000.0 * metres).round() as i32;
    PlannedPath {
        points_mm: path
            .corners
            .iter()
            .take(CORNERS_MAX)
            .flat_map(|corner| [millimetres(corner.x_m), millimetres(corner.y_m)])
            .collect(),
        beyond_mm: u32::try_from(millimetres(path.beyond_m)).unwrap_or_default(),
    }
}

/// Battery readings.
pub(crate) fn battery(battery: &Battery) -> BatteryReading {
    BatteryReading {
        charge: battery.charge,
        voltage_v: battery.voltage_v,
        current_a: battery.current_a,
        temperature_c: battery.temperature_c,
        state: charge_state(battery.state).to_owned(),
        charger: battery.charger.map(charger),
    }
}

fn charger(charger: Charger) -> ChargerReading {
    ChargerReading {
        phase: charger.phase.to_owned(),
        end: charger.end.map(str::to_owned),
        fault: charger.fault.map(str::to_owned),
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

/// Status of the brain, without inhibits and driver, which the core adds.
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
        room: None,
    }
}
