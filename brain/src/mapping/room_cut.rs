//! A line across a room, and the two parts that it cuts.

use std::collections::VecDeque;

use super::cell::neighbours;
use super::{CELL_M, Cell, Raster};
use crate::model::cut_line::CutLine;
use crate::model::edit_error::EditError;
use crate::model::geometry::Point2;

/// People end a line short of the wall, so it is extended by this much, metres.
const BEYOND_M: f64 = 0.5;
/// Smallest part that a person may cut off, square metres.
const PART_MIN_M2: f64 = 0.5;
/// Samples of a line per cell.
const STEPS_PER_CELL: f64 = 4.0;

/// A part of a room, seen from the start of the line to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartSide {
    /// On the left, including the cells under the line.
    Left,
    /// On the right.
    Right,
}

/// The two parts of a room.
pub(super) struct Cut {
    pub(super) room: u16,
    left: Vec<Cell>,
    right: Vec<Cell>,
    /// Whether the parts are connected around an end of the line.
    is_connected: bool,
}

impl Cut {
    pub(super) fn side(&self, side: PartSide) -> &[Cell] {
        match side {
            PartSide::Left => &self.left,
            PartSide::Right => &self.right,
        }
    }

    pub(super) fn smaller(&self) -> PartSide {
        if self.left.len() < self.right.len() {
            PartSide::Left
        } else {
            PartSide::Right
        }
    }
}

/// Cuts a room from border to border; without a room, the one in which the line is longest.
pub(super) fn cut(labels: &Raster<u16>, room: Option<u16>, line: &CutLine) -> Result<Cut, EditError> {
    let cut = nearest_cut(labels, room, line).ok_or(EditError::LineMissesRoom)?;
    if cut.is_connected {
        return Err(EditError::LineEndsInRoom);
    }
    let least = PART_MIN_M2 / (CELL_M * CELL_M);
    if (cut.side(cut.smaller()).len() as f64) < least {
        return Err(EditError::PartTooSmall);
    }
    Ok(cut)
}

/// The same for parts of any size. If the parts are connected around the line, each cell belongs to the nearer side. `None` when
/// the line misses the room, or the whole room lies on one side.
pub(super) fn nearest_cut(labels: &Raster<u16>, room: Option<u16>, line: &CutLine) -> Option<Cut> {
    let (room, under) = longest_part(labels, room, line)?;
    let mut states = Raster::filled(labels.origin(), labels.width(), labels.height(), CutState::Open);
    for cell in &under {
        if let Some(state) = states.get_mut(*cell) {
            *state = CutState::Line;
        }
    }
    let beside = under.iter().flat_map(|cell| neighbours(*cell));
    let mut next: VecDeque<(Cell, PartSide)> =
        beside.map(|cell| (cell, side_of(line, cell.middle()))).collect();
    let (mut left, mut right, mut is_connected) = (under.clone(), Vec::new(), false);
    while let Some((cell, side)) = next.pop_front() {
        let Some(state) = states.get_mut(cell).filter(|_| labels.get(cell) == Some(&room)) else {
            continue;
        };
        match *state {
            CutState::Line => {}
            CutState::On(other) => is_connected |= other != side,
            CutState::Open => {
                *state = CutState::On(side);
                match side {
                    PartSide::Left => left.push(cell),
                    PartSide::Right => right.push(cell),
                }
                next.extend(neighbours(cell).map(|beside| (beside, side)));
            }
        }
    }
    let is_cut = left.len() > under.len() && !right.is_empty();
    is_cut.then_some(Cut {
        room,
        left,
        right,
        is_connected,
    })
}

/// The side of a line on which a point lies.
fn side_of(line: &CutLine, point: Point2) -> PartSide {
    let [from, to] = line.ends();
    let (along_x, along_y) = (to.x_m - from.x_m, to.y_m - from.y_m);
    let across = along_x * (point.y_m - from.y_m) - along_y * (point.x_m - from.x_m);
    if across < 0.0 {
        PartSide::Right
    } else {
        PartSide::Left
    }
}

/// Cells under a part of a line; consecutive cells share an edge.
fn cells_under(line: &CutLine, from_m: f64, to_m: f64) -> Vec<Cell> {
    let steps = ((to_m - from_m).abs() * STEPS_PER_CELL / CELL_M) as u32 + 1;
    let mut cells: Vec<Cell> = Vec::new();
    for step in 0..=steps {
        let share = f64::from(step) / f64::from(steps);
        let cell = Cell::under(line.at(from_m + share * (to_m - from_m)));
        match cells.last().copied() {
            Some(last) if last == cell => {}
            Some(last) => {
                if last.x != cell.x && last.y != cell.y {
                    cells.push(Cell { x: cell.x, y: last.y });
                }
                cells.push(cell);
            }
            None => cells.push(cell),
        }
    }
    cells
}

/// State of a cell during the cut.
#[derive(Clone, Copy)]
enum CutState {
    Open,
    Line,
    On(PartSide),
}

/// The longest part of a line within one room, extended to the room's border at both ends, and the room.
fn longest_part(labels: &Raster<u16>, wanted: Option<u16>, line: &CutLine) -> Option<(u16, Vec<Cell>)> {
    let cells = cells_under(line, 0.0, line.length_m());
    let room_of = |cell: &Cell| {
        let label = labels.get(*cell).copied().filter(|label| *label != 0);
        label.filter(|label| wanted.is_none_or(|room| room == *label))
    };
    let pieces = cells.chunk_by(|one, other| room_of(one) == room_of(other));
    let in_rooms = pieces.filter_map(|piece| Some((room_of(piece.first()?)?, piece)));
    // The first of equal length.
    let (room, piece) = in_rooms.rev().max_by_key(|(_, piece)| piece.len())?;
    let end = line.length_m();
    let mut under = piece.to_vec();
    let inside = |cell: &Cell| labels.get(*cell) == Some(&room);
    if piece.first() == cells.first() {
        under.extend(
            cells_under(line, 0.0, -BEYOND_M)
                .into_iter()
                .take_while(inside)
                .skip(1),
        );
    }
    if piece.last() == cells.last() {
        under.extend(
            cells_under(line, end, end + BEYOND_M)
                .into_iter()
                .take_while(inside)
                .skip(1),
        );
    }
    Some((room, under))
}

#[cfg(test)]
mod tests {
    use super::{PartSide, cut, nearest_cut};
    use crate::mapping::{Cell, Raster};
    use crate::model::cut_line::CutLine;
    use crate::model::edit_error::EditError;
    use crate::model::geometry::Point2;

    fn at(x_m: f64, y_m: f64) -> Point2 {
        Point2 { x_m, y_m }
    }

    fn line(from: Point2, to: Point2) -> CutLine {
        CutLine::new(from, to).unwrap()
    }

    /// Room 1 of 4 x 2 m, and room 2 of 1 x 2 m to its right.
    fn labels() -> Raster<u16> {
        let mut labels = Raster::filled(Cell { x: -1, y: -1 }, 202, 82, 0);
        for index in 0..labels.values().len() {
            let cell = labels.cell(index);
            let is_inside = (0..200).contains(&cell.x) && (0..80).contains(&cell.y);
            let room = if cell.x < 160 { 1 } else { 2 };
            labels.values_mut()[index] = if is_inside { room } else { 0 };
        }
        labels
    }

    #[test]
    fn a_line_from_border_to_border_makes_two_parts_of_all_cells() {
        for line in [
            line(at(1.0, -0.1), at(1.0, 2.1)),
            line(at(1.0, 0.3), at(1.0, 1.7)),
            line(at(0.6, 2.0), at(1.4, 0.0)),
            line(at(1.4, 0.1), at(0.6, 1.9)),
        ] {
            let cut = cut(&labels(), None, &line).unwrap();
            let (left, right) = (cut.side(PartSide::Left), cut.side(PartSide::Right));
            assert_eq!(cut.room, 1);
            assert_eq!(left.len() + right.len(), 160 * 80);
            let small = cut.side(cut.smaller());
            assert!((3_000..3_600).contains(&small.len()), "{}", small.len());
            assert!(left.iter().all(|cell| !right.contains(cell)));
        }
    }

    #[test]
    fn lines_that_cut_nothing_are_refused_by_name() {
        for (room, line, reason) in [
            (
                None,
                line(at(-3.0, 0.0), at(-3.0, 2.0)),
                EditError::LineMissesRoom,
            ),
            (
                Some(2),
                line(at(1.0, 0.0), at(1.0, 2.0)),
                EditError::LineMissesRoom,
            ),
            (
                Some(3),
                line(at(1.0, 0.0), at(1.0, 2.0)),
                EditError::LineMissesRoom,
            ),
            (None, line(at(1.0, 0.7), at(1.0, 1.2)), EditError::LineEndsInRoom),
            (None, line(at(0.2, -0.1), at(0.2, 2.1)), EditError::PartTooSmall),
        ] {
            assert_eq!(cut(&labels(), room, &line).err(), Some(reason), "{line:?}");
        }
        for (from, to) in [
            (at(0.0, 0.0), at(0.0, 0.04)),
            (at(0.0, 0.0), at(f64::NAN, 1.0)),
            (at(0.0, 0.0), at(501.0, 1.0)),
        ] {
            assert_eq!(CutLine::new(from, to), Err(EditError::BadLine));
        }
    }

    #[test]
    fn a_line_over_two_rooms_cuts_the_one_in_which_it_is_longer_or_the_given_one() {
        let along = line(at(1.0, 1.0), at(5.0, 1.0));
        assert_eq!(nearest_cut(&labels(), None, &along).map(|cut| cut.room), Some(1));
        assert_eq!(cut(&labels(), Some(2), &along).map(|cut| cut.room), Ok(2));
    }

    #[test]
    fn a_line_that_no_longer_reaches_the_border_divides_the_room_by_the_nearer_side() {
        let short = line(at(1.0, 0.7), at(1.0, 1.2));
        let cut = nearest_cut(&labels(), Some(1), &short).unwrap();
        let (left, right) = (cut.side(PartSide::Left), cut.side(PartSide::Right));
        assert_eq!(left.len() + right.len(), 160 * 80);
        assert!(left.contains(&Cell { x: 2, y: 40 }) && right.contains(&Cell { x: 150, y: 40 }));
    }
}
