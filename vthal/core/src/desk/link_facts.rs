//! What is known of the link and the robot's slow facts, for the device table and for judging freshness.

use rvac_protocol::message::{Info, MotionPhase, ResetCause, RobotHello, State};
use rvac_units::Tick;

use crate::device::CommandError;

/// Telemetry older than this is not fresh: the firmware would refuse motion at 400 ms (S3), and four reports are missing
/// at the slowest rate that a robot sends.
const FRESH_US: u64 = 300_000;
/// Bytes per second are counted over this time.
const RATE_WINDOW_US: u64 = 1_000_000;

/// Bytes of one direction.
#[derive(Clone, Copy, Debug, Default)]
struct ByteRate {
    counted: u64,
    per_s: f64,
}

/// What is known of the link.
#[derive(Debug, Default)]
pub(crate) struct LinkFacts {
    opened: u32,
    is_open: bool,
    hello: Option<RobotHello>,
    resets: u32,
    pub(crate) state: Option<State>,
    state_us: Option<u64>,
    pub(crate) info: Option<Info>,
    /// Counts per second of the left and the right wheel.
    pub(crate) count_rates_hz: [f64; 2],
    still_reports: u32,
    bytes_in: ByteRate,
    bytes_out: ByteRate,
    rate_since_us: u64,
    last_error: Option<CommandError>,
}

/// Whether the robot was reset between two greetings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Greeting {
    /// First robot, or the same one goes on.
    Continues,
    /// Its clock and its totals began anew.
    Reset(ResetCause),
}

impl LinkFacts {
    pub(crate) fn opened(&mut self, now_us: u64) {
        self.opened += 1;
        self.is_open = true;
        self.state_us = None;
        self.rate_since_us = now_us;
    }

    pub(crate) fn closed(&mut self) {
        self.is_open = false;
        self.state_us = None;
        self.count_rates_hz = [0.0; 2];
    }

    /// Times the device was lost and found again.
    pub(crate) fn reconnects(&self) -> u32 {
        self.opened.saturating_sub(1)
    }

    pub(crate) fn resets(&self) -> u32 {
        self.resets
    }

    pub(crate) fn reset_cause(&self) -> Option<ResetCause> {
        self.hello.as_ref().map(|hello| hello.reset_cause)
    }

    pub(crate) fn greeted(&mut self, hello: &RobotHello) -> Greeting {
        let clock_went_back = |old: Tick| !hello.tick.reached(old);
        let reset = self.hello.as_ref().is_some_and(|old| {
            old.boot_count != hello.boot_count
                || self
                    .state
                    .as_ref()
                    .is_some_and(|state| clock_went_back(state.tick))
        });
        self.hello = Some(hello.clone());
        self.state = None;
        if !reset {
            return Greeting::Continues;
        }
        self.resets += 1;
        Greeting::Reset(hello.reset_cause)
    }

    pub(crate) fn take_state(&mut self, now_us: u64, state: &State) {
        if let Some(old) = &self.state {
            let left = state.count_left.wrapping_sub(old.count_left);
            let right = state.count_right.wrapping_sub(old.count_right);
            let ms = state.tick.since(old.tick);
            if ms > 0 && ms < 10_000 {
                let rate = |counts: i32| f64::from(counts) * 1000.0 / f64::from(ms);
                self.count_rates_hz = [rate(left), rate(right)];
            }
            let still = left == 0 && right == 0 && state.motion == MotionPhase::Idle;
            self.still_reports = if still {
                self.still_reports.saturating_add(1)
            } else {
                0
            };
        }
        self.state = Some(*state);
        self.state_us = Some(now_us);
    }

    /// Reports in a row that say "still".
    pub(crate) fn still_reports(&self) -> u32 {
        self.still_reports
    }

    /// Only reports from now on count for [`LinkFacts::still_reports`].
    pub(crate) fn forget_stillness(&mut self) {
        self.still_reports = 0;
        self.state = None;
    }

    /// Age of the newest telemetry in ms; `None` if there is none since the device was opened.
    pub(crate) fn age_ms(&self, now_us: u64) -> Option<u32> {
        let age_us = now_us.saturating_sub(self.state_us?);
        Some(u32::try_from(age_us / 1000).unwrap_or(u32::MAX))
    }

    pub(crate) fn is_fresh(&self, now_us: u64) -> bool {
        self.state_us
            .is_some_and(|state_us| now_us.saturating_sub(state_us) <= FRESH_US)
    }

    pub(crate) fn count_in(&mut self, bytes: usize) {
        self.bytes_in.counted += bytes as u64;
    }

    pub(crate) fn count_out(&mut self, bytes: usize) {
        self.bytes_out.counted += bytes as u64;
    }

    pub(crate) fn pass_time(&mut self, now_us: u64) {
        let window_us = now_us.saturating_sub(self.rate_since_us);
        if window_us >= RATE_WINDOW_US {
            for rate in [&mut self.bytes_in, &mut self.bytes_out] {
                rate.per_s = rate.counted as f64 * 1e6 / window_us as f64;
                rate.counted = 0;
            }
            self.rate_since_us = now_us;
        }
    }

    /// Bytes per second from and to the robot.
    pub(crate) fn bytes_per_s(&self) -> (f64, f64) {
        (self.bytes_in.per_s, self.bytes_out.per_s)
    }

    /// Whether this differs from the error before; repetitions are not worth a line each.
    pub(crate) fn is_new_error(&mut self, error: CommandError) -> bool {
        self.last_error.replace(error) != Some(error)
    }
}
