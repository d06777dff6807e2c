//! Follows the wall on the right: walls, corners, furniture, cliffs.
//!
//! Terms. *Gap*: distance between the rim and the wall on the right. *Inner corner*: an obstacle ahead; the robot turns
//! left on the spot. *Outer corner*: the wall ends beside the robot, which drives round its end in an arc to the right. A
//! robot without side sensors does the same by touch: after each contact a little to the left, then the arc.
//!
//! Everything is bounded: turns and arcs by their angle, the search by its distance, contacts by their number within a
//! short distance.

mod wall_line;
mod wall_ranges;

use super::{Evasion, EvasionStep};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::{Situation, TaskContext};
use wall_line::WallLine;
use wall_ranges::WallRanges;

/// Gap to keep, metres. A dark wall is really nearer, a bright one farther away: half a centimetre more or less.
const GAP_M: f64 = 0.035;
/// Added to the gap after a contact with a wall that appeared farther away: it is very dark.
const DARK_M: f64 = 0.01;
/// Upper limit of that.
const DARK_MAX_M: f64 = 0.04;
/// Distance after which a step of `DARK_M` is forgotten.
const DARK_FORGET_M: f64 = 3.0;
/// Curvature per metre of excess gap, 1/m2. With `SLOPE_GAIN` an error is corrected within some 0.35 m.
const GAP_GAIN: f64 = 16.0;
/// Curvature for each radian of slope, 1/m.
const SLOPE_GAIN: f64 = 8.0;
/// Sharpest curve towards or away from a wall, 1/m.
const CURVATURE_MAX: f64 = 4.0;
/// Share of the maximum turn rate that curves use.
const TURN_SHARE: f64 = 0.85;
/// Deceleration before an obstacle ahead, m/s2.
const BRAKE_M_PER_S2: f64 = 0.3;
/// Delay from command to wheels, seconds.
const LAG_S: f64 = 0.15;
/// Slowest speed that overcomes the dead band of the motors, m/s.
const CREEP_M_PER_S: f64 = 0.05;
/// Nearer than this to an obstacle ahead the robot turns, metres.
const STOP_M: f64 = 0.03;
/// This much clearance ahead ends a turn at an inner corner, metres.
const CLEAR_M: f64 = 0.16;
/// A wall that is not seen for this distance has ended, metres.
const ENDED_M: f64 = 0.02;
/// Radius of the arc by touch beyond that of the body, metres.
const TOUCH_ARC_M: f64 = 0.1;
/// Radius of the arc back to a cliff beyond that of the body, metres, so that cliffs are met rarely (S8).
const EDGE_ARC_M: f64 = 0.35;
/// Straight drive after a cliff, for the same reason.
const EDGE_PASS_M: f64 = 0.3;
/// After this turn an arc leads round nothing, radians.
const ARC_MAX_RAD: f64 = 7.0;
/// After this angle a turn on the spot finds no way out, radians.
const TURN_MAX_RAD: f64 = 7.0;
/// No home has a longer straight search, metres.
const SEEK_MAX_M: f64 = 14.0;
/// Distance to back off after a contact and at a cliff, metres.
const CONTACT_BACK_M: f64 = 0.02;
const EDGE_BACK_M: f64 = 0.08;
/// Turn away from a cliff, radians.
const EDGE_TURN_RAD: f64 = 0.9;
/// Added for each recent cliff: where cliffs meet, three of them in 5 s would latch the firmware (S8).
const EDGES_TURN_RAD: f64 = 0.7;
const EDGES_MAX: u32 = 2;
/// Distance within which a cliff is recent, metres.
const EDGES_M: f64 = 0.7;
/// Each contact within `CROWDED_M` adds this much to the turn, radians.
const CROWDED_RAD: f64 = 0.35;
/// Distance within which contacts count as crowded, metres.
const CROWDED_M: f64 = 0.25;
/// After this many crowded contacts the robot is boxed in.
const CROWDED_MAX: u32 = 10;

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
        self.phase == WallFollowPhase::Along && self.evasion.is_none() && self.line.is_seen_within(ENDED_M)
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
            WallFollowPhase::Seek { driven_m } if driven_m > SEEK_MAX_M => self.trouble(Reason::LongRun),
            WallFollowPhase::Turn { turned_rad } if turned_rad > TURN_MAX_RAD => {
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
        if self.since_contact_m > CROWDED_M {
            self.contacts = 0;
        }
        self.since_edge_m += driven_m;
        if self.since_edge_m > EDGES_M {
            self.edges = 0;
        }
        self.dark_m = (self.dark_m - DARK_M * driven_m / DARK_FORGET_M).max(0.0);
    }

    fn evade(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> WallStep {
        let observation = situation.observation;
        if situation.at_cliff {
            let reason = Reason::of_cliffs(observation.cliffs).unwrap_or(Reason::CliffFront);
            context.decide(DecisionKind::BackOff, reason, 0.0);
            let turn_rad = EDGE_TURN_RAD + EDGES_TURN_RAD * f64::from(self.edges);
            self.edges = (self.edges + 1).min(EDGES_MAX);
            self.since_edge_m = 0.0;
            self.evasion = Some(Evasion::from_cliff(EDGE_BACK_M, turn_rad));
            self.line.lose();
            self.phase = WallFollowPhase::Pass { left_m: EDGE_PASS_M };
            return WallStep::Going(Motion::Halt);
        }
        let reason = Reason::of_contacts(observation.contacts).unwrap_or(Reason::BumpFront);
        self.contacts += 1;
        if self.contacts > CROWDED_MAX {
            self.contacts = 0;
            return self.trouble(Reason::BoxedIn);
        }
        if reason == Reason::BumpRight && self.line.is_seen_within(CROWDED_M) {
            self.dark_m = (self.dark_m + DARK_M).min(DARK_MAX_M);
        }
        let turn_rad = self.turn_after(reason);
        context.decide(DecisionKind::BackOff, reason, turn_rad);
        self.evasion = Some(Evasion::from_contact(CONTACT_BACK_M, turn_rad));
        self.since_contact_m = 0.0;
        self.phase = if self.line.is_seen_within(ENDED_M) {
            WallFollowPhase::Along
        } else {
            WallFollowPhase::Around {
                turned_rad: 0.0,
                beyond_m: TOUCH_ARC_M,
            }
        };
        WallStep::Going(Motion::Halt)
    }

    /// Turn after a contact, radians. After a first contact on the left the robot tries to pass on the right; after a
    /// second one the passage is too narrow.
    fn turn_after(&self, reason: Reason) -> f64 {
        let crowded_rad = CROWDED_RAD * f64::from(self.contacts.saturating_sub(1)).min(4.0);
        match reason {
            Reason::BumpRight => 0.3 + crowded_rad,
            Reason::BumpLeft if self.contacts <= 1 => -0.2,
            Reason::BumpLeft => 1.4 + crowded_rad,
            _ => 0.8 + crowded_rad,
        }
    }

    fn change_phase(&mut self, situation: &Situation<'_>, ranges: &WallRanges, context: &mut TaskContext) {
        let advance = situation.advance;
        let driven_m = advance.distance_m.max(0.0);
        let stop_m = STOP_M + self.dark_m;
        let is_blocked = ranges.ahead_m.is_some_and(|ahead_m| ahead_m < stop_m);
        let next = match self.phase {
            WallFollowPhase::Turn { turned_rad } => {
                if ranges.ahead_m.is_none_or(|ahead_m| ahead_m > CLEAR_M) {
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
            WallFollowPhase::Pass { .. } => around(EDGE_ARC_M),
            WallFollowPhase::Along if !self.line.is_seen_within(ENDED_M) => {
                let gap_m = self.line.gap_m.clamp(GAP_M, 2.0 * GAP_M);
                self.line.lose();
                context.decide(DecisionKind::Arc, Reason::WallEnded, gap_m);
                around(gap_m)
            }
            WallFollowPhase::Along => WallFollowPhase::Along,
            WallFollowPhase::Around { turned_rad, .. } if turned_rad > ARC_MAX_RAD => {
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
                    turn_rad_per_s: TURN_SHARE * speeds.turn_max_rad_per_s,
                };
            }
            WallFollowPhase::Seek { .. } | WallFollowPhase::Pass { .. } => 0.0,
            WallFollowPhase::Along => self.along(),
            WallFollowPhase::Around { beyond_m, .. } => {
                self.arc(beyond_m, situation.config.body.radius_m, ranges)
            }
        };
        let turn_max = TURN_SHARE * speeds.turn_max_rad_per_s;
        let speed_m_per_s = speeds
            .cruise_m_per_s
            .min(turn_max / curvature.abs().max(1e-6))
            .min(self.braked(ranges, speeds.cruise_m_per_s))
            .max(CREEP_M_PER_S);
        Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: speed_m_per_s * curvature,
        }
    }

    /// Curvature that keeps the gap.
    fn along(&self) -> f64 {
        let gap_m = GAP_M + self.dark_m;
        let error_m = (gap_m - self.line.gap_m).clamp(-0.1, 0.1);
        (GAP_GAIN * error_m - SLOPE_GAIN * self.line.slope_rad).clamp(-CURVATURE_MAX, CURVATURE_MAX)
    }

    /// Curvature of the arc round an end; straight where an obstacle is too near.
    fn arc(&self, beyond_m: f64, radius_m: f64, ranges: &WallRanges) -> f64 {
        let is_near = ranges.diagonal_m.is_some_and(|gap_m| gap_m < GAP_M + self.dark_m);
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
        let left_m = ahead_m - STOP_M - self.dark_m - LAG_S * cruise_m_per_s;
        libm::sqrt(2.0 * BRAKE_M_PER_S2 * left_m.max(0.0))
    }
}

fn around(beyond_m: f64) -> WallFollowPhase {
    WallFollowPhase::Around {
        turned_rad: 0.0,
        beyond_m,
    }
}
