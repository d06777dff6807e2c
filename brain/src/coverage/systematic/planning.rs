//! A plan that is made while the robot goes on: step by step, from what was known when it was begun.

use core::task::Poll;

use super::frontier::hopeful;
use super::since::without_what_came;
use super::squeeze;
use crate::coverage::margins::SIGMA_MIN_M;
use crate::coverage::plan::{CoveragePlan, Departure, PlanSettings, floor_in_reach, plan_area};
use crate::coverage::wanted::Wanted;
use crate::mapping::{CellKnowledge, Raster};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{Gradual, StepBudget};
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{Situation, reachable};

/// A plan is not followed from farther away than this from where it begins, metres: back-offs get longer than expected.
const OFF_START_M: f64 = 0.06;

/// More overlap does not pay: errors of lanes side by side are much alike, and leftovers are cheaper. With the whole deviation three
/// known homes were swept to 0.98 instead of 0.97, in 2.7 to 3.1 times the time (`measurements/systematic-known.md`).
const SIGMA_MAX_M: f64 = 0.015;

/// All that a plan depends on.
#[derive(Debug)]
pub(super) struct Basis {
    pub(super) knowledge: Raster<CellKnowledge>,
    /// Floor is hoped for so far beyond what is known; `None` = nothing is hoped for.
    pub(super) beyond_m: Option<f64>,
    /// The gap to what is known included.
    pub(super) radius_m: f64,
    /// Only floor is wanted that comes into reach with this radius instead.
    pub(super) squeezed_m: Option<f64>,
    /// What was known when the job began: with another radius, too, what came since is looked through.
    pub(super) began: Option<Raster<CellKnowledge>>,
    pub(super) blocked: Vec<Point2>,
    pub(super) wanted: Wanted,
    pub(super) passed: Raster<bool>,
    pub(super) departure: Departure,
    /// The frame of the lanes of earlier plans; `None` = it is to be found.
    pub(super) frame: Option<LaneFrame>,
}

/// A plan that was made.
#[derive(Clone, Debug)]
pub(super) struct Made {
    pub(super) plan: CoveragePlan,
    /// The frame of its lanes.
    pub(super) frame: LaneFrame,
}

/// How far a plan is.
#[derive(Debug)]
pub(super) enum Planning {
    /// To be begun, for a robot that sets out from here.
    Due(Pose2),
    /// Being made.
    UnderWay { rest: Gradual<Made>, draft: Draft },
    /// Made.
    Made { made: Made, draft: Draft },
}

/// What is known of a plan before it is made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draft {
    pub(super) start: Pose2,
    /// Something that the map does not know stands in the way.
    pub(super) is_blocked: bool,
}

impl Draft {
    /// Whether a robot at this place can follow the plan.
    pub(super) fn begins_at(&self, place: Point2) -> bool {
        self.start.position().distance_m(place) < OFF_START_M
    }
}

impl Planning {
    pub(super) fn begin(basis: Basis) -> Self {
        Self::UnderWay {
            draft: Draft {
                start: basis.departure.start,
                is_blocked: !basis.blocked.is_empty(),
            },
            rest: Gradual::new(planned(basis)),
        }
    }

    /// Does the next step of a plan that is being made.
    pub(super) fn go_on(self) -> Self {
        match self {
            Self::UnderWay { mut rest, draft } => match rest.go_on() {
                Poll::Pending => Self::UnderWay { rest, draft },
                Poll::Ready(made) => Self::Made { made, draft },
            },
            other => other,
        }
    }

    /// The same once more, because what it rests on has changed.
    pub(super) fn afresh(self) -> Self {
        match self {
            Self::Due(start) => Self::Due(start),
            Self::UnderWay { draft, .. } | Self::Made { draft, .. } => Self::Due(draft.start),
        }
    }
}

/// What plans depend on besides the ground, now.
pub(super) fn settings(situation: &Situation<'_>) -> PlanSettings {
    PlanSettings {
        swath_m: situation.config.body.swath_m,
        sigma_m: situation.estimate.sigma_m.clamp(SIGMA_MIN_M, SIGMA_MAX_M),
        cruise_m_per_s: situation.config.speeds.cruise_m_per_s,
        turn_rad_per_s: situation.config.speeds.turn_max_rad_per_s,
        takes_along: situation.is_tracked,
    }
}

async fn planned(basis: Basis) -> Made {
    let budget = &mut StepBudget::limited();
    let frame = match basis.frame {
        Some(frame) => frame,
        None => LaneFrame::of_walls(&basis.knowledge, budget).await,
    };
    let plan = planned_in(&frame, basis, budget).await;
    Made {
        plan: plan.in_map(&frame),
        frame,
    }
}

/// The plan in the frame of its lanes.
async fn planned_in(frame: &LaneFrame, basis: Basis, budget: &mut StepBudget) -> CoveragePlan {
    let knowledge = match basis.beyond_m {
        Some(beyond_m) => hopeful(&basis.knowledge, beyond_m, budget).await,
        None => basis.knowledge,
    };
    let departure = Departure {
        start: frame.pose(basis.departure.start),
        ..basis.departure
    };
    let ground = reachable(&knowledge, frame, (basis.radius_m, &basis.blocked), budget).await;
    let course = |cell| basis.wanted.course(frame.cell_in_map(cell));
    let is_in = |cells: &Raster<bool>, cell| cells.get(cell).copied().unwrap_or(false);
    let Some(squeezed_m) = basis.squeezed_m else {
        let swept = |cell| is_in(&basis.passed, frame.cell_in_map(cell));
        return plan_area(&ground, (course, swept), departure, budget).await;
    };
    let floor = floor_in_reach(&ground, &departure, budget).await;
    let known = squeeze::near(&floor, budget).await;
    let knowledge = match &basis.began {
        Some(began) => without_what_came(knowledge, began, budget).await,
        None => knowledge,
    };
    let ground = reachable(&knowledge, frame, (squeezed_m, &basis.blocked), budget).await;
    let swept = |cell| is_in(&basis.passed, frame.cell_in_map(cell)) || is_in(&known, cell);
    plan_area(&ground, (course, swept), departure, budget).await
}

#[cfg(test)]
mod tests {
    use super::{Basis, Planning, reachable};
    use crate::coverage::plan::{CoveragePlan, Departure, PlanSettings, plan_coverage};
    use crate::coverage::systematic::assignment::Assignment;
    use crate::mapping::{Cell, CellKnowledge, Map, Raster};
    use crate::model::config::{Body, SensorLayout};
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::gradual::{StepBudget, at_once};
    use crate::model::order::CleaningOrder;
    use crate::navigation::lane_frame::LaneFrame;

    const START: Pose2 = Pose2 {
        x_m: 0.5,
        y_m: 0.5,
        heading_rad: 0.0,
    };
    const SETTINGS: PlanSettings = PlanSettings {
        swath_m: 0.25,
        sigma_m: 0.01,
        cruise_m_per_s: 0.25,
        turn_rad_per_s: 1.2,
        takes_along: true,
    };

    /// A hall of 10 x 8 m, empty so that its walls alone keep the body off.
    fn basis() -> Basis {
        let body = Body {
            radius_m: 0.175,
            track_m: 0.23,
            swath_m: SETTINGS.swath_m,
        };
        let map = Map::new(body, SensorLayout::default());
        let knowledge = Raster::filled(Cell { x: 0, y: 0 }, 400, 320, CellKnowledge::Free);
        Basis {
            beyond_m: None,
            radius_m: 0.175,
            squeezed_m: None,
            began: None,
            blocked: Vec::new(),
            wanted: Assignment::of(CleaningOrder::default()).wanted(&map),
            passed: Raster::filled(knowledge.origin(), 400, 320, false),
            departure: Departure {
                start: START,
                settings: SETTINGS,
            },
            knowledge,
            frame: None,
        }
    }

    fn made(mut planning: Planning) -> (CoveragePlan, u32) {
        let mut steps = 0;
        loop {
            planning = planning.go_on();
            steps += 1;
            if let Planning::Made { made, draft } = planning {
                assert!(draft.begins_at(Point2 { x_m: 0.52, y_m: 0.5 }));
                assert!(!draft.begins_at(Point2 { x_m: 0.6, y_m: 0.5 }));
                return (made.plan, steps);
            }
        }
    }

    #[test]
    fn a_plan_made_step_by_step_is_the_plan_that_is_made_at_once() {
        let (plan, steps) = made(Planning::begin(basis()));
        let basis = basis();
        let ground = at_once(reachable(
            &basis.knowledge,
            &LaneFrame::OF_MAP,
            (basis.radius_m, &[]),
            &mut StepBudget::unlimited(),
        ));
        assert_eq!(plan, plan_coverage(&ground, |_| false, START, &SETTINGS));
        assert!((3..100).contains(&steps), "{steps} steps");
    }

    /// The hall with a wall across it that has a gap of so many cells, swept up to the wall.
    fn behind_a_gap(gap: i32) -> Basis {
        let mut basis = basis();
        for y in (0..320).filter(|y| !(100..100 + gap).contains(y)) {
            *basis.knowledge.get_mut(Cell { x: 200, y }).unwrap() = CellKnowledge::Occupied;
        }
        for y in 0..320 {
            (0..200).for_each(|x| *basis.passed.get_mut(Cell { x, y }).unwrap() = true);
        }
        basis
    }

    #[test]
    fn a_gap_that_shows_too_narrow_is_squeezed_through_for_the_floor_behind_it_only() {
        let lanes = |gap, squeezed_m| {
            let basis = Basis {
                squeezed_m,
                ..behind_a_gap(gap)
            };
            made(Planning::begin(basis)).0
        };
        // The body is 14 cells wide; with a gap of a centimetre and whole cells it is planned to take 15.
        assert_eq!(lanes(14, None).lanes, 0);
        let through = lanes(14, Some(0.1625));
        assert!(
            through.lanes > 0 && (35.0..40.0).contains(&through.open_m2),
            "{through:?}"
        );
        // Nothing of what was in reach before is wanted, the edges at its walls included.
        let mut swept = behind_a_gap(14);
        swept.passed.values_mut().fill(true);
        swept.squeezed_m = Some(0.1625);
        assert_eq!(made(Planning::begin(swept)).0.open_m2, 0.0);
        assert_eq!(lanes(12, Some(0.1625)).lanes, 0, "narrower than the body");
    }

    #[test]
    fn a_door_in_which_somebody_has_come_to_stand_is_tried_once_nothing_else_is_left() {
        let began = behind_a_gap(40).knowledge;
        let lanes = |squeezed_m, began| {
            let mut basis = Basis {
                squeezed_m,
                began,
                ..behind_a_gap(40)
            };
            for y in 112..128 {
                *basis.knowledge.get_mut(Cell { x: 200, y }).unwrap() = CellKnowledge::Occupied;
            }
            made(Planning::begin(basis)).0
        };
        assert_eq!(lanes(None, Some(began.clone())).lanes, 0);
        assert_eq!(lanes(Some(0.1625), None).lanes, 0);
        let through = lanes(Some(0.1625), Some(began));
        assert!(
            through.lanes > 0 && (35.0..40.0).contains(&through.open_m2),
            "{through:?}"
        );
    }

    #[test]
    fn a_plan_that_is_begun_afresh_is_the_same() {
        let (plan, _) = made(Planning::begin(basis()));
        let again = Planning::begin(basis()).go_on().go_on().afresh();
        assert!(matches!(again, Planning::Due(start) if start == START));
        assert_eq!(made(Planning::begin(basis())).0, plan);
    }
}
