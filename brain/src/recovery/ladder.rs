//! The ladder as an abstract machine: which rung comes next, and when there is none. It knows no places and no time, so that
//! all of its ways can be tried.
//!
//! Terms. *Held*: the robot cannot move off. *Penned*: it moves, but does not get out. *Pen*: what it has not left since it got
//! into trouble; whoever leaves it has come free, and begins at the foot of the ladder the next time.
//!
//! Why it ends: [`Ladder::rungs_left`] is a number that falls by one with each rung that is given, that nothing but leaving the
//! pen raises, and at 0 no rung is given any more.

/// One try to come free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rung {
    /// Back and turn.
    BackOut,
    /// Shake the wheels and turn.
    Wiggle,
    /// Back as far as the ground is known and turn round.
    Reverse,
    /// Along the edge of what holds the robot, the edge on its left.
    EdgeLeft,
    /// The same with the edge on its right.
    EdgeRight,
    /// Stand still: who stands in the way may leave, and a door may open.
    Wait,
}

/// How the robot is in trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grip {
    /// It cannot move off.
    Held,
    /// It moves and does not get out.
    Penned,
}

/// Rungs of a robot that is held, for each place.
const HELD: [Rung; 3] = [Rung::BackOut, Rung::Wiggle, Rung::Reverse];
/// Rungs of a robot that is held, for all places in a pen together.
const HELD_MAX: u8 = 15;
/// Rungs of a robot that is penned.
const PENNED: [Rung; 8] = [
    Rung::EdgeLeft,
    Rung::EdgeRight,
    Rung::Wait,
    Rung::EdgeLeft,
    Rung::Wait,
    Rung::EdgeRight,
    Rung::Wait,
    Rung::EdgeLeft,
];

impl Rung {
    /// What the decision for it is called.
    pub(crate) const fn decision(self) -> &'static str {
        match self {
            Self::BackOut => "escape-back-out",
            Self::Wiggle => "escape-wiggle",
            Self::Reverse => "escape-reverse",
            Self::EdgeLeft => "escape-edge-left",
            Self::EdgeRight => "escape-edge-right",
            Self::Wait => "escape-wait",
        }
    }
}

/// Which rung comes next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Ladder {
    /// Rungs given at this place to a robot that is held.
    held_here: u8,
    /// Rungs given in this pen to a robot that is held.
    held: u8,
    /// Rungs given in this pen to a robot that is penned.
    penned: u8,
}

impl Ladder {
    /// Trouble: the rung to try, `None` when all were tried.
    pub(crate) fn trouble(&mut self, grip: Grip) -> Option<Rung> {
        match grip {
            Grip::Held if self.held >= HELD_MAX => None,
            Grip::Held => {
                let rung = HELD.get(usize::from(self.held_here)).copied()?;
                self.held_here += 1;
                self.held += 1;
                Some(rung)
            }
            Grip::Penned => {
                let rung = PENNED.get(usize::from(self.penned)).copied()?;
                self.penned += 1;
                Some(rung)
            }
        }
    }

    /// The robot has come away from the place where it was held.
    pub(crate) fn move_off(&mut self) {
        self.held_here = 0;
    }

    /// The robot has left the pen. Tells how many rungs that took.
    pub(crate) fn leave(&mut self) -> u8 {
        let rungs = self.held + self.penned;
        *self = Self::default();
        rungs
    }

    /// Rungs that can still be given in this pen, whatever happens.
    #[cfg(test)]
    const fn rungs_left(self) -> u8 {
        HELD_MAX - self.held + PENNED.len() as u8 - self.penned
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{Grip, HELD_MAX, Ladder, PENNED, Rung};

    /// Everything that can happen to a robot that does not leave its pen.
    #[derive(Clone, Copy, Debug)]
    enum Event {
        Trouble(Grip),
        MoveOff,
    }

    const EVENTS: [Event; 3] = [
        Event::Trouble(Grip::Held),
        Event::Trouble(Grip::Penned),
        Event::MoveOff,
    ];

    /// The ladder after an event, and the rung that was given; `Err` = it gave up.
    fn after(mut ladder: Ladder, event: Event) -> Result<(Ladder, Option<Rung>), ()> {
        match event {
            Event::Trouble(grip) => match ladder.trouble(grip) {
                Some(rung) => Ok((ladder, Some(rung))),
                None => Err(()),
            },
            Event::MoveOff => {
                ladder.move_off();
                Ok((ladder, None))
            }
        }
    }

    /// All states that any sequence of events leads to.
    fn reachable() -> BTreeSet<Ladder> {
        let mut found = BTreeSet::from([Ladder::default()]);
        let mut open = vec![Ladder::default()];
        while let Some(ladder) = open.pop() {
            for event in EVENTS {
                if let Ok((next, _)) = after(ladder, event)
                    && found.insert(next)
                {
                    open.push(next);
                }
            }
        }
        found
    }

    #[test]
    fn in_every_reachable_state_every_event_gives_up_or_lowers_the_measure() {
        let states = reachable();
        assert!(states.len() > 300, "{}", states.len());
        for ladder in states {
            for event in EVENTS {
                match after(ladder, event) {
                    Ok((next, Some(_))) => assert_eq!(next.rungs_left() + 1, ladder.rungs_left()),
                    Ok((next, None)) => assert_eq!(next.rungs_left(), ladder.rungs_left()),
                    Err(()) => assert!(matches!(event, Event::Trouble(_))),
                }
            }
        }
    }

    /// Every sequence of troubles, with any number of moves between them, that is longer than the measure has given up.
    #[test]
    fn no_sequence_of_events_is_given_more_rungs_than_the_measure_says() {
        let most = usize::from(Ladder::default().rungs_left());
        assert_eq!(most, usize::from(HELD_MAX) + PENNED.len());
        // States after so many rungs, over all sequences at once.
        let mut now = BTreeSet::from([Ladder::default()]);
        for given in 0.. {
            // Moving off as often as you like.
            let moved = now.iter().map(|ladder| {
                let mut moved = *ladder;
                moved.move_off();
                moved
            });
            let all: BTreeSet<Ladder> = now.iter().copied().chain(moved).collect();
            now = all
                .iter()
                .flat_map(|ladder| {
                    [Grip::Held, Grip::Penned].map(|grip| after(*ladder, Event::Trouble(grip)).ok())
                })
                .flatten()
                .map(|(ladder, _)| ladder)
                .collect();
            assert!(given <= most, "{given} rungs were given");
            if now.is_empty() {
                assert_eq!(given, most, "the longest sequence uses all of the measure");
                break;
            }
        }
    }

    #[test]
    fn leaving_the_pen_begins_anew_from_every_state() {
        for mut ladder in reachable() {
            let rungs = ladder.rungs_left() + ladder.leave();
            assert_eq!(rungs, Ladder::default().rungs_left());
            assert_eq!(ladder, Ladder::default());
        }
    }

    #[test]
    fn a_robot_that_is_held_at_one_place_gets_three_tries() {
        let mut ladder = Ladder::default();
        let rungs = [(); 4].map(|()| ladder.trouble(Grip::Held));
        let wanted = [Some(Rung::BackOut), Some(Rung::Wiggle), Some(Rung::Reverse), None];
        assert_eq!(rungs, wanted);
        ladder.move_off();
        assert_eq!(ladder.trouble(Grip::Held), Some(Rung::BackOut));
    }
}
