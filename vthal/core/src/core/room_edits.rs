//! What clients change of the home while the robot rests: its rooms, and where the dock stands.

use brain::CutLine;
use brain::zone::COORDINATE_MAX_M;
use brain::{Brain, Command, Point2, Pose2, Reason};
use rvac_api::RoomSplitting;

use super::Core;
use super::orders::Asker;
use super::refusal::Refusal;
use crate::Outputs;
use crate::mind::Mind;

impl Core {
    pub(super) fn split_room(
        &mut self,
        now_us: u64,
        (asker, splitting): (Asker, &RoomSplitting),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let line = to_line(splitting.line)?;
        let room = splitting.room;
        let brain = self.resting_home()?.brain();
        let command = Command::SplitRoom { room, line };
        brain.admit(&command).map_err(|reason| match (reason, room) {
            (Reason::NoSuchRoom, Some(room)) => Refusal::no_such_room(room, brain),
            (Reason::LineMissesRoom, Some(room)) => Refusal::because(
                reason,
                format!(
                    "The line from {} does not cut room {room}: draw it across the room, from one wall to the other.",
                    ends(splitting.line)
                ),
            ),
            _ => of_line(reason, splitting.line),
        })?;
        self.edit(now_us, (asker, command, "splits a room"), outputs);
        Ok(())
    }

    pub(super) fn join_rooms(
        &mut self,
        now_us: u64,
        (asker, rooms): (Asker, [u16; 2]),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let brain = self.resting_home()?.brain();
        let command = Command::JoinRooms { rooms };
        brain.admit(&command).map_err(|reason| match reason {
            Reason::NoSuchRoom => {
                let is_known = |id: u16| brain.map().rooms().rooms().iter().any(|room| room.id == id);
                let missing = rooms.into_iter().find(|id| !is_known(*id));
                Refusal::no_such_room(missing.unwrap_or_default(), brain)
            }
            Reason::RoomsApart => Refusal::because(reason, rooms_apart(rooms, brain)),
            _ => Refusal::from(reason),
        })?;
        self.edit(now_us, (asker, command, "joins two rooms"), outputs);
        Ok(())
    }

    pub(super) fn undo_room_change(
        &mut self,
        now_us: u64,
        (asker, number): (Asker, u16),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let brain = self.resting_home()?.brain();
        let command = Command::UndoRoomChange { number };
        let changes = brain.map().annotations().room_changes();
        brain.admit(&command).map_err(|reason| {
            let text = match (reason, changes.built_on(number)) {
                (Reason::RoomChangeInUse, Some(later)) => {
                    format!("Change {later} of the rooms builds on change {number}: take {later} back first.")
                }
                _ => {
                    let numbers: Vec<String> = changes.made().map(|(number, _)| number.to_string()).collect();
                    let known = if numbers.is_empty() {
                        "the rooms are as the robot found them".to_owned()
                    } else {
                        format!("there are {}", numbers.join(", "))
                    };
                    format!("There is no change {number} of the rooms: {known}.")
                }
            };
            Refusal::because(reason, text)
        })?;
        self.edit(
            now_us,
            (asker, command, "takes a change of the rooms back"),
            outputs,
        );
        Ok(())
    }

    pub(super) fn move_dock(
        &mut self,
        now_us: u64,
        (asker, pose): (Asker, Pose2),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let brain = self.resting_home()?.brain();
        let command = Command::MoveDock { pose };
        brain.admit(&command).map_err(|reason| match reason {
            Reason::NoFloorThere => Refusal::no_floor_there(&format!("under {}", robot_at(pose)), brain),
            Reason::DockInside => Refusal::because(
                reason,
                format!(
                    "A no-go zone lies under {}: put the dock beside it, or remove the zone first.",
                    robot_at(pose)
                ),
            ),
            _ => Refusal::from(reason),
        })?;
        self.edit(now_us, (asker, command, "says where the dock stands"), outputs);
        Ok(())
    }

    /// Rooms are looked for anew with each change, and a job keeps the rooms and the dock that it has.
    fn resting_home(&self) -> Result<&Mind, Refusal> {
        let mind = self.known_home()?;
        if !mind.rests() || mind.holds_commands() {
            return Err("job-runs".into());
        }
        Ok(mind)
    }
}

fn robot_at(pose: Pose2) -> String {
    format!("a robot on a dock at x {:.2} m, y {:.2} m", pose.x_m, pose.y_m)
}

fn to_line(line: [[f64; 2]; 2]) -> Result<CutLine, Refusal> {
    let [from, to] = line.map(|[x_m, y_m]| Point2 { x_m, y_m });
    CutLine::new(from, to).map_err(|reason| of_line(reason, line))
}

fn of_line(reason: Reason, line: [[f64; 2]; 2]) -> Refusal {
    let ends = ends(line);
    let text = match reason {
        Reason::BadLine => {
            format!(
                "The line from {ends} cannot be: its ends must be two places within {COORDINATE_MAX_M} m."
            )
        }
        Reason::LineMissesRoom => {
            format!(
                "The line from {ends} lies in no room: draw it across a room, from one wall to the other."
            )
        }
        Reason::LineEndsInRoom => format!(
            "The line from {ends} leaves a way round it: draw it across the whole room, from one wall to the other."
        ),
        Reason::PartTooSmall => format!(
            "The line from {ends} cuts off less than half a square metre: draw it farther from the wall."
        ),
        _ => return Refusal::from(reason),
    };
    Refusal::because(reason, text)
}

fn ends([[x, y], [to_x, to_y]]: [[f64; 2]; 2]) -> String {
    format!("x {x:.2} m, y {y:.2} m to x {to_x:.2} m, y {to_y:.2} m")
}

fn rooms_apart([one, other]: [u16; 2], brain: &Brain) -> String {
    if one == other {
        return format!("Room {one} is one room: name two rooms that lie beside each other.");
    }
    let doors = brain.map().rooms().doors().iter();
    let beside: Vec<String> = doors
        .filter(|door| door.rooms.contains(&one))
        .flat_map(|door| door.rooms)
        .filter(|id| *id != one)
        .map(|id| id.to_string())
        .collect();
    if beside.is_empty() {
        return format!(
            "Rooms {one} and {other} do not lie beside each other: no room lies beside room {one}."
        );
    }
    format!(
        "Rooms {one} and {other} do not lie beside each other: beside room {one} lie {}.",
        beside.join(", ")
    )
}
