//! One lap along the walls of an unknown home: it cleans the edges and shows the outline.
//!
//! Terms. *Lap*: the drive along everything that is connected with the first wall found. *Island*: a free-standing object;
//! driving round it adds up to a right turn. *Track*: points of the lap, one every few centimetres. *Stretch*: part of the
//! track on which the robot never lost the wall.
//!
//! The lap is closed when the robot repeats the track of the current stretch for a while, in the same direction: then it
//! has seen this whole outline. If the turns since the first pass do not add up to a full left turn, it was an island or
//! one of several loops. The robot leaves that and looks for another wall. A lap that never closes ends by its length, or
//! on the track of an earlier stretch.

use core::f64::consts::{PI, TAU};

use super::escape_bounce::EscapeBounce;
use super::whole_turns::WholeTurns;
use crate::coverage::parameters::PERIMETER;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::reason::Reason;
use crate::navigation::{ManoeuvreStep, Situation, TaskContext, TaskStatus, Turn, WallFollower, WallStep};

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
    /// Distance that showed nothing new, less what showed something new.
    stale_m: f64,
    /// Number of the current stretch: a new one begins whenever the robot loses the wall.
    stretch: u32,
    islands: u32,
    troubles: u32,
}

/// A point of the track.
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
    /// It goes on.
    Going(Motion),
    /// It cannot go on without recovery.
    Trouble(Reason),
    /// It is over.
    Over(Reason),
}

impl Perimeter {
    /// Discards unfinished movements; the track stays.
    pub(crate) fn interrupted(&mut self) {
        self.wall.interrupted();
        self.whole_turns.interrupted();
        self.away = None;
        if let Some(escape_bounce) = &mut self.escape_bounce {
            escape_bounce.interrupted();
        }
    }

    /// Starts another lap after a finished one, at a wall that is not on the track yet if there is one.
    pub(crate) fn begin_again(&mut self) {
        self.interrupted();
        self.escape_bounce = None;
        self.again_m = 0.0;
        self.stale_m = 0.0;
        self.islands = 0;
        self.troubles = 0;
    }

    /// Turns away from the wall, for another lap at the next obstacle.
    pub(crate) fn leave(&mut self) -> Motion {
        self.begin_again();
        self.turn_away()
    }

    /// Whether this place lies beyond the track so far: not within its windings, and at a distance from it.
    pub(crate) fn leaves_out(&self, place: Point2) -> bool {
        let points = || self.track.iter().map(|point| point.pose.position());
        if points().any(|point| point.distance_m(place) < PERIMETER.beyond_m) {
            return false;
        }
        let bearings = points().map(|point| libm::atan2(point.y_m - place.y_m, point.x_m - place.x_m));
        let next = bearings.clone().cycle().skip(1);
        let turned_rad: f64 = bearings
            .zip(next)
            .map(|(one_rad, next_rad)| normalize_rad(next_rad - one_rad))
            .sum();
        turned_rad.abs() < PI
    }

    /// Whether it is evading a contact.
    pub(crate) fn is_evading(&self) -> bool {
        self.wall.is_evading()
    }

    /// Distance driven, metres.
    pub(crate) fn driven_m(&self) -> f64 {
        self.driven_m
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> LapStep {
        self.turned_rad += situation.advance.turn_rad;
        self.driven_m += situation.advance.distance_m.max(0.0);
        if self.driven_m > PERIMETER.lap_max_m
            || self.troubles > PERIMETER.troubles_max
            || self.islands > PERIMETER.islands_max
        {
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
                context.decide(DecisionKind::Bounce, reason, f64::from(self.troubles));
                self.escape_bounce = Some(EscapeBounce::from(situation.pose.position()));
                if reason == Reason::BoxedIn {
                    LapStep::Going(Motion::Halt)
                } else {
                    LapStep::Trouble(reason)
                }
            }
        }
    }

    /// Turns on the spot to calibrate the gyro. These whole turns do not count as turns of the lap.
    fn turn_for_gyro(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<Motion> {
        let is_beside_wall = self.wall.is_along_wall();
        let motion = self.whole_turns.step(situation, is_beside_wall, context);
        self.turned_rad -= self.whole_turns.take_made_rad();
        motion
    }

    /// Bounces out of a place where the wall follower fails.
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

    /// Turns away from an island, towards the next wall or island.
    fn leave_island(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> Motion {
        context.decide(
            DecisionKind::LeaveWall,
            Reason::Island,
            situation.pose.heading_rad,
        );
        self.islands += 1;
        self.again_m = 0.0;
        self.wall.interrupted();
        self.turn_away()
    }

    fn turn_away(&mut self) -> Motion {
        self.away = Some(Turn::by(PERIMETER.away_rad));
        Motion::Halt
    }

    /// Extends the track. Gives the reason to end the lap or to leave an island, if the robot repeats its track.
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
        if step_m < PERIMETER.track_step_m {
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
        if self.is_stale_after(is_stale) {
            return Some(Reason::KnownWall);
        }
        let Some(before) = before else {
            self.again_m = 0.0;
            return None;
        };
        self.again_m += step_m.min(2.0 * PERIMETER.track_step_m);
        if before.stretch != here.stretch {
            return (self.again_m > PERIMETER.known_after_m).then_some(Reason::KnownWall);
        }
        (self.again_m > PERIMETER.closed_after_m).then(|| {
            if here.turns_since(&before) < 1.0 {
                Reason::Island
            } else {
                Reason::BackAtStart
            }
        })
    }

    /// Counts a point of the track; `true` when enough points in a row showed nothing new.
    fn is_stale_after(&mut self, is_stale: bool) -> bool {
        self.stale_m = if is_stale {
            self.stale_m + PERIMETER.track_step_m
        } else {
            (self.stale_m - PERIMETER.fresh_worth * PERIMETER.track_step_m).max(0.0)
        };
        self.stale_m > PERIMETER.stale_max_m
    }
}

impl LapPoint {
    /// Whether this floor was already swept from an earlier point.
    fn shows_nothing_beyond(&self, before: &Self) -> bool {
        self.driven_m - before.driven_m > PERIMETER.lap_min_m
            && self.pose.position().distance_m(before.pose.position()) < PERIMETER.swept_radius_m
    }

    /// Full turns to the left since an earlier point with the same heading.
    fn turns_since(&self, before: &Self) -> f64 {
        libm::round((self.turned_rad - before.turned_rad) / TAU)
    }

    fn repeats(&self, before: &Self) -> bool {
        let driven_m = self.driven_m - before.driven_m;
        let least_m = if self.stretch == before.stretch && self.turns_since(before) < 0.0 {
            PERIMETER.island_min_m
        } else {
            PERIMETER.lap_min_m
        };
        let same_m = (PERIMETER.same_place_m
            + PERIMETER.same_place_per_sigma * (self.sigma_m - before.sigma_m))
            .clamp(PERIMETER.same_place_m, PERIMETER.same_place_max_m);
        driven_m > least_m
            && self.pose.position().distance_m(before.pose.position()) < same_m
            && normalize_rad(self.pose.heading_rad - before.pose.heading_rad).abs()
                < PERIMETER.same_heading_rad
    }
}

#[cfg(test)]
mod tests {
    use super::{LapPoint, PERIMETER, Perimeter};
    use crate::model::geometry::{Point2, Pose2};

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
    fn floor_swept_in_the_opposite_direction_is_not_new_and_closes_no_lap() {
        let (before, back) = (at(0.0, 0.0, 0.0), at(0.1, 3.1, 9.0));
        assert!(back.shows_nothing_beyond(&before) && !back.repeats(&before));
        assert!(!at(0.3, 0.0, 9.0).shows_nothing_beyond(&before));
        assert!(!at(0.1, 0.0, 1.0).shows_nothing_beyond(&before), "just passed");
    }

    #[test]
    fn what_lies_outside_of_a_loop_is_left_out_and_what_it_went_round_is_not() {
        // Round a room of 4 m with the wall on the right.
        let mut lap = Perimeter::default();
        for (from_m, along) in [
            ((-2.0, -2.0), (1.0, 0.0)),
            ((2.0, -2.0), (0.0, 1.0)),
            ((2.0, 2.0), (-1.0, 0.0)),
            ((-2.0, 2.0), (0.0, -1.0)),
        ] {
            for step in 0..40 {
                let at_m = 0.1 * f64::from(step);
                let mut point = at(from_m.0 + at_m * along.0, 0.0, 0.0);
                point.pose.y_m = from_m.1 + at_m * along.1;
                lap.track.push(point);
            }
        }
        let is_left_out = |x_m, y_m| lap.leaves_out(Point2 { x_m, y_m });
        assert!(!is_left_out(0.0, 0.0) && !is_left_out(1.9, 1.9), "inside");
        assert!(!is_left_out(2.5, 0.0), "in the door");
        assert!(
            is_left_out(4.0, 0.0) && is_left_out(0.0, -4.0),
            "in the next room"
        );
    }

    #[test]
    fn a_lap_ends_after_a_long_distance_without_anything_new() {
        let mut lap = Perimeter::default();
        let steps = (PERIMETER.stale_max_m / PERIMETER.track_step_m) as u32;
        assert!((0..steps - 1).all(|_| !lap.is_stale_after(true)));
        assert!((0..3).any(|_| lap.is_stale_after(true)));
        let mut lap = Perimeter::default();
        assert!((0..20 * steps).all(|step| !lap.is_stale_after(step % 3 != 0)));
    }
}
