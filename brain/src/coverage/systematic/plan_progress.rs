//! A plan that is made step by step while the robot moves, from the map as it was at the start of planning.

use core::task::Poll;

use super::frontier::optimistic;
use super::new_obstacles::without_new_obstacles;
use super::parameters::{SQUEEZE, SYSTEMATIC};
use super::squeeze;
use crate::coverage::parameters::MARGINS;
use crate::coverage::plan::{Area, CoveragePlan, Departure, PlanSettings, floor_in_reach, plan_area};
use crate::coverage::target_floor::TargetFloor;
use crate::mapping::{CellKnowledge, Raster};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{Gradual, StepBudget};
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{Inflation, Situation, reachable};

/// All inputs of a plan.
#[derive(Debug)]
pub(super) struct PlanInputs {
    pub(super) knowledge: Raster<CellKnowledge>,
    /// Width of the optimistic margin; `None` = only known floor counts.
    pub(super) beyond_m: Option<f64>,
    /// Radius of the body plus the gap to known obstacles.
    pub(super) radius_m: f64,
    /// Only floor counts that becomes reachable with this radius instead.
    pub(super) squeezed_m: Option<f64>,
    /// The map when the job began. In a check for floor behind gaps, obstacles that appeared since are ignored.
    pub(super) began: Option<Raster<CellKnowledge>>,
    pub(super) blocked: Vec<Point2>,
    pub(super) target: TargetFloor,
    pub(super) passed: Raster<bool>,
    pub(super) departure: Departure,
    /// The frame of the lanes of earlier plans; `None` = it is to be found.
    pub(super) frame: Option<LaneFrame>,
}

/// A finished plan.
#[derive(Clone, Debug)]
pub(super) struct FinishedPlan {
    pub(super) plan: CoveragePlan,
    /// The frame of its lanes.
    pub(super) frame: LaneFrame,
}

/// Progress of a plan.
#[derive(Debug)]
pub(super) enum PlanProgress {
    /// To be begun, for a robot that sets out from here.
    Due(Pose2),
    /// In progress.
    Running {
        rest: Gradual<FinishedPlan>,
        request: PlanRequest,
    },
    /// Finished.
    Finished {
        finished: FinishedPlan,
        request: PlanRequest,
    },
}

/// What is known of a plan before it is finished.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanRequest {
    pub(super) start: Pose2,
    /// Obstructions that are not on the map were avoided.
    pub(super) is_blocked: bool,
}

impl PlanRequest {
    /// Whether a robot at this position can follow the plan.
    pub(super) fn begins_at(&self, place: Point2) -> bool {
        self.start.position().distance_m(place) < SYSTEMATIC.off_start_m
    }
}

impl PlanProgress {
    pub(super) fn begin(inputs: PlanInputs) -> Self {
        Self::Running {
            request: PlanRequest {
                start: inputs.departure.start,
                is_blocked: !inputs.blocked.is_empty(),
            },
            rest: Gradual::new(planned(inputs)),
        }
    }

    /// Does the next step of a plan in progress.
    pub(super) fn go_on(self) -> Self {
        match self {
            Self::Running { mut rest, request } => match rest.go_on() {
                Poll::Pending => Self::Running { rest, request },
                Poll::Ready(finished) => Self::Finished { finished, request },
            },
            other => other,
        }
    }

    /// Restarts a plan because its inputs have changed.
    pub(super) fn restarted(self) -> Self {
        match self {
            Self::Due(start) => Self::Due(start),
            Self::Running { request, .. } | Self::Finished { request, .. } => Self::Due(request.start),
        }
    }
}

/// The current parameters of plans.
pub(super) fn settings(situation: &Situation<'_>) -> PlanSettings {
    PlanSettings {
        swath_m: situation.config.body.swath_m,
        sigma_m: situation
            .estimate
            .sigma_m
            .clamp(MARGINS.sigma_min_m, MARGINS.sigma_max_m),
        cruise_m_per_s: situation.config.speeds.cruise_m_per_s,
        turn_rad_per_s: situation.config.speeds.turn_max_rad_per_s,
        takes_along: situation.is_tracked,
    }
}

async fn planned(inputs: PlanInputs) -> FinishedPlan {
    let budget = &mut StepBudget::limited();
    let frame = match inputs.frame {
        Some(frame) => frame,
        None => LaneFrame::of_walls(&inputs.knowledge, budget).await,
    };
    let plan = planned_in(&frame, inputs, budget).await;
    FinishedPlan {
        plan: plan.in_map(&frame),
        frame,
    }
}

/// The plan in the frame of its lanes.
async fn planned_in(frame: &LaneFrame, inputs: PlanInputs, budget: &mut StepBudget) -> CoveragePlan {
    let knowledge = match inputs.beyond_m {
        Some(beyond_m) => optimistic(&inputs.knowledge, beyond_m, budget).await,
        None => inputs.knowledge,
    };
    let departure = Departure {
        start: frame.pose(inputs.departure.start),
        ..inputs.departure
    };
    let inflation = |radius_m| Inflation {
        radius_m,
        blocked: &inputs.blocked,
    };
    let reachable_cells = reachable(&knowledge, frame, inflation(inputs.radius_m), budget).await;
    let pattern = |cell| inputs.target.pattern_at(frame.cell_in_map(cell));
    let is_in = |cells: &Raster<bool>, cell| cells.get(cell).copied().unwrap_or(false);
    let Some(squeezed_m) = inputs.squeezed_m else {
        let is_swept = |cell| is_in(&inputs.passed, frame.cell_in_map(cell));
        return plan_area(&reachable_cells, Area { pattern, is_swept }, departure, budget).await;
    };
    let floor = floor_in_reach(&reachable_cells, &departure, budget).await;
    let known = squeeze::near(&floor, budget).await;
    let is_swept = |cell| is_in(&inputs.passed, frame.cell_in_map(cell)) || is_in(&known, cell);
    let area = Area { pattern, is_swept };
    let knowledge = match &inputs.began {
        Some(began) => {
            let knowledge = without_new_obstacles(knowledge, began, budget).await;
            // Where people have left a door, the usual path leads through it. That of a slimmer body grazes every door post on the way.
            let reachable_cells = reachable(&knowledge, frame, inflation(inputs.radius_m), budget).await;
            let plan = plan_area(&reachable_cells, area, departure, budget).await;
            if plan.lanes > 0 && plan.open_m2 > SQUEEZE.worth_m2 {
                return plan;
            }
            knowledge
        }
        None => knowledge,
    };
    let reachable_cells = reachable(&knowledge, frame, inflation(squeezed_m), budget).await;
    plan_area(&reachable_cells, area, departure, budget).await
}

#[cfg(test)]
mod tests {
    use super::{Inflation, PlanInputs, PlanProgress, reachable};
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

    /// An empty hall of 10 x 8 m, in which only the walls limit the body.
    fn inputs() -> PlanInputs {
        let body = Body {
            radius_m: 0.175,
            track_m: 0.23,
            swath_m: SETTINGS.swath_m,
        };
        let map = Map::new(body, SensorLayout::default());
        let knowledge = Raster::filled(Cell { x: 0, y: 0 }, 400, 320, CellKnowledge::Free);
        PlanInputs {
            beyond_m: None,
            radius_m: 0.175,
            squeezed_m: None,
            began: None,
            blocked: Vec::new(),
            target: Assignment::of(CleaningOrder::default()).target_floor(&map),
            passed: Raster::filled(knowledge.origin(), 400, 320, false),
            departure: Departure {
                start: START,
                settings: SETTINGS,
            },
            knowledge,
            frame: None,
        }
    }

    fn finished(mut plan_progress: PlanProgress) -> (CoveragePlan, u32) {
        let mut steps = 0;
        loop {
            plan_progress = plan_progress.go_on();
            steps += 1;
            if let PlanProgress::Finished { finished, request } = plan_progress {
                assert!(request.begins_at(Point2 { x_m: 0.52, y_m: 0.5 }));
                assert!(!request.begins_at(Point2 { x_m: 0.6, y_m: 0.5 }));
                return (finished.plan, steps);
            }
        }
    }

    #[test]
    fn a_plan_made_in_steps_equals_the_plan_made_at_once() {
        let (plan, steps) = finished(PlanProgress::begin(inputs()));
        let inputs = inputs();
        let reachable_cells = at_once(reachable(
            &inputs.knowledge,
            &LaneFrame::OF_MAP,
            Inflation {
                radius_m: inputs.radius_m,
                blocked: &[],
            },
            &mut StepBudget::unlimited(),
        ));
        assert_eq!(plan, plan_coverage(&reachable_cells, |_| false, START, &SETTINGS));
        assert!((3..100).contains(&steps), "{steps} steps");
    }

    /// The hall with a wall across it that has a gap of this many cells, swept up to the wall.
    fn behind_a_gap(gap: i32) -> PlanInputs {
        let mut inputs = inputs();
        for y in (0..320).filter(|y| !(100..100 + gap).contains(y)) {
            *inputs.knowledge.get_mut(Cell { x: 200, y }).unwrap() = CellKnowledge::Occupied;
        }
        for y in 0..320 {
            (0..200).for_each(|x| *inputs.passed.get_mut(Cell { x, y }).unwrap() = true);
        }
        inputs
    }

    #[test]
    fn a_gap_that_is_too_narrow_on_the_map_is_tried_for_the_floor_behind_it_only() {
        let lanes = |gap, squeezed_m| {
            let inputs = PlanInputs {
                squeezed_m,
                ..behind_a_gap(gap)
            };
            finished(PlanProgress::begin(inputs)).0
        };
        // The body is 14 cells wide; with a gap of a centimetre and whole cells the plan reserves 15.
        assert_eq!(lanes(14, None).lanes, 0);
        let through = lanes(14, Some(0.1625));
        assert!(
            through.lanes > 0 && (35.0..40.0).contains(&through.open_m2),
            "{through:?}"
        );
        // Floor that was reachable before does not count, edges at walls included.
        let mut swept = behind_a_gap(14);
        swept.passed.values_mut().fill(true);
        swept.squeezed_m = Some(0.1625);
        assert_eq!(finished(PlanProgress::begin(swept)).0.open_m2, 0.0);
        assert_eq!(lanes(12, Some(0.1625)).lanes, 0, "narrower than the body");
    }

    #[test]
    fn a_door_that_a_person_blocked_is_tried_once_nothing_else_is_left() {
        let began = behind_a_gap(40).knowledge;
        let lanes = |squeezed_m, began| {
            let mut inputs = PlanInputs {
                squeezed_m,
                began,
                ..behind_a_gap(40)
            };
            for y in 112..128 {
                *inputs.knowledge.get_mut(Cell { x: 200, y }).unwrap() = CellKnowledge::Occupied;
            }
            finished(PlanProgress::begin(inputs)).0
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
    fn through_a_door_that_people_have_left_the_path_keeps_its_usual_gap() {
        // A door of 0.8 m, half of which the map shows a person in.
        let mut inputs = behind_a_gap(32);
        inputs.began = Some(inputs.knowledge.clone());
        inputs.squeezed_m = Some(0.1625);
        for y in 108..124 {
            *inputs.knowledge.get_mut(Cell { x: 200, y }).unwrap() = CellKnowledge::Occupied;
        }
        let radius_m = inputs.radius_m;
        let (plan, _) = finished(PlanProgress::begin(inputs));
        assert!(plan.lanes > 0);
        let posts = [99, 132].map(|y| Cell { x: 200, y }.middle());
        let path = plan
            .segments
            .iter()
            .flat_map(|segment| (0..=100).map(|percent| segment.at(f64::from(percent) / 100.0).position()));
        let nearest_m = path
            .flat_map(|place| posts.map(|post| post.distance_m(place)))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest_m >= radius_m - 0.025, "{nearest_m} m from a post");
    }

    #[test]
    fn a_restarted_plan_is_the_same() {
        let (plan, _) = finished(PlanProgress::begin(inputs()));
        let again = PlanProgress::begin(inputs()).go_on().go_on().restarted();
        assert!(matches!(again, PlanProgress::Due(start) if start == START));
        assert_eq!(finished(PlanProgress::begin(inputs())).0, plan);
    }
}
