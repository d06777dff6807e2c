//! `wall-bounce`: what cheap robots without a map do. A spiral while the floor is open, bouncing, and now and then a stretch
//! along the walls, where bouncing alone sweeps last.

use super::Bounce;
use super::spiral::Spiral;
use crate::model::action::Motion;
use crate::model::reason::Reason;
use crate::navigation::{Leg, Mind, Plan, Situation, Task, Turn, WallFollower, WallStep};

/// Way of bouncing before the next stretch along a wall, metres.
const BOUNCE_M: (f64, f64) = (12.0, 30.0);
/// Way along a wall, metres.
const WALL_M: (f64, f64) = (5.0, 12.0);
/// Turn away from the wall after it, radians.
const AWAY_RAD: (f64, f64) = (0.5, 2.4);
/// A run this long without an encounter is on open floor, metres.
const OPEN_RUN_M: f64 = 1.8;
/// Way between two spirals, metres.
const SPIRAL_EVERY_M: f64 = 30.0;

/// The strategy.
#[derive(Clone, Debug)]
pub(crate) struct WallBounce {
    manner: Manner,
    bounce: Bounce,
    wall: WallFollower,
    /// Way since the last spiral, metres.
    since_spiral_m: f64,
}

#[derive(Clone, Copy, Debug)]
enum Manner {
    /// In widening turns to the left.
    Spiral(Spiral),
    /// Bouncing for some way.
    Bounce { left_m: f64 },
    /// Along what stands on the right for some way.
    Wall { left_m: f64 },
    /// Away from the wall.
    Away(Turn),
}

impl Default for WallBounce {
    fn default() -> Self {
        Self {
            manner: Manner::Spiral(Spiral::default()),
            bounce: Bounce::default(),
            wall: WallFollower::default(),
            since_spiral_m: 0.0,
        }
    }
}

impl Task for WallBounce {
    fn step(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        let way_m = situation.advance.distance_m.max(0.0);
        self.since_spiral_m += way_m;
        match &mut self.manner {
            Manner::Spiral(spiral) => {
                let spiral = *spiral;
                self.spiral(spiral, situation, mind)
            }
            Manner::Bounce { left_m } => {
                *left_m -= way_m;
                let left_m = *left_m;
                self.bounce(left_m, situation, mind)
            }
            Manner::Wall { left_m } => {
                if self.wall.is_following() {
                    *left_m -= way_m;
                }
                let left_m = *left_m;
                self.follow_wall(left_m, situation, mind)
            }
            Manner::Away(turn) => match turn.step(situation) {
                Leg::Going(motion) if situation.is_free() => Plan::Go(motion),
                _ => {
                    self.begin_bounce(mind);
                    self.bounce.step(situation, mind)
                }
            },
        }
    }

    fn interrupted(&mut self) {
        self.bounce.interrupted();
        self.wall.interrupted();
        if let Manner::Spiral(_) | Manner::Away(_) = self.manner {
            self.manner = Manner::Bounce { left_m: BOUNCE_M.0 };
        }
    }
}

impl WallBounce {
    fn begin_bounce(&mut self, mind: &mut Mind) {
        self.bounce.interrupted();
        let left_m = mind.random.between(BOUNCE_M.0, BOUNCE_M.1);
        self.manner = Manner::Bounce { left_m };
    }

    fn spiral(&mut self, mut spiral: Spiral, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        self.since_spiral_m = 0.0;
        match spiral.step(situation) {
            Some(motion) => {
                self.manner = Manner::Spiral(spiral);
                Plan::Go(motion)
            }
            None => {
                self.begin_bounce(mind);
                self.bounce.step(situation, mind)
            }
        }
    }

    fn bounce(&mut self, left_m: f64, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        if !self.bounce.is_evading() {
            if left_m <= 0.0 && !situation.is_free() {
                mind.decide("follow-wall", Reason::Alternation, 0.0);
                self.wall = WallFollower::default();
                let left_m = mind.random.between(WALL_M.0, WALL_M.1);
                self.manner = Manner::Wall { left_m };
                return self.follow_wall(left_m, situation, mind);
            }
            if self.bounce.run_m() > OPEN_RUN_M && self.since_spiral_m > SPIRAL_EVERY_M {
                mind.decide("spiral", Reason::OpenFloor, self.bounce.run_m());
                self.manner = Manner::Spiral(Spiral::default());
                return self.spiral(Spiral::default(), situation, mind);
            }
        }
        self.bounce.step(situation, mind)
    }

    fn follow_wall(&mut self, left_m: f64, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        if left_m <= 0.0 && situation.is_free() && !self.wall.is_evading() {
            let turn_rad = mind.random.between(AWAY_RAD.0, AWAY_RAD.1);
            mind.decide("leave-wall", Reason::Alternation, turn_rad);
            self.manner = Manner::Away(Turn::by(turn_rad));
            return Plan::Go(Motion::Halt);
        }
        match self.wall.step(situation, mind) {
            WallStep::Going(motion) => Plan::Go(motion),
            WallStep::Trouble(reason) => {
                self.begin_bounce(mind);
                Plan::Trouble(reason)
            }
        }
    }
}
