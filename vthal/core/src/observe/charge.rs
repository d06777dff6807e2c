//! From the firmware's words about pack and charger to what the brain makes of them.

use brain::observation::ChargeFlow;
use rvac_protocol::message::{Battery, ChargePhase, ChargeState};

/// A pack with more than this may be full enough that the charger lets it rest, 0..1. Its voltage decides there, and a voltage
/// tells little about the charge.
const NEEDS_CHARGE: f64 = 0.8;
/// Within this every charger may begin, tenths of a degree Celsius: by `design/safety.md` charging is allowed from 0 to
/// 40 °C; sensors err by some degrees.
const FIT_TO_CHARGE: core::ops::RangeInclusive<i16> = 50..=350;

/// What flows from the dock; `None` where the firmware has no charger under its control.
pub(super) fn flow(battery: &Battery) -> Option<ChargeFlow> {
    let charger = battery.charger?;
    Some(match battery.state {
        ChargeState::Charging => ChargeFlow::Flowing,
        ChargeState::Full | ChargeState::Fault => ChargeFlow::Withheld,
        ChargeState::Discharging if charger.phase == ChargePhase::Fault => ChargeFlow::Withheld,
        ChargeState::Discharging if could_take(battery) => ChargeFlow::Missing,
        ChargeState::Discharging => ChargeFlow::Withheld,
    })
}

/// Whether current can be expected on a dock.
fn could_take(battery: &Battery) -> bool {
    let fit = battery
        .temperature
        .is_some_and(|temperature| FIT_TO_CHARGE.contains(&temperature.0));
    fit && battery.charge.as_f64() < NEEDS_CHARGE
}

#[cfg(test)]
mod tests {
    use brain::observation::ChargeFlow;
    use rvac_protocol::message::{Battery, ChargePhase, ChargeState, ChargerStatus};
    use rvac_units::{Current, Ratio, Temperature, Voltage};

    use super::flow;

    fn battery(state: ChargeState, charge_percent: i32, temperature_dc: i16) -> Battery {
        Battery {
            charge: Ratio::from_millionths(10_000 * charge_percent).expect("a share"),
            voltage: Voltage(14_400),
            current: Current(-400),
            temperature: Some(Temperature(temperature_dc)),
            state,
            charger: Some(ChargerStatus {
                phase: ChargePhase::Idle,
                end: None,
                fault: None,
            }),
        }
    }

    #[test]
    fn current_is_missed_only_where_it_can_be_expected() {
        let said = |state, percent, temperature_dc| flow(&battery(state, percent, temperature_dc));
        let idle = ChargeState::Discharging;
        assert_eq!(said(ChargeState::Charging, 30, 250), Some(ChargeFlow::Flowing));
        assert_eq!(said(ChargeState::Full, 30, 250), Some(ChargeFlow::Withheld));
        assert_eq!(said(idle, 30, 250), Some(ChargeFlow::Missing));
        assert_eq!(said(idle, 90, 250), Some(ChargeFlow::Withheld), "hardly used");
        assert_eq!(said(idle, 30, 420), Some(ChargeFlow::Withheld), "warm from work");
        assert_eq!(said(idle, 30, 10), Some(ChargeFlow::Withheld), "cold");
    }

    #[test]
    fn a_robot_without_a_charger_of_its_own_says_nothing() {
        let plain = Battery {
            charger: None,
            ..battery(ChargeState::Discharging, 30, 250)
        };
        assert_eq!(flow(&plain), None);
    }
}
