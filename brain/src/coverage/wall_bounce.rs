//! `wall-bounce`: what cheap robots without a map do. A spiral on open floor, bouncing, and now and then a drive along the
//! walls, which bouncing alone sweeps last.

use super::Bounce;
use super::spiral::Spiral;
use crate::coverage::parameters::{SPIRAL, WALL_BOUNCE};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::{
    ManoeuvreStep, Situation, Task, TaskContext, TaskStatus, Turn, WallFollower, WallStep,
};

/// The strategy.
#[derive(Clone, Debug)]
pub(crate) struct WallBounce {
    mode: WallBounceMode,
    bounce: Bounce,
    wall: WallFollower,
    /// Distance since the last spiral, metres.
    since_spiral_m: f64,
}

#[derive(Clone, Copy, Debug)]
enum WallBounceMode {
    /// A widening spiral to the left.
    Spiral(Spiral),
    /// Bouncing for a distance.
    Bounce { left_m: f64 },
    /// Along the wall on the right for a distance.
    Wall { left_m: f64 },
    /// Turning away from the wall.
    Away(Turn),
}

impl Default for WallBounce {
    fn default() -> Self {
        Self {
            mode: WallBounceMode::Spiral(Spiral::default()),
            bounce: Bounce::default(),
            wall: WallFollower::default(),
            since_spiral_m: 0.0,
        }
    }
}

impl Task for WallBounce {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let driven_m = situation.advance.distance_m.max(0.0);
        self.since_spiral_m += driven_m;
        match &mut self.mode {
            WallBounceMode::Spiral(spiral) => {
                let spiral = *spiral;
                self.spiral(spiral, situation, context)
            }
            WallBounceMode::Bounce { left_m } => {
                *left_m -= driven_m;
                let left_m = *left_m;
                self.bounce(left_m, situation, context)
            }
            WallBounceMode::Wall { left_m } => {
                if self.wall.is_following() {
                    *left_m -= driven_m;
                }
                let left_m = *left_m;
                self.follow_wall(left_m, situation, context)
            }
            WallBounceMode::Away(turn) => match turn.step(situation) {
                ManoeuvreStep::Going(motion) if situation.is_free() => TaskStatus::Go(motion),
                _ => {
                    self.begin_bounce(context);
                    self.bounce.step(situation, context)
                }
            },
        }
    }

    fn interrupted(&mut self) {
        self.bounce.interrupted();
        self.wall.interrupted();
        if let WallBounceMode::Spiral(_) | WallBounceMode::Away(_) = self.mode {
            self.mode = WallBounceMode::Bounce {
                left_m: WALL_BOUNCE.bounce_m.start,
            };
        }
    }
}

impl WallBounce {
    fn begin_bounce(&mut self, context: &mut TaskContext) {
        self.bounce.interrupted();
        let left_m = context.random.within(&WALL_BOUNCE.bounce_m);
        self.mode = WallBounceMode::Bounce { left_m };
    }

    fn spiral(
        &mut self,
        mut spiral: Spiral,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> TaskStatus {
        self.since_spiral_m = 0.0;
        match spiral.step(situation) {
            Some(motion) => {
                self.mode = WallBounceMode::Spiral(spiral);
                TaskStatus::Go(motion)
            }
            None => {
                self.begin_bounce(context);
                self.bounce.step(situation, context)
            }
        }
    }

    fn bounce(&mut self, left_m: f64, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if !self.bounce.is_evading() {
            if left_m <= 0.0 && !situation.is_free() {
                context.decide(DecisionKind::FollowWall, Reason::Alternation, 0.0);
                self.wall = WallFollower::default();
                let left_m = context.random.within(&WALL_BOUNCE.wall_m);
                self.mode = WallBounceMode::Wall { left_m };
                return self.follow_wall(left_m, situation, context);
            }
            if self.bounce.straight_m() > SPIRAL.open_straight_m
                && self.since_spiral_m > WALL_BOUNCE.spiral_every_m
            {
                context.decide(DecisionKind::Spiral, Reason::OpenFloor, self.bounce.straight_m());
                self.mode = WallBounceMode::Spiral(Spiral::default());
                return self.spiral(Spiral::default(), situation, context);
            }
        }
        self.bounce.step(situation, context)
    }

    fn follow_wall(
        &mut self,
        left_m: f64,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> TaskStatus {
        if left_m <= 0.0 && situation.is_free() && !self.wall.is_evading() {
            let turn_rad = context.random.within(&WALL_BOUNCE.away_rad);
            context.decide(DecisionKind::LeaveWall, Reason::Alternation, turn_rad);
            self.mode = WallBounceMode::Away(Turn::by(turn_rad));
            return TaskStatus::Go(Motion::Halt);
        }
        match self.wall.step(situation, context) {
            WallStep::Going(motion) => TaskStatus::Go(motion),
            WallStep::Trouble(reason) => {
                self.begin_bounce(context);
                TaskStatus::Trouble(reason)
            }
        }
    }
}
