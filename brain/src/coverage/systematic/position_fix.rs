//! A robot whose position has become vague takes a fix: it goes to a corner and follows its walls, before lanes go on.
//!
//! Beams reach some decimetres, so in the middle of a hall nothing tells the position for many metres, and lanes only glimpse the
//! walls at their ends: the error across them grows from lane to lane. A corner tells both directions. That costs some metres of
//! way; a robot that does not take it is lost for minutes in floors with wide halls.

use core::task::Poll;

use super::detour::DetourStep;
use crate::coverage::parameters::MARGINS;
use crate::coverage::{LapStep, Perimeter};
use crate::mapping::{CELL_M, Cell, CellKnowledge, DistanceField, Map, Raster};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{Gradual, StepBudget};
use crate::model::no_go::NoGo;
use crate::model::reason::Reason;
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{
    FollowStep, Goal, Inflation, PathFollower, PathSegment, Situation, TaskContext, TaskStatus, caution,
    encounter, plan_path, reachable,
};

/// When a fix begins and ends, and which places are good for one. Chosen by hand in the floor with empty halls; in homes of up to
/// 130 m2 the position never becomes so vague.
struct FixParameters {
    /// A fix begins at this standard deviation of the position, metres: the lanes overlap by less.
    from_sigma_m: f64,
    /// It is over below this one, metres.
    until_sigma_m: f64,
    /// It is over after so far along walls, metres: what they tell is not enough.
    along_max_m: f64,
    /// So far apart are two fixes at least, metres.
    apart_m: f64,
    /// Gap between body and wall at the goal, metres, at least and at most.
    gap_m: [f64; 2],
    /// A second wall across the first at these distances along it makes a corner, metres.
    corner_m: [f64; 8],
    /// A wall without a corner is as good as a corner that is so much farther, metres.
    plain_wall_m: f64,
    /// Forbidden floor is kept this far ahead of the body, metres.
    forbidden_m: f64,
    /// Cells between two places that are judged: less than the goals are wide, or a wall between two of them would have none.
    step_cells: usize,
}

const FIX: FixParameters = FixParameters {
    from_sigma_m: 0.25,
    until_sigma_m: 0.1,
    along_max_m: 15.0,
    apart_m: 5.0,
    gap_m: [0.02, 0.08],
    corner_m: [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
    plain_wall_m: 6.0,
    forbidden_m: 0.05,
    step_cells: 2,
};

/// The drive to a corner and along its walls.
#[derive(Debug, Default)]
pub(super) struct PositionFix {
    stage: Stage,
    /// Distance since the last fix, metres.
    since_m: f64,
}

#[derive(Debug, Default)]
enum Stage {
    #[default]
    Idle,
    /// Looks for the nearest corner.
    Planning(Gradual<Option<Vec<PathSegment>>>),
    Going(PathFollower),
    AlongWalls(Box<Perimeter>),
}

impl PositionFix {
    /// Somebody else moved the robot.
    pub(super) fn interrupted(&mut self) {
        if let Stage::AlongWalls(walls) = &mut self.stage {
            walls.interrupted();
        } else {
            self.stage = Stage::Idle;
        }
    }

    /// `avoid` is forbidden beside the map's own no-go zones.
    pub(super) fn step(
        &mut self,
        avoid: &[NoGo],
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> DetourStep {
        self.since_m += situation.advance.distance_m.abs();
        match core::mem::take(&mut self.stage) {
            Stage::Idle => self.begin(avoid, situation, context),
            Stage::Planning(rest) => self.plan_on(rest, situation),
            Stage::Going(follower) => self.go(follower, situation),
            Stage::AlongWalls(walls) => {
                let reach_m = situation.config.body.radius_m + FIX.forbidden_m;
                let is_barred = leads_into_forbidden(situation.map, situation.pose, reach_m, avoid);
                self.follow(walls, is_barred, (situation, context))
            }
        }
    }

    fn begin(&mut self, avoid: &[NoGo], situation: &Situation<'_>, context: &mut TaskContext) -> DetourStep {
        let sigma_m = situation.estimate.sigma_m;
        let is_vague = !situation.estimate.lost && sigma_m > FIX.from_sigma_m;
        if !is_vague || self.since_m < FIX.apart_m || !situation.is_free() {
            return DetourStep::Idle;
        }
        context.decide(DecisionKind::TakeFix, Reason::PlaceVague, sigma_m);
        let places = Places::of(situation, avoid);
        self.stage = Stage::Planning(Gradual::new(places.path()));
        DetourStep::Driving(TaskStatus::Go(Motion::Halt))
    }

    fn plan_on(
        &mut self,
        mut rest: Gradual<Option<Vec<PathSegment>>>,
        situation: &Situation<'_>,
    ) -> DetourStep {
        self.stage = match rest.go_on() {
            Poll::Pending => Stage::Planning(rest),
            Poll::Ready(Some(segments)) => Stage::Going(PathFollower::new(segments)),
            // The next wall ahead must do.
            Poll::Ready(None) => Stage::AlongWalls(Box::default()),
        };
        if situation.estimate.lost {
            return self.end();
        }
        DetourStep::Driving(TaskStatus::Go(Motion::Halt))
    }

    fn go(&mut self, mut follower: PathFollower, situation: &Situation<'_>) -> DetourStep {
        if situation.estimate.lost || (self.is_sharp(situation) && situation.is_free()) {
            return self.end();
        }
        let caution = caution(situation, &follower);
        let step = if encounter(situation).is_some() {
            FollowStep::Arrived
        } else {
            follower.step(situation, caution)
        };
        let motion = match step {
            FollowStep::Going(motion) => {
                self.stage = Stage::Going(follower);
                motion
            }
            FollowStep::Arrived | FollowStep::Off => {
                self.stage = Stage::AlongWalls(Box::default());
                Motion::Halt
            }
        };
        DetourStep::Driving(TaskStatus::Go(motion))
    }

    /// Follows the walls, unless they lead into forbidden floor.
    fn follow(
        &mut self,
        mut walls: Box<Perimeter>,
        is_barred: bool,
        (situation, context): (&Situation<'_>, &mut TaskContext),
    ) -> DetourStep {
        let may_end = !walls.is_evading() && situation.is_free();
        let is_over = is_barred
            || situation.estimate.lost
            || self.is_sharp(situation)
            || walls.driven_m() > FIX.along_max_m;
        if may_end && is_over {
            context.decide(
                DecisionKind::FixTaken,
                Reason::PlaceVague,
                situation.estimate.sigma_m,
            );
            return self.end();
        }
        let status = match walls.step(situation, context) {
            LapStep::Going(motion) => TaskStatus::Go(motion),
            LapStep::Trouble(reason) => TaskStatus::Trouble(reason),
            LapStep::Over(_) => TaskStatus::Go(walls.leave()),
        };
        self.stage = Stage::AlongWalls(walls);
        DetourStep::Driving(status)
    }

    fn is_sharp(&self, situation: &Situation<'_>) -> bool {
        situation.estimate.sigma_m < FIX.until_sigma_m
    }

    fn end(&mut self) -> DetourStep {
        *self = Self::default();
        DetourStep::Over
    }
}

/// Whether forbidden floor lies in front of a robot, within `reach_m` of its centre and a right angle to both sides.
fn leads_into_forbidden(map: &Map, pose: Pose2, reach_m: f64, avoid: &[NoGo]) -> bool {
    const DIRECTIONS_RAD: [f64; 7] = [-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5];
    let steps = libm::ceil(reach_m / CELL_M) as u32;
    DIRECTIONS_RAD.into_iter().any(|aside_rad| {
        let ray = Pose2 {
            heading_rad: pose.heading_rad + aside_rad,
            ..pose
        };
        (1..=steps)
            .any(|step| map.is_forbidden(ray.after_arc(f64::from(step) * CELL_M, 0.0).position(), avoid))
    })
}

/// What the search for a place depends on.
struct Places {
    knowledge: Raster<CellKnowledge>,
    distance: DistanceField,
    start: Pose2,
    body_m: f64,
}

impl Places {
    fn of(situation: &Situation<'_>, avoid: &[NoGo]) -> Self {
        Self {
            knowledge: situation.map.knowledge_avoiding(avoid),
            distance: situation.map.distance_field().clone(),
            start: situation.pose,
            body_m: situation.config.body.radius_m,
        }
    }

    /// The path to the nearest place that tells the position.
    async fn path(self) -> Option<Vec<PathSegment>> {
        let budget = &mut StepBudget::limited();
        let goals = self.goals(budget).await;
        let inflation = Inflation {
            radius_m: self.body_m + MARGINS.clearance_m,
            blocked: &[],
        };
        let floor = reachable(&self.knowledge, &LaneFrame::OF_MAP, inflation, budget).await;
        plan_path(&floor, self.start, &goals, budget).await
    }

    async fn goals(&self, budget: &mut StepBudget) -> Vec<Goal> {
        let mut goals = Vec::new();
        for row in (0..self.knowledge.height()).step_by(FIX.step_cells) {
            budget.spend(self.knowledge.width()).await;
            for column in (0..self.knowledge.width()).step_by(FIX.step_cells) {
                let index = row * self.knowledge.width() + column;
                goals.extend(self.goal(self.knowledge.cell(index)));
            }
        }
        goals
    }

    /// A place beside a wall.
    fn goal(&self, cell: Cell) -> Option<Goal> {
        let [least_m, most_m] = FIX.gap_m.map(|gap_m| self.body_m + gap_m);
        let is_beside = self.knowledge.get(cell) == Some(&CellKnowledge::Free)
            && (least_m..=most_m).contains(&self.distance.cell_m(cell));
        is_beside.then(|| {
            let at = cell.middle();
            let detour_m = if self.is_corner(at) { 0.0 } else { FIX.plain_wall_m };
            Goal { at, detour_m }
        })
    }

    /// Whether a second wall stands across the one beside this place.
    fn is_corner(&self, at: Point2) -> bool {
        let away = self.distance.gradient(at);
        FIX.corner_m
            .into_iter()
            .flat_map(|along_m| [along_m, -along_m])
            .any(|along_m| {
                let beside = Point2 {
                    x_m: at.x_m - along_m * away.y_m,
                    y_m: at.y_m + along_m * away.x_m,
                };
                self.distance.at(beside) < 0.5 * self.body_m
            })
    }
}

#[cfg(test)]
mod tests {
    use super::{Places, leads_into_forbidden};
    use crate::mapping::{Cell, CellKnowledge, DistanceField, Map, Raster};
    use crate::model::config::{Body, SensorLayout};
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::gradual::at_once;
    use crate::model::no_go::NoGo;
    use crate::model::zone::Zone;

    /// Where a robot at this place of an empty hall goes, and how far that is. Sizes in cells of 2.5 cm.
    fn way(width: usize, height: usize, from: Point2) -> (Point2, f64) {
        let mut knowledge = Raster::filled(Cell { x: 0, y: 0 }, width, height, CellKnowledge::Free);
        for index in 0..knowledge.values().len() {
            let (column, row) = (index % width, index / width);
            let is_wall = column.min(row) < 4 || column + 4 >= width || row + 4 >= height;
            if is_wall {
                knowledge.values_mut()[index] = CellKnowledge::Occupied;
            }
        }
        let places = Places {
            distance: DistanceField::new(&knowledge),
            knowledge,
            start: Pose2 {
                x_m: from.x_m,
                y_m: from.y_m,
                heading_rad: 0.0,
            },
            body_m: 0.17,
        };
        let segments = at_once(places.path()).unwrap();
        let end = segments.last().unwrap().at(1.0).position();
        (end, segments.iter().map(|segment| segment.length_m).sum())
    }

    #[test]
    fn a_corner_that_is_near_is_where_it_goes() {
        let (end, _) = way(200, 160, Point2 { x_m: 2.0, y_m: 1.8 });
        let (across_m, up_m) = (end.x_m.min(5.0 - end.x_m), end.y_m.min(4.0 - end.y_m));
        assert!(across_m.max(up_m) < 1.2 && across_m.min(up_m) < 0.4, "{end:?}");
    }

    #[test]
    fn a_wall_does_where_corners_are_far() {
        let (end, length_m) = way(1_200, 240, Point2 { x_m: 15.0, y_m: 3.4 });
        assert!(end.y_m > 5.6 && length_m < 3.0, "{end:?} after {length_m} m");
    }

    #[test]
    fn walls_are_left_before_forbidden_floor_and_only_then() {
        let body = Body {
            radius_m: 0.17,
            swath_m: 0.27,
            track_m: 0.23,
        };
        let map = Map::new(body, SensorLayout::default());
        let corner = |x_m, y_m| Point2 { x_m, y_m };
        let corners = vec![
            corner(1.0, -1.0),
            corner(2.0, -1.0),
            corner(2.0, 1.0),
            corner(1.0, 1.0),
        ];
        let avoid = [NoGo::zone(&Zone::new(corners).unwrap()).unwrap()];
        let nears = |x_m, heading_rad| {
            let pose = Pose2 {
                x_m,
                y_m: 0.0,
                heading_rad,
            };
            leads_into_forbidden(&map, pose, 0.22, &avoid)
        };
        assert!(!nears(0.7, 0.0), "it is 0.3 m away");
        assert!(nears(0.82, 0.0) && nears(0.82, 1.4), "ahead, and beside");
        assert!(!nears(0.82, 3.1), "it drives away");
    }
}
