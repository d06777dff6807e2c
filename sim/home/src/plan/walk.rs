//! Paths of people and pets between places.

use std::collections::VecDeque;

use super::{DistanceField, Grid};

/// Side of the squares in which paths are searched, metres.
const STEP_M: f64 = 0.1;
/// A goal is moved to free floor that is at most this far away, metres.
const NEAR_M: f64 = 1.0;

/// Who walks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WalkerKind {
    /// On two feet.
    Person,
    /// A cat or a small dog.
    Pet,
}

impl WalkerKind {
    /// Clearance of a path to walls and furniture.
    const fn clearance_m(self) -> f64 {
        match self {
            Self::Person => 0.2,
            Self::Pet => 0.13,
        }
    }
}

/// Somebody who walks through the home for a while.
#[derive(Clone, Debug)]
pub(crate) struct WalkerPlan {
    pub(crate) kind: WalkerKind,
    /// Ways from goal to goal and back to the first, each a row of places a step apart.
    pub(crate) legs: Vec<Vec<(f64, f64)>>,
    /// Stands at each goal for so long.
    pub(crate) rest_ms: u64,
    pub(crate) from_ms: u64,
    pub(crate) until_ms: u64,
}

/// Finds paths over the floor.
pub(crate) struct Ways<'a> {
    grid: &'a Grid,
    blocked: &'a DistanceField,
    columns: usize,
    rows: usize,
}

impl<'a> Ways<'a> {
    pub(crate) fn new(grid: &'a Grid, blocked: &'a DistanceField) -> Self {
        Self {
            grid,
            blocked,
            columns: (grid.width as f64 * grid.cell_m / STEP_M) as usize,
            rows: (grid.height as f64 * grid.cell_m / STEP_M) as usize,
        }
    }

    /// The paths between consecutive goals in a loop; goals that cannot be reached from the previous one are left out.
    pub(crate) fn round(&self, goals: &[(f64, f64)], kind: WalkerKind) -> Vec<Vec<(f64, f64)>> {
        let places: Vec<usize> = goals
            .iter()
            .filter_map(|goal| self.standing(*goal, kind))
            .collect();
        let Some(first) = places.first().copied() else {
            return Vec::new();
        };
        let mut legs = Vec::new();
        let mut here = first;
        for place in places.into_iter().skip(1).chain([first]) {
            if let Some(leg) = self.path(here, place, kind) {
                legs.push(leg);
                here = place;
            }
        }
        legs
    }

    fn place(&self, square: usize) -> (f64, f64) {
        let (column, row) = (square % self.columns, square / self.columns);
        ((column as f64 + 0.5) * STEP_M, (row as f64 + 0.5) * STEP_M)
    }

    fn fits(&self, square: usize, kind: WalkerKind) -> bool {
        let (x_m, y_m) = self.place(square);
        self.grid.index(x_m, y_m).is_some() && self.blocked.at(x_m, y_m) >= kind.clearance_m()
    }

    /// The free square nearest to a goal.
    fn standing(&self, goal: (f64, f64), kind: WalkerKind) -> Option<usize> {
        let mut nearest = None;
        for square in (0..self.columns * self.rows).filter(|square| self.fits(*square, kind)) {
            let (x_m, y_m) = self.place(square);
            let distance_m = libm::hypot(x_m - goal.0, y_m - goal.1);
            if distance_m < nearest.map_or(NEAR_M, |(best_m, _)| best_m) {
                nearest = Some((distance_m, square));
            }
        }
        nearest.map(|(_, square)| square)
    }

    /// The path with the fewest squares.
    fn path(&self, from: usize, to: usize, kind: WalkerKind) -> Option<Vec<(f64, f64)>> {
        const UNSEEN: usize = usize::MAX;
        // Searched backwards, so that following the links goes forward.
        let mut next = vec![UNSEEN; self.columns * self.rows];
        *next.get_mut(to)? = to;
        let mut open = VecDeque::from([to]);
        while let Some(square) = open.pop_front() {
            if square == from {
                break;
            }
            for beside in self.beside(square) {
                let seen = next.get_mut(beside)?;
                if *seen == UNSEEN && self.fits(beside, kind) {
                    *seen = square;
                    open.push_back(beside);
                }
            }
        }
        let mut places = vec![self.place(from)];
        let mut here = from;
        while here != to {
            here = next.get(here).copied().filter(|square| *square != UNSEEN)?;
            places.push(self.place(here));
        }
        Some(places)
    }

    fn beside(&self, square: usize) -> impl Iterator<Item = usize> {
        let (column, row) = (square % self.columns, square / self.columns);
        let (columns, rows) = (self.columns, self.rows);
        [(0, 1), (1, 0), (1, 2), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2)]
            .into_iter()
            .map(move |(right, up)| (column + right, row + up))
            .filter(move |(column, row)| (1..=columns).contains(column) && (1..=rows).contains(row))
            .map(move |(column, row)| (row - 1) * columns + column - 1)
    }
}
