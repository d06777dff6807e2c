//! Memory of short runs.

use crate::behavior::Reason;
use crate::geometry::TurnSide;

/// A run below this is short.
const SHORT_RUN_M: f64 = 0.25;
/// A run above this leads out of the pocket.
const FREE_RUN_M: f64 = 0.6;
/// Short runs until the pocket is called closed.
const CLOSED_AFTER: u32 = 18;
/// Short runs until ranges grow by a level.
const RUNS_PER_LEVEL: u32 = 3;
/// Way back in the open.
const BACK_M: f64 = 0.03;
/// Way back that each level adds.
const BACK_PER_LEVEL_M: f64 = 0.03;
/// Most levels.
const LEVEL_MAX: u32 = 4;

/// What the last runs tell about the place.
#[derive(Clone, Debug, Default)]
pub(super) struct Pocket {
    short_runs: u32,
    side: Option<TurnSide>,
}

impl Pocket {
    /// Notes an encounter after a run, and the side that would be turned to in the open.
    pub(super) fn enter(&mut self, run_m: f64, side: TurnSide) {
        if run_m > FREE_RUN_M {
            *self = Self::default();
        } else if run_m < SHORT_RUN_M {
            self.short_runs += 1;
            self.side.get_or_insert(side);
        }
    }

    /// The side to keep to, once the place looks like a pocket.
    pub(super) fn side(&self) -> Option<TurnSide> {
        self.side.filter(|_| self.level() > 0)
    }

    /// Way back for the next evasion.
    pub(super) fn back_m(&self) -> f64 {
        BACK_M + BACK_PER_LEVEL_M * f64::from(self.level())
    }

    /// Range of the next turn in radians. Head-on a turn must be larger to come free than on one side.
    pub(super) fn turn_range_rad(&self, met: Reason) -> (f64, f64) {
        let (low, high) = if met == Reason::BumpFront {
            (1.3, 3.1)
        } else {
            (0.7, 2.6)
        };
        // In a pocket small steps to the same side scan for the opening.
        if self.level() == 0 {
            (low, high)
        } else {
            (0.5, 1.1 + 0.3 * f64::from(self.level()))
        }
    }

    /// Whether nothing helped.
    pub(super) fn is_closed(&self) -> bool {
        self.short_runs >= CLOSED_AFTER
    }

    fn level(&self) -> u32 {
        (self.short_runs / RUNS_PER_LEVEL).min(LEVEL_MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::Pocket;
    use crate::geometry::TurnSide;

    #[test]
    fn short_runs_widen_the_back_off_and_keep_the_side() {
        let mut pocket = Pocket::default();
        let open_back_m = pocket.back_m();
        for encounter in 0..6 {
            assert!(!pocket.is_closed());
            pocket.enter(
                0.1,
                if encounter % 2 == 0 {
                    TurnSide::Left
                } else {
                    TurnSide::Right
                },
            );
        }
        assert_eq!(pocket.side(), Some(TurnSide::Left));
        assert!(pocket.back_m() > open_back_m);
        pocket.enter(0.7, TurnSide::Right);
        assert_eq!((pocket.side(), pocket.back_m()), (None, open_back_m));
    }

    #[test]
    fn a_pocket_closes_after_a_bounded_number_of_runs() {
        let mut pocket = Pocket::default();
        let runs = (1..100).find(|_| {
            pocket.enter(0.0, TurnSide::Left);
            pocket.is_closed()
        });
        assert_eq!(runs, Some(18));
    }
}
