//! Furniture that people move.

use toml::{Table, Value};

use super::draw::Draw;
use super::shape::{Point, centre, contains, distance_m, edge_m, point, points, tables, written};

/// What is moved every day, by its name.
const LOOSE: [&str; 5] = ["chair", "stool", "box", "toy", "bag"];
/// What is moved for good; without one it is the largest piece.
const SOFAS: [&str; 3] = ["sofa", "couch", "armchair"];
/// How far a chair is moved, metres.
const CHAIR_M: (f64, f64) = (0.1, 1.0);
const SOFA_M: (f64, f64) = (0.2, 1.0);
const ATTEMPTS: u32 = 40;
/// What must stay free around the dock, metres.
const DOCK_M: f64 = 0.9;
/// Gap to other furniture and walls, metres.
const GAP_M: f64 = 0.03;

/// Moves what stands loose; a piece that finds no place stays.
pub(super) fn move_chairs(plan: &mut Table, draw: &mut Draw) {
    for index in 0..tables(plan, "furniture").count() {
        if is_named(plan, index, &LOOSE) {
            for _ in 0..ATTEMPTS {
                let step = draw.step(CHAIR_M.0, CHAIR_M.1);
                if try_to_move(plan, index, step) {
                    break;
                }
            }
        }
    }
}

/// Moves the sofa to a place that leaves the home whole.
pub(super) fn move_sofa(plan: &mut Table, draw: &mut Draw, is_whole: impl Fn(&Table) -> bool) {
    let count = tables(plan, "furniture").count();
    let sofa = (0..count).find(|index| is_named(plan, *index, &SOFAS));
    let Some(index) = sofa.or_else(|| largest(plan)) else {
        return;
    };
    for _ in 0..ATTEMPTS {
        let mut moved = plan.clone();
        let step = draw.step(SOFA_M.0, SOFA_M.1);
        if try_to_move(&mut moved, index, step) && is_whole(&moved) {
            *plan = moved;
            return;
        }
    }
}

fn piece(plan: &Table, index: usize) -> Option<&Table> {
    tables(plan, "furniture").nth(index)
}

fn is_named(plan: &Table, index: usize, names: &[&str]) -> bool {
    let name = piece(plan, index).and_then(|piece| piece.get("name")?.as_str());
    let name = name.unwrap_or_default().to_lowercase();
    names.iter().any(|one| name.contains(one))
}

/// The piece whose outline is longest.
fn largest(plan: &Table) -> Option<usize> {
    let spread = |piece: &Table| {
        let outline = outline(piece);
        let middle = centre(&outline);
        outline
            .iter()
            .map(|corner| distance_m(*corner, middle))
            .fold(0.0, f64::max)
    };
    let pieces = tables(plan, "furniture").map(spread).enumerate();
    pieces
        .max_by(|one, other| one.1.total_cmp(&other.1))
        .map(|(index, _)| index)
}

/// Corners and legs.
fn outline(piece: &Table) -> Vec<Point> {
    [points(piece, "polygon"), points(piece, "legs")].concat()
}

/// Moves a piece; `false` and unchanged when it would stand in something else.
fn try_to_move(plan: &mut Table, index: usize, [x, y]: Point) -> bool {
    let Some(piece) = piece(plan, index) else {
        return false;
    };
    let mut moved = piece.clone();
    for key in ["polygon", "legs"] {
        let to: Vec<Point> = points(piece, key)
            .iter()
            .map(|at| [at[0] + x, at[1] + y])
            .collect();
        if !to.is_empty() {
            moved.insert(key.to_owned(), written(&to));
        }
    }
    if !has_room(plan, index, (&outline(piece), &moved)) {
        return false;
    }
    let pieces = plan.get_mut("furniture").and_then(Value::as_array_mut);
    if let Some(place) = pieces.and_then(|pieces| pieces.get_mut(index)) {
        *place = Value::Table(moved);
    }
    true
}

/// Whether a piece stands in the room where it was, and touches nothing there.
fn has_room(plan: &Table, index: usize, (before, piece): (&[Point], &Table)) -> bool {
    let corners = outline(piece);
    let leg_m = 0.5 * leg_m(piece) + GAP_M;
    let middle = centre(before);
    let in_room = tables(plan, "room")
        .map(|room| points(room, "polygon"))
        .any(|room| {
            contains(&room, middle)
                && corners
                    .iter()
                    .all(|at| contains(&room, *at) && edge_m(&room, *at) > leg_m)
        });
    let dock = plan.get("dock").and_then(|dock| point(dock.get("position")?));
    let is_clear_of_dock = dock.is_none_or(|dock| corners.iter().all(|at| distance_m(*at, dock) > DOCK_M));
    let others = tables(plan, "furniture")
        .enumerate()
        .filter(|(other, _)| *other != index);
    in_room && is_clear_of_dock && others.map(|(_, other)| other).all(|other| !touches(piece, other))
}

fn leg_m(piece: &Table) -> f64 {
    /// As in the format of homes.
    const USUAL_M: f64 = 0.05;
    let given = piece.get("leg-diameter-m").and_then(Value::as_float);
    given.unwrap_or(USUAL_M)
}

fn touches(one: &Table, other: &Table) -> bool {
    let (legs, other_legs) = (points(one, "legs"), points(other, "legs"));
    let apart_m = 0.5 * (leg_m(one) + leg_m(other)) + GAP_M;
    let legs_touch = legs.iter().any(|leg| {
        other_legs
            .iter()
            .any(|beside| distance_m(*leg, *beside) < apart_m)
    });
    legs_touch || stands_in(one, other) || stands_in(other, one)
}

/// Whether a corner or leg of one stands in the solid part of the other, or within a leg's width of it.
fn stands_in(one: &Table, other: &Table) -> bool {
    let solid = points(other, "polygon");
    let gap_m = 0.5 * leg_m(one) + GAP_M;
    !solid.is_empty()
        && outline(one)
            .iter()
            .any(|at| contains(&solid, *at) || edge_m(&solid, *at) < gap_m)
}
