//! What an observation means for the state machine.

use crate::model::observation::{ChargeFlow, Observation};
use crate::model::reason::Reason;

/// Digest of one observation.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Facts {
    pub(crate) now_us: u64,
    pub(crate) link_up: bool,
    pub(crate) wheel_drop: bool,
    pub(crate) docked: bool,
    pub(crate) battery_low: bool,
    pub(crate) charge_flow: Option<ChargeFlow>,
    /// A bumper is pressed, or the firmware still holds the wheels because of one.
    pub(crate) touching: bool,
    /// A cliff is seen, or the firmware still holds the wheels because of one.
    pub(crate) at_cliff: bool,
    /// Something besides the wheels tells the heading.
    pub(crate) knows_heading: bool,
    /// The charger has stopped for a fault.
    pub(crate) charger_fault: bool,
    /// A fault that needs a person.
    pub(crate) fault: Option<Reason>,
    /// Inhibits that `arm` takes away.
    pub(crate) disarmed: Disarmed,
    /// The firmware rests because commands moved nothing.
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
    /// Docked, and `undock` was not said.
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
            battery_low: observation
                .battery_charge
                .is_some_and(|charge| charge < battery_low),
            charge_flow: observation.charge_flow,
            touching: observation.is_touching(),
            at_cliff: observation.is_at_cliff(),
            ..Self::default()
        };
        for name in &observation.inhibits {
            facts.add_inhibit(name);
        }
        facts
    }

    fn add_inhibit(&mut self, name: &str) {
        match name {
            "not-armed" => self.disarmed.not_armed = true,
            "stopped" => self.disarmed.stopped = true,
            "button-stop" => self.disarmed.button_stop = true,
            "link-lost" => self.disarmed.link_lost = true,
            "docked" => self.disarmed.docked = true,
            // Already read as what is touched or seen.
            "bumper" | "cliff" => {}
            // The firmware wants to be charged (S16).
            "battery-low" | "battery-weak" => self.battery_low = true,
            // It forbids charging only, and no motion.
            "charger-fault" => self.charger_fault = true,
            "cliff-sensor" => self.cliff_sensor = true,
            "wheel-drop" => self.wheel_drop = true,
            "not-moving" => self.not_moving = true,
            // The remaining names are latched faults, or come from newer firmware: both need a person.
            other => self.fault = Some(Reason::from_name(other).unwrap_or(Reason::UnknownInhibit)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Facts;
    use crate::model::observation::Observation;
    use crate::model::reason::Reason;

    fn facts_of(name: &'static str) -> Facts {
        let observation = Observation {
            inhibits: vec![name],
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
            ("battery-empty", Reason::BatteryEmpty),
            ("battery-overheated", Reason::BatteryOverheated),
            ("thermistor", Reason::Thermistor),
            ("charger-shorted", Reason::ChargerShorted),
            ("memory", Reason::Memory),
            ("flux-capacitor", Reason::UnknownInhibit),
        ] {
            assert_eq!(facts_of(name).fault, Some(reason), "{name}");
        }
    }
}
