//! How time passes: whole milliseconds, or up to any cycle within one.

use monitor::Pins;

use super::EmulatedRobot;
use crate::board::CYCLES_PER_MS;

/// Milliseconds between two poses in the digest.
const DIGEST_MS: u64 = 100;

/// A millisecond that has begun.
#[derive(Clone, Debug)]
pub(super) struct BegunTick {
    /// What stood at the pins at its beginning.
    pins: Pins,
    /// How far the chip is.
    reached: u64,
}

impl EmulatedRobot {
    /// Advances one millisecond: the home, then what it does to the pins, then 80,000 cycles of the chip, then what the
    /// chip did. What reaches the host's receiver is appended to `to_host`.
    pub fn tick(&mut self, to_host: &mut Vec<u8>) {
        let whole = self.now_ms + u64::from(self.begun.is_none());
        self.advance_to(whole * CYCLES_PER_MS, to_host);
    }

    /// Advances to a cycle, which may lie within a millisecond: for something on the pins that acts between two ticks.
    pub fn advance_to(&mut self, cycle: u64, to_host: &mut Vec<u8>) {
        loop {
            let begun = self.begun.take().unwrap_or_else(|| self.begin_ms());
            let end = self.now_ms * CYCLES_PER_MS;
            let to = cycle.clamp(begun.reached, end);
            self.run(begun.reached, to);
            if to < end {
                self.begun = Some(BegunTick { reached: to, ..begun });
                return;
            }
            self.end_ms(&begun.pins, to_host);
            if end >= cycle {
                return;
            }
        }
    }

    /// The home, and what it does to the pins in the millisecond that begins.
    fn begin_ms(&mut self) -> BegunTick {
        let from = self.now_ms * CYCLES_PER_MS;
        self.now_ms += 1;
        self.world.step(&self.actuation);
        self.circuit.sensors = *self.world.sensors();
        self.drive_inputs(from);
        self.send_to_robot(from);
        BegunTick {
            pins: self.pins(),
            reached: from,
        }
    }

    /// What the chip did in the millisecond that ends.
    fn end_ms(&mut self, pins: &Pins, to_host: &mut Vec<u8>) {
        let end = self.now_ms * CYCLES_PER_MS;
        self.look_at_emitter(end);
        self.lights.take(&mut self.machine, end);
        self.sound.take(&mut self.machine);
        self.motors.take(&mut self.machine, end);
        self.hear_robot(end, to_host);
        self.actuate(end);
        self.notice_resets();
        let drives = self.driven();
        self.monitor.judge(self.now_ms, pins, &drives);
        if self.now_ms.is_multiple_of(DIGEST_MS) {
            let pose = self.world.truth().pose;
            for part in [pose.x_m, pose.y_m, pose.heading_rad] {
                self.digest.word(part.to_bits());
            }
        }
    }
}
