//! How far the robot may still reverse.
//!
//! No sensor looks backwards. Only where the robot came from is floor for sure. Reversing uses up the budget, driving forward
//! restores it. The budget never exceeds its bound, because a turn on the spot puts other floor behind the robot.

use crate::model::advance::Advance;

/// Longest reversed distance that was not driven forward again, metres. The firmware stops reversing from a cliff (S8) and from a
/// pressed bumper (S7) after the same distance.
const BLIND_MAX_M: f64 = 0.15;
/// Stopping distance at 0.15 m/s: 40 ms for telemetry and command, then braking, metres.
const STOPPING_M: f64 = 0.03;

/// The balance of reverse and forward driving.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ReverseBudget {
    backed_m: f64,
}

impl ReverseBudget {
    /// Starts with `backed_m` metres of reversed distance.
    pub(super) fn resumed(backed_m: f64) -> Self {
        // The comparison is written so that NaN leaves no budget.
        let backed_m = if backed_m < BLIND_MAX_M {
            backed_m.max(0.0)
        } else {
            BLIND_MAX_M
        };
        Self { backed_m }
    }

    pub(super) fn follow(&mut self, advance: Advance) {
        *self = Self::resumed(self.backed_m - advance.distance_m);
    }

    /// Reversed distance in metres that was not driven forward again, 0..=0.15.
    pub(super) fn backed_m(self) -> f64 {
        self.backed_m
    }

    /// Distance in metres by which the robot may still reverse.
    pub(super) fn left_m(self) -> f64 {
        (BLIND_MAX_M - STOPPING_M - self.backed_m).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{Advance, ReverseBudget};

    fn left_after(distances_m: &[f64]) -> f64 {
        let mut reverse_budget = ReverseBudget::default();
        for &distance_m in distances_m {
            reverse_budget.follow(Advance {
                distance_m,
                ..Advance::default()
            });
        }
        reverse_budget.left_m()
    }

    fn check(distances_m: &[f64], left_m: f64) {
        let found_m = left_after(distances_m);
        assert!(
            (found_m - left_m).abs() < 1e-12,
            "{found_m} m after {distances_m:?}"
        );
    }

    #[test]
    fn reversing_uses_the_budget_and_driving_forward_restores_it() {
        check(&[], 0.12);
        check(&[-0.05, -0.04], 0.03);
        check(&[-0.05, 0.02, -0.04], 0.05);
        check(&[-0.12], 0.0);
        check(&[-0.12, 0.5], 0.12);
    }

    #[test]
    fn driving_forward_never_exceeds_the_bound() {
        check(&[7.0, -0.1], 0.02);
        check(&[-7.0, 0.1], 0.07);
    }

    #[test]
    fn nan_leaves_no_budget() {
        assert_eq!(ReverseBudget::resumed(f64::NAN).left_m(), 0.0);
        assert_eq!(ReverseBudget::resumed(f64::INFINITY).left_m(), 0.0);
        assert_eq!(ReverseBudget::resumed(-1.0), ReverseBudget::default());
    }
}
