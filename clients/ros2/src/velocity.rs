//! Driving by `/cmd_vel`: each command is worth as long as the daemon's lease, so a robot whose commander dies stands soon after.

use rvac_api::RequestBody;

use crate::frames::TopSpeeds;
use crate::messages::Twist;

/// How long a command holds: the longest lease that the daemon gives.
pub(crate) const LEASE_MS: u16 = 400;

/// Why a command moves nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unfit {
    /// A speed is no number.
    NoNumber,
    /// It asks for a way that two wheels on a floor cannot go: sideways, up, or over.
    OffTheFloor,
    /// It is one of a stream that was there before, as of a stick that somebody forgot.
    AlreadyRunning,
}

impl Unfit {
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::NoNumber => "a speed in /cmd_vel is not a number",
            Self::OffTheFloor => {
                "/cmd_vel asks for a way sideways, up or over; this robot has linear.x and angular.z"
            }
            Self::AlreadyRunning => {
                "/cmd_vel asks for speed since before driving began or was refused; be silent for a second or ask for zero first"
            }
        }
    }
}

/// The request for a command. What is faster than the robot can go is driven at its limit with the same curvature.
///
/// # Errors
/// [`Unfit`].
pub(crate) fn drive(twist: &Twist, top: TopSpeeds, clean: bool) -> Result<RequestBody, Unfit> {
    let parts = [
        twist.linear.x,
        twist.angular.z,
        twist.linear.y,
        twist.linear.z,
        twist.angular.x,
        twist.angular.y,
    ];
    if parts.iter().any(|part| !part.is_finite()) {
        return Err(Unfit::NoNumber);
    }
    let [forward, turn, others @ ..] = parts;
    if others.iter().any(|part| *part != 0.0) {
        return Err(Unfit::OffTheFloor);
    }
    let excess = (forward.abs() / top.forward_m_per_s)
        .max(turn.abs() / top.turn_rad_per_s)
        .max(1.0);
    Ok(RequestBody::Drive {
        v: forward / excess,
        w: turn / excess,
        ttl: LEASE_MS,
        clean,
        power: None,
    })
}

#[cfg(test)]
mod tests {
    use rvac_api::RequestBody;

    use super::{Twist, Unfit, drive};
    use crate::frames::TopSpeeds;
    use crate::messages::Vector3;

    const TOP: TopSpeeds = TopSpeeds {
        forward_m_per_s: 0.4,
        turn_rad_per_s: 2.0,
    };

    fn twist(forward: f64, sideways: f64, turn: f64) -> Twist {
        Twist {
            linear: Vector3::flat(forward, sideways),
            angular: Vector3 {
                x: 0.0,
                y: 0.0,
                z: turn,
            },
        }
    }

    fn speeds(twist: &Twist) -> Result<(f64, f64), Unfit> {
        drive(twist, TOP, false).map(|body| match body {
            RequestBody::Drive { v, w, ttl: 400, .. } => (v, w),
            other => panic!("{other:?}"),
        })
    }

    #[test]
    fn a_command_becomes_a_lease_and_keeps_its_curvature_at_the_limit() {
        assert_eq!(speeds(&twist(0.2, 0.0, -1.0)), Ok((0.2, -1.0)));
        let (v, w) = speeds(&twist(-0.8, 0.0, 1.0)).expect("it can be driven");
        assert!((v + 0.4).abs() < 1e-12 && (w - 0.5).abs() < 1e-12, "{v} {w}");
        let (v, w) = speeds(&twist(0.1, 0.0, 8.0)).expect("it can be driven");
        assert!((v - 0.025).abs() < 1e-12 && (w - 2.0).abs() < 1e-12, "{v} {w}");
    }

    #[test]
    fn what_cannot_be_driven_moves_nothing() {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(speeds(&twist(wrong, 0.0, 0.0)), Err(Unfit::NoNumber));
            assert_eq!(speeds(&twist(0.0, wrong, 0.0)), Err(Unfit::NoNumber));
        }
        assert_eq!(speeds(&twist(0.1, 0.1, 0.0)), Err(Unfit::OffTheFloor));
    }
}
