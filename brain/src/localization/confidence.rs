//! How far the map explains the sensors, and so whether the pose can be right.

use super::particles::BeamScore;

/// When the map explains enough. A share is that of the consistent ones among the informative beams. A home whose doors and
/// chairs moved explains 80 to 90 % of the beams, a wrong pose 10 to 40 %.
struct ConfidenceParameters {
    /// Share before anything was compared.
    start_share: f64,
    /// Beams over which the long average is taken. It shows whether the robot is lost, and ignores a door that was opened.
    long_beams: f64,
    /// Beams over which the short average is taken. It shows whether something is wrong here.
    short_beams: f64,
    /// Below this share the robot is lost.
    lost_below: f64,
    /// Below this share the particles are spread a little.
    doubt_below: f64,
    /// From this share on particles keep what they have learned.
    hold_from: f64,
    /// From this share on the pose is confirmed: more than in a home whose doors and chairs moved.
    confirm_from: f64,
    /// Beams since the robot was placed that a confirmation needs: the robot must have driven.
    confirm_beams_min: u32,
    /// From this share on a lost robot is found.
    found_from: f64,
    /// Beams since the robot was lost that this needs.
    found_beams_min: u32,
}

const PARAMETERS: ConfidenceParameters = ConfidenceParameters {
    start_share: 0.9,
    long_beams: 220.0,
    short_beams: 50.0,
    lost_below: 0.5,
    doubt_below: 0.6,
    hold_from: 0.75,
    confirm_from: 0.88,
    confirm_beams_min: 20,
    found_from: 0.8,
    found_beams_min: 60,
};

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
            explained: PARAMETERS.start_share,
            recently: PARAMETERS.start_share,
            beams: 0,
        }
    }
}

impl Confidence {
    /// Of a lost robot.
    pub(super) fn none() -> Self {
        Self {
            explained: PARAMETERS.lost_below,
            recently: PARAMETERS.lost_below,
            beams: 0,
        }
    }

    pub(super) fn take(&mut self, score: BeamScore) {
        let (informative, consistent) = (f64::from(score.informative), f64::from(score.consistent));
        self.explained += (consistent - informative * self.explained) / PARAMETERS.long_beams;
        self.recently += (consistent - informative * self.recently) / PARAMETERS.short_beams;
        self.beams = self.beams.saturating_add(score.informative);
    }

    /// Whether nothing contradicts what was learned lately.
    pub(super) fn holds(self) -> bool {
        self.explained >= PARAMETERS.hold_from && self.recently >= PARAMETERS.hold_from
    }

    /// Whether enough beams since the start clearly confirm the pose.
    pub(super) fn confirms(self) -> bool {
        self.explained >= PARAMETERS.confirm_from && self.beams >= PARAMETERS.confirm_beams_min
    }

    pub(super) fn verdict(self) -> Verdict {
        if self.explained < PARAMETERS.lost_below {
            Verdict::Wrong
        } else if self.recently < PARAMETERS.doubt_below {
            Verdict::Doubtful
        } else {
            Verdict::Sure
        }
    }

    /// Whether a lost robot is found.
    pub(super) fn is_found(self) -> bool {
        self.recently >= PARAMETERS.found_from && self.beams >= PARAMETERS.found_beams_min
    }

    /// Share of the beams that the map explains, 0..1.
    pub(super) fn explained(self) -> f64 {
        self.explained
    }
}
