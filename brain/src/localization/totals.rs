//! Totals of wheel encoders and gyro at an observation.

/// Totals at the last observation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Totals {
    pub(super) time_us: u64,
    pub(super) left_m: f64,
    pub(super) right_m: f64,
    pub(super) gyro_rad: Option<f64>,
}

impl Totals {
    /// Whether no wheel has turned between the two.
    pub(super) fn wheels_agree_with(self, other: Self) -> bool {
        self.left_m == other.left_m && self.right_m == other.right_m
    }
}
