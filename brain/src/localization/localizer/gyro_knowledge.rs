//! What has been learnt of the gyro, which outlives every map.

use super::Localization;
use crate::localization::calibration::Calibration;
use crate::model::learnt::GyroLearnt;

impl Localization {
    /// What is known of the gyro; `None` while that is not worth keeping.
    #[must_use]
    pub fn learnt_gyro(&self) -> Option<GyroLearnt> {
        self.odometry.calibration.learnt()
    }

    /// Knows nothing of the gyro any more; where the robot is, it knows as well as before.
    pub fn forget_gyro(&mut self) {
        // Guesses of the place have learnt of the gyro, too: they are drawn anew.
        if let Some(present) = self.checkpoint() {
            self.resume_tracking(present);
        }
        self.odometry.calibration = Calibration::default();
    }

    /// Begins with what was learnt of the gyro before.
    pub fn begin_with_gyro(&mut self, learnt: GyroLearnt) {
        self.odometry.calibration = Calibration::resumed(learnt);
    }
}
