//! The path to one of several goals.

use super::PathSegment;
use super::configuration_space::ConfigurationSpace;
use super::router::Router;
use super::smoothing::{self, Polyline};
use crate::mapping::Raster;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::StepBudget;

/// A goal, and its handicap against other goals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Goal {
    /// Its position.
    pub(crate) at: Point2,
    /// Handicap: it is as good as a goal without one that is this much farther, metres.
    pub(crate) detour_m: f64,
}

/// The path over `reachable` to the goal with the lowest sum of path length and handicap. `None` when no goal can be
/// reached.
pub(crate) async fn plan_path(
    reachable: &Raster<bool>,
    start: Pose2,
    goals: &[Goal],
    budget: &mut StepBudget,
) -> Option<Vec<PathSegment>> {
    let mut space = ConfigurationSpace::new(reachable, 1, budget).await;
    let origin = space.origin_near(start.position(), budget).await?;
    space.keep_connected(origin, budget).await;
    let router = Router::new(&space, budget).await;
    let mut cost_field = router.cost_field();
    cost_field.explore(origin, |_| false, budget).await;
    let cell = goals
        .iter()
        .filter_map(|goal| {
            let cell = space.free_under(goal.at)?;
            let path_m = cost_field.path_m(router.block(cell))?;
            Some((path_m + goal.detour_m, cell))
        })
        .min_by(|one, other| one.0.total_cmp(&other.0))
        .map(|(_, cell)| cell)?;
    let corners: Vec<Point2> = cost_field
        .path(cell)
        .into_iter()
        .map(|cell| space.point(cell))
        .collect();
    let polyline = Polyline {
        corners: &corners,
        ring_corners: 0,
        heading_rad: start.heading_rad,
    };
    Some(smoothing::segments(polyline, &space, budget).await)
}

#[cfg(test)]
mod tests {
    use super::{Goal, PathSegment};
    use crate::mapping::{Cell, Raster};
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::gradual::{StepBudget, at_once};

    /// Two rooms of 2 m, side by side, with a door in the middle of the wall between them.
    fn rooms() -> Raster<bool> {
        let mut space = Raster::filled(Cell { x: 0, y: 0 }, 161, 80, true);
        for y in (0..80).filter(|y| !(35..45).contains(y)) {
            *space.get_mut(Cell { x: 80, y }).unwrap() = false;
        }
        space
    }

    fn goal(x_m: f64, y_m: f64, detour_m: f64) -> Goal {
        Goal {
            at: Point2 { x_m, y_m },
            detour_m,
        }
    }

    fn start() -> Pose2 {
        Pose2 {
            x_m: 0.5,
            y_m: 0.3,
            heading_rad: 0.0,
        }
    }

    fn path(goals: &[Goal]) -> Option<Vec<PathSegment>> {
        at_once(super::plan_path(
            &rooms(),
            start(),
            goals,
            &mut StepBudget::unlimited(),
        ))
    }

    fn end(goals: &[Goal]) -> Option<Point2> {
        path(goals)?.last().map(|segment| segment.at(1.0).position())
    }

    #[test]
    fn the_path_leads_through_the_door_and_ends_at_the_goal() {
        let there = end(&[goal(3.5, 0.3, 0.0)]).unwrap();
        assert!(
            there.distance_m(Point2 { x_m: 3.5, y_m: 0.3 }) < 0.05,
            "{there:?}"
        );
        let length_m: f64 = path(&[goal(3.5, 0.3, 0.0)])
            .unwrap()
            .iter()
            .map(|segment| segment.length_m)
            .sum();
        assert!((3.0..3.9).contains(&length_m), "{length_m}");
    }

    #[test]
    fn the_cheapest_goal_is_chosen_and_goals_inside_walls_are_ignored() {
        let near = end(&[goal(3.5, 0.3, 0.0), goal(1.0, 0.3, 1.0)]).unwrap();
        assert!(near.x_m < 1.1, "{near:?}");
        let far = end(&[goal(3.5, 0.3, 0.0), goal(1.0, 0.3, 9.0)]).unwrap();
        assert!(far.x_m > 3.4, "{far:?}");
        assert_eq!(end(&[goal(2.0125, 0.3, 0.0), goal(9.0, 9.0, 0.0)]), None);
    }
}
