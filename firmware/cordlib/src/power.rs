//! The battery in the main loop: inputs and outputs of the charge controller, and the reports to the host.

use rvac_protocol::message::{Battery, ChargeFault, ChargePhase, ChargeState, LogLevel, PackReading};
use rvac_units::{Current, Ratio, Temperature, Throttle, Tick, Voltage};

use crate::board::{ChargeDrive, Charger, Parts};
use crate::charge::{ChargeContext, ChargeOutput, Docking, MotorActivity};
use crate::cord::Cord;
use crate::reflex::PackView;
use crate::rules::latch;

impl<P: Parts> Cord<P> {
    /// One pass of the charger and of the rules of the battery (S16, S17).
    pub(crate) fn power(&mut self, now: Tick) {
        if !self.fitted.battery {
            return;
        }
        let readings = self.board.charger.readings();
        let context = self.charge_context();
        let before = self.charger.status();
        let mut output = self.charger.step(readings, context, now);
        // No current may flow, whatever the charge controller decides.
        let forbidden = latch::FORBID_ALL
            .into_iter()
            .any(|inhibit| self.reflexes.inhibits().contains(inhibit));
        if forbidden || !self.fitted.charger {
            output = self.charger.cut();
        }
        self.switch_charger(output);
        let view = PackView {
            pack_mv: self.charger.pack().map(|(pack_mv, _)| pack_mv),
            cells: i32::from(self.parameters.pack.cells),
            supplied: self.senses.docked,
            thermometer: *self.charger.thermometer(),
        };
        self.reflexes.judge_battery(&view, now);
        self.reflexes.charger_fault = self.charger.status().fault;
        if let Some(fault) = self.charger.status().fault
            && before.fault != Some(fault)
        {
            self.journal.note(LogLevel::Error, "charger:", fault.name());
        }
        if let Some(end) = self.charger.status().end
            && before.end != Some(end)
        {
            self.journal.note(LogLevel::Info, "charge ended by", end.name());
        }
    }

    /// Docked and not about to leave; whether any motor is driven, requested or turning; the load.
    fn charge_context(&self) -> ChargeContext {
        let wheels = self.applied_wheels();
        let driven = wheels != (Throttle::ZERO, Throttle::ZERO);
        let idle = !driven && !self.is_in_motion();
        let loads = &self.parameters.pack.loads;
        let running = self.cleaning.running();
        let parts = [
            (true, loads.electronics_ma),
            (wheels.0 != Throttle::ZERO, loads.wheel_ma),
            (wheels.1 != Throttle::ZERO, loads.wheel_ma),
            (running & 1 != 0, loads.brush_main_ma),
            (running & 2 != 0, loads.brush_sides_ma),
            (running & 4 != 0, loads.vacuum_ma),
        ];
        let load_ma = parts
            .into_iter()
            .filter(|(on, _)| *on)
            .fold(0, |sum: i32, (_, ma)| sum.saturating_add(i32::from(ma)));
        ChargeContext {
            docking: self.docking(),
            motors: if idle {
                MotorActivity::Idle
            } else {
                MotorActivity::Running
            },
            load_ma,
        }
    }

    fn docking(&self) -> Docking {
        if self.reflexes.is_held_by_dock() {
            Docking::Docked
        } else if self.reflexes.dock.is_docked() {
            Docking::Leaving
        } else {
            Docking::Away
        }
    }

    /// Opens the charger's switch before any motor is driven, whatever the charge controller has decided.
    pub(crate) fn cut_charger(&mut self) {
        let output = self.charger.cut();
        self.switch_charger(output);
    }

    fn switch_charger(&mut self, output: ChargeOutput) {
        if output.drive != self.charge_output.drive {
            self.board.charger.drive(output.drive);
        }
        if output.request != self.charge_output.request {
            self.board.charger.ask_dock(output.request);
        }
        self.charge_output = output;
    }

    /// Writes the charger's drive to the board again, changed or not.
    pub(crate) fn renew_charger(&mut self) {
        self.board.charger.drive(self.charge_output.drive);
    }

    /// The last drive of the charger's switch.
    #[must_use]
    pub const fn charge_drive(&self) -> ChargeDrive {
        self.charge_output.drive
    }

    /// Voltage and current of the pack; `None` while they are not measured.
    pub(crate) fn pack(&self) -> Option<PackReading> {
        let (pack_mv, current_ma) = self.charger.pack().filter(|_| self.fitted.battery)?;
        Some(PackReading {
            voltage: Voltage(pack_mv),
            current: Current(current_ma),
        })
    }

    /// How full the battery is; `None` while its charge is not known.
    #[must_use]
    pub fn battery_charge(&self) -> Option<Ratio> {
        let known = self.fitted.battery && self.parameters.pack.measured;
        self.charger.charge_left().filter(|_| known)
    }

    /// The battery for telemetry; `None` while it is not measured or its charge is not known yet, so that no pack is
    /// reported as empty before it was measured, and none as full whose capacity nobody knows.
    pub(crate) fn battery(&self) -> Option<Battery> {
        let charge = self.battery_charge()?;
        let PackReading { voltage, current } = self.pack()?;
        let tenths = self
            .charger
            .temperature_cc()
            .and_then(|cc| i16::try_from(cc / 10).ok());
        Some(Battery {
            charge,
            voltage,
            current,
            temperature: tenths.map(Temperature),
            state: self.charge_state(),
            charger: self.fitted.charger.then(|| self.charger.status()),
        })
    }

    /// The charger's state in the words of `state`.
    pub(crate) fn charge_state(&self) -> ChargeState {
        let docked = self.reflexes.dock.is_docked();
        match self.charger.status().phase {
            ChargePhase::Fault if docked => ChargeState::Fault,
            ChargePhase::Precharge | ChargePhase::Fast | ChargePhase::TopOff => ChargeState::Charging,
            ChargePhase::Maintain => ChargeState::Full,
            ChargePhase::Idle if self.charger.charges() => ChargeState::Charging,
            ChargePhase::Idle if docked && self.charger.is_full() => ChargeState::Full,
            ChargePhase::Idle | ChargePhase::Fault => ChargeState::Discharging,
        }
    }

    /// Whether current flows though the charger is off: only leaving the dock ends it.
    pub(crate) fn is_charger_shorted(&self) -> bool {
        self.charger.status().fault == Some(ChargeFault::Shorted)
    }
}
