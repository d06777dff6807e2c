//! The figures of a link, and which of them should not be.

use serde::Serialize;

use crate::wire::LinkKind;

/// Between two states that the robot is asked for.
pub(crate) const STATE_MS: i32 = 20;
/// Life of a motion command.
pub(crate) const LEASE_MS: u16 = 250;
/// The robot may take as long as the lease, the ramp of its wheels and two of its ticks.
const STAND_MS: u64 = LEASE_MS as u64 + 150;
/// States a second that SPI at 1 MHz has to bring when the host asks for them.
const SPI_LEAST_HZ: f64 = 200.0;

/// The figures of one link.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Measured {
    /// Which.
    pub(crate) kind: &'static str,
    /// Bytes and packets lost or damaged in both directions, without noise.
    pub(crate) lost_bytes: u64,
    /// With noise: reports that the host took and the robot has not sent, and breaches of the safety rules.
    pub(crate) wrong_packets: u64,
    /// 99 of 100 questions were answered within this time, without noise.
    pub(crate) p99_ms: u64,
    /// States a second that reached the host, without noise.
    pub(crate) telemetry_hz: f64,
    /// States a second when the host asks for the next ones as soon as the last came, without noise.
    pub(crate) telemetry_max_hz: f64,
    /// Share of the chip's time in which it worked, without noise.
    pub(crate) cpu_percent: f64,
    /// Longest time from a cable that comes out until the wheels are not driven.
    pub(crate) stands_ms: u64,
    /// Moments at which it came out.
    pub(crate) cuts: u32,
    /// Simulated seconds.
    pub(crate) seconds: u64,
}

impl Measured {
    /// What should not be.
    pub(crate) fn faults(&self) -> Vec<String> {
        let kind = self.kind;
        let mut faults = Vec::new();
        // Where both share a wire, both begin at once now and then: neither is understood, and the session repeats.
        let shares_wire = kind == LinkKind::HalfDuplex.name();
        if self.lost_bytes > 0 && !shares_wire {
            faults.push(format!("{kind} lost {} bytes without noise", self.lost_bytes));
        }
        if self.wrong_packets > 0 {
            faults.push(format!("{kind} passed {} wrong packets", self.wrong_packets));
        }
        let least = if shares_wire { 0.8 } else { 0.95 };
        if self.telemetry_hz < least * 1_000.0 / f64::from(STATE_MS) {
            faults.push(format!("{kind} brought {:.1} states a second", self.telemetry_hz));
        }
        if kind == LinkKind::Spi.name() && self.telemetry_max_hz < SPI_LEAST_HZ {
            faults.push(format!(
                "{kind} brought {:.1} states a second when asked",
                self.telemetry_max_hz
            ));
        }
        if self.stands_ms > STAND_MS {
            faults.push(format!(
                "{kind}: the wheels stood {} ms after the cut",
                self.stands_ms
            ));
        }
        faults
    }
}
