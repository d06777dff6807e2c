//! The driver's seat: who drives by hand, and how hard brushes and suction run meanwhile.

use rvac_api::{CleaningPower, LogLevel};
use rvac_units::Throttle;

use super::arbiter::{Arbiter, Denied, Source, Stick};
use super::audience::Teller;
use super::journal::LogSource;
use crate::ClientId;
use crate::device::CleanerPower;
use crate::refusal::Refused;

/// Brushes and suction are off.
pub(crate) const NO_POWER: CleaningPower = CleaningPower {
    suction: 0.0,
    main_brush: 0.0,
    side_brushes: 0.0,
};

/// What a client asks of the wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HandDrive {
    pub(crate) speed_m_per_s: f64,
    pub(crate) turn_rad_per_s: f64,
    pub(crate) lease_ms: u16,
    /// How hard brushes and suction run.
    pub(crate) power: CleaningPower,
}

impl HandDrive {
    /// Where the stick is.
    pub(crate) fn stick(&self) -> Stick {
        Stick {
            speed_m_per_s: self.speed_m_per_s,
            turn_rad_per_s: self.turn_rad_per_s,
            lease_us: u64::from(self.lease_ms) * 1000,
        }
    }

    /// How hard brushes and suction run.
    ///
    /// # Errors
    /// The named reason `range` when a share is not within 0..=1.
    pub(crate) fn cleaner_power(&self) -> Result<CleanerPower, Refused> {
        let power = self.power;
        Ok(CleanerPower {
            brush_main: throttle(power.main_brush)?,
            brush_sides: throttle(power.side_brushes)?,
            vacuum: throttle(power.suction)?,
        })
    }
}

/// A client pulls the stick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    pub(crate) stick: Stick,
    pub(crate) brakes: Brakes,
}

/// The driver, and the power that the driver sets for brushes and suction.
#[derive(Debug)]
pub(crate) struct DriverDesk {
    pub(crate) arbiter: Arbiter,
    power: CleanerPower,
}

impl Default for DriverDesk {
    fn default() -> Self {
        Self {
            arbiter: Arbiter::default(),
            power: CleanerPower::FULL,
        }
    }
}

impl DriverDesk {
    /// How hard brushes and suction run while a person drives.
    pub(crate) fn power(&self) -> CleanerPower {
        self.power
    }

    /// Whether `source` may start or change a job now.
    ///
    /// # Errors
    /// Somebody else drives.
    pub(crate) fn admit(&mut self, now_us: u64, source: Source) -> Result<(), Refused> {
        self.arbiter.admit(now_us, source).map_err(denied)
    }

    /// As [`Self::admit`], while no lease has ended unseen.
    ///
    /// # Errors
    /// Somebody else drives.
    pub(crate) fn admit_now(&self, source: Source) -> Result<(), Refused> {
        self.arbiter.admit_now(source).map_err(denied)
    }

    /// A client moves the stick. Gives the end of the lease.
    ///
    /// # Errors
    /// Why it may not, also while the robot brakes, because it would stop for the driver before.
    pub(crate) fn drive(
        &mut self,
        client: ClientId,
        pull: Pull,
        teller: &mut Teller<'_>,
    ) -> Result<u64, Refused> {
        let Pull { stick, brakes } = pull;
        let was_driver = self.arbiter.driver() == Some(client);
        let valid_until_us = self.arbiter.drive(teller.now_us, client, stick).map_err(denied)?;
        if brakes == Brakes::Braking {
            self.arbiter.release(client);
            return Err("stopped");
        }
        if !was_driver {
            let text = format!("{} drives", teller.name(client));
            teller.log(LogLevel::Info, LogSource::Client, text);
        }
        Ok(valid_until_us)
    }

    /// The driver sets brushes and suction.
    pub(crate) fn set_power(&mut self, power: CleanerPower) {
        self.power = power;
    }
}

/// Whether a stop was sent and is not confirmed yet: a new driver would be stopped by the order that
/// was meant for the driver before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Brakes {
    Free,
    Braking,
}

fn denied(denied: Denied) -> Refused {
    match denied {
        Denied::DriverBusy(_) => "driver-busy",
        Denied::ReturnToCentre => "centre-first",
        Denied::LeaseRange => "lease-range",
    }
}

fn throttle(share: f64) -> Result<Throttle, Refused> {
    // NaN is in no range.
    if !(0.0..=1.0).contains(&share) {
        return Err("range");
    }
    Ok(Throttle::saturating_from_millionths((share * 1e6).round() as i32))
}
