//! Zero-velocity updates: measures the gyro's bias while the wheels are at rest.

use super::totals::Totals;

/// When a robot counts as resting.
struct RestParameters {
    /// The robot still swings for so long after the last encoder count, seconds.
    settle_s: f64,
    /// Shortest interval that is used, without the swinging, seconds.
    interval_min_s: f64,
    /// Longest interval of one measurement, seconds.
    interval_max_s: f64,
    /// A faster turn with resting wheels is a person who turns the robot, or a bump, radians per second.
    carried_rad_per_s: f64,
    /// Resolution of the reported heading, a hundredth of a degree, in radians. Two reports in quick succession may differ by one
    /// step. Counted as a turn, that would be degrees an hour on the dock.
    resolution_rad: f64,
}

const PARAMETERS: RestParameters = RestParameters {
    settle_s: 0.3,
    interval_min_s: 0.3,
    interval_max_s: 2.0,
    carried_rad_per_s: 0.03,
    resolution_rad: 1.8e-4,
};

/// Detects intervals at rest.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StationaryDetector {
    rest: Option<Rest>,
}

/// Wheels at rest.
#[derive(Clone, Copy, Debug)]
struct Rest {
    began_us: u64,
    /// Totals at the start of the present interval.
    since: Totals,
}

/// Turn rate that the gyro measured at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StationaryInterval {
    pub(super) rad_per_s: f64,
    pub(super) time_s: f64,
}

fn seconds(from_us: u64, to: Totals) -> f64 {
    to.time_us.saturating_sub(from_us) as f64 * 1e-6
}

impl StationaryDetector {
    /// Whether the wheels have been at rest for longer than the swinging, and nobody turns the robot.
    pub(super) fn is_stationary(&self, now: Totals, seen_rad: f64, time_s: f64) -> bool {
        let rests = self.rest.is_some_and(|rest| {
            rest.since.wheels_agree_with(now) && seconds(rest.began_us, now) > PARAMETERS.settle_s
        });
        rests && seen_rad.abs() <= PARAMETERS.carried_rad_per_s * time_s + PARAMETERS.resolution_rad
    }

    /// Takes the totals of an observation. Returns the interval that ends here.
    pub(super) fn observe(&mut self, now: Totals) -> Option<StationaryInterval> {
        let Some(rest) = self.rest.filter(|rest| rest.since.wheels_agree_with(now)) else {
            self.rest = Some(Rest {
                began_us: now.time_us,
                since: now,
            });
            return None;
        };
        let settled = seconds(rest.began_us, now) > PARAMETERS.settle_s;
        let is_long = seconds(rest.since.time_us, now) >= PARAMETERS.interval_max_s;
        if !settled || is_long {
            self.rest = Some(Rest { since: now, ..rest });
        }
        if settled && is_long {
            rested(rest.since, now)
        } else {
            None
        }
    }

    /// The wheels begin to turn, which ends the interval.
    pub(super) fn end(&mut self, last: Totals) -> Option<StationaryInterval> {
        let rest = self.rest.take()?;
        rested(rest.since, last)
    }
}

fn rested(since: Totals, now: Totals) -> Option<StationaryInterval> {
    let time_s = seconds(since.time_us, now);
    let rad_per_s = (now.gyro_rad? - since.gyro_rad?) / time_s;
    // Written so that NaN is not used.
    let is_usable = time_s >= PARAMETERS.interval_min_s && rad_per_s.abs() <= PARAMETERS.carried_rad_per_s;
    is_usable.then_some(StationaryInterval { rad_per_s, time_s })
}

#[cfg(test)]
mod tests {
    use super::{StationaryDetector, StationaryInterval, Totals};

    fn at(time_s: f64, left_m: f64, gyro_rad: f64) -> Totals {
        Totals {
            time_us: (time_s * 1e6) as u64,
            left_m,
            right_m: left_m,
            gyro_rad: Some(gyro_rad),
        }
    }

    fn intervals(
        watch: &mut StationaryDetector,
        from_s: f64,
        steps: u32,
        rad_per_s: f64,
    ) -> Vec<StationaryInterval> {
        (0..steps)
            .filter_map(|step| {
                let time_s = from_s + f64::from(step) * 0.02;
                watch.observe(at(time_s, 1.0, rad_per_s * time_s))
            })
            .collect()
    }

    #[test]
    fn a_long_rest_gives_several_intervals_and_a_turn_by_hand_gives_none() {
        let mut watch = StationaryDetector::default();
        let pieces = intervals(&mut watch, 0.0, 500, 0.001);
        assert_eq!(pieces.len(), 4, "{pieces:?}");
        assert!(
            pieces
                .iter()
                .all(|piece| (piece.rad_per_s - 0.001).abs() < 1e-6 && piece.time_s >= 2.0),
            "{pieces:?}"
        );
        assert_eq!(intervals(&mut watch, 10.0, 500, 0.5), []);
    }

    #[test]
    fn a_short_rest_gives_an_interval_when_it_ends() {
        let mut watch = StationaryDetector::default();
        assert_eq!(intervals(&mut watch, 0.0, 51, 0.002), []);
        let rested = watch.end(at(1.0, 1.0, 0.002)).unwrap();
        assert!((rested.rad_per_s - 0.002).abs() < 1e-6, "{rested:?}");
        assert!((0.6..0.8).contains(&rested.time_s), "{rested:?}");
        assert_eq!(watch.end(at(1.1, 1.0, 0.002)), None);
    }
}
