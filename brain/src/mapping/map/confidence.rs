//! Confidence of a map, for the whole home and per room.
//!
//! *Face*: the side of a floor cell at which an obstacle begins.

use std::collections::BTreeMap;

use super::Map;
use crate::mapping::Cell;
use crate::mapping::occupancy_grid::{CellKnowledge, Evidence, Flag, is_touched_only};

/// Confidence of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapConfidence {
    /// Root mean square over all floor cells of the smallest pose uncertainty at which each was seen, metres.
    pub sigma_m: f64,
    /// Share of the floor on which the robot's body has been, 0..=1; the rest was only seen from afar.
    pub driven: f64,
    /// Share of the faces that are known from contacts alone, 0..=1.
    pub touched: f64,
}

/// The counts behind it.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    cells: u32,
    driven: u32,
    square_m2: f64,
    faces: u32,
    touched: u32,
}

impl Count {
    fn confidence(self) -> Option<MapConfidence> {
        let share = |part: u32, all: u32| f64::from(part) / f64::from(all.max(1));
        (self.cells > 0).then(|| MapConfidence {
            sigma_m: libm::sqrt(self.square_m2 / f64::from(self.cells)),
            driven: share(self.driven, self.cells),
            touched: share(self.touched, self.faces),
        })
    }

    fn add(&mut self, cell: Cell, evidence: Evidence, map: &Map) {
        let sigma_m = 0.01 * f64::from(evidence.sigma_cm);
        self.cells += 1;
        self.driven += u32::from(evidence.has(Flag::Body));
        self.square_m2 += sigma_m * sigma_m;
        for obstacle in SIDES
            .into_iter()
            .filter_map(|(x, y)| obstacle_beside(map, cell, x, y))
        {
            self.faces += 1;
            self.touched += u32::from(is_touched_only(map.home.grid.at(obstacle)));
        }
    }
}

/// Offsets of the four sides.
const SIDES: [(i32, i32); 4] = [(-1, 0), (1, 0), (0, -1), (0, 1)];

/// The obstacle at a side of a floor cell. A cell between may be unknown, because the body is drawn a little smaller than it is.
fn obstacle_beside(map: &Map, cell: Cell, x: i32, y: i32) -> Option<Cell> {
    let known = |cell: &Cell| map.knowledge().get(*cell).copied().unwrap_or_default();
    [1, 2]
        .map(|steps| Cell {
            x: cell.x + steps * x,
            y: cell.y + steps * y,
        })
        .into_iter()
        .find(|beside| known(beside) != CellKnowledge::Unknown)
        .filter(|beside| known(beside) == CellKnowledge::Occupied)
}

impl Map {
    /// Confidence of the whole map; `None` without known floor. It visits all cells, so it is for display only.
    #[must_use]
    pub fn confidence(&self) -> Option<MapConfidence> {
        let mut count = Count::default();
        self.floor()
            .for_each(|(cell, evidence)| count.add(cell, evidence, self));
        count.confidence()
    }

    /// Confidence of each room, by identity.
    #[must_use]
    pub fn room_confidence(&self) -> Vec<(u16, MapConfidence)> {
        let mut counts: BTreeMap<u16, Count> = BTreeMap::new();
        let labels = self.rooms().labels();
        for (cell, evidence) in self.floor() {
            if let Some(room) = labels.get(cell).filter(|room| **room != 0) {
                counts.entry(*room).or_default().add(cell, evidence, self);
            }
        }
        let sure = |(room, count): (u16, Count)| Some((room, count.confidence()?));
        counts.into_iter().filter_map(sure).collect()
    }

    /// Floor cells and their evidence.
    fn floor(&self) -> impl Iterator<Item = (Cell, Evidence)> + '_ {
        let knowledge = self.knowledge();
        self.home
            .grid
            .gathered()
            .filter(|(cell, _)| knowledge.get(*cell) == Some(&CellKnowledge::Free))
    }
}
