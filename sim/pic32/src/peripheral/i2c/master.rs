//! The steps of an I2C master, half a period of the clock at a time.

use super::{
    ACKNOWLEDGE_STEP, BUS_COLLISION, HOLD_CYCLES, I2c, NOT_ACKNOWLEDGE, NOT_ACKNOWLEDGED, RECEIVE_STEP,
    RESTART_STEP, START_STEP, STOP_STEP,
};
use crate::peripheral::rate::Now;

/// A step and how far it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MasterStep {
    Start { phase: u8 },
    Restart { phase: u8 },
    Stop { phase: u8 },
    Send { byte: u8, bit: u8, phase: u8 },
    Receive { byte: u8, bit: u8, phase: u8 },
    Acknowledge { phase: u8 },
}

/// What a clock pulse is for: what data is during it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ClockPulse {
    /// The pulse goes on.
    GoesOn,
    /// It is over, and data was so in its middle.
    Over(bool),
}

/// Phases of a clock pulse.
const SET_DATA: u8 = 0;
const RAISE_CLOCK: u8 = 1;
const AWAIT_CLOCK: u8 = 2;
const DROP_CLOCK: u8 = 3;

impl MasterStep {
    /// The step that a write to I2CxCON asks for.
    pub(super) fn of(control: u32) -> Option<MasterStep> {
        let asked = control & (START_STEP | RESTART_STEP | STOP_STEP | RECEIVE_STEP | ACKNOWLEDGE_STEP);
        match asked & asked.wrapping_neg() {
            START_STEP => Some(MasterStep::Start { phase: 0 }),
            RESTART_STEP => Some(MasterStep::Restart { phase: 0 }),
            STOP_STEP => Some(MasterStep::Stop { phase: 0 }),
            RECEIVE_STEP => Some(MasterStep::Receive {
                byte: 0,
                bit: 0,
                phase: 0,
            }),
            ACKNOWLEDGE_STEP => Some(MasterStep::Acknowledge { phase: 0 }),
            _ => None,
        }
    }

    /// Its bit in I2CxCON.
    pub(super) fn bit(self) -> u32 {
        match self {
            MasterStep::Start { .. } => START_STEP,
            MasterStep::Restart { .. } => RESTART_STEP,
            MasterStep::Stop { .. } => STOP_STEP,
            MasterStep::Send { .. } => 0,
            MasterStep::Receive { .. } => RECEIVE_STEP,
            MasterStep::Acknowledge { .. } => ACKNOWLEDGE_STEP,
        }
    }

    pub(super) fn is_sending(self) -> bool {
        matches!(self, MasterStep::Send { .. })
    }

    /// Whether the hold time of a bit before this one has passed already.
    fn follows_a_bit(self) -> bool {
        match self {
            MasterStep::Send { bit, .. } | MasterStep::Receive { bit, .. } => bit > 0,
            MasterStep::Start { .. }
            | MasterStep::Restart { .. }
            | MasterStep::Stop { .. }
            | MasterStep::Acknowledge { .. } => false,
        }
    }

    fn phase(self) -> u8 {
        match self {
            MasterStep::Start { phase }
            | MasterStep::Restart { phase }
            | MasterStep::Stop { phase }
            | MasterStep::Send { phase, .. }
            | MasterStep::Receive { phase, .. }
            | MasterStep::Acknowledge { phase } => phase,
        }
    }

    fn phase_mut(&mut self) -> &mut u8 {
        match self {
            MasterStep::Start { phase }
            | MasterStep::Restart { phase }
            | MasterStep::Stop { phase }
            | MasterStep::Send { phase, .. }
            | MasterStep::Receive { phase, .. }
            | MasterStep::Acknowledge { phase } => phase,
        }
    }

    /// The phase in which it waits for the clock to rise, which others may hold low.
    fn awaits_clock(self) -> bool {
        self.phase() == AWAIT_CLOCK && !matches!(self, MasterStep::Start { .. })
    }
}

impl I2c {
    pub(super) fn begin_step(&mut self, step: MasterStep, now: Now) {
        self.step = Some(step);
        self.advance_step(now);
    }

    /// The clock is high: whoever held it low has let go.
    pub(super) fn master_hears_clock_rise(&mut self, now: Now) {
        if self.step.is_some_and(MasterStep::awaits_clock) && self.timer.is_none() {
            self.advance_step(now);
        }
    }

    /// Whether this side makes the start that is on the lines now.
    pub(super) fn makes_start(&self) -> bool {
        matches!(
            self.step,
            Some(MasterStep::Start { .. } | MasterStep::Restart { .. })
        )
    }

    /// Does what comes next in the step.
    pub(super) fn advance_step(&mut self, now: Now) {
        let Some(step) = self.step else { return };
        match step {
            MasterStep::Start { phase } => self.advance_start(phase, now),
            MasterStep::Restart { phase } => self.advance_restart(phase, now),
            MasterStep::Stop { phase } => self.advance_stop(phase, now),
            MasterStep::Send { byte, bit, .. } => self.advance_send(byte, bit, now),
            MasterStep::Receive { byte, bit, .. } => self.advance_receive(byte, bit, now),
            MasterStep::Acknowledge { .. } => {
                let high = self.has(NOT_ACKNOWLEDGE);
                if let ClockPulse::Over(_) = self.clock_pulse(high, now) {
                    self.end_step();
                }
            }
        }
    }

    fn next_phase(&mut self) {
        if let Some(step) = &mut self.step {
            *step.phase_mut() += 1;
        }
    }

    /// The next phase comes half a period later.
    fn next_after_half(&mut self, now: Now) {
        self.next_phase();
        self.wait_half(now, 0);
    }

    fn end_step(&mut self) {
        (self.step, self.timer) = (None, None);
        self.events.master = true;
    }

    /// Somebody else drives the bus: lines are let go, requests are forgotten.
    fn collide(&mut self) {
        (self.step, self.timer, self.transmit) = (None, None, None);
        (self.pulls_clock, self.pulls_data, self.owns_bus) = (false, false, false);
        self.flags |= BUS_COLLISION;
        self.events.collision = true;
    }

    fn advance_start(&mut self, phase: u8, now: Now) {
        match phase {
            0 | 1 if !self.clock_high || !self.data_high => return self.collide(),
            0 => {}
            1 => self.pulls_data = true,
            _ => {
                self.pulls_clock = true;
                self.owns_bus = true;
                return self.end_step();
            }
        }
        self.next_after_half(now);
    }

    fn advance_restart(&mut self, phase: u8, now: Now) {
        match phase {
            SET_DATA => self.pulls_data = false,
            RAISE_CLOCK => return self.raise_clock(now),
            AWAIT_CLOCK => {}
            DROP_CLOCK if !self.data_high => return self.collide(),
            DROP_CLOCK => self.pulls_data = true,
            _ => {
                self.pulls_clock = true;
                return self.end_step();
            }
        }
        self.next_after_half(now);
    }

    fn advance_stop(&mut self, phase: u8, now: Now) {
        match phase {
            SET_DATA => self.pulls_data = true,
            RAISE_CLOCK => return self.raise_clock(now),
            AWAIT_CLOCK => {}
            DROP_CLOCK => self.pulls_data = false,
            _ => {
                self.owns_bus = false;
                return self.end_step();
            }
        }
        self.next_after_half(now);
    }

    /// Lets go of the clock; the next phase begins when it is high.
    fn raise_clock(&mut self, now: Now) {
        self.next_phase();
        self.pulls_clock = false;
        if self.clock_high {
            self.advance_step(now);
        }
    }

    /// One pulse of the clock with data at this level.
    fn clock_pulse(&mut self, high: bool, now: Now) -> ClockPulse {
        let phase = self.step.map_or(0, MasterStep::phase);
        match phase {
            SET_DATA => {
                self.pulls_data = !high;
                let follows = self.step.is_some_and(MasterStep::follows_a_bit);
                self.next_phase();
                self.wait_half(now, if follows { HOLD_CYCLES } else { 0 });
            }
            RAISE_CLOCK => self.raise_clock(now),
            AWAIT_CLOCK => {
                self.next_after_half(now);
            }
            _ => {
                let data = self.data_high;
                self.pulls_clock = true;
                return ClockPulse::Over(data);
            }
        }
        ClockPulse::GoesOn
    }

    /// After a pulse: data changes when its hold time is over.
    fn next_bit(&mut self, step: MasterStep, now: Now) {
        self.step = Some(step);
        self.wait_hold(now);
    }

    fn advance_send(&mut self, byte: u8, bit: u8, now: Now) {
        let is_acknowledge = bit == 8;
        let high = is_acknowledge || byte << bit & 0x80 != 0;
        let ClockPulse::Over(data) = self.clock_pulse(high, now) else {
            return;
        };
        if is_acknowledge {
            self.raise_flag(NOT_ACKNOWLEDGED, data);
            return self.end_step();
        }
        if high && !data {
            return self.collide();
        }
        if bit == 7 {
            self.transmit = None;
        }
        let bit = bit + 1;
        self.next_bit(MasterStep::Send { byte, bit, phase: 0 }, now);
    }

    fn advance_receive(&mut self, byte: u8, bit: u8, now: Now) {
        let ClockPulse::Over(data) = self.clock_pulse(true, now) else {
            return;
        };
        let byte = byte << 1 | u8::from(data);
        if bit == 7 {
            self.deliver(byte);
            return self.end_step();
        }
        let bit = bit + 1;
        self.next_bit(MasterStep::Receive { byte, bit, phase: 0 }, now);
    }
}

const _: () = assert!(
    HOLD_CYCLES < 40,
    "shorter than half a period of the fastest clock"
);
