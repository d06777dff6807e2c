//! What the brain feels of the floor.

use super::Brain;
use crate::behavior::BehaviorState;
use crate::model::observation::Observation;

impl Brain {
    /// Feels by the motors' loads what the robot drives on. How hard the brush runs while a person drives, the brain does not know.
    pub(super) fn feel_floor(&mut self, observation: &Observation, cleaners: bool) {
        let is_known = cleaners && self.status().state != BehaviorState::Manual;
        let brush_percent = is_known.then(|| self.power_here().main_brush);
        if let Some(felt) = self.carpet.update(observation, brush_percent) {
            self.map.note_surface(observation.time_us, felt);
        }
    }
}
