//! The recovery sequence as an abstract state machine: which behavior comes next, and when there is none. It knows no
//! positions and no time, so that tests can try all of its paths.
//!
//! Terms. *Held*: the robot cannot move off. *Penned*: it moves, but does not get out. *Pen*: the area that it has not left
//! since it got stuck; a robot that leaves it is free and begins with the first behavior the next time.
//!
//! Termination: [`RecoverySequence::behaviors_left`] falls by one with each behavior, only leaving the pen raises it, and
//! at 0 there is no further behavior.

use crate::model::decision::DecisionKind;

/// One attempt to get free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum RecoveryBehavior {
    /// Back and turn.
    BackOut,
    /// Shake the wheels and turn.
    Wiggle,
    /// Back as far as the reverse budget allows and turn round.
    Reverse,
    /// Along the contour of the obstacle, on the robot's left.
    ContourLeft,
    /// The same with the contour on its right.
    ContourRight,
    /// Stand still: people in the way may leave, and a door may open.
    Wait,
}

/// How the robot is stuck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StuckKind {
    /// It cannot move off.
    Held,
    /// It moves and does not get out.
    Penned,
}

/// Behaviors of a held robot, for each position.
const HELD: [RecoveryBehavior; 3] = [
    RecoveryBehavior::BackOut,
    RecoveryBehavior::Wiggle,
    RecoveryBehavior::Reverse,
];
/// Behaviors of a held robot, for all positions in a pen together.
const HELD_MAX: u8 = 15;
/// Behaviors of a penned robot.
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
    /// The name of its decision.
    pub(crate) const fn decision(self) -> DecisionKind {
        match self {
            Self::BackOut => DecisionKind::EscapeBackOut,
            Self::Wiggle => DecisionKind::EscapeWiggle,
            Self::Reverse => DecisionKind::EscapeReverse,
            Self::ContourLeft => DecisionKind::EscapeEdgeLeft,
            Self::ContourRight => DecisionKind::EscapeEdgeRight,
            Self::Wait => DecisionKind::EscapeWait,
        }
    }
}

/// Which behavior comes next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct RecoverySequence {
    /// Behaviors used at this position while held.
    held_here: u8,
    /// Behaviors used in this pen while held.
    held: u8,
    /// Behaviors used in this pen while penned.
    penned: u8,
}

impl RecoverySequence {
    /// The robot is stuck: the behavior to try, `None` when all were tried.
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

    /// The robot has moved away from where it was held.
    pub(crate) fn move_off(&mut self) {
        self.held_here = 0;
    }

    /// The robot has left the pen. Gives how many behaviors that took.
    pub(crate) fn leave(&mut self) -> u8 {
        let behaviors = self.held + self.penned;
        *self = Self::default();
        behaviors
    }

    /// Behaviors that are still available in this pen, whatever happens.
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

    /// The sequence after an event, and the chosen behavior; `Err` = it gave up.
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

    /// Every sequence of stuck events, with any number of moves between them, that is longer than the measure has given up.
    #[test]
    fn no_sequence_of_events_gets_more_behaviors_than_the_measure_allows() {
        let most = usize::from(RecoverySequence::default().behaviors_left());
        assert_eq!(most, usize::from(HELD_MAX) + PENNED.len());
        // States after `given` behaviors, over all sequences at once.
        let mut now = BTreeSet::from([RecoverySequence::default()]);
        for given in 0.. {
            // Any number of moves.
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
            assert!(given <= most, "{given} behaviors were given");
            if now.is_empty() {
                assert_eq!(given, most, "the longest sequence uses all of the measure");
                break;
            }
        }
    }

    #[test]
    fn leaving_the_pen_resets_every_state() {
        for mut sequence in reachable() {
            let behaviors = sequence.behaviors_left() + sequence.leave();
            assert_eq!(behaviors, RecoverySequence::default().behaviors_left());
            assert_eq!(sequence, RecoverySequence::default());
        }
    }

    #[test]
    fn a_robot_that_is_held_at_one_place_gets_three_attempts() {
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
