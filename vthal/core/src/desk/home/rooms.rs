//! Edits of rooms and of the pose of the dock: what is wrong with one, in words.

use brain::CutLine;
use brain::zone::COORDINATE_MAX_M;
use brain::{Brain, EditError, Point2, Pose2, RoomEdit};
use rvac_api::short_number;

use crate::refusal::Refusal;

/// What is wrong with an edit of the rooms, in words.
pub(super) fn refusal(error: EditError, edit: &RoomEdit, brain: &Brain) -> Refusal {
    match (error, edit) {
        (
            EditError::NoSuchRoom,
            RoomEdit::Name { room, .. }
            | RoomEdit::Set { room, .. }
            | RoomEdit::Split { room: Some(room), .. },
        ) => Refusal::no_such_room(*room, brain),
        (EditError::NameTaken, RoomEdit::Name { .. }) => {
            Refusal::because(error, "Another room is called so: take another name.".to_owned())
        }
        (_, RoomEdit::Split { room, line }) => {
            of_line(error, *room, line.ends().map(|end| [end.x_m, end.y_m]))
        }
        (EditError::NoSuchRoom, RoomEdit::Join { rooms }) => {
            let is_known = |id: &u16| brain.map().rooms().rooms().iter().any(|room| room.id == *id);
            let missing = rooms.iter().find(|id| !is_known(id));
            Refusal::no_such_room(missing.copied().unwrap_or_default(), brain)
        }
        (EditError::RoomsApart, RoomEdit::Join { rooms }) => {
            Refusal::because(error, rooms_apart(*rooms, brain))
        }
        (_, RoomEdit::Undo { number }) => Refusal::because(error, not_undone(error, *number, brain)),
        (_, RoomEdit::Name { .. } | RoomEdit::Set { .. } | RoomEdit::Join { .. }) => Refusal::from(error),
    }
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

/// What is wrong with a place of the dock, in words.
pub(super) fn dock_refusal(error: EditError, pose: Pose2, brain: &Brain) -> Refusal {
    match error {
        EditError::NoFloorThere => Refusal::no_floor_there(&format!("under {}", robot_at(pose)), brain),
        EditError::DockInside => Refusal::because(
            error,
            format!(
                "A no-go zone lies under {}: put the dock beside it, or remove the zone first.",
                robot_at(pose)
            ),
        ),
        _ => Refusal::from(error),
    }
}

fn robot_at(pose: Pose2) -> String {
    format!(
        "a robot on a dock at x {} m, y {} m",
        place(pose.x_m),
        place(pose.y_m)
    )
}

pub(crate) fn to_line(line: [[f64; 2]; 2]) -> Result<CutLine, Refusal> {
    let [from, to] = line.map(|[x_m, y_m]| Point2 { x_m, y_m });
    CutLine::new(from, to).map_err(|error| of_line(error, None, line))
}

fn of_line(error: EditError, room: Option<u16>, line: [[f64; 2]; 2]) -> Refusal {
    let ends = ends(line);
    let text = match (error, room) {
        (EditError::BadLine, _) => {
            format!(
                "The line from {ends} cannot be: its ends must be two places within {COORDINATE_MAX_M} m."
            )
        }
        (EditError::LineMissesRoom, Some(room)) => format!(
            "The line from {ends} does not cut room {room}: draw it across the room, from one wall to the other."
        ),
        (EditError::LineMissesRoom, None) => {
            format!(
                "The line from {ends} lies in no room: draw it across a room, from one wall to the other."
            )
        }
        (EditError::LineEndsInRoom, _) => format!(
            "The line from {ends} leaves a way round it: draw it across the whole room, from one wall to the other."
        ),
        (EditError::PartTooSmall, _) => format!(
            "The line from {ends} cuts off less than half a square metre: draw it farther from the wall."
        ),
        _ => return Refusal::from(error),
    };
    Refusal::because(error, text)
}

fn ends([[x, y], [to_x, to_y]]: [[f64; 2]; 2]) -> String {
    let [x, y, to_x, to_y] = [x, y, to_x, to_y].map(place);
    format!("x {x} m, y {y} m to x {to_x} m, y {to_y} m")
}

/// To a centimetre, unless it is no place in a home.
fn place(coordinate_m: f64) -> String {
    if coordinate_m.abs() < COORDINATE_MAX_M {
        format!("{coordinate_m:.2}")
    } else {
        short_number(coordinate_m)
    }
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
