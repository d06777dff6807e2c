//! One lap along the walls of a home that nobody knows yet: it cleans the edges and shows the outline.
//!
//! Terms. *Lap*: the way along everything that hangs together with the first wall that is met. *Island*: something that
//! stands free; the way round it turns right in sum. *Track*: places of the lap, one every few centimetres.
//! *Stretch*: part of the track on which it never lost what it follows.
//!
//! The lap is closed when the robot goes along the track of its stretch for a while, in the same direction: then it has seen
//! all of this outline. When the sum of turns since the first time is not a full turn to the left, it was an island, or a
//! loop among several; it leaves that and looks for another wall. A lap that never closes ends by its length, or on the track of an earlier stretch.

use core::f64::consts::TAU;

use super::escape_bounce::EscapeBounce;
use super::whole_turns::WholeTurns;
use crate::model::action::Motion;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::reason::Reason;
use crate::navigation::{ManoeuvreStep, Situation, TaskContext, TaskStatus, Turn, WallFollower, WallStep};

/// Places of the track are so far apart, metres.
const TRACK_STEP_M: f64 = 0.1;
/// A place nearer than this was passed before, metres; less sure poses have more.
const SAME_M: f64 = 0.14;
/// Farthest that a place is taken for one that was passed before, metres.
const SAME_MAX_M: f64 = 0.5;
/// As `SAME_M`, for the heading, radians.
const SAME_RAD: f64 = 0.6;
/// A lap round an island is at least so long, metres: a body's width round nothing.
const ISLAND_MIN_M: f64 = 1.0;
/// A lap along walls is at least so long, metres.
const LAP_MIN_M: f64 = 4.0;
/// So much way on the own track closes a lap, metres.
const AGAIN_M: f64 = 0.4;
/// So much way on the track of an earlier stretch ends a lap, metres: it leads to nothing new.
const AGAIN_ELSEWHERE_M: f64 = 5.0;
/// A place this near to one that was passed before shows nothing new, whatever it looks at, metres: its floor is swept.
const SHOWN_M: f64 = 0.22;
/// So much way that shows nothing new, more than three times as much as shows something, ends a lap, metres.
const STALE_MAX_M: f64 = 8.0;
const FRESH_WORTH: f64 = 3.0;
/// A lap longer than this is ended, metres: twice that of a large home.
const LAP_MAX_M: f64 = 400.0;
/// So many islands in one lap and no walls: enough.
const ISLANDS_MAX: u32 = 12;
/// Turn away from an island, radians.
const AWAY_RAD: f64 = 1.5;
/// Troubles in one lap until it is ended.
const TROUBLES_MAX: u32 = 6;

/// The lap.
#[derive(Debug, Default)]
pub(crate) struct Perimeter {
    wall: WallFollower,
    away: Option<Turn>,
    escape_bounce: Option<EscapeBounce>,
    whole_turns: WholeTurns,
    track: Vec<LapPoint>,
    driven_m: f64,
    turned_rad: f64,
    again_m: f64,
    /// Way that shows nothing new, less what shows something.
    stale_m: f64,
    /// Number of the present stretch: a new one begins wherever it leaves what it followed.
    stretch: u32,
    islands: u32,
    troubles: u32,
}

/// A place of the track.
#[derive(Clone, Copy, Debug)]
struct LapPoint {
    pose: Pose2,
    sigma_m: f64,
    driven_m: f64,
    turned_rad: f64,
    stretch: u32,
}

/// State of the lap after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LapStep {
    /// On it.
    Going(Motion),
    /// It cannot go on by its own means.
    Trouble(Reason),
    /// It is over.
    Over(Reason),
}

impl Perimeter {
    /// Half-done movements are void; the track stays.
    pub(crate) fn interrupted(&mut self) {
        self.wall.interrupted();
        self.whole_turns.interrupted();
        self.away = None;
        if let Some(escape_bounce) = &mut self.escape_bounce {
            escape_bounce.interrupted();
        }
    }

    /// Another lap after one that is over, at a wall that is not on the track yet, if there is one.
    pub(crate) fn begin_again(&mut self) {
        self.interrupted();
        self.escape_bounce = None;
        self.again_m = 0.0;
        self.stale_m = 0.0;
        self.islands = 0;
        self.troubles = 0;
    }

    /// Turns its back to the wall that it follows, for another lap at what is met next.
    pub(crate) fn leave(&mut self) -> Motion {
        self.begin_again();
        self.turn_away()
    }

    /// Whether it is getting away from something that it touched.
    pub(crate) fn is_evading(&self) -> bool {
        self.wall.is_evading()
    }

    /// Way that was made, metres.
    pub(crate) fn driven_m(&self) -> f64 {
        self.driven_m
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> LapStep {
        self.turned_rad += situation.advance.turn_rad;
        self.driven_m += situation.advance.distance_m.max(0.0);
        if self.driven_m > LAP_MAX_M || self.troubles > TROUBLES_MAX || self.islands > ISLANDS_MAX {
            return LapStep::Over(Reason::LongLap);
        }
        if let Some(turn) = &mut self.away {
            match turn.step(situation) {
                ManoeuvreStep::Going(motion) if situation.is_free() => return LapStep::Going(motion),
                _ => self.away = None,
            }
        }
        if let Some(step) = self.bounce(situation, context) {
            return step;
        }
        if let Some(motion) = self.turn_for_gyro(situation, context) {
            return LapStep::Going(motion);
        }
        if !self.wall.is_evading() && situation.is_free() {
            match self.passed_before(situation) {
                Some(Reason::Island) => return LapStep::Going(self.leave_island(situation, context)),
                Some(reason) => return LapStep::Over(reason),
                None => {}
            }
        }
        match self.wall.step(situation, context) {
            WallStep::Going(motion) => LapStep::Going(motion),
            WallStep::Trouble(reason) => {
                self.troubles += 1;
                context.decide("bounce", reason, f64::from(self.troubles));
                self.escape_bounce = Some(EscapeBounce::from(situation.pose.position()));
                if reason == Reason::BoxedIn {
                    LapStep::Going(Motion::Halt)
                } else {
                    LapStep::Trouble(reason)
                }
            }
        }
    }

    /// Turns on the spot for the gyro's sake. Whole turns lead round nothing and do not count as such.
    fn turn_for_gyro(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<Motion> {
        let is_beside_wall = self.wall.is_along_wall();
        let motion = self.whole_turns.step(situation, is_beside_wall, context);
        self.turned_rad -= self.whole_turns.take_made_rad();
        motion
    }

    /// Bounces out of a place where following leads nowhere.
    fn bounce(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<LapStep> {
        match self.escape_bounce.as_mut()?.step(situation, context) {
            Some(TaskStatus::Go(motion)) => Some(LapStep::Going(motion)),
            Some(TaskStatus::Trouble(reason)) => Some(LapStep::Trouble(reason)),
            Some(TaskStatus::Finished(_)) | None => {
                self.escape_bounce = None;
                None
            }
        }
    }

    /// Turns its back to an island; what is met next is another wall, or another island.
    fn leave_island(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Motion {
        context.decide("leave-wall", Reason::Island, situation.pose.heading_rad);
        self.islands += 1;
        self.again_m = 0.0;
        self.wall.interrupted();
        self.turn_away()
    }

    fn turn_away(&mut self) -> Motion {
        self.away = Some(Turn::by(AWAY_RAD));
        Motion::Halt
    }

    /// Lengthens the track, and says what it means that the robot goes along it.
    fn passed_before(&mut self, situation: &Situation<'_>) -> Option<Reason> {
        if !self.wall.is_following() {
            self.stretch = self.track.last().map_or(0, |last| last.stretch + 1);
            self.again_m = 0.0;
            return None;
        }
        let step_m = self
            .track
            .last()
            .map_or(f64::INFINITY, |last| self.driven_m - last.driven_m);
        if step_m < TRACK_STEP_M {
            return None;
        }
        let here = LapPoint {
            pose: situation.pose,
            sigma_m: situation.estimate.sigma_m,
            driven_m: self.driven_m,
            turned_rad: self.turned_rad,
            stretch: self.stretch,
        };
        let before = self
            .track
            .iter()
            .rev()
            .find(|before| here.repeats(before))
            .copied();
        let is_stale = self.track.iter().any(|before| here.shows_nothing_beyond(before));
        self.track.push(here);
        if self.grows_stale(is_stale) {
            return Some(Reason::KnownWall);
        }
        let Some(before) = before else {
            self.again_m = 0.0;
            return None;
        };
        self.again_m += step_m.min(2.0 * TRACK_STEP_M);
        if before.stretch != here.stretch {
            return (self.again_m > AGAIN_ELSEWHERE_M).then_some(Reason::KnownWall);
        }
        (self.again_m > AGAIN_M).then(|| {
            if here.turns_since(&before) < 1.0 {
                Reason::Island
            } else {
                Reason::BackAtStart
            }
        })
    }

    /// Counts a place of the track; `true` when there were enough that show nothing new.
    fn grows_stale(&mut self, is_stale: bool) -> bool {
        self.stale_m = if is_stale {
            self.stale_m + TRACK_STEP_M
        } else {
            (self.stale_m - FRESH_WORTH * TRACK_STEP_M).max(0.0)
        };
        self.stale_m > STALE_MAX_M
    }
}

impl LapPoint {
    /// Whether the floor here was swept from an earlier place.
    fn shows_nothing_beyond(&self, before: &Self) -> bool {
        self.driven_m - before.driven_m > LAP_MIN_M
            && self.pose.position().distance_m(before.pose.position()) < SHOWN_M
    }

    /// Full turns to the left since an earlier place with the same heading.
    fn turns_since(&self, before: &Self) -> f64 {
        libm::round((self.turned_rad - before.turned_rad) / TAU)
    }

    fn repeats(&self, before: &Self) -> bool {
        let driven_m = self.driven_m - before.driven_m;
        let least_m = if self.stretch == before.stretch && self.turns_since(before) < 0.0 {
            ISLAND_MIN_M
        } else {
            LAP_MIN_M
        };
        let same_m = (SAME_M + 0.3 * (self.sigma_m - before.sigma_m)).clamp(SAME_M, SAME_MAX_M);
        driven_m > least_m
            && self.pose.position().distance_m(before.pose.position()) < same_m
            && normalize_rad(self.pose.heading_rad - before.pose.heading_rad).abs() < SAME_RAD
    }
}

#[cfg(test)]
mod tests {
    use super::{LapPoint, Perimeter, STALE_MAX_M, TRACK_STEP_M};
    use crate::model::geometry::Pose2;

    fn at(x_m: f64, heading_rad: f64, driven_m: f64) -> LapPoint {
        LapPoint {
            pose: Pose2 {
                x_m,
                y_m: 0.0,
                heading_rad,
            },
            sigma_m: 0.02,
            driven_m,
            turned_rad: 0.0,
            stretch: 0,
        }
    }

    #[test]
    fn floor_that_was_swept_the_other_way_round_shows_nothing_new_and_is_no_closed_lap() {
        let (before, back) = (at(0.0, 0.0, 0.0), at(0.1, 3.1, 9.0));
        assert!(back.shows_nothing_beyond(&before) && !back.repeats(&before));
        assert!(!at(0.3, 0.0, 9.0).shows_nothing_beyond(&before));
        assert!(!at(0.1, 0.0, 1.0).shows_nothing_beyond(&before), "just passed");
    }

    #[test]
    fn a_lap_ends_when_it_shows_nothing_new_for_long_and_not_while_it_shows_something_now_and_then() {
        let mut lap = Perimeter::default();
        let steps = (STALE_MAX_M / TRACK_STEP_M) as u32;
        assert!((0..steps - 1).all(|_| !lap.grows_stale(true)));
        assert!((0..3).any(|_| lap.grows_stale(true)));
        let mut lap = Perimeter::default();
        assert!((0..20 * steps).all(|step| !lap.grows_stale(step % 3 != 0)));
    }
}
