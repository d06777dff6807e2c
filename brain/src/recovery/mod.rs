//! Getting free. A *ladder* has three *rungs*, each a bounded sequence of movements; after each the task tries again. Who
//! is in trouble again before having come 0.3 m away takes the next rung; after the last one the robot waits for a person.

mod ladder;
mod progress;
mod slip;

pub(crate) use ladder::{Ladder, Rung};
pub(crate) use progress::ProgressWatch;
pub(crate) use slip::{SlipWatch, Traction};

use crate::manoeuvre::{BackOff, Part, Sequence, Turn};
use crate::random::Random;

/// The movements of a rung.
pub(crate) fn escape(rung: Rung, random: &mut Random) -> Sequence {
    let sign = if random.coin() { 1.0 } else { -1.0 };
    let mut turn = |low_rad, high_rad| Part::Turn(Turn::by(sign * random.between(low_rad, high_rad)));
    Sequence::new(match rung {
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
    })
}
