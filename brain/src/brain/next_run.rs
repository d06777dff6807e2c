//! With what the next run of a brain begins.

use super::Brain;
use super::checkpoint::Checkpoint;
use crate::model::geometry::Pose2;

impl Brain {
    /// As [`Self::checkpoint_without_home`], for a run that begins now. A robot on its dock that has just completed the first map of its
    /// home gets the dock's pose in that map, and localizes in the map from then on, as after a restart. Each run judges the map anew.
    #[must_use]
    pub fn checkpoint_for_next_run(&self) -> Checkpoint {
        let present = Checkpoint {
            map_doubt: None,
            ..self.checkpoint_without_home()
        };
        match self.dock_of_new_map() {
            Some(pose) => Checkpoint {
                pose,
                tracking: Some(self.localization.tracking_on_dock()),
                ..present
            },
            None => present,
        }
    }

    /// Pose of a docked robot in a map that it has just completed and does not localize in yet.
    fn dock_of_new_map(&self) -> Option<Pose2> {
        let dock = self.map.dock_location();
        let has_new_map = self.behavior.has_covered_home() && self.map_agreement().is_none();
        let is_on_dock = self.localization.is_docked() && !dock.is_reported();
        dock.pose().filter(|_| has_new_map && is_on_dock)
    }
}
