//! The bounded memory of a ladder.

use crate::geometry::Point2;

/// Come this far from the place of trouble, the robot counts as free.
const FREE_M: f64 = 0.3;

/// One try to come free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rung {
    /// Back and turn.
    BackOut,
    /// Shake the wheels and turn.
    Wiggle,
    /// Back as far as the ground is known and turn round.
    Reverse,
}

impl Rung {
    const ALL: [Self; 3] = [Self::BackOut, Self::Wiggle, Self::Reverse];

    /// What the decision for it is called.
    pub(crate) const fn decision(self) -> &'static str {
        match self {
            Self::BackOut => "escape-back-out",
            Self::Wiggle => "escape-wiggle",
            Self::Reverse => "escape-reverse",
        }
    }
}

/// Which rung comes next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ladder {
    climbed: usize,
    trouble_at: Option<Point2>,
}

impl Ladder {
    /// Trouble at `place`: the rung to try, `None` when all were tried.
    pub(crate) fn trouble(&mut self, place: Point2) -> Option<Rung> {
        self.watch(place);
        self.trouble_at.get_or_insert(place);
        let rung = Rung::ALL.get(self.climbed).copied();
        self.climbed += 1;
        rung
    }

    /// Notes where the robot is, and forgets the trouble it has left behind.
    pub(crate) fn watch(&mut self, place: Point2) {
        if self
            .trouble_at
            .is_some_and(|trouble| trouble.distance_m(place) > FREE_M)
        {
            *self = Self::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Ladder, Rung};
    use crate::geometry::Point2;

    #[test]
    fn three_tries_then_none() {
        let mut ladder = Ladder::default();
        let rungs = [(); 5].map(|()| ladder.trouble(Point2::ORIGIN));
        assert_eq!(
            rungs,
            [
                Some(Rung::BackOut),
                Some(Rung::Wiggle),
                Some(Rung::Reverse),
                None,
                None
            ]
        );
    }

    #[test]
    fn leaving_the_place_forgets_the_tries() {
        let mut ladder = Ladder::default();
        ladder.trouble(Point2::ORIGIN);
        ladder.watch(Point2 { x_m: 0.2, y_m: 0.0 });
        assert_eq!(ladder.trouble(Point2 { x_m: 0.25, y_m: 0.0 }), Some(Rung::Wiggle));
        ladder.watch(Point2 { x_m: 0.31, y_m: 0.0 });
        assert_eq!(
            ladder.trouble(Point2 { x_m: 0.31, y_m: 0.0 }),
            Some(Rung::BackOut)
        );
    }
}
