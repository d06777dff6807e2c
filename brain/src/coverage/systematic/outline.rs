//! What the robot knows of the outline of its home when it plans.

use super::parameters::OUTLINE;
use crate::coverage::perimeter::Perimeter;
use crate::mapping::{CELL_M, CellKnowledge};
use crate::model::geometry::Point2;
use crate::model::reason::Reason;
use crate::navigation::Situation;

/// What is known of the home.
#[derive(Debug)]
pub(super) enum Outline {
    /// All of it, since before the job.
    Known,
    /// Nothing: the lap along the walls comes first.
    Lap(Box<Perimeter>),
    /// The walls; the robot explores the rest.
    Growing(OptimisticMargin),
}

/// The laps along walls so far: where one went round a part of the home only, another follows once the robot stands beyond it.
#[derive(Debug, Default)]
pub(super) struct Laps {
    last: Option<Box<Perimeter>>,
    ended: u32,
}

impl Laps {
    /// A lap has ended for this reason. Returns how far the robot explores beyond what it knows now.
    pub(super) fn end(&mut self, lap: Box<Perimeter>, reason: Reason) -> OptimisticMargin {
        self.ended += 1;
        self.last = Some(lap);
        match reason {
            Reason::BackAtStart if self.ended == 1 => OptimisticMargin::CLOSED,
            Reason::BackAtStart | Reason::KnownWall => OptimisticMargin::KNOWN,
            _ => OptimisticMargin::OPEN,
        }
    }

    /// The next lap, for a robot that has come to a place beyond all laps so far.
    pub(super) fn next_from(&mut self, here: Point2) -> Option<Box<Perimeter>> {
        if self.ended >= OUTLINE.laps_max || !self.last.as_ref()?.leaves_out(here) {
            return None;
        }
        let mut lap = self.last.take()?;
        lap.begin_again();
        Some(lap)
    }
}

/// How much unknown floor beyond the known part is assumed to be free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OptimisticMargin {
    /// Width, metres.
    pub(super) beyond_m: f64,
    /// Width once no other floor is left, metres.
    at_last_m: f64,
}

impl OptimisticMargin {
    /// After a closed lap along the walls.
    pub(super) const CLOSED: Self = Self {
        beyond_m: OUTLINE.margin_near_m,
        at_last_m: OUTLINE.margin_near_m,
    };
    /// After a lap that ended because it showed nothing new.
    pub(super) const KNOWN: Self = Self {
        beyond_m: OUTLINE.margin_near_m,
        at_last_m: OUTLINE.margin_far_m,
    };
    /// After a lap that ended for another reason.
    pub(super) const OPEN: Self = Self {
        beyond_m: OUTLINE.margin_far_m,
        at_last_m: OUTLINE.margin_far_m,
    };

    /// Whether the margin reaches as far as a room: where a wall was missed it includes floor outside of the home.
    pub(super) fn is_far(self) -> bool {
        self.beyond_m > OUTLINE.margin_near_m
    }

    /// Widens the margin when no other floor is left. `false` when it was as wide already.
    pub(super) fn grow(&mut self) -> bool {
        let grows = self.beyond_m < self.at_last_m;
        self.beyond_m = self.at_last_m;
        grows
    }
}

/// Whether the reachable floor is next to nothing of the known free floor.
pub(super) fn shuts_in(reachable_m2: f64, free_m2: f64) -> bool {
    reachable_m2 < OUTLINE.shut_in_share * free_m2
}

/// Whether the map was good enough to plan on when the job began.
pub(super) fn knows_home(situation: &Situation<'_>) -> bool {
    let is_blind = situation.config.sensors.proximity.sensors().is_empty();
    let knowledge = situation.map.knowledge().values();
    let free = knowledge
        .iter()
        .filter(|kind| **kind == CellKnowledge::Free)
        .count();
    let shows_home = free as f64 * CELL_M * CELL_M > OUTLINE.known_m2;
    situation.is_tracked || (is_blind && shows_home)
}

#[cfg(test)]
mod tests {
    use super::{OptimisticMargin, shuts_in};

    #[test]
    fn only_a_lap_that_may_have_missed_a_passage_widens_the_margin() {
        for (mut margin, grows) in [
            (OptimisticMargin::CLOSED, false),
            (OptimisticMargin::KNOWN, true),
            (OptimisticMargin::OPEN, false),
        ] {
            assert_eq!(margin.grow(), grows);
            assert!(!margin.grow(), "once");
        }
    }

    #[test]
    fn a_map_encloses_a_robot_that_reaches_only_a_corner_of_it() {
        assert!(shuts_in(0.8, 9.0));
        assert!(
            !shuts_in(7.0, 9.0),
            "what is too narrow for the body is free, too"
        );
        assert!(!shuts_in(0.0, 0.0), "nothing is known");
    }
}
