//! The single gate between all requests and the motors.
//!
//! Wheels never move unless the host has armed, a lease is fresh, and nothing inhibits. On every pass, after all other
//! code, [`MotionPermit::restrict`] is applied to the wheel outputs and [`MotionPermit::restrict_cleaner`] to brushes and
//! suction. No error elsewhere can therefore turn a motor.

use rvac_protocol::message::{Bumpers, Inhibit, Inhibits};
use rvac_units::Throttle;

use crate::board::WheelDrive;
use crate::parameters::WheelParameters;
use crate::rules::cliff;

/// Inhibits that forbid no motion: they inform the host (S16, S18).
const ADVISORY: Inhibits =
    Inhibits::from_bits(bit(Inhibit::BatteryLow) | bit(Inhibit::ChargerFault) | bit(Inhibit::ChargerShorted));

/// Inhibits with a permitted escape: motion away from the bumper (S6), slow reverse from a cliff (S8, S9).
const ESCAPABLE: Inhibits =
    Inhibits::from_bits(bit(Inhibit::Bumper) | bit(Inhibit::Cliff) | bit(Inhibit::CliffSensorFault));

/// Inhibits under which the wheels may still move: a weak pack (S16) carries the robot to its dock.
const WHEELS_MAY_RUN: Inhibits =
    Inhibits::from_bits(ESCAPABLE.bits() | ADVISORY.bits() | bit(Inhibit::BatteryWeak));

/// Inhibits under which the robot may still back off a dock whose current it cannot switch off.
const DOCK_ESCAPE_MAY_RUN: Inhibits = Inhibits::from_bits(
    bit(Inhibit::BatteryHot)
        | bit(Inhibit::BatteryOverheated)
        | bit(Inhibit::Thermistor)
        | bit(Inhibit::BatteryEmpty),
);

/// Inhibits under which brushes and suction may run: the escapes above, a lost link, because each has a lease of its own
/// (S1), and a robot that makes no progress (S15).
const CLEANERS_MAY_RUN: Inhibits = Inhibits::from_bits(
    ESCAPABLE.bits() | ADVISORY.bits() | bit(Inhibit::LinkLost) | bit(Inhibit::NotMoving),
);

const fn bit(inhibit: Inhibit) -> u32 {
    1 << inhibit as u32
}

/// Which motion is allowed now, and what inhibits the rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MotionPermit {
    /// The host has armed motion.
    pub armed: bool,
    /// A lease (or a `move` with a live link) covers wheel motion.
    pub fresh: bool,
    /// Everything that inhibits.
    pub inhibits: Inhibits,
    /// Bumper zones that are pressed, as S6 sees them (release debounced).
    pub bumpers: Bumpers,
    /// The robot backs off a dock whose current nothing else can stop (S18). A hot or empty pack does not prevent that.
    pub escaping_dock: bool,
    /// What bounds a reverse while a cliff is seen (S8).
    pub reverse: ReverseBound,
}

/// The bound of a reverse from a cliff, whoever asks for it: by the measured speed of each rim, or by the duty where speeds
/// are not known. The distance is bounded in `reflex/cliff`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReverseBound {
    /// Most duty of a wheel, in millionths; `None` where the speed is measured.
    pub duty_max: Option<i32>,
    /// Left and right rim turn backward faster than S8 allows.
    pub too_fast: [bool; 2],
}

impl ReverseBound {
    /// The bound for a machine whose rims turn at these speeds, in µm/s; `None` without calibrated encoders.
    pub(crate) fn of(rims_um_per_s: Option<[i32; 2]>, wheel: &WheelParameters) -> Self {
        const FASTEST: i32 = cliff::SPEED_MAX_UM_PER_S + cliff::SPEED_RIPPLE_UM_PER_S;
        match rims_um_per_s {
            Some(rims) => Self {
                duty_max: None,
                too_fast: rims.map(|rim| rim < -FASTEST),
            },
            None => Self {
                duty_max: Some(wheel.duty_at(cliff::SPEED_MAX_UM_PER_S)),
                too_fast: [false; 2],
            },
        }
    }

    const fn restrict(&self, (left, right): (WheelDrive, WheelDrive)) -> (WheelDrive, WheelDrive) {
        let [left_too_fast, right_too_fast] = self.too_fast;
        (
            if left_too_fast {
                WheelDrive::Brake
            } else {
                self.weaken(left)
            },
            if right_too_fast {
                WheelDrive::Brake
            } else {
                self.weaken(right)
            },
        )
    }

    const fn weaken(&self, drive: WheelDrive) -> WheelDrive {
        let duty = drive.duty().millionths();
        match self.duty_max {
            Some(most) if duty < most.saturating_neg() => {
                WheelDrive::Duty(Throttle::saturating_from_millionths(most.saturating_neg()))
            }
            _ => drive,
        }
    }
}

impl MotionPermit {
    /// The part of a wheel request that is permitted.
    #[must_use]
    pub const fn restrict(&self, left: WheelDrive, right: WheelDrive) -> (WheelDrive, WheelDrive) {
        let asked = (left.duty().millionths(), right.duty().millionths());
        if !self.armed || !self.fresh || !self.allows_direction(asked.0, asked.1) {
            (WheelDrive::Brake, WheelDrive::Brake)
        } else if self.inhibits_forward() {
            let away = (no_more_than(left, asked.1), no_more_than(right, asked.0));
            if self.sees_cliff() {
                self.reverse.restrict(away)
            } else {
                away
            }
        } else {
            (left, right)
        }
    }

    /// The part of a request for brush or suction that is permitted. `cleaning` keeps the lease of the request.
    #[must_use]
    pub const fn restrict_cleaner(&self, duty: Throttle) -> Throttle {
        if self.armed && self.inhibits.without(CLEANERS_MAY_RUN).is_empty() {
            duty
        } else {
            Throttle::ZERO
        }
    }

    /// Whether the inhibits let the wheels turn in these directions. Only the signs of the two numbers matter; standing
    /// still is always allowed.
    #[must_use]
    pub const fn allows_direction(&self, left: i32, right: i32) -> bool {
        if left == 0 && right == 0 {
            return true;
        }
        let blocking = self.inhibits.without(WHEELS_MAY_RUN);
        let blocking = if self.escaping_dock {
            blocking.without(DOCK_ESCAPE_MAY_RUN)
        } else {
            blocking
        };
        if !blocking.is_empty() {
            return false;
        }
        if self.sees_cliff() && (left > 0 || right > 0) {
            return false;
        }
        !self.inhibits.contains(Inhibit::Bumper) || self.is_away(left, right)
    }

    /// Whether a bumper zone is pressed or a wheel hangs: brushes and suction do not start then (S29).
    #[must_use]
    pub const fn has_contact(&self) -> bool {
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

    /// Reversing leads away from any contact. A turn on the spot leads away if it swings the pressed side back.
    const fn is_away(&self, left: i32, right: i32) -> bool {
        let backwards = left <= 0 && right <= 0;
        let turns_right = left >= 0 && right <= 0;
        let turns_left = right >= 0 && left <= 0;
        backwards
            || (turns_right && self.bumpers.left && !self.bumpers.right)
            || (turns_left && self.bumpers.right && !self.bumpers.left)
    }
}

/// Keeps a turn on the spot away from an obstacle from creeping forward: the wheel that turns forward gets at most the
/// backward duty of the other wheel, `other`.
const fn no_more_than(drive: WheelDrive, other: i32) -> WheelDrive {
    let duty = drive.duty().millionths();
    if duty > other.saturating_neg() && duty > 0 {
        WheelDrive::Duty(Throttle::saturating_from_millionths(other.saturating_neg()))
    } else {
        drive
    }
}
