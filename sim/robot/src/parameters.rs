//! From the robot's description to the firmware's parameters.

use cordlib::{LoadParameters, PackParameters, Parameters};
use home::RobotModel;
use rvac_protocol::message::Limits;
use rvac_units::{AngularSpeed, Current, Length, Speed, Throttle};

const FIRMWARE: &str = concat!("sim-", env!("CARGO_PKG_VERSION"));

/// Parameters of this model for the firmware of the board `device`.
#[must_use]
pub fn parameters_for(device: &'static str, model: &RobotModel) -> Parameters {
    let limits = Limits {
        speed_max: Speed::from_m_per_s(model.drive.speed_max_m_per_s),
        turn_max: AngularSpeed::from_rad_per_s(model.drive.turn_max_rad_per_s),
        track: Length::from_m(model.drive.track_m),
        count_nm: (model.drive.count_m * 1e9) as u32,
        radius: Length::from_m(model.body.radius_m),
        swath: Length::from_m(model.body.swath_m),
    };
    let mut parameters = Parameters::for_machine(device, FIRMWARE, limits);
    parameters.wheel.speed_at_full = Speed::from_m_per_s(model.wheel_motor.free_speed_m_per_s);
    parameters.wheel.dead_band =
        Throttle::saturating_from_millionths((model.wheel_motor.dead_band_brake * 1e6) as i32);
    parameters.guard.wheel_current_max = stall_limit(model.wheel_motor.stall_current_a);
    parameters.pack = pack_of(model);
    parameters
}

/// Three quarters of what a held wheel draws from a full pack, so that an empty one reaches it too.
fn stall_limit(stall_a: f64) -> Current {
    Current::from_a(0.75 * stall_a)
}

/// The battery and its loads.
fn pack_of(model: &RobotModel) -> PackParameters {
    let milli = |value: f64| (value * 1e3) as u16;
    let (battery, cleaners) = (&model.battery, &model.cleaners);
    PackParameters {
        cells: battery.cells,
        capacity_mah: milli(battery.capacity_ah),
        current_max_ma: milli(battery.charge_a),
        resistance_mohm: milli(battery.resistance_ohm),
        drain_ma: milli(battery.trickle_a),
        measured: true,
        loads: LoadParameters {
            electronics_ma: milli(battery.electronics_a),
            // A wheel at cruising speed takes a little more than one that turns freely.
            wheel_ma: milli(model.wheel_motor.idle_current_a * 2.0),
            brush_main_ma: milli(cleaners.main_a),
            brush_sides_ma: milli(cleaners.sides_a),
            vacuum_ma: milli(cleaners.vacuum_a),
        },
    }
}
