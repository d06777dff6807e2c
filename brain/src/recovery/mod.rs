//! Recovery. A *recovery sequence* tries *behaviors*, each a bounded sequence of manoeuvres; after each the task tries
//! again. A robot that leaves its *pen*, the box of two metres in which it got stuck, is free; one that has no behavior
//! left waits for a person. Recovery always ends: a pen gives a bounded number of behaviors ([`RecoverySequence`]), each
//! takes a bounded time, and between two of them the task has a bounded time to get out ([`Pen`]).

mod cliff_watch;
mod pen;
mod progress;
mod recovery_sequence;
mod slip;

pub(crate) use cliff_watch::CliffWatch;
pub(crate) use pen::{Pen, Whereabouts};
pub(crate) use progress::ProgressWatch;
pub(crate) use recovery_sequence::{RecoveryBehavior, RecoverySequence, StuckKind};
pub(crate) use slip::{SlipWatch, Traction};

use crate::model::geometry::TurnSide;
use crate::model::random::Random;
use crate::model::reason::Reason;
use crate::navigation::{BackOff, ContourTrace, Manoeuvre, ManoeuvreSequence, Turn};

/// Time along a contour: once round a closet.
const CONTOUR_S: f64 = 75.0;
/// Time for people to leave.
const WAIT_S: f64 = 60.0;

/// How the robot is stuck, by the reason.
pub(crate) const fn stuck_kind(reason: Reason) -> StuckKind {
    match reason {
        Reason::BoxedIn | Reason::ShutIn => StuckKind::Penned,
        _ => StuckKind::Held,
    }
}

/// The manoeuvres of a behavior.
pub(crate) fn escape(behavior: RecoveryBehavior, random: &mut Random) -> ManoeuvreSequence {
    let sign = if random.coin() { 1.0 } else { -1.0 };
    let mut turn = |low_rad, high_rad| Manoeuvre::Turn(Turn::by(sign * random.between(low_rad, high_rad)));
    let parts = match behavior {
        RecoveryBehavior::BackOut => vec![Manoeuvre::Back(BackOff::from_contact(0.12)), turn(1.0, 2.2)],
        RecoveryBehavior::Wiggle => vec![
            Manoeuvre::Swing { sign, left_s: 0.5 },
            Manoeuvre::Swing {
                sign: -sign,
                left_s: 0.8,
            },
            Manoeuvre::Swing { sign, left_s: 0.8 },
            turn(1.5, 2.8),
        ],
        RecoveryBehavior::Reverse => vec![Manoeuvre::Back(BackOff::from_contact(0.15)), turn(2.2, 3.1)],
        RecoveryBehavior::ContourLeft => vec![Manoeuvre::Contour(ContourTrace::new(
            TurnSide::Left,
            CONTOUR_S,
            random,
        ))],
        RecoveryBehavior::ContourRight => vec![Manoeuvre::Contour(ContourTrace::new(
            TurnSide::Right,
            CONTOUR_S,
            random,
        ))],
        RecoveryBehavior::Wait => vec![
            Manoeuvre::Back(BackOff::from_contact(0.02)),
            Manoeuvre::Wait { left_s: WAIT_S },
        ],
    };
    ManoeuvreSequence::new(parts)
}
