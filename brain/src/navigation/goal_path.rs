//! The way to one place.

use super::configuration_space::Ground;
use super::router::Router;
use super::{Piece, smoothing};
use crate::mapping::Raster;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::StepBudget;

/// A place that may be gone to, and what it is worth to go to another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Goal {
    /// The place.
    pub(crate) at: Point2,
    /// It is as good as a place without this that lies so much farther, metres.
    pub(crate) detour_m: f64,
}

/// The way over `reachable` to the goal that is best to reach: the shortest, with what the goals are worth. `None` when none
/// of them can be reached.
pub(crate) async fn plan_way(
    reachable: &Raster<bool>,
    (start, goals): (Pose2, &[Goal]),
    budget: &mut StepBudget,
) -> Option<Vec<Piece>> {
    let mut ground = Ground::new(reachable, 1, budget).await;
    let origin = ground.origin_near(start.position(), budget).await?;
    ground.keep_connected(origin, budget).await;
    let router = Router::new(&ground, budget).await;
    let mut spread = router.spread();
    router.explore(origin, (&mut spread, budget), |_| false).await;
    let cell = goals
        .iter()
        .filter_map(|goal| {
            let cell = ground.free_under(goal.at)?;
            let way_m = spread.way_m(router.block(cell))?;
            Some((way_m + goal.detour_m, cell))
        })
        .min_by(|one, other| one.0.total_cmp(&other.0))
        .map(|(_, cell)| cell)?;
    let corners: Vec<Point2> = router
        .way(&spread, origin, cell)
        .into_iter()
        .map(|cell| ground.point(cell))
        .collect();
    Some(smoothing::pieces((&corners, 0), start.heading_rad, (&ground, budget)).await)
}

#[cfg(test)]
mod tests {
    use super::{Goal, Piece};
    use crate::mapping::{Cell, Raster};
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::gradual::{StepBudget, at_once};

    /// Two rooms of 2 m, side by side, with a door in the middle of the wall between them.
    fn rooms() -> Raster<bool> {
        let mut ground = Raster::filled(Cell { x: 0, y: 0 }, 161, 80, true);
        for y in (0..80).filter(|y| !(35..45).contains(y)) {
            *ground.get_mut(Cell { x: 80, y }).unwrap() = false;
        }
        ground
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

    fn way(goals: &[Goal]) -> Option<Vec<Piece>> {
        at_once(super::plan_way(
            &rooms(),
            (start(), goals),
            &mut StepBudget::unlimited(),
        ))
    }

    fn end(goals: &[Goal]) -> Option<Point2> {
        way(goals)?.last().map(|piece| piece.at(1.0).position())
    }

    #[test]
    fn the_way_leads_through_the_door_and_ends_at_the_goal() {
        let there = end(&[goal(3.5, 0.3, 0.0)]).unwrap();
        assert!(
            there.distance_m(Point2 { x_m: 3.5, y_m: 0.3 }) < 0.05,
            "{there:?}"
        );
        let length_m: f64 = way(&[goal(3.5, 0.3, 0.0)])
            .unwrap()
            .iter()
            .map(|piece| piece.length_m)
            .sum();
        assert!((3.0..3.9).contains(&length_m), "{length_m}");
    }

    #[test]
    fn the_goal_that_is_worth_most_is_chosen_and_walls_are_none() {
        let near = end(&[goal(3.5, 0.3, 0.0), goal(1.0, 0.3, 1.0)]).unwrap();
        assert!(near.x_m < 1.1, "{near:?}");
        let far = end(&[goal(3.5, 0.3, 0.0), goal(1.0, 0.3, 9.0)]).unwrap();
        assert!(far.x_m > 3.4, "{far:?}");
        assert_eq!(end(&[goal(2.0125, 0.3, 0.0), goal(9.0, 9.0, 0.0)]), None);
    }
}
