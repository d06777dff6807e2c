//! Changes of the map besides observations: edits by people, contacts of the dock, and corrections by localization.

use super::Brain;
use crate::localization::MapCorrection;
use crate::model::decision::DecisionKind;
use crate::model::edit_error::EditError;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::map_edit::{MapEdit, NoGoEdit};
use crate::model::reason::Reason;

/// A robot that docks farther than this from the pose that a person gave cannot know which of the two is wrong, metres and radians.
const DOCK_DISTANCE_MAX_M: f64 = 1.0;
const DOCK_ANGLE_MAX_RAD: f64 = 1.0;

impl Brain {
    /// Corrects the map as localization asks.
    pub(super) fn correct_map(&mut self, correction: Option<MapCorrection>) {
        match correction {
            Some(MapCorrection::Redraw { keyframes }) => self.map.redraw(&keyframes),
            Some(MapCorrection::RollBack { since_us, keyframes }) => {
                self.map.roll_back(since_us, &keyframes);
                self.mind
                    .decide(DecisionKind::Withdraw, Reason::PlaceUnknown, 0.0);
            }
            None => {}
        }
    }

    /// Makes an edit of the map. One that was admitted and does not hold any more changes nothing.
    pub(super) fn edit(&mut self, edit: &MapEdit, is_docked: bool) -> Result<(), EditError> {
        let made = self.map.apply(edit);
        match made {
            Ok(()) => self.follow_edit(edit, is_docked),
            Err(error) => self.mind.refuse_edit(error),
        }
        made
    }

    /// What an edit changes beside the map. A robot that is on the dock was carried along with it.
    fn follow_edit(&mut self, edit: &MapEdit, is_docked: bool) {
        match edit {
            // A path that was planned before may lead through it.
            MapEdit::NoGo(NoGoEdit::Add(_) | NoGoEdit::Reshape { .. }) => {
                self.behavior.discard_plans();
            }
            MapEdit::NoGo(NoGoEdit::Remove { .. } | NoGoEdit::Name { .. })
            | MapEdit::Place(_)
            | MapEdit::Room(_) => {}
            MapEdit::Dock(_) => {
                self.beams.forget();
                self.localization.put_dock(self.map.dock_location());
                if is_docked {
                    // The path so far does not lead here.
                    self.map.start_anew();
                    self.wake_on_dock();
                }
            }
        }
    }

    /// The robot is on the dock. Its pose refines a dock that a person placed or that was seldom used, if the two are near each other and
    /// the robot's pose is confirmed.
    pub(super) fn observe_dock(&mut self, pose: Pose2) {
        let place = self.map.dock_location();
        let Some(known) = place.pose().filter(|_| !place.is_converged()) else {
            return;
        };
        let is_near = known.position().distance_m(pose.position()) <= DOCK_DISTANCE_MAX_M
            && normalize_rad(known.heading_rad - pose.heading_rad).abs() <= DOCK_ANGLE_MAX_RAD;
        if is_near && self.localization.is_confirmed() {
            self.map.measure_dock(pose);
            self.localization.put_dock(self.map.dock_location());
            self.mind.decide(DecisionKind::DockFound, Reason::Docked, 0.0);
        }
    }
}
