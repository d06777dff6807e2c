//! What the robot has learned of its gyro. It outlives every map.

use super::Localization;
use crate::localization::calibration::Calibration;
use crate::model::learnt::GyroLearnt;

impl Localization {
    /// What is known of the gyro; `None` while it is too uncertain to keep.
    #[must_use]
    pub fn learnt_gyro(&self) -> Option<GyroLearnt> {
        self.odometry.calibration.learnt()
    }

    /// Forgets the calibration of the gyro. The pose stays as sure as before.
    pub fn forget_gyro(&mut self) {
        // The particles carry a calibration, too, so they are drawn again.
        if let Some(present) = self.checkpoint() {
            self.resume_tracking(present);
        }
        self.odometry.calibration = Calibration::default();
    }

    /// Starts with a calibration that was learned before.
    pub fn begin_with_gyro(&mut self, learnt: GyroLearnt) {
        self.odometry.calibration = Calibration::resumed(learnt);
    }
}
