//! Recovery. A *recovery sequence* tries *behaviors*, each a bounded sequence of manoeuvres; after each the task tries
//! again. A robot that leaves its *pen*, the box of two metres in which it got stuck, is free; one that has no behavior
//! left waits for a person. Recovery always ends: a pen gives a bounded number of behaviors ([`RecoverySequence`]), each
//! takes a bounded time, and between two of them the task has a bounded time to get out ([`Pen`]).

mod cliff_watch;
mod parameters;
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
use parameters::MANOEUVRES;

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
    let mut turn = |range_rad| Manoeuvre::Turn(Turn::by(sign * random.within(range_rad)));
    let parts = match behavior {
        RecoveryBehavior::BackOut => vec![
            Manoeuvre::Back(BackOff::from_contact(MANOEUVRES.back_out_m)),
            turn(&MANOEUVRES.back_out_turn_rad),
        ],
        RecoveryBehavior::Wiggle => vec![
            Manoeuvre::Swing {
                sign,
                left_s: MANOEUVRES.wiggle_first_s,
            },
            Manoeuvre::Swing {
                sign: -sign,
                left_s: MANOEUVRES.wiggle_s,
            },
            Manoeuvre::Swing {
                sign,
                left_s: MANOEUVRES.wiggle_s,
            },
            turn(&MANOEUVRES.wiggle_turn_rad),
        ],
        RecoveryBehavior::Reverse => vec![
            Manoeuvre::Back(BackOff::from_contact(MANOEUVRES.reverse_m)),
            turn(&MANOEUVRES.reverse_turn_rad),
        ],
        RecoveryBehavior::ContourLeft => vec![Manoeuvre::Contour(ContourTrace::new(
            TurnSide::Left,
            MANOEUVRES.contour_s,
            random,
        ))],
        RecoveryBehavior::ContourRight => vec![Manoeuvre::Contour(ContourTrace::new(
            TurnSide::Right,
            MANOEUVRES.contour_s,
            random,
        ))],
        RecoveryBehavior::Wait => vec![
            Manoeuvre::Back(BackOff::from_contact(MANOEUVRES.wait_back_m)),
            Manoeuvre::Wait {
                left_s: MANOEUVRES.wait_s,
            },
        ],
    };
    ManoeuvreSequence::new(parts)
}
