//! From the text of a description to a checked [`RobotModel`].

use super::figure::{Figure, FigureList};
use super::raw::{
    RawBattery, RawBody, RawBumper, RawCleaners, RawDrive, RawGyro, RawLidar, RawModel, RawPlaces,
    RawProximity, RawReceivers, RawWheelMotor,
};
use super::{
    BatteryModel, BodyModel, BumperModel, Cleaners, CliffMount, DriveModel, GyroModel, LidarModel,
    ModelError, ProximityModel, ReceiverMount, RobotModel, WheelMotor,
};

/// Names the file in every complaint.
struct ModelReader<'a> {
    origin: &'a str,
}

type Range = core::ops::RangeInclusive<f64>;

impl ModelReader<'_> {
    fn complaint(&self, key: &str, problem: String) -> ModelError {
        ModelError::Value {
            origin: self.origin.to_owned(),
            key: key.to_owned(),
            problem,
        }
    }

    /// The figure's value, after unit and range were checked. `key` is `group.name [unit]`.
    fn figure(&self, figure: &Figure, key: &str, range: Range) -> Result<f64, ModelError> {
        let (name, unit) = split_unit(key);
        self.check_unit(&figure.unit, name, unit)?;
        self.check_range(figure.value, name, &range)
    }

    fn count(&self, figure: &Figure, key: &str, range: Range) -> Result<u16, ModelError> {
        let value = self.figure(figure, key, range)?;
        if libm::trunc(value) == value {
            Ok(value as u16)
        } else {
            Err(self.complaint(
                split_unit(key).0,
                format!("is {value}, but must be a whole number"),
            ))
        }
    }

    fn list(&self, list: &FigureList, key: &str, range: Range) -> Result<Vec<f64>, ModelError> {
        let (name, unit) = split_unit(key);
        self.check_unit(&list.unit, name, unit)?;
        if list.values.len() > LIST_MAX {
            let problem = format!(
                "has {} values; at most {LIST_MAX} are supported",
                list.values.len()
            );
            return Err(self.complaint(name, problem));
        }
        list.values
            .iter()
            .map(|value| self.check_range(*value, name, &range))
            .collect()
    }

    fn check_unit(&self, found: &str, name: &str, unit: &str) -> Result<(), ModelError> {
        if found == unit {
            Ok(())
        } else {
            Err(self.complaint(name, format!("has the unit `{found}`, but must have `{unit}`")))
        }
    }

    fn check_range(&self, value: f64, name: &str, range: &Range) -> Result<f64, ModelError> {
        if range.contains(&value) {
            Ok(value)
        } else {
            let (low, high) = (range.start(), range.end());
            Err(self.complaint(name, format!("is {value}, but must lie in {low} to {high}")))
        }
    }
}

/// Most sensors of one kind.
const LIST_MAX: usize = 8;

fn split_unit(key: &str) -> (&str, &str) {
    key.trim_end_matches(']').split_once(" [").unwrap_or((key, "1"))
}

fn radians(degrees: f64) -> f64 {
    degrees * core::f64::consts::PI / 180.0
}

pub(crate) fn robot_model(text: &str, origin: &str) -> Result<RobotModel, ModelError> {
    let raw: RawModel = toml::from_str(text).map_err(|error| ModelError::Format {
        origin: origin.to_owned(),
        message: error.to_string().trim().replace('\n', " "),
    })?;
    let reader = ModelReader { origin };
    let body = body(&reader, &raw.body)?;
    Ok(RobotModel {
        drive: drive(&reader, &raw.drive)?,
        wheel_motor: wheel_motor(&reader, &raw.wheel_motor)?,
        cleaners: cleaners(&reader, &raw.cleaners)?,
        bumper: bumper(&reader, &raw.bumper)?,
        cliffs: cliffs(&reader, &raw.cliffs, &body)?,
        wheel_drops: reader.count(&raw.wheel_drops.count, "wheel-drops.count", 0.0..=2.0)? as u8,
        proximity: raw
            .proximity
            .map(|part| proximity(&reader, &part, &body))
            .transpose()?,
        gyro: raw.gyro.map(|part| gyro(&reader, &part)).transpose()?,
        dock_receivers: match raw.dock_receivers {
            Some(part) => receivers(&reader, &part)?,
            None => Vec::new(),
        },
        battery: battery(&reader, &raw.battery)?,
        buttons: reader.count(&raw.buttons.count, "buttons.count", 0.0..=8.0)? as u8,
        lidar: raw.lidar.map(|part| lidar(&reader, &part)).transpose()?,
        name: raw.name,
        title: raw.title,
        body,
    })
}

fn body(reader: &ModelReader<'_>, raw: &RawBody) -> Result<BodyModel, ModelError> {
    let radius_m = reader.figure(&raw.radius, "body.radius [m]", 0.05..=0.5)?;
    Ok(BodyModel {
        radius_m,
        swath_m: reader.figure(&raw.swath, "body.swath [m]", 0.05..=2.0 * radius_m)?,
        climb_m: reader.figure(&raw.climb, "body.climb [m]", 0.0..=0.1)?,
    })
}

fn drive(reader: &ModelReader<'_>, raw: &RawDrive) -> Result<DriveModel, ModelError> {
    let speed_max_m_per_s = reader.figure(&raw.speed_max, "drive.speed-max [m/s]", 0.05..=2.0)?;
    Ok(DriveModel {
        track_m: reader.figure(&raw.track, "drive.track [m]", 0.05..=1.0)?,
        count_m: reader.figure(
            &raw.distance_per_count,
            "drive.distance-per-count [mm]",
            0.001..=50.0,
        )? / 1000.0,
        encoder_lines: reader.count(&raw.encoder_lines, "drive.encoder-lines", 1.0..=2.0)? as u8,
        cruise_m_per_s: reader.figure(&raw.cruise, "drive.cruise [m/s]", 0.02..=speed_max_m_per_s)?,
        speed_max_m_per_s,
        turn_max_rad_per_s: reader.figure(&raw.turn_max, "drive.turn-max [rad/s]", 0.1..=20.0)?,
    })
}

fn wheel_motor(reader: &ModelReader<'_>, raw: &RawWheelMotor) -> Result<WheelMotor, ModelError> {
    Ok(WheelMotor {
        free_speed_m_per_s: reader.figure(&raw.free_speed, "wheel-motor.free-speed [m/s]", 0.05..=5.0)?,
        stall_force_n: reader.figure(&raw.stall_force, "wheel-motor.stall-force [N]", 1.0..=500.0)?,
        stall_current_a: reader.figure(&raw.stall_current, "wheel-motor.stall-current [A]", 0.05..=50.0)?,
        idle_current_a: reader.figure(&raw.idle_current, "wheel-motor.idle-current [A]", 0.0..=10.0)?,
        dead_band_brake: reader.figure(&raw.dead_band_brake, "wheel-motor.dead-band-brake", 0.0..=0.95)?,
        dead_band_coast: reader.figure(&raw.dead_band_coast, "wheel-motor.dead-band-coast", 0.0..=0.95)?,
        lag_s: reader.figure(&raw.lag, "wheel-motor.lag [s]", 0.005..=5.0)?,
        traction_n: reader.figure(&raw.traction, "wheel-motor.traction [N]", 0.5..=500.0)?,
    })
}

fn cleaners(reader: &ModelReader<'_>, raw: &RawCleaners) -> Result<Cleaners, ModelError> {
    Ok(Cleaners {
        main_a: reader.figure(&raw.main, "cleaners.main [A]", 0.0..=20.0)?,
        sides_a: reader.figure(&raw.sides, "cleaners.sides [A]", 0.0..=20.0)?,
        vacuum_a: reader.figure(&raw.vacuum, "cleaners.vacuum [A]", 0.0..=20.0)?,
    })
}

fn bumper(reader: &ModelReader<'_>, raw: &RawBumper) -> Result<BumperModel, ModelError> {
    let travel_m = reader.figure(&raw.travel, "bumper.travel [mm]", 0.5..=30.0)? / 1000.0;
    let switch_mm = reader.figure(&raw.switch, "bumper.switch [mm]", 0.1..=travel_m * 1000.0)?;
    Ok(BumperModel {
        half_arc_rad: radians(reader.figure(&raw.half_arc, "bumper.half-arc [deg]", 10.0..=180.0)?),
        overlap_rad: radians(reader.figure(&raw.overlap, "bumper.overlap [deg]", 0.0..=180.0)?),
        travel_m,
        switch_m: switch_mm / 1000.0,
        force_n: reader.figure(&raw.force, "bumper.force [N]", 0.1..=100.0)?,
    })
}

fn cliffs(
    reader: &ModelReader<'_>,
    raw: &RawPlaces,
    body: &BodyModel,
) -> Result<Vec<CliffMount>, ModelError> {
    let span = -body.radius_m..=body.radius_m;
    let x = reader.list(&raw.x, "cliffs.x [m]", span.clone())?;
    let y = reader.list(&raw.y, "cliffs.y [m]", span)?;
    if x.len() != y.len() || x.len() > CLIFFS_MAX {
        let problem = format!(
            "has {} values and `cliffs.y` has {}; both need the same number, at most {CLIFFS_MAX}",
            x.len(),
            y.len()
        );
        return Err(reader.complaint("cliffs.x", problem));
    }
    Ok(x.into_iter()
        .zip(y)
        .map(|(x_m, y_m)| CliffMount { x_m, y_m })
        .collect())
}

/// Most cliff sensors.
const CLIFFS_MAX: usize = 4;
/// Most dock receivers.
const RECEIVERS_MAX: usize = 4;

fn proximity(
    reader: &ModelReader<'_>,
    raw: &RawProximity,
    body: &BodyModel,
) -> Result<ProximityModel, ModelError> {
    let headings = reader.list(&raw.headings, "proximity.headings [deg]", -180.0..=180.0)?;
    Ok(ProximityModel {
        headings_rad: headings.into_iter().map(radians).collect(),
        mount_radius_m: reader.figure(
            &raw.mount_radius,
            "proximity.mount-radius [m]",
            0.0..=body.radius_m,
        )?,
        range_m: reader.figure(&raw.range, "proximity.range [m]", 0.01..=2.0)?,
        half_angle_rad: radians(reader.figure(&raw.half_angle, "proximity.half-angle [deg]", 0.0..=30.0)?),
        half_level_m: reader.figure(&raw.half_level, "proximity.half-level [m]", 0.005..=1.0)?,
        near_m: raw
            .near
            .as_ref()
            .map(|near| reader.figure(near, "proximity.near [m]", 0.005..=1.0))
            .transpose()?,
    })
}

fn gyro(reader: &ModelReader<'_>, raw: &RawGyro) -> Result<GyroModel, ModelError> {
    let degrees = reader.figure(&raw.resolution, "gyro.resolution [deg]", 0.0001..=1.0)?;
    Ok(GyroModel {
        resolution_rad: radians(degrees),
    })
}

fn receivers(reader: &ModelReader<'_>, raw: &RawReceivers) -> Result<Vec<ReceiverMount>, ModelError> {
    let headings = reader.list(&raw.headings, "dock-receivers.headings [deg]", -180.0..=180.0)?;
    if headings.len() > RECEIVERS_MAX {
        let problem = format!(
            "has {} values; at most {RECEIVERS_MAX} are supported",
            headings.len()
        );
        return Err(reader.complaint("dock-receivers.headings", problem));
    }
    let half = reader.figure(&raw.half_angle, "dock-receivers.half-angle [deg]", 1.0..=180.0)?;
    Ok(headings
        .into_iter()
        .map(|heading| ReceiverMount {
            heading_rad: radians(heading),
            half_angle_rad: radians(half),
        })
        .collect())
}

fn battery(reader: &ModelReader<'_>, raw: &RawBattery) -> Result<BatteryModel, ModelError> {
    Ok(BatteryModel {
        cells: reader.count(&raw.cells, "battery.cells", 1.0..=40.0)? as u8,
        capacity_ah: reader.figure(&raw.capacity, "battery.capacity [Ah]", 0.1..=50.0)?,
        resistance_ohm: reader.figure(&raw.resistance, "battery.resistance [ohm]", 0.0..=5.0)?,
        electronics_a: reader.figure(&raw.electronics, "battery.electronics [A]", 0.0..=5.0)?,
        charge_a: reader.figure(&raw.charge, "battery.charge [A]", 0.0..=20.0)?,
        trickle_a: reader.figure(&raw.trickle, "battery.trickle [A]", 0.0..=20.0)?,
    })
}

fn lidar(reader: &ModelReader<'_>, raw: &RawLidar) -> Result<LidarModel, ModelError> {
    Ok(LidarModel {
        range_m: reader.figure(&raw.range, "lidar.range [m]", 0.1..=50.0)?,
        beams: reader.count(&raw.beams, "lidar.beams", 4.0..=4000.0)?,
        turns_hz: reader.figure(&raw.turns, "lidar.turns [Hz]", 0.1..=50.0)?,
        noise: reader.figure(&raw.noise, "lidar.noise", 0.0..=0.5)?,
    })
}
