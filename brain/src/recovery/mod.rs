//! Getting free. A *ladder* has *rungs*, each a bounded sequence of movements; after each the task tries again. A robot that
//! leaves its *pen*, the box of two metres in which it was in trouble, has come free; one that has no rung left waits for a
//! person. So trouble ends either way: a pen gives a bounded number of rungs ([`Ladder`]), each takes a bounded time, and
//! between two of them the task has a bounded time to get out ([`Pen`]).

mod edge_watch;
mod ladder;
mod pen;
mod progress;
mod slip;

pub(crate) use edge_watch::EdgeWatch;
pub(crate) use ladder::{Grip, Ladder, Rung};
pub(crate) use pen::{Pen, Whereabouts};
pub(crate) use progress::ProgressWatch;
pub(crate) use slip::{SlipWatch, Traction};

use crate::model::geometry::TurnSide;
use crate::model::random::Random;
use crate::model::reason::Reason;
use crate::navigation::{BackOff, EdgeTrace, Part, Sequence, Turn};

/// Time along an edge: once round a closet.
const EDGE_S: f64 = 75.0;
/// Time that people get to leave.
const WAIT_S: f64 = 60.0;

/// How a reason of trouble holds the robot.
pub(crate) const fn grip(reason: Reason) -> Grip {
    match reason {
        Reason::BoxedIn | Reason::ShutIn => Grip::Penned,
        _ => Grip::Held,
    }
}

/// The movements of a rung.
pub(crate) fn escape(rung: Rung, random: &mut Random) -> Sequence {
    let sign = if random.coin() { 1.0 } else { -1.0 };
    let mut turn = |low_rad, high_rad| Part::Turn(Turn::by(sign * random.between(low_rad, high_rad)));
    let parts = match rung {
        Rung::BackOut => vec![Part::Back(BackOff::from_contact(0.12)), turn(1.0, 2.2)],
        Rung::Wiggle => vec![
            Part::Swing { sign, left_s: 0.5 },
            Part::Swing {
                sign: -sign,
                left_s: 0.8,
            },
            Part::Swing { sign, left_s: 0.8 },
            turn(1.5, 2.8),
        ],
        Rung::Reverse => vec![Part::Back(BackOff::from_contact(0.15)), turn(2.2, 3.1)],
        Rung::EdgeLeft => vec![Part::Edge(EdgeTrace::new(TurnSide::Left, EDGE_S, random))],
        Rung::EdgeRight => vec![Part::Edge(EdgeTrace::new(TurnSide::Right, EDGE_S, random))],
        Rung::Wait => vec![
            Part::Back(BackOff::from_contact(0.02)),
            Part::Wait { left_s: WAIT_S },
        ],
    };
    Sequence::new(parts)
}
