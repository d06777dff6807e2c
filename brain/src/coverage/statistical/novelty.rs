//! The share of new floor on the robot's drive.

use super::law::NoveltyCount;
use super::parameters::{LAW, NOVELTY};
use crate::coverage::parameters::RECENT;
use crate::coverage::recent_coverage::is_new;
use crate::model::geometry::Point2;
use crate::navigation::Situation;

/// A running average, and the count of the whole job.
#[derive(Clone, Debug)]
pub(super) struct Novelty {
    share: f64,
    since_m: f64,
    count: Option<NoveltyCount>,
}

impl Default for Novelty {
    fn default() -> Self {
        Self {
            share: 1.0,
            since_m: 0.0,
            count: None,
        }
    }
}

impl Novelty {
    /// Share of the last metres that was not swept recently, 0..=1; 1 at the start in a new place.
    pub(super) fn share(&self) -> f64 {
        self.share
    }

    /// The counts of this job.
    pub(super) fn count(&self) -> NoveltyCount {
        self.count.unwrap_or_default()
    }

    /// The robot has come to another place.
    pub(super) fn restart(&mut self) {
        self.share = 1.0;
    }

    pub(super) fn follow(&mut self, situation: &Situation<'_>) {
        let count = self.count.get_or_insert_with(|| NoveltyCount {
            before_m: situation.map.path_length_m(),
            ..NoveltyCount::default()
        });
        count.time_s += situation.advance.time_s;
        self.since_m += situation.advance.distance_m.max(0.0);
        if self.since_m < NOVELTY.step_m {
            return;
        }
        let new = |within_s| {
            NOVELTY
                .across
                .iter()
                .filter(|across| is_new_at(**across, within_s, situation))
                .count()
        };
        let weight = (self.since_m / NOVELTY.window_m).min(1.0);
        self.share += weight * (new(RECENT.memory_s) as f64 / NOVELTY.across.len() as f64 - self.share);
        count.driven_m += core::mem::take(&mut self.since_m);
        count.seen += NOVELTY.across.len() as u32;
        count.new += new(LAW.memory_s) as u32;
    }
}

/// Whether the floor ahead of a point across the swath is new.
fn is_new_at(across: f64, within_s: u32, situation: &Situation<'_>) -> bool {
    let at = situation.pose.transform(Point2 {
        x_m: NOVELTY.ahead_m,
        y_m: across * situation.config.body.swath_m,
    });
    is_new(situation.map, at, within_s)
}
