//! The ladder as an abstract machine: which rung comes next, and when there is none. It knows no places and no time, so that
//! all of its ways can be tried.
//!
//! Terms. *Held*: the robot cannot move off. *Penned*: it moves, but does not get out. *Pen*: what it has not left since it got
//! into trouble; whoever leaves it has come free, and begins at the foot of the ladder the next time.
//!
//! Why it ends: [`RecoverySequence::rungs_left`] is a number that falls by one with each rung that is given, that nothing but leaving the
//! pen raises, and at 0 no rung is given any more.

/// One try to come free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum RecoveryBehavior {
    /// Back and turn.
    BackOut,
    /// Shake the wheels and turn.
    Wiggle,
    /// Back as far as the ground is known and turn round.
    Reverse,
    /// Along the edge of what holds the robot, the edge on its left.
    ContourLeft,
    /// The same with the edge on its right.
    ContourRight,
    /// Stand still: who stands in the way may leave, and a door may open.
    Wait,
}

/// How the robot is in trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StuckKind {
    /// It cannot move off.
    Held,
    /// It moves and does not get out.
    Penned,
}

/// Rungs of a robot that is held, for each place.
const HELD: [RecoveryBehavior; 3] = [
    RecoveryBehavior::BackOut,
    RecoveryBehavior::Wiggle,
    RecoveryBehavior::Reverse,
];
/// Rungs of a robot that is held, for all places in a pen together.
const HELD_MAX: u8 = 15;
/// Rungs of a robot that is penned.
const PENNED: [RecoveryBehavior; 8] = [
    RecoveryBehavior::ContourLeft,
    RecoveryBehavior::ContourRight,
    RecoveryBehavior::Wait,
    RecoveryBehavior::ContourLeft,
    RecoveryBehavior::Wait,
    RecoveryBehavior::ContourRight,
    RecoveryBehavior::Wait,
    RecoveryBehavior::ContourLeft,
];

impl RecoveryBehavior {
    /// What the decision for it is called.
    pub(crate) const fn decision(self) -> &'static str {
        match self {
            Self::BackOut => "escape-back-out",
            Self::Wiggle => "escape-wiggle",
            Self::Reverse => "escape-reverse",
            Self::ContourLeft => "escape-edge-left",
            Self::ContourRight => "escape-edge-right",
            Self::Wait => "escape-wait",
        }
    }
}

/// Which rung comes next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct RecoverySequence {
    /// Rungs given at this place to a robot that is held.
    held_here: u8,
    /// Rungs given in this pen to a robot that is held.
    held: u8,
    /// Rungs given in this pen to a robot that is penned.
    penned: u8,
}

impl RecoverySequence {
    /// Trouble: the rung to try, `None` when all were tried.
    pub(crate) fn trouble(&mut self, stuck_kind: StuckKind) -> Option<RecoveryBehavior> {
        match stuck_kind {
            StuckKind::Held if self.held >= HELD_MAX => None,
            StuckKind::Held => {
                let behavior = HELD.get(usize::from(self.held_here)).copied()?;
                self.held_here += 1;
                self.held += 1;
                Some(behavior)
            }
            StuckKind::Penned => {
                let behavior = PENNED.get(usize::from(self.penned)).copied()?;
                self.penned += 1;
                Some(behavior)
            }
        }
    }

    /// The robot has come away from the place where it was held.
    pub(crate) fn move_off(&mut self) {
        self.held_here = 0;
    }

    /// The robot has left the pen. Tells how many rungs that took.
    pub(crate) fn leave(&mut self) -> u8 {
        let behaviors = self.held + self.penned;
        *self = Self::default();
        behaviors
    }

    /// Rungs that can still be given in this pen, whatever happens.
    #[cfg(test)]
    const fn behaviors_left(self) -> u8 {
        HELD_MAX - self.held + PENNED.len() as u8 - self.penned
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{HELD_MAX, PENNED, RecoveryBehavior, RecoverySequence, StuckKind};

    /// Everything that can happen to a robot that does not leave its pen.
    #[derive(Clone, Copy, Debug)]
    enum Event {
        Trouble(StuckKind),
        MoveOff,
    }

    const EVENTS: [Event; 3] = [
        Event::Trouble(StuckKind::Held),
        Event::Trouble(StuckKind::Penned),
        Event::MoveOff,
    ];

    /// The ladder after an event, and the rung that was given; `Err` = it gave up.
    fn after(
        mut sequence: RecoverySequence,
        event: Event,
    ) -> Result<(RecoverySequence, Option<RecoveryBehavior>), ()> {
        match event {
            Event::Trouble(stuck_kind) => match sequence.trouble(stuck_kind) {
                Some(behavior) => Ok((sequence, Some(behavior))),
                None => Err(()),
            },
            Event::MoveOff => {
                sequence.move_off();
                Ok((sequence, None))
            }
        }
    }

    /// All states that any sequence of events leads to.
    fn reachable() -> BTreeSet<RecoverySequence> {
        let mut found = BTreeSet::from([RecoverySequence::default()]);
        let mut open = vec![RecoverySequence::default()];
        while let Some(sequence) = open.pop() {
            for event in EVENTS {
                if let Ok((next, _)) = after(sequence, event)
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
        for sequence in states {
            for event in EVENTS {
                match after(sequence, event) {
                    Ok((next, Some(_))) => assert_eq!(next.behaviors_left() + 1, sequence.behaviors_left()),
                    Ok((next, None)) => assert_eq!(next.behaviors_left(), sequence.behaviors_left()),
                    Err(()) => assert!(matches!(event, Event::Trouble(_))),
                }
            }
        }
    }

    /// Every sequence of troubles, with any number of moves between them, that is longer than the measure has given up.
    #[test]
    fn no_sequence_of_events_is_given_more_rungs_than_the_measure_says() {
        let most = usize::from(RecoverySequence::default().behaviors_left());
        assert_eq!(most, usize::from(HELD_MAX) + PENNED.len());
        // States after so many rungs, over all sequences at once.
        let mut now = BTreeSet::from([RecoverySequence::default()]);
        for given in 0.. {
            // Moving off as often as you like.
            let moved = now.iter().map(|sequence| {
                let mut moved = *sequence;
                moved.move_off();
                moved
            });
            let all: BTreeSet<RecoverySequence> = now.iter().copied().chain(moved).collect();
            now = all
                .iter()
                .flat_map(|sequence| {
                    [StuckKind::Held, StuckKind::Penned]
                        .map(|stuck_kind| after(*sequence, Event::Trouble(stuck_kind)).ok())
                })
                .flatten()
                .map(|(sequence, _)| sequence)
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
        for mut sequence in reachable() {
            let behaviors = sequence.behaviors_left() + sequence.leave();
            assert_eq!(behaviors, RecoverySequence::default().behaviors_left());
            assert_eq!(sequence, RecoverySequence::default());
        }
    }

    #[test]
    fn a_robot_that_is_held_at_one_place_gets_three_tries() {
        let mut sequence = RecoverySequence::default();
        let behaviors = [(); 4].map(|()| sequence.trouble(StuckKind::Held));
        let expected = [
            Some(RecoveryBehavior::BackOut),
            Some(RecoveryBehavior::Wiggle),
            Some(RecoveryBehavior::Reverse),
            None,
        ];
        assert_eq!(behaviors, expected);
        sequence.move_off();
        assert_eq!(sequence.trouble(StuckKind::Held), Some(RecoveryBehavior::BackOut));
    }
}
