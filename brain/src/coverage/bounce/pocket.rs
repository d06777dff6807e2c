//! Memory of short straights.

use core::ops::Range;

use super::parameters::{BOUNCE, POCKET};
use crate::model::geometry::TurnSide;
use crate::model::reason::Reason;

/// What the last straights show about the place.
#[derive(Clone, Debug, Default)]
pub(super) struct Pocket {
    short_straights: u32,
    side: Option<TurnSide>,
}

/// How tight the place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PocketKind {
    /// No pocket.
    Open,
    /// Narrow: small turns away from each contact follow the edge out.
    Edge,
    /// A corner or a cage: steps to the same side search for the opening.
    Cage,
}

impl Pocket {
    /// Records an encounter after a straight, and the side to which the robot would turn in the open.
    pub(super) fn enter(&mut self, straight_m: f64, side: TurnSide) {
        if straight_m > POCKET.free_m {
            *self = Self::default();
        } else if straight_m < POCKET.short_m {
            self.short_straights += 1;
            if self.kind() == PocketKind::Cage {
                self.side.get_or_insert(side);
            }
        }
    }

    /// The side to keep to, where the place requires one.
    pub(super) fn side(&self) -> Option<TurnSide> {
        self.side
    }

    /// Distance of the next back-off.
    pub(super) fn back_m(&self) -> f64 {
        if self.kind() == PocketKind::Cage {
            POCKET.cage_back_m
        } else {
            BOUNCE.back_m
        }
    }

    /// Range of the next turn, radians.
    pub(super) fn turn_range_rad(&self, reason: Reason) -> &'static Range<f64> {
        match (self.kind(), reason) {
            (PocketKind::Open, Reason::BumpFront | Reason::NoGoAhead) => &BOUNCE.ahead_turn_rad,
            (PocketKind::Open, _) => &BOUNCE.side_turn_rad,
            (PocketKind::Edge, Reason::BumpFront | Reason::NoGoAhead) => &POCKET.edge_ahead_turn_rad,
            (PocketKind::Edge, _) => &POCKET.edge_side_turn_rad,
            (PocketKind::Cage, _) => &POCKET.cage_turn_rad,
        }
    }

    /// Whether the robot is in the open.
    pub(super) fn is_open(&self) -> bool {
        self.kind() == PocketKind::Open
    }

    /// Whether all attempts have failed.
    pub(super) fn is_closed(&self) -> bool {
        self.short_straights >= POCKET.closed_after
    }

    fn kind(&self) -> PocketKind {
        if self.short_straights < POCKET.edge_after {
            PocketKind::Open
        } else if self.short_straights < POCKET.cage_after {
            PocketKind::Edge
        } else {
            PocketKind::Cage
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Pocket;
    use crate::model::geometry::TurnSide;
    use crate::model::reason::Reason;

    #[test]
    fn short_straights_lead_along_the_edge_then_round_to_one_side() {
        let mut pocket = Pocket::default();
        let open = (pocket.back_m(), pocket.turn_range_rad(Reason::BumpLeft));
        for _ in 0..5 {
            pocket.enter(0.1, TurnSide::Left);
        }
        assert!(pocket.turn_range_rad(Reason::BumpLeft).end < open.1.end);
        assert_eq!(pocket.side(), None);
        for encounter in 0..8 {
            assert!(!pocket.is_closed());
            pocket.enter(
                0.1,
                if encounter % 2 == 0 {
                    TurnSide::Right
                } else {
                    TurnSide::Left
                },
            );
        }
        assert_eq!(pocket.side(), Some(TurnSide::Right), "the first side in the cage");
        assert!(pocket.back_m() > open.0);
        pocket.enter(0.7, TurnSide::Right);
        assert_eq!((pocket.back_m(), pocket.turn_range_rad(Reason::BumpLeft)), open);
    }

    #[test]
    fn a_pocket_closes_after_a_bounded_number_of_straights() {
        let mut pocket = Pocket::default();
        let runs = (1..100).find(|_| {
            pocket.enter(0.0, TurnSide::Left);
            pocket.is_closed()
        });
        assert_eq!(runs, Some(22));
    }
}
