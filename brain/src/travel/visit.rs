//! Drives to a place that a person has named, and stands there.

use core::f64::consts::TAU;

use super::drive::{Travel, TravelStep};
use super::parameters::TRAVEL;
use crate::model::geometry::Point2;
use crate::model::order::{CleaningOrder, HomePart};
use crate::model::reason::Reason;
use crate::navigation::{Goal, Situation, Task, TaskContext, TaskStatus};

/// The task.
#[derive(Debug)]
pub(crate) struct Visit {
    travel: Travel,
}

impl Visit {
    /// To the nearest place of the order.
    pub(crate) fn of(order: &CleaningOrder) -> Self {
        let goals = order.parts().iter().filter_map(|part| match part {
            HomePart::Spot(place) => Some(near(*place)),
            HomePart::Room(_) | HomePart::Zone(_) => None,
        });
        Self {
            travel: Travel::to_place(goals.flatten().collect()),
        }
    }
}

impl Task for Visit {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if situation.estimate.lost && situation.is_free() {
            return TaskStatus::Finished(Reason::PlaceUnknown);
        }
        match self.travel.step(situation, context) {
            TravelStep::Going(motion) => TaskStatus::Go(motion),
            TravelStep::Arrived => TaskStatus::Finished(Reason::Arrived),
            TravelStep::Blocked => TaskStatus::Finished(Reason::WayBlocked),
            TravelStep::Held(reason) => TaskStatus::Trouble(reason),
        }
    }

    fn interrupted(&mut self) {
        self.travel.interrupted();
    }

    fn planned_path(&self) -> Vec<Point2> {
        self.travel.planned_path()
    }
}

/// The place, and others around it that do as well where the body does not fit there: under a chair, close to a wall.
fn near(place: Point2) -> Vec<Goal> {
    let around = TRAVEL.near_m.into_iter().flat_map(|off_m| {
        (0..TRAVEL.near_directions).map(move |direction| {
            let bearing_rad = TAU * f64::from(direction) / f64::from(TRAVEL.near_directions);
            let (sin, cos) = libm::sincos(bearing_rad);
            Goal {
                at: Point2 {
                    x_m: place.x_m + off_m * cos,
                    y_m: place.y_m + off_m * sin,
                },
                detour_m: TRAVEL.near_detour * off_m,
            }
        })
    });
    let itself = Goal {
        at: place,
        detour_m: 0.0,
    };
    core::iter::once(itself).chain(around).collect()
}

#[cfg(test)]
mod tests {
    use super::{TRAVEL, near};
    use crate::model::geometry::Point2;

    #[test]
    fn places_around_count_the_more_the_farther_they_are() {
        let place = Point2 { x_m: 2.0, y_m: -1.0 };
        let goals = near(place);
        assert_eq!(
            goals.len(),
            1 + TRAVEL.near_m.len() * TRAVEL.near_directions as usize
        );
        assert_eq!((goals[0].at, goals[0].detour_m), (place, 0.0));
        for goal in &goals[1..] {
            let off_m = goal.at.distance_m(place);
            assert!(
                (goal.detour_m - TRAVEL.near_detour * off_m).abs() < 1e-9,
                "{goal:?}"
            );
            assert!(off_m <= 0.6 + 1e-9, "{goal:?}");
        }
    }
}
