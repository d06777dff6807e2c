//! The one gate between every wish and the motors.
//!
//! Wheels never move unless the host has armed, a lease is fresh, and nothing inhibits. [`Standing::permit`] is applied
//! to the wheel outputs and [`Standing::permit_cleaner`] to brushes and suction on every pass, after all other code has
//! had its say, so that no mistake elsewhere can turn a motor.

use rvac_protocol::message::{Bumpers, Inhibit, Inhibits};
use rvac_units::Throttle;

use crate::board::WheelDrive;

/// Speed limit while a cliff is seen (S8), in µm/s.
pub(crate) const CLIFF_SPEED_MAX_UM_PER_S: i32 = 100_000;

/// Inhibits that forbid no motion: they tell the host what the robot needs (S16, S18).
const TELLING: Inhibits =
    Inhibits::from_bits(bit(Inhibit::BatteryLow) | bit(Inhibit::ChargerFault) | bit(Inhibit::ChargerShorted));

/// Inhibits that leave a way out: motion away from the bumper (S6), slow reverse from a cliff (S8, S9).
const WAY_OUT: Inhibits =
    Inhibits::from_bits(bit(Inhibit::Bumper) | bit(Inhibit::Cliff) | bit(Inhibit::CliffSensorFault));

/// Inhibits that leave the wheels some or all of their motion: a weak pack (S16) still carries the robot to its dock.
const WHEELS_GO_ON: Inhibits =
    Inhibits::from_bits(WAY_OUT.bits() | TELLING.bits() | bit(Inhibit::BatteryWeak));

/// Inhibits that do not hold a robot on a dock that charges it against its will.
const LEAVING_GOES_ON: Inhibits = Inhibits::from_bits(
    bit(Inhibit::BatteryHot)
        | bit(Inhibit::BatteryOverheated)
        | bit(Inhibit::Thermistor)
        | bit(Inhibit::BatteryEmpty),
);

/// Inhibits that leave brushes and suction running: the way out above, the seconds of grace after a lost link (S1), and
/// a robot that does not get on (S15).
const CLEANING_GOES_ON: Inhibits =
    Inhibits::from_bits(WAY_OUT.bits() | TELLING.bits() | bit(Inhibit::LinkLost) | bit(Inhibit::NotMoving));

const fn bit(inhibit: Inhibit) -> u32 {
    1 << inhibit as u32
}

/// What is allowed now, and why not more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Standing {
    /// The host has armed motion.
    pub armed: bool,
    /// A lease (or a `move` with a living link) covers wheel motion.
    pub fresh: bool,
    /// Everything that inhibits.
    pub inhibits: Inhibits,
    /// Bumper zones that are pressed, as S6 sees them (release debounced).
    pub bumpers: Bumpers,
    /// The robot backs off a dock whose current nothing else can stop (S18): a hot or empty pack does not hold it there.
    pub leaving: bool,
}

impl Standing {
    /// What the wheels may do of what is asked.
    #[must_use]
    pub const fn permit(&self, left: WheelDrive, right: WheelDrive) -> (WheelDrive, WheelDrive) {
        let asked = (left.duty().millionths(), right.duty().millionths());
        if !self.armed || !self.fresh || !self.allows_direction(asked.0, asked.1) {
            (WheelDrive::Brake, WheelDrive::Brake)
        } else if self.inhibits_forward() {
            (no_more_than(left, asked.1), no_more_than(right, asked.0))
        } else {
            (left, right)
        }
    }

    /// What a brush or the suction may do of what is asked. Its own lease is kept where the wish comes from.
    #[must_use]
    pub const fn permit_cleaner(&self, duty: Throttle) -> Throttle {
        if self.armed && self.inhibits.without(CLEANING_GOES_ON).is_empty() {
            duty
        } else {
            Throttle::ZERO
        }
    }

    /// Whether the inhibits let the wheels turn this way. Only the signs of the two numbers matter; standing still is
    /// always allowed.
    #[must_use]
    pub const fn allows_direction(&self, left: i32, right: i32) -> bool {
        if left == 0 && right == 0 {
            return true;
        }
        let held = self.inhibits.without(WHEELS_GO_ON);
        let held = if self.leaving {
            held.without(LEAVING_GOES_ON)
        } else {
            held
        };
        if !held.is_empty() {
            return false;
        }
        if self.sees_cliff() && (left > 0 || right > 0) {
            return false;
        }
        !self.inhibits.contains(Inhibit::Bumper) || self.is_away(left, right)
    }

    /// Whether a bumper zone is pressed or a wheel hangs: nothing with blades starts then (S29).
    #[must_use]
    pub const fn touches(&self) -> bool {
        self.inhibits.contains(Inhibit::Bumper) || self.inhibits.contains(Inhibit::WheelDrop)
    }

    /// Whether the speed is limited to that of S8.
    #[must_use]
    pub const fn sees_cliff(&self) -> bool {
        self.inhibits.contains(Inhibit::Cliff) || self.inhibits.contains(Inhibit::CliffSensorFault)
    }

    /// Whether the centre of the robot must not go forward.
    #[must_use]
    pub const fn inhibits_forward(&self) -> bool {
        self.sees_cliff() || self.inhibits.contains(Inhibit::Bumper)
    }

    /// Backwards leads away from any press. A turn on the spot leads away when it swings the pressed side back.
    const fn is_away(&self, left: i32, right: i32) -> bool {
        let backwards = left <= 0 && right <= 0;
        let turns_right = left >= 0 && right <= 0;
        let turns_left = right >= 0 && left <= 0;
        backwards
            || (turns_right && self.bumpers.left && !self.bumpers.right)
            || (turns_left && self.bumpers.right && !self.bumpers.left)
    }
}

/// A turn on the spot away from an obstacle must not creep forward: the wheel that turns forward gets no more than the
/// other one, whose duty is `other`, gets backward.
const fn no_more_than(drive: WheelDrive, other: i32) -> WheelDrive {
    let duty = drive.duty().millionths();
    if duty > other.saturating_neg() && duty > 0 {
        WheelDrive::Duty(Throttle::saturating_from_millionths(other.saturating_neg()))
    } else {
        drive
    }
}
