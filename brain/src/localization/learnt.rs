//! What has been learnt of the gyro, which outlives every map.

use super::Localization;
use super::calibration::Calibration;
use crate::learnt::GyroLearnt;

impl Localization {
    /// What is known of the gyro; `None` while that is not worth keeping.
    #[must_use]
    pub fn learnt_gyro(&self) -> Option<GyroLearnt> {
        self.odometry.calibration.learnt()
    }

    /// Begins with what was learnt of the gyro before.
    pub fn begin_with_gyro(&mut self, learnt: GyroLearnt) {
        self.odometry.calibration = Calibration::resumed(learnt);
    }
}
