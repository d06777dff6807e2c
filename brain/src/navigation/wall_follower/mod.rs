//! Follows the wall on the right: walls, corners, furniture, cliffs.
//!
//! Terms. *Gap*: distance between the rim and the wall on the right. *Inner corner*: an obstacle ahead; the robot turns
//! left on the spot. *Outer corner*: the wall ends beside the robot, which drives round its end in an arc to the right. A
//! robot without side sensors does the same by touch: after each contact a little to the left, then the arc.
//!
//! Everything is bounded: turns and arcs by their angle, the search by its distance, contacts by their number within a
//! short distance.

mod parameters;
mod wall_line;
mod wall_ranges;

use super::{Evasion, EvasionStep};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::parameters::{CHASSIS, EVASION};
use crate::navigation::{Situation, TaskContext};
use parameters::{CLIFFS, CONTACTS, CONTROL};
use wall_line::WallLine;
use wall_ranges::WallRanges;

/// Follows a wall on the right.
#[derive(Clone, Debug, Default)]
pub(crate) struct WallFollower {
    phase: WallFollowPhase,
    line: WallLine,
    evasion: Option<Evasion>,
    dark_m: f64,
    /// Crowded contacts, and the distance since the last one.
    contacts: u32,
    since_contact_m: f64,
    /// The same for cliffs.
    edges: u32,
    since_edge_m: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum WallFollowPhase {
    /// Straight on until an obstacle.
    Seek { driven_m: f64 },
    /// Along the wall.
    Along,
    /// Round the end of the wall; `beyond_m` is the radius beyond that of the body.
    Around { turned_rad: f64, beyond_m: f64 },
    /// Left on the spot.
    Turn { turned_rad: f64 },
    /// Straight on along a cliff.
    Pass { left_m: f64 },
}

impl Default for WallFollowPhase {
    fn default() -> Self {
        Self::Seek { driven_m: 0.0 }
    }
}

/// State after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum WallStep {
    /// It goes on.
    Going(Motion),
    /// It cannot go on.
    Trouble(Reason),
}

impl WallFollower {
    /// Whether it follows a wall, and is not searching for one.
    pub(crate) fn is_following(&self) -> bool {
        !matches!(self.phase, WallFollowPhase::Seek { .. })
    }

    /// Whether it sees a wall beside it and drives along it.
    pub(crate) fn is_along_wall(&self) -> bool {
        self.phase == WallFollowPhase::Along
            && self.evasion.is_none()
            && self.line.is_seen_within(CONTROL.ended_m)
    }

    /// Whether it is evading a contact.
    pub(crate) fn is_evading(&self) -> bool {
        self.evasion.is_some()
    }

    /// Discards unfinished movements.
    pub(crate) fn interrupted(&mut self) {
        self.evasion = None;
        self.line.lose();
        self.phase = WallFollowPhase::default();
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> WallStep {
        let ranges = WallRanges::read(situation);
        self.line.follow(situation.advance, &ranges);
        if let Some(evasion) = &mut self.evasion {
            match evasion.step(situation) {
                EvasionStep::Going(motion) => return WallStep::Going(motion),
                EvasionStep::Free => self.evasion = None,
                EvasionStep::Held(reason) => {
                    self.interrupted();
                    return WallStep::Trouble(reason);
                }
            }
        } else if !situation.is_free() {
            return self.evade(situation, context);
        }
        self.count(situation.advance.distance_m.max(0.0));
        self.change_phase(situation, &ranges, context);
        match self.phase {
            WallFollowPhase::Seek { driven_m } if driven_m > CONTROL.seek_max_m => {
                self.trouble(Reason::LongRun)
            }
            WallFollowPhase::Turn { turned_rad } if turned_rad > CONTROL.turn_max_rad => {
                self.trouble(Reason::BoxedIn)
            }
            _ => WallStep::Going(self.motion(situation, &ranges)),
        }
    }

    fn trouble(&mut self, reason: Reason) -> WallStep {
        self.interrupted();
        WallStep::Trouble(reason)
    }

    fn count(&mut self, driven_m: f64) {
        self.since_contact_m += driven_m;
        if self.since_contact_m > CONTACTS.crowded_m {
            self.contacts = 0;
        }
        self.since_edge_m += driven_m;
        if self.since_edge_m > CLIFFS.recent_m {
            self.edges = 0;
        }
        self.dark_m = (self.dark_m - CONTACTS.dark_step_m * driven_m / CONTACTS.dark_forget_m).max(0.0);
    }

    fn evade(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> WallStep {
        let observation = situation.observation;
        if situation.at_cliff {
            let reason = Reason::of_cliffs(observation.cliffs).unwrap_or(Reason::CliffFront);
            context.decide(DecisionKind::BackOff, reason, 0.0);
            let turn_rad = CLIFFS.turn_rad + CLIFFS.recent_turn_rad * f64::from(self.edges);
            self.edges = (self.edges + 1).min(CLIFFS.recent_max);
            self.since_edge_m = 0.0;
            self.evasion = Some(Evasion::from_cliff(EVASION.cliff_back_m, turn_rad));
            self.line.lose();
            self.phase = WallFollowPhase::Pass {
                left_m: CLIFFS.pass_m,
            };
            return WallStep::Going(Motion::Halt);
        }
        let reason = Reason::of_contacts(observation.contacts).unwrap_or(Reason::BumpFront);
        self.contacts += 1;
        if self.contacts > CONTACTS.crowded_max {
            self.contacts = 0;
            return self.trouble(Reason::BoxedIn);
        }
        if reason == Reason::BumpRight && self.line.is_seen_within(CONTACTS.crowded_m) {
            self.dark_m = (self.dark_m + CONTACTS.dark_step_m).min(CONTACTS.dark_max_m);
        }
        let turn_rad = self.turn_after(reason);
        context.decide(DecisionKind::BackOff, reason, turn_rad);
        self.evasion = Some(Evasion::from_contact(CONTACTS.back_m, turn_rad));
        self.since_contact_m = 0.0;
        self.phase = if self.line.is_seen_within(CONTROL.ended_m) {
            WallFollowPhase::Along
        } else {
            WallFollowPhase::Around {
                turned_rad: 0.0,
                beyond_m: CONTACTS.arc_beyond_m,
            }
        };
        WallStep::Going(Motion::Halt)
    }

    /// Turn after a contact, radians. After a first contact on the left the robot tries to pass on the right; after a
    /// second one the passage is too narrow.
    fn turn_after(&self, reason: Reason) -> f64 {
        let crowded_rad = CONTACTS.crowded_turn_rad
            * f64::from(self.contacts.saturating_sub(1)).min(CONTACTS.crowded_turns_max);
        match reason {
            Reason::BumpRight => CONTACTS.right_turn_rad + crowded_rad,
            Reason::BumpLeft if self.contacts <= 1 => CONTACTS.left_first_turn_rad,
            Reason::BumpLeft => CONTACTS.left_turn_rad + crowded_rad,
            _ => CONTACTS.ahead_turn_rad + crowded_rad,
        }
    }

    fn change_phase(&mut self, situation: &Situation<'_>, ranges: &WallRanges, context: &mut TaskContext) {
        let advance = situation.advance;
        let driven_m = advance.distance_m.max(0.0);
        let stop_m = CONTROL.stop_m + self.dark_m;
        let is_blocked = ranges.ahead_m.is_some_and(|ahead_m| ahead_m < stop_m);
        let next = match self.phase {
            WallFollowPhase::Turn { turned_rad } => {
                if ranges.ahead_m.is_none_or(|ahead_m| ahead_m > CONTROL.clear_m) {
                    WallFollowPhase::Along
                } else {
                    WallFollowPhase::Turn {
                        turned_rad: turned_rad + advance.turn_rad.max(0.0),
                    }
                }
            }
            _ if is_blocked => {
                context.decide(DecisionKind::Turn, Reason::WallAhead, 0.0);
                self.line.lose();
                WallFollowPhase::Turn { turned_rad: 0.0 }
            }
            WallFollowPhase::Seek { .. } | WallFollowPhase::Around { .. } if ranges.side_m.is_some() => {
                WallFollowPhase::Along
            }
            WallFollowPhase::Seek { driven_m: before_m } => WallFollowPhase::Seek {
                driven_m: before_m + driven_m,
            },
            WallFollowPhase::Pass { left_m } if left_m > 0.0 => WallFollowPhase::Pass {
                left_m: left_m - driven_m,
            },
            WallFollowPhase::Pass { .. } => around(CLIFFS.arc_beyond_m),
            WallFollowPhase::Along if !self.line.is_seen_within(CONTROL.ended_m) => {
                let gap_m = self.line.gap_m.clamp(CONTROL.gap_m, 2.0 * CONTROL.gap_m);
                self.line.lose();
                context.decide(DecisionKind::Arc, Reason::WallEnded, gap_m);
                around(gap_m)
            }
            WallFollowPhase::Along => WallFollowPhase::Along,
            WallFollowPhase::Around { turned_rad, .. } if turned_rad > CONTROL.arc_max_rad => {
                WallFollowPhase::default()
            }
            WallFollowPhase::Around { turned_rad, beyond_m } => WallFollowPhase::Around {
                turned_rad: turned_rad + (-advance.turn_rad).max(0.0),
                beyond_m,
            },
        };
        self.phase = next;
    }

    fn motion(&self, situation: &Situation<'_>, ranges: &WallRanges) -> Motion {
        let speeds = situation.config.speeds;
        let curvature = match self.phase {
            WallFollowPhase::Turn { .. } => {
                return Motion::Drive {
                    speed_m_per_s: 0.0,
                    turn_rad_per_s: CONTROL.turn_share * speeds.turn_max_rad_per_s,
                };
            }
            WallFollowPhase::Seek { .. } | WallFollowPhase::Pass { .. } => 0.0,
            WallFollowPhase::Along => self.along(),
            WallFollowPhase::Around { beyond_m, .. } => {
                self.arc(beyond_m, situation.config.body.radius_m, ranges)
            }
        };
        let turn_max = CONTROL.turn_share * speeds.turn_max_rad_per_s;
        let speed_m_per_s = speeds
            .cruise_m_per_s
            .min(turn_max / curvature.abs().max(1e-6))
            .min(self.braked(ranges, speeds.cruise_m_per_s))
            .max(CHASSIS.speed_min_m_per_s);
        Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: speed_m_per_s * curvature,
        }
    }

    /// Curvature that keeps the gap.
    fn along(&self) -> f64 {
        let gap_m = CONTROL.gap_m + self.dark_m;
        let error_m = (gap_m - self.line.gap_m).clamp(-CONTROL.gap_error_max_m, CONTROL.gap_error_max_m);
        (CONTROL.gap_gain_per_m2 * error_m - CONTROL.slope_gain_per_m * self.line.slope_rad)
            .clamp(-CONTROL.curvature_max_per_m, CONTROL.curvature_max_per_m)
    }

    /// Curvature of the arc round an end; straight where an obstacle is too near.
    fn arc(&self, beyond_m: f64, radius_m: f64, ranges: &WallRanges) -> f64 {
        let is_near = ranges
            .diagonal_m
            .is_some_and(|gap_m| gap_m < CONTROL.gap_m + self.dark_m);
        if is_near {
            0.0
        } else {
            -1.0 / (radius_m + beyond_m)
        }
    }

    /// The speed from which it can stop before the obstacle ahead.
    fn braked(&self, ranges: &WallRanges, cruise_m_per_s: f64) -> f64 {
        let Some(ahead_m) = ranges.ahead_m else {
            return f64::INFINITY;
        };
        let left_m = ahead_m - CONTROL.stop_m - self.dark_m - CONTROL.lag_s * cruise_m_per_s;
        libm::sqrt(2.0 * CONTROL.brake_m_per_s2 * left_m.max(0.0))
    }
}

fn around(beyond_m: f64) -> WallFollowPhase {
    WallFollowPhase::Around {
        turned_rad: 0.0,
        beyond_m,
    }
}
