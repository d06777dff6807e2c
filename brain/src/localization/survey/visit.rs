//! Short ways along walls, told apart from the ways between them.

use super::stroke::{Glimpse, Stroke, strokes};
use crate::config::ProximityLayout;
use crate::geometry::{Pose2, normalize_rad};
use crate::localization::Advance;
use crate::observation::Observation;

/// A visit is over when nothing was seen for this way, metres.
const UNSEEN_M: f64 = 0.12;
/// And at the latest after this way, metres.
const WAY_MAX_M: f64 = 0.7;
/// Glimpses are this far apart, metres and radians.
const STEP_M: f64 = 0.01;
const STEP_RAD: f64 = 0.045;
/// Most glimpses of a visit.
const GLIMPSES_MAX: usize = 500;
/// Levels below this are noise.
const LEVEL_MIN: f64 = 0.06;

/// A visit that is over.
#[derive(Clone, Debug)]
pub(super) struct Visit {
    /// When it ended.
    pub(super) time_us: u64,
    /// Where it ended, by odometry.
    pub(super) odom: Pose2,
    /// What it showed, in the frame of the robot at its end.
    pub(super) strokes: Vec<Stroke>,
}

/// The visit that is going on.
#[derive(Clone, Debug, Default)]
pub(super) struct VisitLog {
    glimpses: Vec<Glimpse>,
    way_m: f64,
    unseen_m: f64,
    step_m: f64,
    step_rad: f64,
}

impl VisitLog {
    /// Takes in where the robot is by odometry and what it sees there. Gives the visit that ends here.
    pub(super) fn follow(
        &mut self,
        (odom, advance): (Pose2, Advance),
        observation: &Observation,
        layout: &ProximityLayout,
    ) -> Option<Visit> {
        let way_m = advance.distance_m.abs();
        self.step_m += way_m;
        self.step_rad += advance.turn_rad.abs();
        if !self.glimpses.is_empty() {
            self.way_m += way_m;
            self.unseen_m += way_m;
        }
        if self.step_m >= STEP_M || self.step_rad >= STEP_RAD {
            (self.step_m, self.step_rad) = (0.0, 0.0);
            self.look(odom, observation, layout);
        }
        let over =
            self.unseen_m >= UNSEEN_M || self.way_m >= WAY_MAX_M || self.glimpses.len() >= GLIMPSES_MAX;
        if !over {
            return None;
        }
        let log = core::mem::take(self);
        let base_from_odom = odom.inverse();
        let strokes = strokes(&log.glimpses, &layout.response)
            .into_iter()
            .map(|stroke| Stroke {
                middle: base_from_odom.transform(stroke.middle),
                normal_rad: normalize_rad(stroke.normal_rad - odom.heading_rad),
                ..stroke
            })
            .collect();
        Some(Visit {
            time_us: observation.time_us,
            odom,
            strokes,
        })
    }

    fn look(&mut self, odom: Pose2, observation: &Observation, layout: &ProximityLayout) {
        for (sensor, level) in layout.sensors().iter().zip(&observation.proximity) {
            let level = f64::from(*level);
            let seen = layout.response.distance_m(level).filter(|_| level >= LEVEL_MIN);
            if let Some(seen_m) = seen {
                self.unseen_m = 0.0;
                self.glimpses.push(Glimpse {
                    beam: odom * *sensor,
                    seen_m,
                });
            }
        }
    }
}
