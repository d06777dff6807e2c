//! Requests about rooms and the pose of the dock. The division into rooms and the dock change only while the robot rests.

use brain::CutLine;
use brain::zone::COORDINATE_MAX_M;
use brain::{Brain, EditError, MapEdit, Point2, Pose2, RoomEdit};
use rvac_api::{RoomNaming, RoomSettings, RoomSplitting};

use super::{AdmittedEdit, known_home};
use crate::brain_session::BrainSession;
use crate::desk::room_power::to_brain;
use crate::desk::words::to_name;
use crate::refusal::Refusal;

/// Requests about rooms.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RoomRequest {
    /// Names a room, or takes its name away.
    Name(RoomNaming),
    /// Says how it is cleaned; without settings as any other.
    Set {
        room: u16,
        settings: Option<RoomSettings>,
    },
    /// Cuts it in two along a line.
    Split(RoomSplitting),
    /// Makes two rooms one.
    Join { rooms: [u16; 2] },
    /// Reverts a change of the rooms.
    Undo { number: u16 },
}

impl RoomRequest {
    pub(super) fn edit(&self, brain_session: Option<&BrainSession>) -> Result<AdmittedEdit, Refusal> {
        match self {
            Self::Name(naming) => name_room(naming, brain_session),
            Self::Set { room, settings } => set_room(*room, *settings, brain_session),
            Self::Split(splitting) => split_room(splitting, brain_session),
            Self::Join { rooms } => join_rooms(*rooms, brain_session),
            Self::Undo { number } => undo_room_change(*number, brain_session),
        }
    }
}

fn name_room(naming: &RoomNaming, brain_session: Option<&BrainSession>) -> Result<AdmittedEdit, Refusal> {
    let room = naming.room;
    let name = naming.name.as_deref().map(to_name).transpose()?;
    let brain = known_home(brain_session)?.brain();
    let edit = MapEdit::Room(RoomEdit::Name { room, name });
    AdmittedEdit::new(brain, edit, "names a room").map_err(|error| match error {
        EditError::NoSuchRoom => Refusal::no_such_room(room, brain),
        EditError::NameTaken => {
            Refusal::because(error, "Another room is called so: take another name.".to_owned())
        }
        _ => Refusal::from(error),
    })
}

fn set_room(
    room: u16,
    settings: Option<RoomSettings>,
    brain_session: Option<&BrainSession>,
) -> Result<AdmittedEdit, Refusal> {
    let settings = settings.map(to_brain).transpose()?;
    let brain = known_home(brain_session)?.brain();
    let edit = MapEdit::Room(RoomEdit::Set { room, settings });
    AdmittedEdit::new(brain, edit, "says how a room is cleaned").map_err(|error| match error {
        EditError::NoSuchRoom => Refusal::no_such_room(room, brain),
        _ => Refusal::from(error),
    })
}

fn split_room(
    splitting: &RoomSplitting,
    brain_session: Option<&BrainSession>,
) -> Result<AdmittedEdit, Refusal> {
    let line = to_line(splitting.line)?;
    let room = splitting.room;
    let brain = resting_home(brain_session)?.brain();
    let edit = MapEdit::Room(RoomEdit::Split { room, line });
    AdmittedEdit::new(brain, edit, "splits a room").map_err(|error| match (error, room) {
        (EditError::NoSuchRoom, Some(room)) => Refusal::no_such_room(room, brain),
        (EditError::LineMissesRoom, Some(room)) => Refusal::because(
            error,
            format!(
                "The line from {} does not cut room {room}: draw it across the room, from one wall to the other.",
                ends(splitting.line)
            ),
        ),
        _ => of_line(error, splitting.line),
    })
}

fn join_rooms(rooms: [u16; 2], brain_session: Option<&BrainSession>) -> Result<AdmittedEdit, Refusal> {
    let brain = resting_home(brain_session)?.brain();
    let edit = MapEdit::Room(RoomEdit::Join { rooms });
    AdmittedEdit::new(brain, edit, "joins two rooms").map_err(|error| match error {
        EditError::NoSuchRoom => {
            let is_known = |id: u16| brain.map().rooms().rooms().iter().any(|room| room.id == id);
            let missing = rooms.into_iter().find(|id| !is_known(*id));
            Refusal::no_such_room(missing.unwrap_or_default(), brain)
        }
        EditError::RoomsApart => Refusal::because(error, rooms_apart(rooms, brain)),
        _ => Refusal::from(error),
    })
}

fn undo_room_change(number: u16, brain_session: Option<&BrainSession>) -> Result<AdmittedEdit, Refusal> {
    let brain = resting_home(brain_session)?.brain();
    let edit = MapEdit::Room(RoomEdit::Undo { number });
    AdmittedEdit::new(brain, edit, "takes a change of the rooms back")
        .map_err(|error| Refusal::because(error, not_undone(error, number, brain)))
}

fn not_undone(error: EditError, number: u16, brain: &Brain) -> String {
    let changes = brain.map().annotations().room_changes();
    if let (EditError::RoomChangeInUse, Some(later)) = (error, changes.built_on(number)) {
        return format!("Change {later} of the rooms builds on change {number}: take {later} back first.");
    }
    let numbers: Vec<String> = changes.made().map(|(number, _)| number.to_string()).collect();
    let known = if numbers.is_empty() {
        "the rooms are as the robot found them".to_owned()
    } else {
        format!("there are {}", numbers.join(", "))
    };
    format!("There is no change {number} of the rooms: {known}.")
}

pub(super) fn move_dock(pose: Pose2, brain_session: Option<&BrainSession>) -> Result<AdmittedEdit, Refusal> {
    let brain = resting_home(brain_session)?.brain();
    let edit = MapEdit::Dock(pose);
    AdmittedEdit::new(brain, edit, "says where the dock stands").map_err(|error| match error {
        EditError::NoFloorThere => Refusal::no_floor_there(&format!("under {}", robot_at(pose)), brain),
        EditError::DockInside => Refusal::because(
            error,
            format!(
                "A no-go zone lies under {}: put the dock beside it, or remove the zone first.",
                robot_at(pose)
            ),
        ),
        _ => Refusal::from(error),
    })
}

/// Each change segments the rooms anew, and a job keeps the rooms and the dock that it started with.
fn resting_home(brain_session: Option<&BrainSession>) -> Result<&BrainSession, Refusal> {
    let brain_session = known_home(brain_session)?;
    if !brain_session.rests() || brain_session.holds_commands() {
        return Err("job-runs".into());
    }
    Ok(brain_session)
}

fn robot_at(pose: Pose2) -> String {
    format!("a robot on a dock at x {:.2} m, y {:.2} m", pose.x_m, pose.y_m)
}

fn to_line(line: [[f64; 2]; 2]) -> Result<CutLine, Refusal> {
    let [from, to] = line.map(|[x_m, y_m]| Point2 { x_m, y_m });
    CutLine::new(from, to).map_err(|error| of_line(error, line))
}

fn of_line(error: EditError, line: [[f64; 2]; 2]) -> Refusal {
    let ends = ends(line);
    let text = match error {
        EditError::BadLine => {
            format!(
                "The line from {ends} cannot be: its ends must be two places within {COORDINATE_MAX_M} m."
            )
        }
        EditError::LineMissesRoom => {
            format!(
                "The line from {ends} lies in no room: draw it across a room, from one wall to the other."
            )
        }
        EditError::LineEndsInRoom => format!(
            "The line from {ends} leaves a way round it: draw it across the whole room, from one wall to the other."
        ),
        EditError::PartTooSmall => format!(
            "The line from {ends} cuts off less than half a square metre: draw it farther from the wall."
        ),
        _ => return Refusal::from(error),
    };
    Refusal::because(error, text)
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
