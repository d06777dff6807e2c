//! How much of its floor a job has swept so far, also between two plans.
//!
//! The newest plan gives the floor area and the swept part; what was swept since is added. In the low bound a strip counts
//! less, the less certain the pose was there.

use super::known_floor::CountedFloor;
use super::parameters::EVALUATION;
use crate::coverage::estimate::kept_low;
use crate::coverage::plan::{CoveragePlan, PlanSettings};
use crate::coverage::target_floor::TargetFloor;
use crate::mapping::{CELL_M, Map, Raster};
use crate::model::swept_share::SweptShare;

/// Floor that was passed, square metres, and its low bound.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PassedFloor {
    m2: f64,
    low_m2: f64,
}

impl PassedFloor {
    /// Counts the passed cells that belong to the target floor.
    pub(super) fn count(
        passed: &Raster<bool>,
        target: &TargetFloor,
        map: &Map,
        settings: &PlanSettings,
    ) -> Self {
        let (mut cells, mut cells_low) = (0.0, 0.0);
        // Neighbours mostly have the same deviation, and the share is expensive to compute.
        let mut before: (Option<f64>, f64) = (None, kept_low(None, settings));
        for (index, _) in passed.values().iter().enumerate().filter(|(_, is)| **is) {
            let cell = passed.cell(index);
            if target.pattern_at(cell).is_none() {
                continue;
            }
            let sigma_m = map.sigma_m(cell);
            if sigma_m != before.0 {
                before = (sigma_m, kept_low(sigma_m, settings));
            }
            cells += 1.0;
            cells_low += before.1;
        }
        Self {
            m2: cells * CELL_M * CELL_M,
            low_m2: cells_low * CELL_M * CELL_M,
        }
    }

    /// The passed floor, square metres.
    pub(super) fn m2(self) -> f64 {
        self.m2
    }

    /// Ratio of the low bound to the passed floor.
    fn kept_low(self) -> f64 {
        if self.m2 > 0.0 { self.low_m2 / self.m2 } else { 1.0 }
    }
}

/// The figures of a plan.
#[derive(Clone, Copy, Debug)]
struct Tally {
    settings: PlanSettings,
    /// Floor counted when the plan was begun.
    counted: PassedFloor,
    /// Swept and total floor according to the plan, square metres; 0 until it is finished.
    passed_m2: f64,
    floor_m2: f64,
}

/// The figures of the plan in progress and of the newest one.
#[derive(Debug, Default)]
pub(super) struct Shares {
    next: Option<Tally>,
    newest: Option<Tally>,
    /// Most floor that was known at any time, square metres.
    most_m2: f64,
}

impl Shares {
    /// A plan is begun with this much counted.
    pub(super) fn begin(&mut self, settings: PlanSettings, counted: PassedFloor) {
        self.next = Some(Tally {
            settings,
            counted,
            passed_m2: 0.0,
            floor_m2: 0.0,
        });
    }

    /// Records how much floor is known now; gives the maximum so far.
    pub(super) fn know_floor(&mut self, known_m2: f64) -> f64 {
        self.most_m2 = self.most_m2.max(known_m2);
        self.most_m2
    }

    /// The plan is finished, with this much floor.
    pub(super) fn take(&mut self, plan: &CoveragePlan, floor_m2: f64) {
        self.newest = self.next.take().map(|tally| Tally {
            passed_m2: plan.passed_m2(),
            floor_m2,
            ..tally
        });
    }

    /// The plan gives no figures: the one before it stays the newest.
    pub(super) fn pass_over(&mut self) {
        self.next = None;
    }

    /// Whether this finished plan does not know most of what was passed.
    pub(super) fn is_elsewhere(&self, plan: &CoveragePlan) -> bool {
        let begun = self.next.filter(|_| self.has_plan());
        begun.is_some_and(|tally| plan.passed_m2() < EVALUATION.elsewhere_share * tally.counted.m2)
    }

    /// Whether any plan has given figures yet.
    pub(super) fn has_plan(&self) -> bool {
        self.newest.is_some()
    }

    /// The share with what is counted now; of a known home's floor where that is `known`. Where nothing can be counted because the map was drawn again, the figures of the
    /// plan are used alone.
    pub(super) fn share(
        &self,
        count: impl Fn(&PlanSettings) -> Option<PassedFloor>,
        known: impl Fn() -> Option<CountedFloor>,
    ) -> Option<SweptShare> {
        let tally = self.newest.filter(|tally| tally.floor_m2 > 0.0)?;
        let now = count(&tally.settings).unwrap_or(tally.counted);
        let CountedFloor { floor_m2, passed_m2 } = known()
            .filter(|known| known.floor_m2 > 0.0)
            .unwrap_or_else(|| CountedFloor {
                floor_m2: tally.floor_m2,
                passed_m2: tally.passed_m2 + (now.m2 - tally.counted.m2).max(0.0),
            });
        let share = (passed_m2 / floor_m2).clamp(0.0, 1.0);
        Some(SweptShare {
            share,
            share_low: share * now.kept_low(),
            left_m2: (1.0 - share) * floor_m2,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{CountedFloor, PassedFloor, Shares};
    use crate::coverage::plan::{CoveragePlan, PlanSettings};

    const SETTINGS: PlanSettings = PlanSettings {
        swath_m: 0.25,
        sigma_m: 0.01,
        cruise_m_per_s: 0.25,
        turn_rad_per_s: 1.2,
        takes_along: true,
    };

    fn passed(m2: f64, low_m2: f64) -> PassedFloor {
        PassedFloor { m2, low_m2 }
    }

    /// After a plan over 10 square metres of which two were passed.
    fn shares() -> Shares {
        let plan = CoveragePlan {
            floor_m2: 10.0,
            open_m2: 8.0,
            ..CoveragePlan::default()
        };
        let mut shares = Shares::default();
        shares.begin(SETTINGS, passed(2.5, 2.0));
        assert_eq!(shares.share(|_| None, || None), None, "no plan is made yet");
        shares.take(&plan, 10.0);
        shares
    }

    #[test]
    fn floor_passed_since_the_plan_is_added() {
        let reported = shares()
            .share(|_| Some(passed(5.5, 4.4)), || None)
            .expect("there is floor");
        assert!((reported.share - 0.5).abs() < 1e-9, "{reported:?}");
        assert!((reported.share_low - 0.4).abs() < 1e-9, "{reported:?}");
    }

    #[test]
    fn the_floor_of_a_known_home_counts_instead_of_that_of_the_plan() {
        let known = CountedFloor {
            floor_m2: 20.0,
            passed_m2: 19.0,
        };
        let reported = shares()
            .share(|_| Some(passed(5.5, 4.4)), || Some(known))
            .expect("there is floor");
        assert!((reported.share - 0.95).abs() < 1e-9, "{reported:?}");
        assert!((reported.left_m2 - 1.0).abs() < 1e-9, "{reported:?}");
    }

    #[test]
    fn without_a_count_the_plan_gives_the_share_and_no_share_exceeds_one() {
        let reported = shares().share(|_| None, || None).expect("there is floor");
        assert!((reported.share - 0.2).abs() < 1e-9, "{reported:?}");
        assert!((reported.share_low - 0.16).abs() < 1e-9, "{reported:?}");
        let all = shares()
            .share(|_| Some(passed(40.0, 40.0)), || None)
            .expect("there is floor");
        assert_eq!((all.share, all.share_low), (1.0, 1.0));
    }

    #[test]
    fn a_plan_that_misses_the_passed_floor_belongs_to_a_robot_elsewhere() {
        let beside = CoveragePlan {
            floor_m2: 20.0,
            open_m2: 20.0,
            ..CoveragePlan::default()
        };
        let mut first = Shares::default();
        first.begin(SETTINGS, passed(2.5, 2.0));
        assert!(!first.is_elsewhere(&beside), "nothing else is known");
        let mut shares = shares();
        shares.begin(SETTINGS, passed(2.5, 2.0));
        assert!(shares.is_elsewhere(&beside));
        let within = CoveragePlan {
            open_m2: 18.5,
            ..beside
        };
        assert!(!shares.is_elsewhere(&within));
        shares.begin(SETTINGS, passed(0.0, 0.0));
        let beside = CoveragePlan {
            open_m2: 20.0,
            ..within
        };
        assert!(!shares.is_elsewhere(&beside), "what was passed was withdrawn");
    }

    #[test]
    fn the_plan_of_a_robot_that_is_cut_off_changes_nothing_and_no_floor_has_no_share() {
        let mut shares = shares();
        shares.begin(SETTINGS, passed(3.5, 2.8));
        shares.pass_over();
        let reported = shares
            .share(|_| Some(passed(5.5, 4.4)), || None)
            .expect("there is floor");
        assert!((reported.share - 0.5).abs() < 1e-9, "{reported:?}");
        shares.begin(SETTINGS, passed(0.0, 0.0));
        shares.take(&CoveragePlan::default(), 0.0);
        assert_eq!(shares.share(|_| None, || None), None);
    }
}
