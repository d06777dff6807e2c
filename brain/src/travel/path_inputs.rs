//! What a search for a path is made from, and the search itself.

use super::parameters::TRAVEL;
use super::unseen_specks::close_specks;
use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{Gradual, StepBudget};
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{Goal, Inflation, PathSegment, Situation, plan_path, reachable};

/// Half a cell, so that a raster that is turned to the map's leaves no cell out, metres.
const HALF_CELL_M: f64 = 0.5 * CELL_M;

/// All inputs of a path search.
#[derive(Debug)]
pub(super) struct PathInputs {
    knowledge: Raster<CellKnowledge>,
    body_m: f64,
    /// Places of obstructions that are not on the map.
    pub(super) blocked: Vec<Point2>,
    start: Pose2,
    goals: Vec<Goal>,
    /// Pose of a docked robot, when the goals lie before it.
    pub(super) dock: Option<Pose2>,
}

impl PathInputs {
    pub(super) fn of(situation: &Situation<'_>, goals: Vec<Goal>) -> Self {
        Self {
            knowledge: situation.map.knowledge().clone(),
            body_m: situation.config.body.radius_m,
            blocked: Vec::new(),
            start: situation.pose,
            goals,
            dock: None,
        }
    }

    /// What was floor counts as floor. Nearly all that is unknown lies outside of the home, so only what is beside floor is asked of that.
    pub(super) fn open_past_floor(&mut self, situation: &Situation<'_>) {
        situation
            .map
            .open_past_floor(&mut self.knowledge, |knowledge, index| {
                knowledge.values().get(index) == Some(&CellKnowledge::Occupied)
                    || is_beside_floor(knowledge, index)
            });
    }

    /// Unknown cells between the dock and the places before it become free; returns whether there were any. A robot that turned
    /// aside as soon as it had left its dock for the first time knows no floor there, and what can be docked at stands free.
    fn open_before_dock(&mut self) -> bool {
        let Some(dock) = self.dock else {
            return false;
        };
        // Near the dock its beams lead better than a map that is new there.
        if dock.position().distance_m(self.start.position()) < TRAVEL.by_beams_m {
            return false;
        }
        let mut is_opened = false;
        let margin_m = self.body_m + TRAVEL.clearances_m[0];
        let steps = |length_m: f64| ((length_m + margin_m) / HALF_CELL_M) as i32;
        let far = steps(TRAVEL.front_m.into_iter().fold(0.0, f64::max));
        let aside_max = steps(TRAVEL.beside_m.into_iter().fold(0.0, f64::max));
        for before in 0..=far {
            for aside in -aside_max..=aside_max {
                let at = dock.transform(Point2 {
                    x_m: -HALF_CELL_M * f64::from(before),
                    y_m: HALF_CELL_M * f64::from(aside),
                });
                if let Some(kind) = self.knowledge.get_mut(Cell::under(at))
                    && *kind == CellKnowledge::Unknown
                {
                    *kind = CellKnowledge::Free;
                    is_opened = true;
                }
            }
        }
        is_opened
    }

    /// The path with the first of these gaps that allows one; when none does, one over what nobody has seen between floor, and then over
    /// unknown floor before the dock.
    pub(super) async fn first_path(mut self, clearances_m: &'static [f64]) -> Option<Vec<PathSegment>> {
        let budget = &mut StepBudget::limited();
        let path = self.first_that(clearances_m, |_| true, budget).await;
        if path.is_some() {
            return path;
        }
        if close_specks(&mut self.knowledge, budget).await {
            let path = self.first_that(clearances_m, |_| true, budget).await;
            if path.is_some() {
                return path;
            }
        }
        if !self.open_before_dock() {
            return None;
        }
        // Opened floor that nothing leads to would be the nearest floor to a robot that stands on none.
        let start = self.start.position();
        let sets_out_here = |path: &[PathSegment]| {
            path.first()
                .is_none_or(|first| first.start.position().distance_m(start) < TRAVEL.set_out_max_m)
        };
        self.first_that(clearances_m, sets_out_here, budget).await
    }

    /// The path with the first of these gaps between the body and what is known that allows one that is good enough.
    async fn first_that(
        &self,
        clearances_m: &'static [f64],
        is_good: impl Fn(&[PathSegment]) -> bool,
        budget: &mut StepBudget,
    ) -> Option<Vec<PathSegment>> {
        for gap_m in clearances_m {
            let inflation = Inflation {
                radius_m: self.body_m + gap_m,
                blocked: &self.blocked,
            };
            let reachable_cells = reachable(&self.knowledge, &LaneFrame::OF_MAP, inflation, budget).await;
            let path = plan_path(&reachable_cells, self.start, &self.goals, budget).await;
            if let Some(path) = path.filter(|path| is_good(path)) {
                return Some(path);
            }
        }
        None
    }
}

/// Whether the cell before or after this one in the row, or in the column, is free.
fn is_beside_floor(knowledge: &Raster<CellKnowledge>, index: usize) -> bool {
    let values = knowledge.values();
    let is_free =
        |index: Option<usize>| index.and_then(|index| values.get(index)) == Some(&CellKnowledge::Free);
    let width = knowledge.width();
    [1, width]
        .into_iter()
        .any(|step| is_free(index.checked_sub(step)) || is_free(index.checked_add(step)))
}

/// Starts the computation of the length of the path to the place in front of `dock`, metres; `None` when the map has none.
pub(crate) fn path_length_m(dock: Pose2, situation: &Situation<'_>) -> Gradual<Option<f64>> {
    let mut inputs = PathInputs::of(situation, goals(dock));
    inputs.dock = Some(dock);
    Gradual::new(async move { Some(length_m(&inputs.first_path(&TRAVEL.clearances_m[1..2]).await?)) })
}

/// Places in front of the dock, those on the centreline at a good distance first.
pub(super) fn goals(dock: Pose2) -> Vec<Goal> {
    let mut goals = Vec::with_capacity(TRAVEL.front_m.len() * TRAVEL.beside_m.len());
    for (rank, front_m) in TRAVEL.front_m.into_iter().enumerate() {
        for aside_m in TRAVEL.beside_m {
            goals.push(Goal {
                at: dock.transform(Point2 {
                    x_m: -front_m,
                    y_m: aside_m,
                }),
                detour_m: TRAVEL.front_detour * TRAVEL.front_step_m * rank as f64
                    + TRAVEL.beside_detour * aside_m.abs(),
            });
        }
    }
    goals
}

/// Length of a path, metres.
pub(super) fn length_m(segments: &[PathSegment]) -> f64 {
    segments.iter().map(|segment| segment.length_m).sum()
}

#[cfg(test)]
mod tests {
    use super::{PathInputs, goals, length_m};
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::gradual::at_once;
    use crate::travel::parameters::TRAVEL;

    /// A dock that looks along x, and the floor of a robot that left it, turned aside at once and drove away along y.
    fn turned_aside() -> PathInputs {
        let mut knowledge = Raster::filled(Cell { x: -120, y: -60 }, 180, 280, CellKnowledge::Unknown);
        let dock = Pose2::default();
        for step in 0..150 {
            let along_m = 0.025 * f64::from(step);
            disc(
                &mut knowledge,
                Point2 {
                    x_m: -0.25,
                    y_m: along_m,
                },
            );
        }
        for step in 0..10 {
            disc(
                &mut knowledge,
                Point2 {
                    x_m: -0.025 * f64::from(step),
                    y_m: 0.0,
                },
            );
        }
        PathInputs {
            knowledge,
            body_m: 0.17,
            blocked: Vec::new(),
            start: Pose2 {
                x_m: -0.25,
                y_m: 3.5,
                heading_rad: 0.0,
            },
            goals: goals(dock),
            dock: Some(dock),
        }
    }

    /// The floor below the body at `middle`.
    fn disc(knowledge: &mut Raster<CellKnowledge>, middle: Point2) {
        for index in 0..knowledge.values().len() {
            if knowledge.cell(index).middle().distance_m(middle) < 0.21
                && let Some(kind) = knowledge.values_mut().get_mut(index)
            {
                *kind = CellKnowledge::Free;
            }
        }
    }

    #[test]
    fn floor_before_the_dock_that_nobody_has_seen_leads_to_it() {
        let path = at_once(turned_aside().first_path(&TRAVEL.clearances_m)).expect("a path");
        // 3.5 m back along its own way, then out to the best place before the dock.
        assert!((4.0..4.8).contains(&length_m(&path)), "{}", length_m(&path));
    }

    #[test]
    fn what_is_known_before_the_dock_is_left_as_it_is() {
        for kind in [CellKnowledge::Occupied, CellKnowledge::NoGo, CellKnowledge::Cliff] {
            let mut inputs = turned_aside();
            for index in 0..inputs.knowledge.values().len() {
                let at = inputs.knowledge.cell(index).middle();
                if (-0.5..-0.44).contains(&at.x_m) {
                    inputs.knowledge.values_mut()[index] = kind;
                }
            }
            assert!(
                at_once(inputs.first_path(&TRAVEL.clearances_m)).is_none(),
                "{kind:?}"
            );
        }
    }

    #[test]
    fn places_of_beams_open_nothing() {
        let mut inputs = turned_aside();
        inputs.dock = None;
        assert!(at_once(inputs.first_path(&TRAVEL.clearances_m)).is_none());
    }
}
