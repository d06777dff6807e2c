//! Current regulation: a slow integral controller, and fast fold-back when the supply jumps.

use rvac_units::Ratio;

use crate::board::ChargeDrive;
use crate::limit::within;

/// Highest duty in millionths: at least a twentieth of each envelope stays quiet for the converter.
pub(super) const DUTY_MAX: i32 = 950_000;
/// Millionths of duty for each mA of error in 100 ms. A supply that gives 1.5 A at full duty follows within 2 s.
const GAIN: i32 = 30;
/// Most that the duty rises in 100 ms: the ramp to full current takes about 15 s.
const RISE_MAX: i32 = 4_000;
const FALL_MAX: i32 = 40_000;
/// The current follows the duty if it changes by this much.
const FOLLOWS_MA: i32 = 40;
/// The duty rises at most this far beyond the duty at which the current last followed. A frozen current sensor therefore
/// cannot drive the duty to its limit, and a weak supply is not overdriven.
const LEAD_MAX: i32 = 150_000;

/// The controller.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Regulator {
    duty: i32,
    followed_duty: i32,
    followed_ma: i32,
}

impl Regulator {
    /// The current starts from zero.
    pub(super) const fn restart(&mut self) {
        self.duty = 0;
        self.followed_duty = 0;
        self.followed_ma = 0;
    }

    /// One step of 100 ms.
    pub(super) fn control(&mut self, current_ma: i32, target_ma: i32) {
        if current_ma.saturating_sub(self.followed_ma).saturating_abs() >= FOLLOWS_MA
            || self.duty < self.followed_duty
        {
            self.followed_ma = current_ma;
            self.followed_duty = self.duty;
        }
        let error_ma = target_ma.saturating_sub(current_ma);
        let step = within(error_ma.saturating_mul(GAIN), -FALL_MAX, RISE_MAX);
        let most = DUTY_MAX.min(self.followed_duty.saturating_add(LEAD_MAX));
        self.duty = within(self.duty.saturating_add(step), 0, most);
    }

    /// Once an envelope: cuts the duty at once when the supply has jumped up.
    pub(super) fn fold_back(&mut self, current_ma: i32, limit_ma: i32, target_ma: i32) {
        if current_ma > limit_ma {
            let scaled =
                i64::from(self.duty).saturating_mul(i64::from(target_ma)) / i64::from(current_ma.max(1));
            self.duty = within(i32::try_from(scaled).unwrap_or(0), 0, self.duty);
        }
    }

    /// Whether the duty is high enough that current must be seen.
    pub(super) const fn must_flow(&self) -> bool {
        self.duty >= LEAD_MAX / 2
    }

    /// The request to the switch.
    pub(super) const fn drive(&self) -> ChargeDrive {
        if self.duty <= 0 {
            return ChargeDrive::Off;
        }
        match Ratio::from_millionths(self.duty) {
            Ok(duty) => ChargeDrive::Duty(duty),
            Err(_) => ChargeDrive::Off,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DUTY_MAX, Regulator};

    /// A supply that gives `full_ma` at full duty.
    fn settle(regulator: &mut Regulator, full_ma: i32, target_ma: i32, tenths: u32) -> i32 {
        let mut current_ma = 0;
        for _ in 0..tenths {
            current_ma = (i64::from(full_ma) * i64::from(regulator.duty) / 1_000_000) as i32;
            regulator.control(current_ma, target_ma);
        }
        current_ma
    }

    #[test]
    fn strong_and_weak_supplies_reach_what_they_can_without_overshoot() {
        for (full_ma, reaches_ma) in [(1_500, 950), (3_000, 950), (1_000, 950), (600, 570)] {
            let mut regulator = Regulator::default();
            let mut most_ma = 0;
            for _ in 0..600 {
                most_ma = most_ma.max(settle(&mut regulator, full_ma, 950, 1));
            }
            assert!(
                (reaches_ma - 10..=reaches_ma + 40).contains(&most_ma),
                "{full_ma}: {most_ma}"
            );
        }
    }

    #[test]
    fn a_current_sensor_that_stands_still_does_not_drive_the_duty_up() {
        let mut regulator = Regulator::default();
        settle(&mut regulator, 1_500, 400, 300);
        let before = regulator.duty;
        for _ in 0..1_000 {
            regulator.control(400, 950);
        }
        assert!(
            regulator.duty <= before + 160_000 && regulator.duty < DUTY_MAX,
            "{}",
            regulator.duty
        );
    }

    #[test]
    fn a_jump_of_the_supply_is_cut_within_one_envelope() {
        let mut regulator = Regulator::default();
        settle(&mut regulator, 1_500, 950, 400);
        let jumped_ma = 1_400;
        regulator.fold_back(jumped_ma, 1_100, 950);
        let now_ma = i64::from(jumped_ma) * i64::from(regulator.duty) / 633_000;
        assert!(now_ma < 1_000, "{now_ma}");
    }
}
