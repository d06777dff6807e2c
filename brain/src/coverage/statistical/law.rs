//! How much floor there is, and how much of it is swept, by statistics.
//!
//! A robot that crosses floor at random meets recently swept floor the more often the less floor there is: of a floor `A` a
//! share `exp(-d w / A)` is still new after a distance `d` with a swath `w`, if points are independent of each other.
//! Conversely, the share that was new gives `A`, over distances so short that wheel odometry is still accurate. The swept
//! share after a long distance comes from simulated homes.

use core::ops::Range;

use super::parameters::LAW;
use crate::model::swept_share::SweptShare;

/// What was counted on the drive.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NoveltyCount {
    /// Distance swept before the count began, metres.
    pub(super) before_m: f64,
    /// Distance since then, metres.
    pub(super) driven_m: f64,
    /// Time of that distance, seconds.
    pub(super) time_s: f64,
    /// Points that were sampled, and those of them that were new.
    pub(super) seen: u32,
    pub(super) new: u32,
}

impl NoveltyCount {
    /// Floor area, square metres; `None` before it can be estimated.
    fn floor_m2(&self, swath_m: f64) -> Option<f64> {
        if self.seen == 0 {
            return None;
        }
        let known_m = (f64::from(LAW.memory_s) * self.driven_m / self.time_s.max(1.0)).min(self.driven_m);
        let share = f64::from(self.new) / f64::from(self.seen);
        let Range {
            start: mut low_m2,
            end: mut high_m2,
        } = LAW.floor_m2;
        for _ in 0..LAW.bisections {
            let middle_m2 = 0.5 * (low_m2 + high_m2);
            // More floor means a larger new share.
            if new_share(swath_m / middle_m2, known_m, self.driven_m) < share {
                low_m2 = middle_m2;
            } else {
                high_m2 = middle_m2;
            }
        }
        Some(0.5 * (low_m2 + high_m2))
    }

    /// Share that is swept; `None` before it can be estimated.
    pub(super) fn share(&self, swath_m: f64) -> Option<SweptShare> {
        if self.time_s < LAW.estimate_after_s {
            return None;
        }
        let floor_m2 = self.floor_m2(swath_m)?;
        let times = (self.before_m + self.driven_m) * swath_m / floor_m2;
        let larger = LAW.larger * (1.0 + LAW.larger_early * LAW.estimate_after_s / self.time_s);
        Some(SweptShare {
            share: swept(times),
            share_low: swept(times / larger),
            left_m2: (1.0 - swept(times)) * floor_m2,
        })
    }
}

/// Expected share of new points on a drive whose last `known_m` are remembered at any time, where each metre sweeps
/// `part_per_m` of the floor.
fn new_share(part_per_m: f64, known_m: f64, driven_m: f64) -> f64 {
    let in_the_end = libm::exp(-part_per_m * known_m);
    ((1.0 - in_the_end) / part_per_m + (driven_m - known_m) * in_the_end) / driven_m
}

/// Share of a floor that is swept after this many times its area was.
fn swept(times: f64) -> f64 {
    1.0 - libm::exp(-LAW.pace * libm::pow(times, LAW.slowing))
}

#[cfg(test)]
mod tests {
    use super::{LAW, NoveltyCount, swept};
    use crate::model::random::Random;

    const SWATH_M: f64 = 0.25;
    const SPEED_M_PER_S: f64 = 0.2;
    /// A point is as large as what a robot sweeps in 5 cm.
    const STEP_M: f64 = 0.05;

    /// A robot that reaches random points of a floor, for this distance.
    fn by_chance(floor_m2: f64, driven_m: f64, seed: u64) -> NoveltyCount {
        let mut random = Random::new(seed);
        let places = (floor_m2 / (SWATH_M * STEP_M)) as usize;
        let mut swept_s: Vec<Option<f64>> = vec![None; places];
        let mut count = NoveltyCount::default();
        while count.driven_m < driven_m {
            count.driven_m += STEP_M;
            count.time_s += STEP_M / SPEED_M_PER_S;
            let place = (random.between(0.0, places as f64) as usize).min(places - 1);
            let is_known = swept_s[place].is_some_and(|at_s| count.time_s - at_s <= f64::from(LAW.memory_s));
            count.seen += 1;
            count.new += u32::from(!is_known);
            swept_s[place] = Some(count.time_s);
        }
        count
    }

    #[test]
    fn the_floor_area_follows_from_the_share_of_new_floor() {
        for (floor_m2, driven_m) in [(8.0, 60.0), (20.0, 100.0), (60.0, 300.0), (150.0, 1_200.0)] {
            for seed in 1..=3 {
                let estimated_m2 = by_chance(floor_m2, driven_m, seed).floor_m2(SWATH_M).unwrap();
                assert!(
                    (estimated_m2 / floor_m2 - 1.0).abs() < 0.12,
                    "{estimated_m2} m2 instead of {floor_m2} m2"
                );
            }
        }
    }

    #[test]
    fn there_is_no_early_estimate_and_the_share_never_reaches_one() {
        assert_eq!(by_chance(50.0, 230.0, 1).share(SWATH_M), None);
        let shares: Vec<f64> = [250.0, 400.0, 800.0, 1_600.0]
            .map(|driven_m| by_chance(50.0, driven_m, 1).share(SWATH_M).unwrap())
            .map(|estimate| {
                assert!(
                    estimate.share_low < estimate.share && estimate.share < 1.0,
                    "{estimate:?}"
                );
                estimate.share
            })
            .to_vec();
        assert!(shares.is_sorted(), "{shares:?}");
        assert!(swept(0.0) == 0.0 && swept(1.0) < 0.55, "half after once its area");
    }

    #[test]
    fn floor_swept_before_a_restart_counts() {
        let count = by_chance(100.0, 300.0, 1);
        let with_before = NoveltyCount {
            before_m: 200.0,
            ..count
        };
        assert!(with_before.share(SWATH_M).unwrap().share > count.share(SWATH_M).unwrap().share + 0.1);
    }
}
