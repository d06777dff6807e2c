//! Memory of short straights.

use crate::model::geometry::TurnSide;
use crate::model::reason::Reason;

/// A straight below this is short.
const SHORT_M: f64 = 0.25;
/// A straight above this leads out of the pocket.
const FREE_M: f64 = 0.6;
/// Short straights until the robot follows the edge by touch.
const EDGE_AFTER: u32 = 3;
/// Short straights until it searches all round for an opening.
const SCAN_AFTER: u32 = 10;
/// Short straights until the pocket counts as closed.
const CLOSED_AFTER: u32 = 22;
/// Distance to back off in the open and along an edge.
const BACK_M: f64 = 0.03;
/// Distance to back off while searching. Between chair legs the next turn needs a different position.
const SCAN_BACK_M: f64 = 0.08;

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
        if straight_m > FREE_M {
            *self = Self::default();
        } else if straight_m < SHORT_M {
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
            SCAN_BACK_M
        } else {
            BACK_M
        }
    }

    /// Range of the next turn, radians. After a head-on contact the turn must be larger than after a touch on one side.
    pub(super) fn turn_range_rad(&self, reason: Reason) -> (f64, f64) {
        match (self.kind(), reason) {
            (PocketKind::Open, Reason::BumpFront) => (1.3, 3.1),
            (PocketKind::Open, _) => (0.7, 2.6),
            (PocketKind::Edge, Reason::BumpFront) => (0.8, 1.8),
            (PocketKind::Edge, _) => (0.15, 0.6),
            (PocketKind::Cage, _) => (0.4, 1.4),
        }
    }

    /// Whether the robot is in the open.
    pub(super) fn is_open(&self) -> bool {
        self.kind() == PocketKind::Open
    }

    /// Whether all attempts have failed.
    pub(super) fn is_closed(&self) -> bool {
        self.short_straights >= CLOSED_AFTER
    }

    fn kind(&self) -> PocketKind {
        match self.short_straights {
            0..EDGE_AFTER => PocketKind::Open,
            EDGE_AFTER..SCAN_AFTER => PocketKind::Edge,
            _ => PocketKind::Cage,
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
        assert!(pocket.turn_range_rad(Reason::BumpLeft).1 < open.1.1);
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
