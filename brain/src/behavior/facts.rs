//! What an observation means for the state machine.

use crate::model::fault::Fault;
use crate::model::inhibit::Inhibit;
use crate::model::link_fault::LinkFault;
use crate::model::observation::{ChargeFlow, Observation};

/// Digest of one observation.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Facts {
    pub(crate) now_us: u64,
    pub(crate) link_up: bool,
    /// Why the link is not up, unless it is silent.
    pub(crate) link_fault: Option<LinkFault>,
    pub(crate) wheel_drop: bool,
    pub(crate) docked: bool,
    /// What the pack holds, 0..=1.
    pub(crate) battery_charge: Option<f32>,
    pub(crate) battery_low: bool,
    pub(crate) charge_flow: Option<ChargeFlow>,
    /// A bumper is pressed, or the firmware still holds the wheels because of one.
    pub(crate) touching: bool,
    /// A cliff is seen, or the firmware still holds the wheels because of one.
    pub(crate) at_cliff: bool,
    /// There is a source of heading besides the wheels.
    pub(crate) knows_heading: bool,
    /// Beacons are in range that will tell the heading once the robot drives.
    pub(crate) hears_beacons: bool,
    /// The charger has stopped for a fault.
    pub(crate) charger_fault: bool,
    /// Values of this robot that it needs to move were never measured.
    pub(crate) not_calibrated: bool,
    /// A fault that needs a person.
    pub(crate) fault: Option<Fault>,
    /// Inhibits that `arm` takes away.
    pub(crate) disarmed: Disarmed,
    /// The firmware rests because commands had no effect on the wheels' travel.
    pub(crate) not_moving: bool,
    /// A cliff sensor fails its self-test at this moment; lasting, it is a fault.
    pub(crate) cliff_sensor: bool,
}

/// Inhibits that `arm` takes away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Disarmed {
    pub(crate) not_armed: bool,
    pub(crate) stopped: bool,
    pub(crate) button_stop: bool,
    pub(crate) link_lost: bool,
    /// Docked, and `undock` was not commanded.
    pub(crate) docked: bool,
}

impl Disarmed {
    pub(crate) fn any(self) -> bool {
        self != Self::default()
    }
}

impl Facts {
    pub(crate) fn read(observation: &Observation, battery_low: f32) -> Self {
        let mut facts = Self {
            now_us: observation.time_us,
            link_up: observation.link_up,
            wheel_drop: observation.wheel_drop,
            docked: observation.docked,
            battery_charge: observation.battery_charge,
            battery_low: observation
                .battery_charge
                .is_some_and(|charge| charge < battery_low),
            charge_flow: observation.charge_flow,
            touching: observation.is_touching(),
            at_cliff: observation.is_at_cliff(),
            hears_beacons: observation.hears_beacons(),
            ..Self::default()
        };
        for inhibit in observation.inhibits.iter() {
            facts.add_inhibit(inhibit);
        }
        facts.link_up &= facts.link_fault.is_none();
        if observation.inhibits.other().is_some() {
            facts.fault = Some(Fault::UnknownInhibit);
        }
        facts
    }

    fn add_inhibit(&mut self, inhibit: Inhibit) {
        match inhibit {
            Inhibit::NotArmed => self.disarmed.not_armed = true,
            Inhibit::Stopped => self.disarmed.stopped = true,
            Inhibit::ButtonStop => self.disarmed.button_stop = true,
            Inhibit::LinkLost => self.disarmed.link_lost = true,
            Inhibit::Docked => self.disarmed.docked = true,
            // The observation's contacts and cliffs include these.
            Inhibit::Bumper | Inhibit::Cliff => {}
            // The firmware asks for charge (S16).
            Inhibit::BatteryLow | Inhibit::BatteryWeak => self.battery_low = true,
            // It forbids charging only, and no motion.
            Inhibit::ChargerFault => self.charger_fault = true,
            Inhibit::CliffSensorFault => self.cliff_sensor = true,
            Inhibit::WheelDrop => self.wheel_drop = true,
            Inhibit::NotMoving => self.not_moving = true,
            Inhibit::NotCalibrated => self.not_calibrated = true,
            Inhibit::LinkGarbled
            | Inhibit::LinkCorrupted
            | Inhibit::LinkLate
            | Inhibit::ClockFrozen
            | Inhibit::ClockJumped
            | Inhibit::CommandsLost
            | Inhibit::CommandsStale => self.link_fault = LinkFault::of_inhibit(inhibit),
            // These need a person.
            Inhibit::ResetLoop
            | Inhibit::BumperStuck
            | Inhibit::CliffTrapped
            | Inhibit::WheelStall
            | Inhibit::BrushStall
            | Inhibit::Runaway
            | Inhibit::EncoderFault
            | Inhibit::InternalFault
            | Inhibit::BatteryEmpty
            | Inhibit::BatteryHot
            | Inhibit::BatteryOverheated
            | Inhibit::Thermistor
            | Inhibit::ChargerShorted
            | Inhibit::Clock
            | Inhibit::Memory => self.fault = Some(Fault::of_inhibit(inhibit)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Facts;
    use crate::model::fault::Fault;
    use crate::model::inhibit::Inhibits;
    use crate::model::observation::Observation;

    fn facts_of(name: &'static str) -> Facts {
        let observation = Observation {
            inhibits: Inhibits::from_names([name]),
            ..Observation::default()
        };
        Facts::read(&observation, 0.15)
    }

    #[test]
    fn a_low_pack_leads_home_and_a_broken_charger_stops_no_job() {
        for name in ["battery-low", "battery-weak"] {
            let facts = facts_of(name);
            assert!(facts.battery_low && facts.fault.is_none(), "{name}");
        }
        let facts = facts_of("charger-fault");
        assert!(!facts.battery_low && facts.fault.is_none());
    }

    #[test]
    fn what_needs_a_person_is_a_fault_by_its_name() {
        for (name, reason) in [
            ("battery-empty", Fault::BatteryEmpty),
            ("battery-overheated", Fault::BatteryOverheated),
            ("thermistor", Fault::Thermistor),
            ("charger-shorted", Fault::ChargerShorted),
            ("memory", Fault::Memory),
            ("flux-capacitor", Fault::UnknownInhibit),
        ] {
            assert_eq!(facts_of(name).fault, Some(reason), "{name}");
        }
    }
}
