//! Rooms, walls and doors.
//!
//! Three layouts of a floor: a *studio* with a bathroom in its corner; a *spine*, which is a corridor with a
//! row of rooms on each side and a living room at its end over the whole depth; and a *hall*, the same with the living room
//! and the kitchen in the rows.

use super::draw::Draw;
use super::shape::Rect;
use super::things::{PlacedDoor, PlacedLine, Room, RoomKind, Things};

/// Thickness of walls between rooms, metres.
const WALL_M: f64 = 0.12;
/// Doors keep this distance from the corners of a room, metres.
const JAMB_M: f64 = 0.16;

/// How large a home is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HomeSize {
    Studio,
    Small,
    Medium,
    Large,
}

/// Draws the rooms of a home.
pub(super) fn draw_rooms(draw: &mut Draw, extent: HomeSize) -> Things {
    let mut things = Things::default();
    match extent {
        HomeSize::Studio => studio(draw, &mut things),
        HomeSize::Small | HomeSize::Medium | HomeSize::Large => rows(draw, extent, &mut things),
    }
    things
}

fn studio(draw: &mut Draw, things: &mut Things) {
    let room = Rect::new([0.0, 0.0], [draw.length(4.2, 6.2), draw.length(5.2, 7.4)]);
    let bath = Rect::new([0.0, 0.0], [draw.length(1.8, 2.3), draw.length(1.9, 2.5)]);
    things.rooms.push(Room {
        kind: RoomKind::Studio,
        rect: room,
    });
    things.rooms.push(Room {
        kind: RoomKind::Bath,
        rect: bath,
    });
    let half = 0.5 * WALL_M;
    let corner = [bath.high[0] + half, bath.high[1] + half];
    things.walls.push(PlacedLine {
        ends: [[0.0, corner[1]], corner],
        thickness_m: WALL_M,
    });
    things.walls.push(PlacedLine {
        ends: [[corner[0], 0.0], [corner[0], corner[1] + half]],
        thickness_m: WALL_M,
    });
    let width = draw.length(0.74, 0.86);
    let start = draw.length(JAMB_M, bath.high[1] - JAMB_M - width);
    things.doors.push(PlacedDoor {
        ends: [[corner[0], start], [corner[0], start + width]],
        open: true,
        threshold_m: draw.pick(&[0.0, 0.006, 0.01]),
    });
}

/// A row of rooms beside the corridor.
struct RoomRow {
    low_y: f64,
    high_y: f64,
    door_y: f64,
    kinds: Vec<RoomKind>,
}

fn rows(draw: &mut Draw, extent: HomeSize, things: &mut Things) {
    let full_depth = draw.chance(0.55);
    let corridor_m = draw.length(1.1, if extent == HomeSize::Large { 1.9 } else { 1.5 });
    let (south_m, north_m) = (draw.length(2.5, 3.6), draw.length(3.0, 4.2));
    let corridor_y = [south_m + WALL_M, south_m + WALL_M + corridor_m];
    let top = corridor_y[1] + WALL_M + north_m;
    let living_m = draw.length(3.8, 5.4);
    let first_x = if full_depth { living_m + WALL_M } else { 0.0 };
    let (south, north) = kinds(draw, extent, full_depth);
    let total_m = wanted_m(draw, &south).max(wanted_m(draw, &north));
    let end_x = first_x + total_m;
    let corridor = Rect::new([first_x, corridor_y[0]], [end_x, corridor_y[1]]);
    if full_depth {
        things.rooms.push(Room {
            kind: RoomKind::Living,
            rect: Rect::new([0.0, 0.0], [living_m, top]),
        });
        living_door(draw, living_m + 0.5 * WALL_M, corridor, things);
    }
    things.rooms.push(Room {
        kind: RoomKind::Corridor,
        rect: corridor,
    });
    let stairs_m = stairs(draw, extent, corridor, things);
    for row in [
        RoomRow {
            low_y: 0.0,
            high_y: south_m,
            door_y: south_m + 0.5 * WALL_M,
            kinds: south,
        },
        RoomRow {
            low_y: top - north_m,
            high_y: top,
            door_y: corridor_y[1] + 0.5 * WALL_M,
            kinds: north,
        },
    ] {
        fill(draw, &row, [first_x, end_x, end_x - stairs_m], things);
    }
}

/// The rooms of both rows.
fn kinds(draw: &mut Draw, extent: HomeSize, full_depth: bool) -> (Vec<RoomKind>, Vec<RoomKind>) {
    use RoomKind::{Bath, Bedroom, Child, Kitchen, Living, Office, Storage, Toilet};
    let (mut south, mut north) = match extent {
        HomeSize::Large => (vec![Kitchen, Bath, Toilet, Office], vec![Bedroom, Child, Bedroom]),
        HomeSize::Medium => (vec![Kitchen, Bath, Office], vec![Bedroom, Child]),
        HomeSize::Small | HomeSize::Studio => (vec![Kitchen, Bath], vec![Bedroom]),
    };
    if draw.chance(0.4) {
        south.push(Storage);
    }
    if !full_depth {
        north.insert(0, Living);
    }
    if draw.chance(0.3) {
        north.reverse();
    }
    (south, north)
}

/// Width that a row would like to have.
fn wanted_m(draw: &mut Draw, kinds: &[RoomKind]) -> f64 {
    kinds
        .iter()
        .map(|kind| width_of(draw, *kind) + WALL_M)
        .sum::<f64>()
        - WALL_M
}

fn width_of(draw: &mut Draw, kind: RoomKind) -> f64 {
    let (low, high) = match kind {
        RoomKind::Living | RoomKind::Studio => (4.6, 6.0),
        RoomKind::Kitchen => (2.6, 3.6),
        RoomKind::Bedroom => (3.2, 4.4),
        RoomKind::Child => (2.6, 3.4),
        RoomKind::Office => (2.4, 3.2),
        RoomKind::Bath => (1.9, 2.6),
        RoomKind::Toilet => (1.1, 1.3),
        RoomKind::Storage => (1.3, 1.8),
        RoomKind::Corridor => (1.1, 1.6),
    };
    draw.length(low, high)
}

/// Lays the rooms of a row side by side over the whole length, each with a door to the corridor.
fn fill(draw: &mut Draw, row: &RoomRow, [first_x, end_x, doors_end_x]: [f64; 3], things: &mut Things) {
    let widths: Vec<f64> = row.kinds.iter().map(|kind| width_of(draw, *kind)).collect();
    let walls_m = WALL_M * (row.kinds.len() as f64 - 1.0);
    // Small rooms stay small; the others take what is over.
    let grows = |kind: RoomKind| !matches!(kind, RoomKind::Toilet | RoomKind::Storage | RoomKind::Bath);
    let sum_of = |wanted: bool| -> f64 {
        let chosen = row
            .kinds
            .iter()
            .zip(&widths)
            .filter(|(kind, _)| grows(**kind) == wanted);
        chosen.map(|(_, width)| *width).sum()
    };
    let factor = (end_x - first_x - walls_m - sum_of(false)) / sum_of(true);
    let mut x = first_x;
    for (number, (kind, width)) in row.kinds.iter().zip(&widths).enumerate() {
        let is_last = number + 1 == row.kinds.len();
        let drawn = if grows(*kind) { width * factor } else { *width };
        let end = if is_last {
            end_x
        } else {
            x + libm::round(drawn * 50.0) / 50.0
        };
        things.rooms.push(Room {
            kind: *kind,
            rect: Rect::new([x, row.low_y], [end, row.high_y]),
        });
        let wall = DoorWall {
            y: row.door_y,
            low_x: x,
            high_x: end.min(doors_end_x),
        };
        row_door(draw, *kind, wall, things);
        x = end + WALL_M;
    }
}

/// The wall of a room in which its door is.
#[derive(Clone, Copy, Debug)]
struct DoorWall {
    y: f64,
    low_x: f64,
    high_x: f64,
}

fn row_door(draw: &mut Draw, kind: RoomKind, wall: DoorWall, things: &mut Things) {
    let (narrow, wide) = match kind {
        RoomKind::Living => (1.0, 1.6),
        RoomKind::Toilet | RoomKind::Storage | RoomKind::Bath => (0.7, 0.8),
        _ => (0.78, 0.92),
    };
    let width = draw.length(narrow, wide);
    let start = draw.length(wall.low_x + JAMB_M, wall.high_x - JAMB_M - width);
    let wet = matches!(kind, RoomKind::Bath | RoomKind::Toilet | RoomKind::Kitchen);
    things.doors.push(PlacedDoor {
        ends: [[start, wall.y], [start + width, wall.y]],
        open: kind != RoomKind::Storage || draw.chance(0.5),
        threshold_m: if wet {
            draw.pick(&[0.0, 0.006, 0.01, 0.012])
        } else {
            0.0
        },
    });
}

fn living_door(draw: &mut Draw, x: f64, corridor: Rect, things: &mut Things) {
    let width = draw.length(0.84, (corridor.depth() - 0.1).min(1.4));
    let start = draw.length(corridor.low[1], corridor.high[1] - width);
    things.doors.push(PlacedDoor {
        ends: [[x, start], [x, start + width]],
        open: true,
        threshold_m: draw.pick(&[0.0, 0.0, 0.008]),
    });
}

/// Stairs down at the end of the corridor of some large homes; gives the length that they take.
fn stairs(draw: &mut Draw, extent: HomeSize, corridor: Rect, things: &mut Things) -> f64 {
    if extent != HomeSize::Large || !draw.chance(0.5) {
        return 0.0;
    }
    let length = draw.length(0.9, 1.2);
    things.stairs.push(Rect::new(
        [corridor.high[0] - length, corridor.low[1]],
        corridor.high,
    ));
    length
}
