//! The kind of floor, by the loads of the motors.

use super::Brain;
use crate::behavior::BehaviorState;
use crate::model::observation::Observation;

impl Brain {
    /// Estimates the kind of floor under the robot from the motors' loads. During manual driving the power of the brush is unknown.
    pub(super) fn sense_floor(&mut self, observation: &Observation, cleaners: bool) {
        let is_known = cleaners && self.status().state != BehaviorState::Manual;
        let brush_percent = is_known.then(|| self.power_here().main_brush);
        if let Some(felt) = self.carpet.update(observation, brush_percent) {
            self.map.note_surface(observation.time_us, felt);
        }
    }
}
