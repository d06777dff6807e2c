//! Whether the robot is lost: its pose error is too large to work with, for longer than a moment.

use serde::Serialize;

/// Wrong by more than this, metres.
const LOST_M: f64 = 0.5;
/// For longer than this, milliseconds.
const LOST_MS: u64 = 60_000;

/// A period of being lost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LostStretch {
    /// Simulated second at which it began, without those on the charger in the middle of the job.
    pub begun_s: f64,
    /// How long it lasted.
    pub length_s: f64,
    /// Whether the robot knew its place again before the run was over.
    pub found_again: bool,
}

/// Measures periods of being lost.
#[derive(Clone, Debug, Default)]
pub(super) struct LostWatch {
    since_ms: Option<u64>,
    now_ms: u64,
    finished: Vec<LostStretch>,
}

impl LostWatch {
    pub(super) fn sample(&mut self, now_ms: u64, error_m: f64) {
        self.now_ms = now_ms;
        if error_m > LOST_M {
            self.since_ms.get_or_insert(now_ms);
        } else {
            let finished = self.present().map(|stretch| LostStretch {
                found_again: true,
                ..stretch
            });
            self.finished.extend(finished);
            self.since_ms = None;
        }
    }

    /// The period that still lasts, if it is long enough.
    fn present(&self) -> Option<LostStretch> {
        let since_ms = self.since_ms?;
        let lasts_ms = self.now_ms - since_ms;
        (lasts_ms > LOST_MS).then(|| LostStretch {
            begun_s: since_ms as f64 / 1000.0,
            length_s: lasts_ms as f64 / 1000.0,
            found_again: false,
        })
    }

    /// All that were long enough, in the order of time.
    pub(super) fn stretches(&self) -> Vec<LostStretch> {
        self.finished.iter().copied().chain(self.present()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::LostWatch;

    #[test]
    fn short_stretches_do_not_count_and_long_ones_count_whole() {
        let mut lost = LostWatch::default();
        for second in 0..400_u64 {
            let wrong = (10..50).contains(&second) || (100..200).contains(&second) || second >= 300;
            lost.sample(second * 1000, if wrong { 0.6 } else { 0.1 });
        }
        let stretches = lost
            .stretches()
            .iter()
            .map(|stretch| (stretch.begun_s, stretch.length_s, stretch.found_again))
            .collect::<Vec<_>>();
        assert_eq!(stretches, [(100.0, 100.0, true), (300.0, 99.0, false)]);
    }
}
