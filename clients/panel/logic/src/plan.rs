//! A floor plan as a picture: that of a simulated home, or the robot's map.

use rvac_api::{Pose, SimulatedPlan};

use crate::Bounds;
use crate::home::{CARPET, CHOSEN, NO_GO, ROOM, ROOM_TINTS};

/// Cells that a plan may have: 4096 by 4096, which every WebGL2 takes as a texture.
const SIDE_MAX: u32 = 4096;

/// Not known, and beside known floor.
const UNSURE: u32 = 7;
/// How far such cells are marked.
const UNSURE_CELLS: usize = 3;

/// Colours of the kinds of cells, red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanPalette {
    /// Floor.
    pub floor: [u8; 3],
    /// Walls and furniture.
    pub obstacle: [u8; 3],
    /// A drop.
    pub cliff: [u8; 3],
    /// A rug.
    pub rug: [u8; 3],
    /// What is not known, where it begins beside floor that is.
    pub unsure: [u8; 3],
    /// Floor that must not be entered.
    pub no_go: [u8; 3],
    /// Floor of rooms that a person has chosen.
    pub chosen: [u8; 3],
    /// Floor of rooms, in turn.
    pub rooms: [[u8; 3]; ROOM_TINTS as usize],
}

impl PlanPalette {
    /// The colour of floor where carpet lies on it: a sixth nearer to that of furniture.
    pub(crate) fn carpeted(self, floor: [u8; 3]) -> [u8; 3] {
        core::array::from_fn(|part| {
            let [floor, obstacle] = [floor, self.obstacle].map(|colour| u16::from(colour[part]));
            ((5 * floor + obstacle) / 6) as u8
        })
    }

    /// Red, green, blue and opacity of a kind of cell; what is outside or unknown is transparent.
    fn pixel(self, kind: u32) -> [u8; 4] {
        if kind >= CARPET {
            let [red, green, blue, opacity] = self.pixel(kind - CARPET);
            let [red, green, blue] = self.carpeted([red, green, blue]);
            return [red, green, blue, opacity];
        }
        let [red, green, blue] = match kind {
            UNSURE => self.unsure,
            1 => self.floor,
            2 => self.obstacle,
            3 => self.cliff,
            4 => self.rug,
            NO_GO => self.no_go,
            CHOSEN => self.chosen,
            _ => match kind
                .checked_sub(ROOM)
                .and_then(|room| self.rooms.get(room as usize))
            {
                Some(tint) => *tint,
                None => return [0; 4],
            },
        };
        [red, green, blue, 255]
    }
}

/// Calls `each` with the index of the first cell, the number of cells and the kind of each run that lies in the plan.
fn runs(plan: &SimulatedPlan, mut each: impl FnMut(usize, usize, u32)) {
    let total = plan.width as usize * plan.height as usize;
    let mut at = 0;
    for run in plan.cells.chunks_exact(2) {
        let &[kind, length] = run else { continue };
        let length = (length as usize).min(total - at);
        each(at, length, kind);
        at += length;
    }
}

/// Thickness of the outline in cells.
const OUTLINE: usize = 2;

/// The plan with a wall around it: cells outside within two cells of floor or furniture become obstacles. Furniture against the
/// border of a home is outside of it, and a home without walls is hard to read.
#[must_use]
pub fn outlined(plan: &SimulatedPlan) -> SimulatedPlan {
    let grown = 2 * OUTLINE as u32;
    if plan.width == 0 || plan.height == 0 || plan.width > SIDE_MAX - grown || plan.height > SIDE_MAX - grown
    {
        return plan.clone();
    }
    let (width, height) = (plan.width + grown, plan.height + grown);
    let mut cells = vec![0; width as usize * height as usize];
    let old_width = plan.width as usize;
    runs(plan, |first, length, kind| {
        for at in first..first + length {
            let place = (at / old_width + OUTLINE) * width as usize + at % old_width + OUTLINE;
            if let Some(cell) = cells.get_mut(place) {
                *cell = kind;
            }
        }
    });
    let walls = wall_cells(&cells, width as usize);
    for place in walls {
        if let Some(cell) = cells.get_mut(place) {
            *cell = 2;
        }
    }
    let margin = OUTLINE as f64 * plan.cell_m;
    let (x, y) = placed(&plan.origin, -margin, -margin);
    let origin = Pose { x, y, ..plan.origin };
    SimulatedPlan {
        name: plan.name.clone(),
        width,
        height,
        origin,
        cells: cells.into_iter().flat_map(|kind| [kind, 1]).collect(),
        ..*plan
    }
}

/// Places of outside cells near a cell that is neither outside nor a drop.
fn wall_cells(cells: &[u32], width: usize) -> Vec<usize> {
    let inside = |place: usize| matches!(cells.get(place), Some(1 | 2 | 4));
    let near = |place: usize| {
        let (row, column) = (place / width, place % width);
        let rows = row.saturating_sub(OUTLINE)..=row + OUTLINE;
        let mut neighbours = rows.flat_map(|row| {
            let columns = column.saturating_sub(OUTLINE)..=(column + OUTLINE).min(width - 1);
            columns.map(move |column| row * width + column)
        });
        neighbours.any(inside)
    };
    (0..cells.len())
        .filter(|&place| cells.get(place) == Some(&0) && near(place))
        .collect()
}

/// The kind of each cell, row by row from the lowest y; none when the plan is too large to be shown.
pub(crate) fn kinds(plan: &SimulatedPlan) -> Option<Vec<u32>> {
    if plan.width == 0 || plan.height == 0 || plan.width > SIDE_MAX || plan.height > SIDE_MAX {
        return None;
    }
    let mut cells = vec![0; plan.width as usize * plan.height as usize];
    runs(plan, |first, length, kind| {
        if let Some(run) = cells.get_mut(first..first + length) {
            run.fill(kind);
        }
    });
    Some(cells)
}

/// Cells that are not known and touch known floor become [`UNSURE`], as far as [`UNSURE_CELLS`] go along row or column: there the
/// robot does not know how the home goes on. The true plan of a home has a wall everywhere, and no such cells.
fn mark_unsure(cells: &mut [u32], width: usize) {
    let is_floor = |kind: u32| kind == 1 || kind == CHOSEN || kind >= ROOM;
    let places: Vec<usize> = (0..cells.len())
        .filter(|place| cells.get(*place).is_some_and(|kind| is_floor(*kind)))
        .collect();
    for place in places {
        let column = place % width;
        let reach =
            |steps: usize, step: isize| (1..=steps).map(move |n| place.checked_add_signed(step * n as isize));
        let aside = [
            (column.min(UNSURE_CELLS), -1),
            ((width - 1 - column).min(UNSURE_CELLS), 1),
            (UNSURE_CELLS, -(width as isize)),
            (UNSURE_CELLS, width as isize),
        ];
        for (steps, step) in aside {
            for beside in reach(steps, step).map_while(|beside| beside) {
                match cells.get_mut(beside) {
                    Some(kind) if *kind == 0 || *kind == UNSURE => *kind = UNSURE,
                    _ => break,
                }
            }
        }
    }
}

/// Four bytes a cell, row by row from the lowest y; none when the plan is too large to be shown.
#[must_use]
pub fn plan_pixels(plan: &SimulatedPlan, palette: PlanPalette) -> Option<Vec<u8>> {
    let mut cells = kinds(plan)?;
    mark_unsure(&mut cells, plan.width as usize);
    Some(cells.into_iter().flat_map(|kind| palette.pixel(kind)).collect())
}

/// The smallest rectangle of the map that holds all cells which are not outside.
#[must_use]
pub fn plan_bounds(plan: &SimulatedPlan) -> Option<Bounds> {
    if plan.width == 0 {
        return None;
    }
    let width = plan.width as usize;
    let mut columns = (usize::MAX, 0);
    let mut rows = (usize::MAX, 0);
    runs(plan, |first, length, kind| {
        if kind == 0 || length == 0 {
            return;
        }
        let last = first + length - 1;
        rows = (rows.0.min(first / width), rows.1.max(last / width + 1));
        let wraps = first / width != last / width;
        let (left, right) = if wraps {
            (0, width)
        } else {
            (first % width, last % width + 1)
        };
        columns = (columns.0.min(left), columns.1.max(right));
    });
    if columns.1 == 0 {
        return None;
    }
    let corner = |column: usize, row: usize| {
        let (x, y) = placed(
            &plan.origin,
            column as f64 * plan.cell_m,
            row as f64 * plan.cell_m,
        );
        Bounds::around(x, y, 0.0)
    };
    let bounds = corner(columns.0, rows.0).with(corner(columns.1, rows.0));
    Some(
        bounds
            .with(corner(columns.0, rows.1))
            .with(corner(columns.1, rows.1)),
    )
}

/// The point of the map at `(x, y)` in the frame of `origin`.
fn placed(origin: &Pose, x: f64, y: f64) -> (f64, f64) {
    let (sin, cos) = origin.heading.sin_cos();
    (origin.x + x * cos - y * sin, origin.y + x * sin + y * cos)
}

#[cfg(test)]
mod tests {
    use super::{PlanPalette, outlined, plan_bounds, plan_pixels};
    use rvac_api::{Pose, SimulatedPlan};

    const PALETTE: PlanPalette = PlanPalette {
        floor: [1, 1, 1],
        obstacle: [2, 2, 2],
        cliff: [3, 3, 3],
        rug: [4, 4, 4],
        no_go: [5, 5, 5],
        chosen: [7, 7, 7],
        unsure: [8, 8, 8],
        rooms: [[6, 6, 6]; 6],
    };

    fn plan(cells: Vec<u32>) -> SimulatedPlan {
        let origin = Pose {
            x: 10.0,
            y: 20.0,
            heading: 0.0,
            t: 0.0,
        };
        SimulatedPlan {
            name: "x".to_owned(),
            cell_m: 0.5,
            width: 4,
            height: 3,
            origin,
            cells,
            dock: None,
        }
    }

    #[test]
    fn what_is_not_known_is_marked_where_it_touches_floor() {
        // Not known, not known, floor, obstacle; obstacle, three not known; four not known.
        let pixels = plan_pixels(&plan(vec![0, 2, 1, 1, 2, 1, 2, 1, 0, 7]), PALETTE).unwrap();
        let reds: Vec<u8> = pixels.chunks_exact(4).map(|pixel| pixel[0]).collect();
        assert_eq!(reds, [8, 8, 1, 2, 2, 0, 8, 0, 0, 0, 8, 0]);
    }

    #[test]
    fn cells_become_pixels() {
        let pixels = plan_pixels(&plan(vec![0, 5, 1, 2, 2, 1, 9, 4]), PALETTE).unwrap();
        let reds: Vec<u8> = pixels.chunks_exact(4).map(|pixel| pixel[0]).collect();
        assert_eq!(reds, [0, 8, 8, 0, 8, 1, 1, 2, 0, 0, 0, 0]);
        assert_eq!(pixels[5 * 4 + 3], 255);
        assert_eq!(pixels[3], 0);
        let pixels = plan_pixels(&plan(vec![5, 1, 16, 1, 21, 1, 22, 9]), PALETTE).unwrap();
        let reds: Vec<u8> = pixels.chunks_exact(4).map(|pixel| pixel[0]).take(4).collect();
        assert_eq!(reds, [5, 6, 6, 0], "no-go, rooms, and a room without a tint");
    }

    #[test]
    fn too_many_too_few_and_odd_cells_do_no_harm() {
        for cells in [vec![], vec![1], vec![1, u32::MAX, 2, u32::MAX], vec![1, 3]] {
            assert_eq!(plan_pixels(&plan(cells), PALETTE).unwrap().len(), 48);
        }
        let huge = SimulatedPlan {
            width: 1 << 20,
            ..plan(vec![])
        };
        assert_eq!(plan_pixels(&huge, PALETTE), None);
    }

    #[test]
    fn a_wall_goes_around_but_not_along_a_drop() {
        let plan = outlined(&plan(vec![1, 12]));
        assert_eq!((plan.width, plan.height), (8, 7));
        assert_eq!((plan.origin.x, plan.origin.y), (9.0, 19.0));
        let pixels = plan_pixels(&plan, PALETTE).unwrap();
        let count = |kind: u8| pixels.chunks_exact(4).filter(|pixel| pixel[0] == kind).count();
        assert_eq!((count(1), count(2), count(0)), (12, 56 - 12, 0));
        let drop = outlined(&super::tests::plan(vec![3, 12]));
        let pixels = plan_pixels(&drop, PALETTE).unwrap();
        assert_eq!(pixels.chunks_exact(4).filter(|pixel| pixel[0] == 2).count(), 0);
    }

    #[test]
    fn bounds_leave_out_what_is_outside() {
        let bounds = plan_bounds(&plan(vec![0, 5, 1, 2, 0, 5])).unwrap();
        assert_eq!((bounds.x_min, bounds.x_max), (10.5, 11.5));
        assert_eq!((bounds.y_min, bounds.y_max), (20.5, 21.0));
        assert_eq!(plan_bounds(&plan(vec![0, 12])), None);
    }

    #[test]
    fn a_turned_plan_is_bounded_too() {
        let mut turned = plan(vec![1, 12]);
        turned.origin.heading = std::f64::consts::FRAC_PI_2;
        let bounds = plan_bounds(&turned).unwrap();
        assert!((bounds.x_min - 8.5).abs() < 1e-9 && (bounds.x_max - 10.0).abs() < 1e-9);
        assert!((bounds.y_min - 20.0).abs() < 1e-9 && (bounds.y_max - 22.0).abs() < 1e-9);
    }
}
