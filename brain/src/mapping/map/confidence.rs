//! How sure a map is, for the whole home and for each room.
//!
//! *Face*: the side of a cell of floor on which an obstacle begins.

use std::collections::BTreeMap;

use super::Map;
use crate::mapping::Cell;
use crate::mapping::occupancy_grid::{CellKnowledge, Evidence, Flag, is_touched_only};

/// How sure what is known is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapConfidence {
    /// Standard deviation of the robot's place when it saw the floor best, metres; root of the mean square over its cells.
    pub sigma_m: f64,
    /// Share of the floor on which the robot's body has been, 0..=1; the rest was seen from afar.
    pub driven: f64,
    /// Share of the faces that nothing but a touch has told, 0..=1.
    pub touched: f64,
}

/// What is counted for it.
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

    fn add(&mut self, (cell, evidence): (Cell, Evidence), map: &Map) {
        let sigma_m = 0.01 * f64::from(evidence.sigma_cm);
        self.cells += 1;
        self.driven += u32::from(evidence.has(Flag::Body));
        self.square_m2 += sigma_m * sigma_m;
        for obstacle in SIDES
            .into_iter()
            .filter_map(|side| obstacle_beside(cell, side, map))
        {
            self.faces += 1;
            self.touched += u32::from(is_touched_only(map.home.grid.at(obstacle)));
        }
    }
}

/// Columns and rows to the four sides.
const SIDES: [(i32, i32); 4] = [(-1, 0), (1, 0), (0, -1), (0, 1)];

/// The obstacle that begins on a side of a cell of floor. A cell between may be unknown: the body is drawn a little smaller than
/// it is.
fn obstacle_beside(cell: Cell, (x, y): (i32, i32), map: &Map) -> Option<Cell> {
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
    /// How sure the map of the whole home is; `None` where no floor is known. Looks at all cells: for people who look at it.
    #[must_use]
    pub fn confidence(&self) -> Option<MapConfidence> {
        let mut count = Count::default();
        self.floor().for_each(|floor| count.add(floor, self));
        count.confidence()
    }

    /// The same of each room, by their identities.
    #[must_use]
    pub fn room_confidence(&self) -> Vec<(u16, MapConfidence)> {
        let mut counts: BTreeMap<u16, Count> = BTreeMap::new();
        let labels = self.rooms().labels();
        for floor in self.floor() {
            if let Some(room) = labels.get(floor.0).filter(|room| **room != 0) {
                counts.entry(*room).or_default().add(floor, self);
            }
        }
        let sure = |(room, count): (u16, Count)| Some((room, count.confidence()?));
        counts.into_iter().filter_map(sure).collect()
    }

    /// Cells of floor with what was gathered about them.
    fn floor(&self) -> impl Iterator<Item = (Cell, Evidence)> + '_ {
        let knowledge = self.knowledge();
        self.home
            .grid
            .gathered()
            .filter(|(cell, _)| knowledge.get(*cell) == Some(&CellKnowledge::Free))
    }
}
