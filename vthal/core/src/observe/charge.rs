//! From the firmware's words about pack and charger to what the brain makes of them.

use brain::observation::ChargeFlow;

use crate::device::{Battery, ChargeState};

/// A pack with more than this may be full enough that the charger lets it rest, 0..1. Its voltage decides there, and a voltage
/// says little about the charge.
const NEEDS_CHARGE: f64 = 0.8;
/// Within this every charger may begin, degrees Celsius: by `design/safety.md` charging is allowed from 0 to
/// 40 °C; sensors err by some degrees.
const FIT_TO_CHARGE_C: core::ops::RangeInclusive<f64> = 5.0..=35.0;

/// What flows from the dock; `None` where the firmware has no charger under its control.
pub(super) fn flow(battery: &Battery) -> Option<ChargeFlow> {
    let charger = battery.charger?;
    Some(match battery.state {
        ChargeState::Charging => ChargeFlow::Flowing,
        ChargeState::Full | ChargeState::Fault => ChargeFlow::Withheld,
        ChargeState::Discharging if charger.has_failed => ChargeFlow::Withheld,
        ChargeState::Discharging if could_take(battery) => ChargeFlow::Missing,
        ChargeState::Discharging => ChargeFlow::Withheld,
    })
}

/// Whether current can be expected on a dock.
fn could_take(battery: &Battery) -> bool {
    let fit = battery
        .temperature_c
        .is_some_and(|temperature_c| FIT_TO_CHARGE_C.contains(&temperature_c));
    fit && battery.charge < NEEDS_CHARGE
}

#[cfg(test)]
mod tests {
    use brain::observation::ChargeFlow;

    use super::flow;
    use crate::device::{Battery, ChargeState, Charger};

    fn battery(state: ChargeState, charge: f64, temperature_c: f64) -> Battery {
        Battery {
            charge,
            voltage_v: 14.4,
            current_a: -0.4,
            temperature_c: Some(temperature_c),
            state,
            charger: Some(Charger {
                phase: "idle",
                end: None,
                fault: None,
                has_failed: false,
            }),
        }
    }

    #[test]
    fn current_is_missed_only_where_it_can_be_expected() {
        let said = |state, charge, temperature_c| flow(&battery(state, charge, temperature_c));
        let idle = ChargeState::Discharging;
        assert_eq!(said(ChargeState::Charging, 0.3, 25.0), Some(ChargeFlow::Flowing));
        assert_eq!(said(ChargeState::Full, 0.3, 25.0), Some(ChargeFlow::Withheld));
        assert_eq!(said(idle, 0.3, 25.0), Some(ChargeFlow::Missing));
        assert_eq!(said(idle, 0.9, 25.0), Some(ChargeFlow::Withheld), "hardly used");
        assert_eq!(
            said(idle, 0.3, 42.0),
            Some(ChargeFlow::Withheld),
            "warm from work"
        );
        assert_eq!(said(idle, 0.3, 1.0), Some(ChargeFlow::Withheld), "cold");
    }

    #[test]
    fn a_robot_without_a_charger_of_its_own_says_nothing() {
        let plain = Battery {
            charger: None,
            ..battery(ChargeState::Discharging, 0.3, 25.0)
        };
        assert_eq!(flow(&plain), None);
    }
}
