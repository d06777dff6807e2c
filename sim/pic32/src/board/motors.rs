//! The motors as their bridges see the pins: mean duty for the physics, and to the cycle when a drive began and ended.

use home::Bridge;

use super::CYCLES_PER_MS;
use super::wiring::{DigitalLine, Wiring};
use crate::machine::Machine;

/// A motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MotorOutput {
    /// Left wheel.
    WheelLeft,
    /// Right wheel.
    WheelRight,
    /// Main brush.
    BrushMain,
    /// Both side brushes.
    BrushSides,
    /// Suction.
    Vacuum,
}

impl MotorOutput {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::WheelLeft,
        Self::WheelRight,
        Self::BrushMain,
        Self::BrushSides,
        Self::Vacuum,
    ];
}

/// A stretch of time in which a motor was driven without a pause of more than `PAUSE` cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DriveInterval {
    /// Cycle of the first pulse.
    pub from: u64,
    /// Cycle at which the last pulse ended; `None` = it goes on.
    pub until: Option<u64>,
    /// The wheel or brush was driven forward.
    pub forward: bool,
}

/// A longer pause than two periods of the PWM ends a drive: the compare register is 0.
const PAUSE: u64 = 8_000;
/// A period of the PWM: for so long after its last pulse a motor still counts as driven.
const PERIOD: u64 = 4_000;
/// Drives that are kept of each motor.
const KEPT: usize = 256;

#[derive(Clone, Debug)]
struct One {
    enable: DigitalLine,
    phase: Option<DigitalLine>,
    mode: Option<DigitalLine>,
    high_cycles: u64,
    /// Share of the last millisecond in which it was driven, 0..=1.
    duty: f64,
    /// The duty of the last millisecond that had one.
    driven: f64,
    /// The one before: what a deaf bridge goes on with.
    kept: f64,
    drives: Vec<DriveInterval>,
    level_on: bool,
    last_off: u64,
}

/// All motors.
#[derive(Clone, Debug)]
pub(super) struct MotorOutputs {
    motors: [One; 5],
    watched: bool,
    deaf: bool,
}

impl MotorOutputs {
    /// `deaf` wheel bridges keep the last duty when commanded to brake.
    pub(super) fn new(wiring: &Wiring, deaf: bool) -> Self {
        let one = |enable, phase, mode| One {
            enable,
            phase,
            mode,
            high_cycles: 0,
            duty: 0.0,
            driven: 0.0,
            kept: 0.0,
            drives: Vec::new(),
            level_on: false,
            last_off: 0,
        };
        let wheel = |number: usize| {
            let pins = wiring.wheels[number];
            one(pins.enable, Some(pins.phase), Some(pins.mode))
        };
        Self {
            motors: [
                wheel(0),
                wheel(1),
                one(wiring.brush_enable, Some(wiring.brush_phase), None),
                one(wiring.brush_sides, None, None),
                one(wiring.vacuum, None, None),
            ],
            watched: false,
            deaf,
        }
    }

    /// From now on drives are written down to the cycle.
    pub(super) fn watch(&mut self, machine: &mut Machine) {
        self.watched = true;
        for motor in &mut self.motors {
            machine.watch(motor.enable.pin);
            motor.level_on = motor.enable.is_on(machine.output(motor.enable.pin));
        }
    }

    /// Takes what the pins did in the millisecond that ended at `end`.
    pub(super) fn take(&mut self, machine: &mut Machine, end: u64) {
        for motor in &mut self.motors {
            let high_cycles = machine.high_cycles(motor.enable.pin);
            let high = high_cycles - motor.high_cycles;
            motor.high_cycles = high_cycles;
            motor.duty = (high as f64 / CYCLES_PER_MS as f64).min(1.0);
            // The millisecond in which it is switched off shows less than what went before.
            if motor.duty > 0.0 {
                motor.kept = motor.driven;
                motor.driven = motor.duty;
            }
            if self.watched {
                motor.log(machine, end);
            }
        }
    }

    /// Duty of a motor in the last millisecond, forward positive.
    pub(super) fn duty(&self, motor: MotorOutput, machine: &Machine) -> f64 {
        let one = &self.motors[motor as usize];
        let is_wheel = matches!(motor, MotorOutput::WheelLeft | MotorOutput::WheelRight);
        let duty = if self.deaf && is_wheel { one.kept } else { one.duty };
        if one.is_forward(machine) { duty } else { -duty }
    }

    /// What a wheel's bridge makes of it.
    pub(super) fn bridge(&self, motor: MotorOutput, machine: &Machine) -> Bridge {
        let mode = self.motors[motor as usize].mode;
        Bridge {
            pwm: self.duty(motor, machine),
            brake: mode.is_some_and(|mode| mode.is_on(machine.output(mode.pin))),
        }
    }

    /// When the motor was driven, since [`Self::watch`] and at most the last of them.
    pub(super) fn drives(&self, motor: MotorOutput) -> &[DriveInterval] {
        &self.motors[motor as usize].drives
    }

    /// A reset ends every drive; the pins are inputs.
    pub(super) fn reset(&mut self) {
        for motor in &mut self.motors {
            motor.driven = 0.0;
            motor.kept = 0.0;
            motor.duty = 0.0;
        }
    }
}

impl One {
    fn is_forward(&self, machine: &Machine) -> bool {
        self.phase
            .is_none_or(|phase| phase.is_on(machine.output(phase.pin)))
    }

    fn log(&mut self, machine: &mut Machine, end: u64) {
        let forward = self.is_forward(machine);
        for (cycle, level) in machine.take_edges(self.enable.pin) {
            let on = level == self.enable.active;
            if on && !self.level_on {
                self.begin(cycle, forward);
            } else if !on && self.level_on {
                self.last_off = cycle;
            }
            self.level_on = on;
        }
        if !self.level_on && end.saturating_sub(self.last_off) > PAUSE {
            self.close();
        }
    }

    fn begin(&mut self, cycle: u64, forward: bool) {
        if cycle - self.last_off.min(cycle) > PAUSE {
            self.close();
        }
        if self.drives.last().is_none_or(|drive| drive.until.is_some()) {
            if self.drives.len() >= KEPT {
                self.drives.remove(0);
            }
            self.drives.push(DriveInterval {
                from: cycle,
                until: None,
                forward,
            });
        }
    }

    fn close(&mut self) {
        if let Some(drive) = self.drives.last_mut() {
            drive.until = drive.until.or(Some(self.last_off));
        }
    }
}

/// What became of a drive after an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// The motor was not driven at the moment of the event.
    NotDriven,
    /// Its last pulse ended so many cycles after the event.
    Stopped(u64),
    /// It is still driven.
    StillDriven,
}

/// What became, after the event at `event`, of the drive that was going on then.
#[must_use]
pub fn reaction(drives: &[DriveInterval], event: u64) -> Reaction {
    let going = drives
        .iter()
        .find(|drive| drive.from <= event && drive.until.is_none_or(|until| until + PERIOD > event));
    match going.map(|drive| drive.until) {
        None => Reaction::NotDriven,
        Some(Some(until)) => Reaction::Stopped(until.saturating_sub(event)),
        Some(None) => Reaction::StillDriven,
    }
}

#[cfg(test)]
mod tests {
    use super::{DriveInterval, Reaction, reaction};

    #[test]
    fn a_reaction_is_the_time_from_the_event_to_the_end_of_the_drive() {
        let drives =
            [(10, Some(50)), (10_000, Some(18_000)), (30_000, None)].map(|(from, until)| DriveInterval {
                from,
                until,
                forward: true,
            });
        for (event, wanted) in [
            (5, Reaction::NotDriven),
            (5_000, Reaction::NotDriven),
            (60, Reaction::Stopped(0)),
            (11_000, Reaction::Stopped(7_000)),
            (40_000, Reaction::StillDriven),
        ] {
            assert_eq!(reaction(&drives, event), wanted);
        }
    }
}
