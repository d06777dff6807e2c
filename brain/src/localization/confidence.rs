//! Whether the robot is where it believes to be: does the map explain what the sensors show?

use super::particles::BeamScore;

/// BeamModel over which the share of explained ones is averaged: a long memory tells whether the robot is lost, so that one
/// door that opened does not, a short one whether something is wrong here.
const LONG_BEAMS: f64 = 220.0;
const SHORT_BEAMS: f64 = 50.0;
/// Below this share the robot is lost. A home whose doors and chairs moved explains 80 to 90 % of the beams, a wrong place
/// 10 to 40 %.
const LOST_BELOW: f64 = 0.5;
/// Below this share the guesses are spread a little.
const DOUBT_BELOW: f64 = 0.6;
/// Above this share guesses hold on to what they have learnt.
const HOLD_FROM: f64 = 0.75;
/// From this share on there is no doubt: more than in a home whose doors and chairs moved.
const CONFIRM_FROM: f64 = 0.88;
/// BeamModel that must have been told for that since the robot was placed: it has driven since.
const CONFIRM_BEAMS: u32 = 20;
/// From this share on a lost robot has found itself.
const FOUND_FROM: f64 = 0.8;
/// BeamModel that must have been told since the robot was lost.
const FOUND_BEAMS: u32 = 60;
/// What is believed of a place that nothing was compared with yet.
const START: f64 = 0.9;

/// Share of the beams that the map explains.
#[derive(Clone, Copy, Debug)]
pub(super) struct Confidence {
    explained: f64,
    recently: f64,
    /// BeamModel since the last reset.
    beams: u32,
}

/// What to make of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The map explains what is seen.
    Sure,
    /// Not all of it.
    Doubtful,
    /// It does not.
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
    /// Of a robot that does not know where it is.
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

    /// Whether nothing speaks against what has been learnt lately.
    pub(super) fn holds(self) -> bool {
        self.explained >= HOLD_FROM && self.recently >= HOLD_FROM
    }

    /// Whether enough was told since the robot was put there, and speaks clearly for it.
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

    /// Whether a lost robot may believe its best guess.
    pub(super) fn is_found(self) -> bool {
        self.recently >= FOUND_FROM && self.beams >= FOUND_BEAMS
    }

    /// Share of the beams that the map explains, 0..1.
    pub(super) fn explained(self) -> f64 {
        self.explained
    }
}
