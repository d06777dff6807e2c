//! What changes the map besides what is seen: people, the dock's contacts, and what turns out about where the robot was.

use super::Brain;
use crate::localization::MapCorrection;
use crate::model::command::Command;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::reason::Reason;

/// A robot that docks farther than this from where a person pointed does not know which of the two is wrong, metres and radians.
const TOLD_M: f64 = 1.0;
const TOLD_RAD: f64 = 1.0;

impl Brain {
    /// Does with the map what the robot's place asks for.
    pub(super) fn correct_map(&mut self, correction: Option<MapCorrection>) {
        match correction {
            Some(MapCorrection::Redraw { keyframes }) => self.map.redraw(&keyframes),
            Some(MapCorrection::RollBack { since_us, keyframes }) => {
                self.map.roll_back(since_us, &keyframes);
                self.mind.decide("withdraw", Reason::PlaceUnknown, 0.0);
            }
            None => {}
        }
    }

    /// Does what a person wants of the map. What was admitted and does not hold any more changes nothing.
    pub(super) fn edit_map(&mut self, command: &Command, is_docked: bool) {
        let refused = match command {
            Command::AddNoGo { no_go } => self.map.add_no_go(no_go.clone()).err(),
            Command::RemoveNoGo { number } => self.map.remove_no_go(*number).err(),
            Command::NameNoGo { number, name } => self.map.name_no_go(*number, name.clone()).err(),
            Command::ReshapeNoGo { number, no_go } => self.map.reshape_no_go(*number, no_go.clone()).err(),
            Command::KeepPlace { place, number } => self.map.keep_place(place.clone(), *number).err(),
            Command::NamePlace { number, name } => self.map.name_place(*number, name.clone()).err(),
            Command::ReshapePlace { number, shape } => self.map.reshape_place(*number, shape).err(),
            Command::ForgetPlace { number } => self.map.forget_place(*number).err(),
            Command::NameRoom { room, name } => self.map.name_room(*room, name.clone()).err(),
            Command::SetRoom { room, settings } => self.map.set_room(*room, *settings).err(),
            Command::SplitRoom { room, line } => self.map.split_room(*room, *line).err(),
            Command::JoinRooms { rooms } => self.map.join_rooms(*rooms).err(),
            Command::UndoRoomChange { number } => self.map.undo_room_change(*number).err(),
            Command::MoveDock { pose } => self.move_dock(*pose, is_docked).err(),
            _ => None,
        };
        if let Some(reason) = refused {
            self.mind.decide("edit-refused", reason, 0.0);
        }
    }

    /// A person says where the dock stands now. A robot that is on it was carried along.
    fn move_dock(&mut self, pose: Pose2, is_docked: bool) -> Result<(), Reason> {
        self.map.move_dock(pose)?;
        self.beams.forget();
        self.localization.put_dock(self.map.dock_location());
        if is_docked {
            // The way so far does not lead here.
            self.map.start_anew();
            self.wake_on_dock();
        }
        Ok(())
    }

    /// The robot stands on the dock: where it was told to be, or was felt too seldom, if that is near enough and the robot may trust
    /// its own place.
    pub(super) fn feel_dock(&mut self, pose: Pose2) {
        let place = self.map.dock_location();
        let Some(known) = place.pose().filter(|_| !place.is_converged()) else {
            return;
        };
        let is_near = known.position().distance_m(pose.position()) <= TOLD_M
            && normalize_rad(known.heading_rad - pose.heading_rad).abs() <= TOLD_RAD;
        if is_near && self.localization.is_confirmed() {
            self.map.measure_dock(pose);
            self.localization.put_dock(self.map.dock_location());
            self.mind.decide("dock-found", Reason::Docked, 0.0);
        }
    }
}
