//! Clearing what is latched: only when its cause is gone. A cause that comes again latches again.

use rvac_protocol::message::{Currents, Inhibit, Refusal};
use rvac_units::Current;

use crate::board::{HardwareChecks, HardwareFault, Parts};
use crate::cord::Cord;

impl<P: Parts> Cord<P> {
    /// Clears a latched inhibit.
    ///
    /// # Errors
    /// `CauseRemains` while its cause stands.
    pub(crate) fn clear(&mut self, inhibit: Inhibit) -> Result<(), Refusal> {
        if matches!(inhibit, Inhibit::ChargerFault | Inhibit::ChargerShorted) {
            return self.clear_charger(inhibit);
        }
        if self.cause_stands(inhibit) {
            return Err(Refusal::CauseRemains);
        }
        self.reflexes.clear(inhibit);
        if inhibit == Inhibit::BrushStall {
            self.cleaning.forgive();
        }
        Ok(())
    }

    fn clear_charger(&mut self, inhibit: Inhibit) -> Result<(), Refusal> {
        let cleared = !self.inhibits().contains(inhibit) || self.charger.clear();
        self.reflexes.charger_fault = self.charger.status().fault;
        if cleared {
            Ok(())
        } else {
            Err(Refusal::CauseRemains)
        }
    }

    /// Whether the cause of an inhibit is present now, as far as a robot at rest can tell. There is no arm for "all
    /// others": a new inhibit needs its own answer.
    fn cause_stands(&mut self, inhibit: Inhibit) -> bool {
        let guard = self.parameters.guard;
        match inhibit {
            Inhibit::Clock => self.board.checks.stands(HardwareFault::Clock),
            Inhibit::Memory => self.board.checks.stands(HardwareFault::Memory),
            Inhibit::InternalFault => self.board.checks.stands(HardwareFault::Internal),
            Inhibit::ResetLoop => self.reflexes.is_young(),
            Inhibit::BumperStuck => self.reflexes.touches(),
            Inhibit::CliffTrapped => self.reflexes.sees_cliff(),
            Inhibit::Runaway => self.reflexes.wheel_turns(),
            Inhibit::BatteryOverheated => self.reflexes.battery().is_hot(),
            Inhibit::Thermistor => self.reflexes.battery().is_unmeasured(),
            Inhibit::WheelStall => self.draws_more_than(guard.wheel_current_max, |currents| {
                currents
                    .wheel_left
                    .magnitude()
                    .max(currents.wheel_right.magnitude())
            }),
            Inhibit::BrushStall => self.draws_more_than(guard.brush_current_max, |currents| {
                currents.brush_main.magnitude()
            }),
            // Only a wheel that is driven shows what its encoder is worth.
            Inhibit::EncoderFault => false,
            Inhibit::NotArmed
            | Inhibit::LinkLost
            | Inhibit::Bumper
            | Inhibit::Cliff
            | Inhibit::CliffSensorFault
            | Inhibit::WheelDrop
            | Inhibit::NotMoving
            | Inhibit::Docked
            | Inhibit::ButtonStop
            | Inhibit::Stopped
            | Inhibit::BatteryLow
            | Inhibit::BatteryWeak
            | Inhibit::BatteryEmpty
            | Inhibit::BatteryHot
            | Inhibit::ChargerFault
            | Inhibit::ChargerShorted => self.inhibits().contains(inhibit),
        }
    }

    /// Whether a motor draws too much current, though it is off: a shorted bridge, or a sensor that is broken.
    fn draws_more_than(&self, limit: Current, magnitude: impl Fn(&Currents) -> i32) -> bool {
        self.senses
            .currents
            .is_some_and(|currents| magnitude(&currents) > limit.0)
    }
}
