//! What changes the map besides what is seen: people, the dock's contacts, and what turns out about where the robot was.

use super::Brain;
use crate::localization::MapCorrection;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::map_edit::MapEdit;
use crate::model::reason::Reason;

/// A robot that docks farther than this from where a person pointed does not know which of the two is wrong, metres and radians.
const TOLD_M: f64 = 1.0;
const TOLD_RAD: f64 = 1.0;

impl Brain {
    /// Does with the map what the robot's place asks for.
    pub(super) fn correct_map(&mut self, correction: Option<MapCorrection>) {
        match correction {
            Some(MapCorrection::Redraw { keyframes }) => self.map.redraw(&keyframes),
            Some(MapCorrection::Withdraw { since_us, keyframes }) => {
                self.map.withdraw(since_us, &keyframes);
                self.mind.decide("withdraw", Reason::PlaceUnknown, 0.0);
            }
            None => {}
        }
    }

    /// Makes an edit of the map. One that was admitted and does not hold any more changes nothing.
    pub(super) fn edit(&mut self, edit: &MapEdit, is_docked: bool) {
        match self.map.apply(edit) {
            Ok(()) => self.follow_edit(edit, is_docked),
            Err(error) => self.mind.refuse("edit-refused", error.name()),
        }
    }

    /// What an edit changes beside the map. A robot that is on the dock was carried along with it.
    fn follow_edit(&mut self, edit: &MapEdit, is_docked: bool) {
        match edit {
            MapEdit::NoGo(_) | MapEdit::Place(_) | MapEdit::Room(_) => {}
            MapEdit::Dock(_) => {
                self.beams.forget();
                self.localization.put_dock(self.map.dock_place());
                if is_docked {
                    // The path so far does not lead here.
                    self.map.start_anew();
                    self.wake_on_dock();
                }
            }
        }
    }

    /// The robot stands on the dock: where it was told to be, or was felt too seldom, if that is near enough and the robot may trust
    /// its own place.
    pub(super) fn feel_dock(&mut self, pose: Pose2) {
        let place = self.map.dock_place();
        let Some(known) = place.pose().filter(|_| !place.is_sure()) else {
            return;
        };
        let is_near = known.position().distance_m(pose.position()) <= TOLD_M
            && normalize_rad(known.heading_rad - pose.heading_rad).abs() <= TOLD_RAD;
        if is_near && self.localization.is_confirmed() {
            self.map.feel_dock(pose);
            self.localization.put_dock(self.map.dock_place());
            self.mind.decide("dock-found", Reason::Docked, 0.0);
        }
    }
}
