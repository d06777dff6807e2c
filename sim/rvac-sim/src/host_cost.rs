//! Processor time of the host's core.
//!
//! Processor time of this thread, as Linux counts it, so that other work on the machine matters little. A step is one
//! call of the core with news from the robot or with a timer that is due: while it lasts the daemon does not respond,
//! and a lease of the firmware (120 ms) must not run out. The smallest boards that the daemon runs on are some 40 times
//! slower than a desktop.

use rustix::time::{ClockId, clock_gettime};
use serde::Serialize;

/// A step longer than this is one of the long ones, microseconds: 80 ms on a board that is 40 times slower.
const LONG_US: f64 = 2_000.0;

/// Processor time of the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct HostCost {
    /// Longest step, microseconds.
    pub step_max_us: f64,
    /// Simulated second at which it was.
    pub step_max_at_s: f64,
    /// Steps longer than 2 ms.
    pub long_steps: u32,
    /// How many steps there were.
    pub steps: u32,
    /// All steps, seconds.
    pub processor_s: f64,
}

impl HostCost {
    /// Does a step and counts it.
    pub(crate) fn measure<T>(&mut self, now_us: u64, step: impl FnOnce() -> T) -> T {
        let began_s = thread_processor_s();
        let answer = step();
        let step_us = 1e6 * (thread_processor_s() - began_s);
        if step_us > self.step_max_us {
            (self.step_max_us, self.step_max_at_s) = (step_us, now_us as f64 * 1e-6);
        }
        self.long_steps += u32::from(step_us > LONG_US);
        self.steps += 1;
        self.processor_s += step_us * 1e-6;
        answer
    }
}

/// Seconds that this thread has had a processor.
#[must_use]
pub fn thread_processor_s() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::HostCost;

    #[test]
    fn the_longest_step_is_the_one_that_did_most() {
        let mut cost = HostCost::default();
        for (second, rounds) in [(1, 10_u64), (2, 3_000_000), (3, 10)] {
            let sum = cost.measure(second * 1_000_000, || {
                (0..rounds).fold(7_u64, |sum, round| std::hint::black_box(sum ^ round))
            });
            assert!(sum < u64::MAX);
        }
        assert_eq!((cost.step_max_at_s, cost.steps), (2.0, 3));
        assert!(cost.step_max_us <= cost.processor_s * 1e6 + 1e-6, "{cost:?}");
    }
}
