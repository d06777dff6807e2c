//! Bouncing away from a place where nothing else works.

use super::Bounce;
use crate::coverage::parameters::ESCAPE_BOUNCE;
use crate::model::geometry::Point2;
use crate::navigation::{Situation, Task, TaskContext, TaskStatus};

/// A bounded time of bouncing.
#[derive(Debug)]
pub(super) struct EscapeBounce {
    bounce: Bounce,
    from: Point2,
    left_s: f64,
}

impl EscapeBounce {
    /// Away from this place.
    pub(super) fn from(place: Point2) -> Self {
        Self {
            bounce: Bounce::default(),
            from: place,
            left_s: ESCAPE_BOUNCE.time_max_s,
        }
    }

    /// What to do; `None` when the robot has left the place or the time is over.
    pub(super) fn step(
        &mut self,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> Option<TaskStatus> {
        self.left_s -= situation.advance.time_s;
        let is_away = self.from.distance_m(situation.pose.position()) > ESCAPE_BOUNCE.away_m;
        let is_over = (is_away || self.left_s <= 0.0) && !self.bounce.is_evading() && situation.is_free();
        (!is_over).then(|| self.bounce.step(situation, context))
    }

    /// Discards unfinished movements.
    pub(super) fn interrupted(&mut self) {
        self.bounce.interrupted();
    }
}
