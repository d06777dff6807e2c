//! Whether the robot is lost: its believed place is wrong by more than it can work with, for longer than a moment.

/// Wrong by more than this, metres.
const LOST_M: f64 = 0.5;
/// For longer than this, milliseconds.
const LOST_MS: u64 = 60_000;

/// Measures stretches of being lost.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LostWatch {
    since_ms: Option<u64>,
    now_ms: u64,
    finished_ms: u64,
    finished_times: u32,
}

impl LostWatch {
    pub(super) fn sample(&mut self, now_ms: u64, error_m: f64) {
        self.now_ms = now_ms;
        if error_m > LOST_M {
            self.since_ms.get_or_insert(now_ms);
        } else {
            self.finished_ms += self.present_ms();
            self.finished_times += u32::from(self.present_ms() > 0);
            self.since_ms = None;
        }
    }

    /// The stretch that still lasts, if it is long enough.
    fn present_ms(&self) -> u64 {
        let lasts_ms = self.since_ms.map_or(0, |since_ms| self.now_ms - since_ms);
        if lasts_ms > LOST_MS { lasts_ms } else { 0 }
    }

    pub(super) fn seconds(&self) -> f64 {
        (self.finished_ms + self.present_ms()) as f64 / 1000.0
    }

    pub(super) fn times(&self) -> u32 {
        self.finished_times + u32::from(self.present_ms() > 0)
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
        assert_eq!((lost.seconds(), lost.times()), (100.0 + 99.0, 2));
    }
}
