//! How far the map explains the sensors, and so whether the pose can be right.

use super::particles::BeamScore;

/// Informative beams over which the share of consistent ones is averaged. A long average shows whether the robot is lost, and
/// ignores a door that was opened. A short one shows whether something is wrong here.
const LONG_BEAMS: f64 = 220.0;
const SHORT_BEAMS: f64 = 50.0;
/// Below this share the robot is lost. A home whose doors and chairs moved explains 80 to 90 % of the beams, a wrong pose 10 to 40
/// %.
const LOST_BELOW: f64 = 0.5;
/// Below this share the particles are spread a little.
const DOUBT_BELOW: f64 = 0.6;
/// Above this share particles keep what they have learned.
const HOLD_FROM: f64 = 0.75;
/// From this share on the pose is confirmed: more than in a home whose doors and chairs moved.
const CONFIRM_FROM: f64 = 0.88;
/// Informative beams since the robot was placed that a confirmation needs: the robot must have driven.
const CONFIRM_BEAMS: u32 = 20;
/// From this share on a lost robot is found.
const FOUND_FROM: f64 = 0.8;
/// Informative beams since the robot was lost that this needs.
const FOUND_BEAMS: u32 = 60;
/// Share before anything was compared.
const START: f64 = 0.9;

/// Share of the beams that the map explains.
#[derive(Clone, Copy, Debug)]
pub(super) struct Confidence {
    explained: f64,
    recently: f64,
    /// Informative beams since the last reset.
    beams: u32,
}

/// The conclusion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The map explains what the sensors show.
    Sure,
    /// It does not explain all of it.
    Doubtful,
    /// It does not explain it.
    Wrong,
}

impl Default for Confidence {
    fn default() -> Self {
        Self {
            explained: START,
            recently: START,
            beams: 0,
        }
    }
}

impl Confidence {
    /// Of a lost robot.
    pub(super) fn none() -> Self {
        Self {
            explained: LOST_BELOW,
            recently: LOST_BELOW,
            beams: 0,
        }
    }

    pub(super) fn take(&mut self, score: BeamScore) {
        let (informative, consistent) = (f64::from(score.informative), f64::from(score.consistent));
        self.explained += (consistent - informative * self.explained) / LONG_BEAMS;
        self.recently += (consistent - informative * self.recently) / SHORT_BEAMS;
        self.beams = self.beams.saturating_add(score.informative);
    }

    /// Whether nothing contradicts what was learned lately.
    pub(super) fn holds(self) -> bool {
        self.explained >= HOLD_FROM && self.recently >= HOLD_FROM
    }

    /// Whether enough beams since the start clearly confirm the pose.
    pub(super) fn confirms(self) -> bool {
        self.explained >= CONFIRM_FROM && self.beams >= CONFIRM_BEAMS
    }

    pub(super) fn verdict(self) -> Verdict {
        if self.explained < LOST_BELOW {
            Verdict::Wrong
        } else if self.recently < DOUBT_BELOW {
            Verdict::Doubtful
        } else {
            Verdict::Sure
        }
    }

    /// Whether a lost robot is found.
    pub(super) fn is_found(self) -> bool {
        self.recently >= FOUND_FROM && self.beams >= FOUND_BEAMS
    }

    /// Share of the beams that the map explains, 0..1.
    pub(super) fn explained(self) -> f64 {
        self.explained
    }
}
