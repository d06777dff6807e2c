//! What is known of the link and the robot's slow facts, for the device table and for judging freshness.

use crate::device::{CommandError, Greeting, Report, SlowFacts, WheelSpeeds};

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
    reset_cause: Option<&'static str>,
    resets: u32,
    pub(crate) report: Option<Report>,
    report_us: Option<u64>,
    pub(crate) slow: Option<SlowFacts>,
    pub(crate) wheel_speeds: WheelSpeeds,
    bytes_in: ByteRate,
    bytes_out: ByteRate,
    rate_since_us: u64,
    last_error: Option<CommandError>,
}

impl LinkFacts {
    pub(crate) fn opened(&mut self, now_us: u64) {
        self.opened = self.opened.saturating_add(1);
        self.is_open = true;
        self.report_us = None;
        self.rate_since_us = now_us;
    }

    pub(crate) fn closed(&mut self) {
        self.is_open = false;
        self.report_us = None;
        self.wheel_speeds = WheelSpeeds::default();
    }

    /// Times the device was lost and found again.
    pub(crate) fn reconnects(&self) -> u32 {
        self.opened.saturating_sub(1)
    }

    pub(crate) fn resets(&self) -> u32 {
        self.resets
    }

    /// Why the robot last started, if it reports that.
    pub(crate) fn reset_cause(&self) -> Option<&'static str> {
        self.reset_cause
    }

    pub(crate) fn greeted(&mut self, greeting: &Greeting) {
        self.report = None;
        self.reset_cause = greeting.reset_cause;
        self.resets = self.resets.saturating_add(u32::from(greeting.was_reset));
    }

    pub(crate) fn take_report(&mut self, now_us: u64, report: Report) {
        if let Some(speeds) = report.travel.speeds {
            self.wheel_speeds = speeds;
        }
        self.report = Some(report);
        self.report_us = Some(now_us);
    }

    /// Age of the newest telemetry in ms; `None` if there is none since the device was opened.
    pub(crate) fn age_ms(&self, now_us: u64) -> Option<u32> {
        let age_us = now_us.saturating_sub(self.report_us?);
        Some(u32::try_from(age_us / 1000).unwrap_or(u32::MAX))
    }

    /// Whether the newest telemetry is no older than `fresh_us`.
    pub(crate) fn is_fresh(&self, now_us: u64, fresh_us: u64) -> bool {
        self.report_us
            .is_some_and(|report_us| now_us.saturating_sub(report_us) <= fresh_us)
    }

    pub(crate) fn count_in(&mut self, bytes: usize) {
        self.bytes_in.counted = self.bytes_in.counted.saturating_add(bytes as u64);
    }

    pub(crate) fn count_out(&mut self, bytes: usize) {
        self.bytes_out.counted = self.bytes_out.counted.saturating_add(bytes as u64);
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
