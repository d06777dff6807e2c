//! `statistical`: the strategy of a robot whose heading comes from its wheels alone.
//!
//! It has no map, but for some minutes wheel odometry is good enough to tell swept floor from unswept. So it bounces
//! towards floor that was not swept recently, with a spiral in the open, until hardly any floor is new. Then it follows the
//! walls until the floor beside them is new, which is mostly another room. Statistics estimate the swept share ([`law`])
//! and decide when to end.

mod law;
mod novelty;
mod parameters;

use super::Bounce;
use super::spiral::Spiral;
use crate::coverage::parameters::{RECENT, SPIRAL};
use crate::coverage::recent_coverage::is_new;
use crate::mapping::Map;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::Point2;
use crate::model::reason::Reason;
use crate::model::swept_share::SweptShare;
use crate::navigation::{
    ManoeuvreStep, Situation, Task, TaskContext, TaskStatus, Turn, WallFollower, WallStep,
};
use novelty::Novelty;
use parameters::STATISTICAL;

/// The strategy.
#[derive(Clone, Debug)]
pub(crate) struct Statistical {
    mode: StatisticalMode,
    bounce: Bounce,
    wall: WallFollower,
    novelty: Novelty,
    since_spiral_m: f64,
    swath_m: f64,
    has_begun: bool,
}

#[derive(Clone, Copy, Debug)]
enum StatisticalMode {
    /// A widening spiral.
    Spiral(Spiral),
    /// Bouncing towards new floor.
    Bounce,
    /// Along the wall on the right.
    Wall(WallDrive),
    /// Turning away from the wall.
    Away(Turn),
}

/// A drive along the walls, metres.
#[derive(Clone, Copy, Debug, Default)]
struct WallDrive {
    driven_m: f64,
    /// The last part of it, with new floor beside it.
    new_m: f64,
}

impl WallDrive {
    fn follow(&mut self, driven_m: f64, situation: &Situation<'_>) {
        self.driven_m += driven_m;
        self.new_m = if is_new_beside(situation) {
            self.new_m + driven_m
        } else {
            0.0
        };
    }

    fn is_over(self) -> bool {
        (self.driven_m > STATISTICAL.wall_m.start && self.new_m > STATISTICAL.beside_new_m)
            || self.driven_m > STATISTICAL.wall_m.end
    }
}

impl Default for Statistical {
    fn default() -> Self {
        Self {
            mode: StatisticalMode::Spiral(Spiral::default()),
            bounce: Bounce::towards_new_floor(),
            wall: WallFollower::default(),
            novelty: Novelty::default(),
            since_spiral_m: 0.0,
            swath_m: 0.0,
            has_begun: false,
        }
    }
}

impl Task for Statistical {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.begin(situation, context);
        self.novelty.follow(situation);
        let estimate = self.swept_share(situation.map).unwrap_or_default();
        if estimate.share_low >= STATISTICAL.enough_share {
            context.decide(DecisionKind::Covered, Reason::ByStatistics, estimate.share);
            return TaskStatus::Finished(Reason::ByStatistics);
        }
        let driven_m = situation.advance.distance_m.max(0.0);
        self.since_spiral_m += driven_m;
        match &mut self.mode {
            StatisticalMode::Spiral(_) => self.spiral(situation, context),
            StatisticalMode::Bounce => self.bounce(situation, context),
            StatisticalMode::Wall(wall_drive) => {
                if self.wall.is_following() {
                    wall_drive.follow(driven_m, situation);
                }
                self.follow_wall(situation, context)
            }
            StatisticalMode::Away(turn) => match turn.step(situation) {
                ManoeuvreStep::Going(motion) if situation.is_free() => TaskStatus::Go(motion),
                _ => self.begin_bounce(situation, context),
            },
        }
    }

    fn interrupted(&mut self) {
        self.bounce.interrupted();
        self.wall.interrupted();
        if let StatisticalMode::Spiral(_) | StatisticalMode::Away(_) = self.mode {
            self.mode = StatisticalMode::Bounce;
        }
    }

    fn swept_share(&self, _map: &Map) -> Option<SweptShare> {
        self.novelty.count().share(self.swath_m)
    }
}

impl Statistical {
    /// For a task that has said itself why it cleans by statistics.
    pub(crate) fn unannounced() -> Self {
        Self {
            has_begun: true,
            ..Self::default()
        }
    }

    /// Whether an evasion is in progress.
    pub(crate) fn is_evading(&self) -> bool {
        self.bounce.is_evading() || self.wall.is_evading()
    }

    /// Records once how it cleans.
    fn begin(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        self.swath_m = situation.config.body.swath_m;
        if !core::mem::replace(&mut self.has_begun, true) && !situation.knows_heading {
            context.decide(DecisionKind::CleanByStatistics, Reason::NoHeading, 0.0);
        }
    }

    fn begin_bounce(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.bounce.interrupted();
        self.mode = StatisticalMode::Bounce;
        self.bounce.step(situation, context)
    }

    fn spiral(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        self.since_spiral_m = 0.0;
        if let StatisticalMode::Spiral(spiral) = &mut self.mode
            && let Some(motion) = spiral.step(situation)
        {
            return TaskStatus::Go(motion);
        }
        self.begin_bounce(situation, context)
    }

    fn bounce(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let share = self.novelty.share();
        if self.bounce.is_evading() {
            return self.bounce.step(situation, context);
        }
        if share < STATISTICAL.leave_share && !situation.is_free() {
            context.decide(DecisionKind::FollowWall, Reason::SweptLately, share);
            self.wall = WallFollower::default();
            self.mode = StatisticalMode::Wall(WallDrive::default());
            return self.follow_wall(situation, context);
        }
        let is_open = self.bounce.straight_m() > SPIRAL.open_straight_m
            && self.since_spiral_m > STATISTICAL.spiral_every_m;
        if is_open && share > STATISTICAL.spiral_share {
            context.decide(DecisionKind::Spiral, Reason::OpenFloor, self.bounce.straight_m());
            self.mode = StatisticalMode::Spiral(Spiral::default());
            return self.spiral(situation, context);
        }
        self.bounce.step(situation, context)
    }

    fn follow_wall(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let is_over = matches!(self.mode, StatisticalMode::Wall(wall_drive) if wall_drive.is_over());
        if is_over && situation.is_free() && !self.wall.is_evading() {
            let turn_rad = context.random.within(&STATISTICAL.away_rad);
            context.decide(DecisionKind::LeaveWall, Reason::NewFloor, turn_rad);
            self.novelty.restart();
            self.mode = StatisticalMode::Away(Turn::by(turn_rad));
            return TaskStatus::Go(Motion::Halt);
        }
        match self.wall.step(situation, context) {
            WallStep::Going(motion) => TaskStatus::Go(motion),
            WallStep::Trouble(reason) => {
                self.bounce.interrupted();
                self.mode = StatisticalMode::Bounce;
                TaskStatus::Trouble(reason)
            }
        }
    }
}

/// Whether most of the floor beside the robot was not swept recently.
fn is_new_beside(situation: &Situation<'_>) -> bool {
    let is_new_at = |y_m: &&f64| {
        let at = situation.pose.transform(Point2 { x_m: 0.0, y_m: **y_m });
        is_new(situation.map, at, RECENT.memory_s)
    };
    STATISTICAL.beside_m.iter().filter(is_new_at).count() >= STATISTICAL.beside_new_min
}
