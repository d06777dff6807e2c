//! The motors as their drivers see the pins: the mean of a millisecond.
//!
//! Whether a wheel's driver takes pulses is not known; here it does. Both of its lines on together is recorded as a short.

use super::CYCLES_PER_MS;
use super::wiring::{DigitalLine, Wiring};
use crate::machine::Machine;
use crate::pins::{Edge, Levels};

/// A motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Motor {
    /// Left wheel.
    WheelLeft,
    /// Right wheel.
    WheelRight,
    /// Main brush.
    Brush,
    /// Suction with side brush.
    Suction,
}

/// All motors.
#[derive(Clone, Debug)]
pub(super) struct Motors {
    /// Lines forward and backward.
    lines: [(DigitalLine, Option<DigitalLine>); 4],
    duties: [f64; 4],
    levels: Levels,
    /// Cycles up to which each was on.
    on_until: [u64; 4],
    /// Cycles in which both lines of a wheel were on.
    short_cycles: u64,
}

impl Motors {
    /// All off.
    pub(super) fn new(wiring: &Wiring, machine: &mut Machine) -> Self {
        let [left, right] = wiring.wheels;
        let lines = [
            (left.forward, Some(left.backward)),
            (right.forward, Some(right.backward)),
            (wiring.brush, None),
            (wiring.suction, None),
        ];
        for (forward, backward) in lines {
            machine.watch(forward.pin);
            if let Some(backward) = backward {
                machine.watch(backward.pin);
            }
        }
        Self {
            lines,
            duties: [0.0; 4],
            levels: machine.outputs(),
            on_until: [0; 4],
            short_cycles: 0,
        }
    }

    /// Takes what the pins did in the millisecond up to `end`.
    pub(super) fn take(&mut self, edges: &[Edge], end: u64) {
        let mut driven = [0_i64; 4];
        let mut from = end - CYCLES_PER_MS;
        for edge in edges {
            let until = edge.cycle.clamp(from, end);
            self.pass((from, until), &mut driven);
            self.levels.set(edge.pin, edge.level);
            from = until;
        }
        self.pass((from, end), &mut driven);
        self.duties = driven.map(|cycles| cycles as f64 / CYCLES_PER_MS as f64);
    }

    fn pass(&mut self, (from, until): (u64, u64), driven: &mut [i64; 4]) {
        let cycles = until - from;
        let parts = self.lines.iter().zip(driven).zip(&mut self.on_until);
        for (((forward, backward), driven), on_until) in parts {
            let is_forward = forward.is_on(&self.levels);
            let is_backward = backward.is_some_and(|line| line.is_on(&self.levels));
            match (is_forward, is_backward) {
                (true, true) => self.short_cycles += cycles,
                (true, false) => *driven += cycles as i64,
                (false, true) => *driven -= cycles as i64,
                (false, false) => continue,
            }
            if cycles > 0 {
                *on_until = until;
            }
        }
    }

    /// The chip was reset: what it did before is over.
    pub(super) fn reset(&mut self, machine: &Machine) {
        self.duties = [0.0; 4];
        self.levels = machine.outputs();
    }

    /// Mean drive of a motor in the last millisecond, -1..=1, forward positive.
    pub(super) fn duty(&self, motor: Motor) -> f64 {
        self.duties[motor as usize]
    }

    /// The cycle up to which a motor was on, 0 if it never was.
    pub(super) fn on_until(&self, motor: Motor) -> u64 {
        self.on_until[motor as usize]
    }

    /// For how many cycles both lines of a wheel were on.
    pub(super) fn short_cycles(&self) -> u64 {
        self.short_cycles
    }
}
