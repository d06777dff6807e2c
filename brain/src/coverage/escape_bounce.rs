//! Bouncing away from a place where nothing else works.

use super::Bounce;
use crate::model::geometry::Point2;
use crate::navigation::{Situation, Task, TaskContext, TaskStatus};

/// At this distance the robot has left the place, metres.
const ESCAPE_M: f64 = 0.6;
/// Longest time of bouncing, seconds.
const ESCAPE_S: f64 = 20.0;

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
            left_s: ESCAPE_S,
        }
    }

    /// What to do; `None` when the robot has left the place or the time is over.
    pub(super) fn step(
        &mut self,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> Option<TaskStatus> {
        self.left_s -= situation.advance.time_s;
        let is_away = self.from.distance_m(situation.pose.position()) > ESCAPE_M;
        let is_over = (is_away || self.left_s <= 0.0) && !self.bounce.is_evading() && situation.is_free();
        (!is_over).then(|| self.bounce.step(situation, context))
    }

    /// Discards unfinished movements.
    pub(super) fn interrupted(&mut self) {
        self.bounce.interrupted();
    }
}
