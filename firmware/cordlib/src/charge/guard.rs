//! The single gate between the charge controller and its switch, as `permit` is for the motors. It checks the readings
//! independently and knows nothing of phases and stops, so that no error there can keep the switch on.

use crate::board::ChargeDrive;
use crate::rules::charge_guard::{AGE_MAX_MS, COLDEST_CC, FLOW_MAX_MS, HOTTEST_CC, REST_MS};

use super::meter::PackTemperature;
use super::regulate::DUTY_MAX;

/// The readings that the guard checks.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChargeConditions {
    /// On the dock's contacts, which carry a supply, and not about to leave.
    pub(super) supplied: bool,
    /// No motor is driven and no wheel turns.
    pub(super) motors_idle: bool,
    pub(super) age_ms: u32,
    pub(super) temperature: Option<PackTemperature>,
    pub(super) pack_mv: Option<i32>,
    /// Least and most voltage at which the pack may get current.
    pub(super) pack_range_mv: (i32, i32),
}

/// The guard's own timers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Guard {
    flow_ms: u32,
    off_ms: u32,
}

impl Guard {
    /// Words in the kept record.
    pub(super) const WORDS: usize = 2;

    /// For the kept record.
    pub(super) const fn words(&self) -> [u32; Self::WORDS] {
        [self.flow_ms, self.off_ms]
    }

    /// From the kept record.
    pub(super) const fn from_words([flow_ms, off_ms]: [u32; Self::WORDS]) -> Self {
        Self { flow_ms, off_ms }
    }

    /// Current flowed for so long and was not counted.
    pub(super) const fn note_flow(&mut self, ms: u32) {
        self.flow_ms = self.flow_ms.saturating_add(ms);
        self.off_ms = 0;
    }

    /// The part of the request that may reach the switch. `elapsed_ms` is the time since the last call.
    pub(super) fn permit(
        &mut self,
        request: ChargeDrive,
        view: &ChargeConditions,
        elapsed_ms: u32,
    ) -> ChargeDrive {
        let drive = if self.allows(view) {
            request
        } else {
            ChargeDrive::Off
        };
        let drive = match drive {
            ChargeDrive::Duty(duty) if (1..=DUTY_MAX).contains(&duty.millionths()) => drive,
            _ => ChargeDrive::Off,
        };
        self.count(drive, elapsed_ms);
        drive
    }

    fn allows(&self, view: &ChargeConditions) -> bool {
        let (least_mv, most_mv) = view.pack_range_mv;
        view.supplied
            && view.motors_idle
            && view.age_ms <= AGE_MAX_MS
            && view
                .temperature
                .is_some_and(|range| range.coldest_cc >= COLDEST_CC && range.warmest_cc <= HOTTEST_CC)
            && view.pack_mv.is_some_and(|mv| (least_mv..=most_mv).contains(&mv))
            && self.flow_ms <= FLOW_MAX_MS
    }

    fn count(&mut self, drive: ChargeDrive, elapsed_ms: u32) {
        if drive != ChargeDrive::Off {
            self.off_ms = 0;
            self.flow_ms = self.flow_ms.saturating_add(elapsed_ms);
            return;
        }
        self.off_ms = self.off_ms.saturating_add(elapsed_ms);
        if self.off_ms >= REST_MS {
            self.flow_ms = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ChargeConditions, FLOW_MAX_MS, Guard, PackTemperature};
    use crate::board::ChargeDrive;
    use rvac_units::Ratio;

    const GOOD: ChargeConditions = ChargeConditions {
        supplied: true,
        motors_idle: true,
        age_ms: 20,
        temperature: between(2_400, 2_600),
        pack_mv: Some(16_000),
        pack_range_mv: (9_000, 20_600),
    };

    const fn between(coldest_cc: i32, warmest_cc: i32) -> Option<PackTemperature> {
        Some(PackTemperature {
            coldest_cc,
            warmest_cc,
        })
    }

    fn duty(millionths: i32) -> ChargeDrive {
        ChargeDrive::Duty(Ratio::from_millionths(millionths).unwrap())
    }

    #[test]
    fn each_precondition_alone_keeps_the_switch_off() {
        let request = duty(500_000);
        assert_eq!(Guard::default().permit(request, &GOOD, 1), request);
        let bad = [
            ChargeConditions {
                supplied: false,
                ..GOOD
            },
            ChargeConditions {
                motors_idle: false,
                ..GOOD
            },
            ChargeConditions { age_ms: 201, ..GOOD },
            ChargeConditions {
                temperature: None,
                ..GOOD
            },
            ChargeConditions {
                temperature: between(4_300, 5_101),
                ..GOOD
            },
            ChargeConditions {
                temperature: between(-1, 900),
                ..GOOD
            },
            ChargeConditions {
                pack_mv: None,
                ..GOOD
            },
            ChargeConditions {
                pack_mv: Some(8_999),
                ..GOOD
            },
            ChargeConditions {
                pack_mv: Some(20_601),
                ..GOOD
            },
        ];
        for view in bad {
            assert_eq!(
                Guard::default().permit(request, &view, 1),
                ChargeDrive::Off,
                "{view:?}"
            );
        }
        assert_eq!(Guard::default().permit(duty(950_001), &GOOD, 1), ChargeDrive::Off);
        assert_eq!(Guard::default().permit(duty(0), &GOOD, 1), ChargeDrive::Off);
    }

    #[test]
    fn current_ends_after_its_longest_time_and_comes_back_after_a_rest() {
        let request = duty(500_000);
        let mut guard = Guard::default();
        let mut flowed_ms = 0;
        while guard.permit(request, &GOOD, 1_000) != ChargeDrive::Off {
            flowed_ms += 1_000;
        }
        assert!(
            (FLOW_MAX_MS..FLOW_MAX_MS + 3_000).contains(&flowed_ms),
            "{flowed_ms}"
        );
        for _ in 0..1_800 {
            guard.permit(ChargeDrive::Off, &GOOD, 1_000);
        }
        assert_eq!(guard.permit(request, &GOOD, 1_000), ChargeDrive::Off);
        for _ in 0..1_861 {
            guard.permit(ChargeDrive::Off, &GOOD, 1_000);
        }
        assert_eq!(guard.permit(request, &GOOD, 1_000), request);
    }
}
