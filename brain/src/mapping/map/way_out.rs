//! The way out of floor that people have forbidden around the robot.

use std::collections::VecDeque;

use super::Map;
use crate::mapping::reach::passable;
use crate::mapping::{Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};
use crate::model::no_go::NoGo;

/// No parent: not reached, or the start.
const NONE: u32 = u32::MAX;

impl Map {
    /// Whether a no-go zone, a virtual wall or one of `avoid` covers a place.
    pub(crate) fn is_forbidden(&self, at: Point2, avoid: &[NoGo]) -> bool {
        let zones = self.home.annotations.no_go.values().chain(avoid);
        zones.map(NoGo::area).any(|area| area.contains(at))
    }

    /// The shortest way from a forbidden place to one where a body with `clearance_m` around it stands over allowed floor
    /// only: its places without the first. It leads over floor that would be free if nothing were forbidden. `None` when
    /// there is no such way.
    pub(crate) fn way_out(&self, from: Point2, clearance_m: f64, avoid: &[NoGo]) -> Option<Vec<Point2>> {
        let allowed = self.knowledge_avoiding(avoid);
        let open = self.home.knowledge_without_no_go();
        let open = open.as_ref().unwrap_or_else(|| self.knowledge());
        let passable = |knowledge: &Raster<CellKnowledge>| {
            at_once(passable(knowledge, clearance_m, &mut StepBudget::unlimited()))
        };
        let (goals, ways) = (passable(&allowed), passable(open));
        let chain = shortest(&ways, Cell::under(from), |cell| goals.get(cell) == Some(&true))?;
        Some(
            straightened(&ways, &chain)
                .into_iter()
                .map(Cell::middle)
                .collect(),
        )
    }
}

/// Cells from `from` to the nearest goal by the fewest steps, both ends included. The robot's own cell and those next to it
/// need not be passable: it stands there.
fn shortest(ways: &Raster<bool>, from: Cell, is_goal: impl Fn(Cell) -> bool) -> Option<Vec<Cell>> {
    let start = ways.index(from)?;
    let mut parents = vec![NONE; ways.values().len()];
    let mut waiting = VecDeque::from([start]);
    let mut goal = None;
    while let Some(place) = waiting.pop_front() {
        if is_goal(ways.cell(place)) {
            goal = Some(place);
            break;
        }
        for cell in around(ways.cell(place)) {
            let Some(next) = ways.index(cell).filter(|next| *next != start) else {
                continue;
            };
            let is_open =
                ways.get(cell) == Some(&true) || ways.get(from) != Some(&true) && is_near(from, cell);
            if is_open
                && let Some(parent) = parents.get_mut(next)
                && *parent == NONE
            {
                *parent = place as u32;
                waiting.push_back(next);
            }
        }
    }
    let mut place = goal?;
    let mut chain = vec![ways.cell(place)];
    while let Some(parent) = parents.get(place).filter(|parent| **parent != NONE) {
        place = *parent as usize;
        chain.push(ways.cell(place));
    }
    chain.reverse();
    Some(chain)
}

/// Cells within which a robot that touches something may turn to free ones.
const TOUCHING_CELLS: i32 = 4;

fn is_near(from: Cell, cell: Cell) -> bool {
    (from.x - cell.x).abs() <= TOUCHING_CELLS && (from.y - cell.y).abs() <= TOUCHING_CELLS
}

/// The eight cells around one, straight steps first.
fn around(cell: Cell) -> [Cell; 8] {
    [
        (1, 0),
        (0, 1),
        (-1, 0),
        (0, -1),
        (1, 1),
        (-1, 1),
        (-1, -1),
        (1, -1),
    ]
    .map(|(x, y)| Cell {
        x: cell.x.saturating_add(x),
        y: cell.y.saturating_add(y),
    })
}

/// The corners of a chain after its first cell: as few as lines over passable cells allow.
fn straightened(ways: &Raster<bool>, chain: &[Cell]) -> Vec<Cell> {
    let mut corners = Vec::new();
    let mut at = 0;
    while let Some(here) = chain.get(at) {
        let mut next = at + 1;
        while chain
            .get(next + 1)
            .is_some_and(|beyond| is_straight(ways, *here, *beyond))
        {
            next += 1;
        }
        corners.extend(chain.get(next));
        at = next;
    }
    corners
}

/// Whether the line between two cells leads over passable ones, in steps of half a cell.
fn is_straight(ways: &Raster<bool>, from: Cell, to: Cell) -> bool {
    let (one, other) = (from.middle(), to.middle());
    let steps = 2 * (from.x - to.x).abs().max((from.y - to.y).abs());
    (1..=steps).all(|step| {
        let share = f64::from(step) / f64::from(steps);
        let place = Point2 {
            x_m: one.x_m + share * (other.x_m - one.x_m),
            y_m: one.y_m + share * (other.y_m - one.y_m),
        };
        ways.get(Cell::under(place)) == Some(&true)
    })
}
