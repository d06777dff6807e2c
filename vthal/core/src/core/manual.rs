//! What a drive request asks of the wheels, and how hard brushes and suction run meanwhile.

use rvac_api::CleaningPower;
use rvac_units::Throttle;

use crate::arbiter::Stick;
use crate::device::CleanerPower;

/// Where the stick is, in m/s forward and rad/s, for so many milliseconds.
pub(super) fn stick((speed_m_per_s, turn_rad_per_s): (f64, f64), lease_ms: u16) -> Stick {
    Stick {
        speed_m_per_s,
        turn_rad_per_s,
        lease_us: u64::from(lease_ms) * 1000,
    }
}

/// What a drive request asks of brushes and suction.
///
/// # Errors
/// The named reason `range` when a share is not within 0..=1.
pub(super) fn power(clean: bool, power: Option<CleaningPower>) -> Result<CleanerPower, &'static str> {
    let Some(power) = power else {
        return Ok(if clean {
            CleanerPower::FULL
        } else {
            CleanerPower::NONE
        });
    };
    Ok(CleanerPower {
        brush_main: throttle(power.main_brush)?,
        brush_sides: throttle(power.side_brushes)?,
        vacuum: throttle(power.suction)?,
    })
}

fn throttle(share: f64) -> Result<Throttle, &'static str> {
    // NaN is in no range.
    if !(0.0..=1.0).contains(&share) {
        return Err("range");
    }
    Ok(Throttle::saturating_from_millionths((share * 1e6).round() as i32))
}
