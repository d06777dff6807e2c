//! The coverage grid: how often each cell was swept and when last, and the swath that paints it.
//!
//! *Pass*: the brush crosses a cell. Another pass begins when the brush returns after some time.

use std::collections::BTreeMap;

use super::cell::{CELL_M, Cell, index};
use super::tile_grid::{Located, TILE_CELLS, TileGrid, TileKey, first_cell, locate};
use crate::model::geometry::{Point2, Pose2};

/// Most tiles of one map: 10,000 square metres. Cells beyond are not stored.
const TILES_MAX: usize = 4096;
/// The swath paints when one of its ends has moved this far.
const BRUSH_STEP_M: f64 = 0.5 * CELL_M;

/// Resolution of the time of the last pass, seconds; with [`TIME_BITS`] it covers over nine hours.
const TICK_S: u32 = 4;
/// Bits of the time in a cell's word; the others count passes.
const TIME_BITS: u32 = 13;
/// Largest time and number of passes.
const TICKS_MAX: u16 = (1 << TIME_BITS) - 1;
const PASSES_MAX: u16 = (1 << (16 - TIME_BITS)) - 1;
/// A brush that returns after this many ticks makes another pass. Turning on the spot and backing off take less.
const AWAY_TICKS: u16 = 4;

/// Adjacent swept cells of one row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SweptRun {
    /// First cell.
    pub start: Cell,
    /// Number of cells to the right, the first included.
    pub length: u32,
}

impl SweptRun {
    /// Whether `cell` is the right neighbour of its last cell.
    fn ends_before(&self, cell: Cell) -> bool {
        self.start.y == cell.y && i64::from(self.start.x) + i64::from(self.length) == i64::from(cell.x)
    }
}

/// How a cell was swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellPasses {
    /// Number of passes, from 1; 7 means 7 or more.
    pub passes: u8,
    /// Time of the last pass, seconds since the job's first sweep, in steps of four seconds; 0 for cells swept before a restart.
    pub last_s: u32,
}

/// Passes of a cell and the time of the last one: 0 = never swept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct CellWord(u16);

impl CellWord {
    fn swept_at(self, tick: u16) -> Self {
        let (passes, before) = (self.passes(), self.0 & TICKS_MAX);
        let is_new = passes == 0 || tick.saturating_sub(before) >= AWAY_TICKS;
        let passes = (passes + u16::from(is_new)).min(PASSES_MAX);
        Self(passes << TIME_BITS | tick.clamp(before, TICKS_MAX))
    }

    fn passes(self) -> u16 {
        self.0 >> TIME_BITS
    }

    fn cell_passes(self) -> Option<CellPasses> {
        (self.0 != 0).then(|| CellPasses {
            passes: self.passes() as u8,
            last_s: u32::from(self.0 & TICKS_MAX) * TICK_S,
        })
    }
}

/// One bit per cell in a `u64` per row, and a word per cell: 9 kB.
#[derive(Clone, Debug)]
struct CoverageTile {
    swept: [u64; TILE_CELLS as usize],
    words: Vec<CellWord>,
}

impl Default for CoverageTile {
    fn default() -> Self {
        Self {
            swept: [0; TILE_CELLS as usize],
            words: vec![CellWord::default(); (TILE_CELLS * TILE_CELLS) as usize],
        }
    }
}

/// The swept cells and their order.
#[derive(Clone, Debug, Default)]
pub(super) struct CoverageGrid {
    tiles: TileGrid<CoverageTile>,
    order: Vec<Cell>,
    /// When the first cell was swept, host time in microseconds; `None` = not yet since a restart.
    begun_us: Option<u64>,
    /// Ticks since then.
    tick: u16,
}

impl CoverageGrid {
    /// Sets the time of all later painting.
    pub(super) fn set_time(&mut self, time_us: u64) {
        let begun_us = *self.begun_us.get_or_insert(time_us);
        let ticks = time_us.saturating_sub(begun_us) / (1_000_000 * u64::from(TICK_S));
        self.tick = u16::try_from(ticks).unwrap_or(TICKS_MAX).min(TICKS_MAX);
    }

    /// [`CellPasses::last_s`] of a cell that is swept now.
    pub(super) fn now_s(&self) -> u32 {
        u32::from(self.tick) * TICK_S
    }

    /// How a cell was swept; `None` = never.
    pub(super) fn cell_passes(&self, cell: Cell) -> Option<CellPasses> {
        let place = locate(cell);
        let tile = self.tiles.get(place.key)?;
        tile.words.get(place.index())?.cell_passes()
    }

    pub(super) fn cells(&self) -> &[Cell] {
        &self.order
    }

    pub(super) fn area_m2(&self) -> f64 {
        self.order.len() as f64 * CELL_M * CELL_M
    }

    pub(super) fn contains(&self, cell: Cell) -> bool {
        let place = locate(cell);
        let tile = self.tiles.get(place.key);
        tile.is_some_and(|tile| tile.swept[place.row] & bit(&place) != 0)
    }

    /// All swept cells as runs, in the order of their rows.
    pub(super) fn runs(&self) -> Vec<SweptRun> {
        let mut rows: BTreeMap<i32, Vec<(TileKey, &CoverageTile)>> = BTreeMap::new();
        for (key, tile) in self.tiles.iter() {
            rows.entry(key.row).or_default().push((key, tile));
        }
        let mut runs = Vec::new();
        for tiles in rows.values() {
            for row in 0..TILE_CELLS {
                for (key, tile) in tiles {
                    let low = first_cell(*key);
                    let start = Cell {
                        y: low.y + row,
                        ..low
                    };
                    add_runs(&mut runs, start, tile.swept[row as usize]);
                }
            }
        }
        runs
    }

    pub(super) fn paint_run(&mut self, run: SweptRun) {
        for offset in 0..i32::try_from(run.length).unwrap_or(i32::MAX) {
            let Some(x) = run.start.x.checked_add(offset) else {
                return;
            };
            self.paint(Cell { x, y: run.start.y });
        }
    }

    fn paint(&mut self, cell: Cell) {
        let place = locate(cell);
        let has_room = self.tiles.len() < TILES_MAX;
        let tile = self
            .tiles
            .place(place.key, || has_room.then(CoverageTile::default));
        let Some(tile) = tile.and_then(|tile| self.tiles.at_mut(tile)) else {
            return;
        };
        if tile.swept[place.row] & bit(&place) == 0 {
            tile.swept[place.row] |= bit(&place);
            self.order.push(cell);
        }
        let word = &mut tile.words[place.index()];
        *word = word.swept_at(self.tick);
    }

    /// Paints the cells whose centres lie in the triangle, borders included.
    fn paint_triangle(&mut self, corners: [Point2; 3]) {
        let [a, b, c] = corners;
        let (low_x, high_x) = extent([a.x_m, b.x_m, c.x_m]);
        let (low_y, high_y) = extent([a.y_m, b.y_m, c.y_m]);
        for y in low_y..=high_y {
            for x in low_x..=high_x {
                let centre = Point2 {
                    x_m: (f64::from(x) + 0.5) * CELL_M,
                    y_m: (f64::from(y) + 0.5) * CELL_M,
                };
                let sides = [side(a, b, centre), side(b, c, centre), side(c, a, centre)];
                if sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0) {
                    self.paint(Cell { x, y });
                }
            }
        }
    }
}

/// Adds the cells of one row of a tile, which begins at `start`. Cells adjacent to the last run extend it.
fn add_runs(runs: &mut Vec<SweptRun>, start: Cell, bits: u64) {
    let mut left = bits;
    while left != 0 {
        let skipped = left.trailing_zeros();
        let length = (left >> skipped).trailing_ones();
        let first = Cell {
            x: start.x + skipped as i32,
            y: start.y,
        };
        match runs.last_mut() {
            Some(run) if run.ends_before(first) => run.length += length,
            _ => runs.push(SweptRun { start: first, length }),
        }
        // In two steps: a run may fill the row, and 64 bits cannot be shifted out at once.
        left = (left >> skipped >> (length - 1) >> 1) << (skipped + length - 1) << 1;
    }
}

/// The bit of a cell in its row.
fn bit(place: &Located) -> u64 {
    1 << place.column
}

fn extent(coordinates_m: [f64; 3]) -> (i32, i32) {
    let [a, b, c] = coordinates_m;
    (index(a.min(b).min(c)), index(a.max(b).max(c)))
}

/// Twice the signed area of the triangle `a`, `b`, `point`: positive when `point` lies left of the line from a to b.
fn side(a: Point2, b: Point2, point: Point2) -> f64 {
    (b.x_m - a.x_m) * (point.y_m - a.y_m) - (b.y_m - a.y_m) * (point.x_m - a.x_m)
}

/// The cleaning bar under the robot: as wide as the swath, perpendicular to the heading, through the centre.
#[derive(Clone, Debug)]
pub(super) struct Swath {
    half_m: f64,
    last: Option<Bar>,
}

#[derive(Clone, Copy, Debug)]
struct Bar {
    left: Point2,
    centre: Point2,
    right: Point2,
}

impl Swath {
    pub(super) fn new(swath_m: f64) -> Self {
        Self {
            half_m: 0.5 * swath_m,
            last: None,
        }
    }

    /// Stops painting; the next sweep starts at the next pose.
    pub(super) fn lift(&mut self) {
        self.last = None;
    }

    /// Paints the area between the last position of the bar and the one at `pose`.
    pub(super) fn sweep_to(&mut self, pose: Pose2, layer: &mut CoverageGrid) {
        let bar = Bar {
            left: pose.transform(Point2 {
                x_m: 0.0,
                y_m: self.half_m,
            }),
            centre: pose.position(),
            right: pose.transform(Point2 {
                x_m: 0.0,
                y_m: -self.half_m,
            }),
        };
        let Some(last) = self.last else {
            self.last = Some(bar);
            return;
        };
        if bar
            .left
            .distance_m(last.left)
            .max(bar.right.distance_m(last.right))
            < BRUSH_STEP_M
        {
            return;
        }
        // Each half is painted separately, because the two bars cross at the centre when the robot turns on the spot.
        for (last_end, end) in [(last.left, bar.left), (last.right, bar.right)] {
            layer.paint_triangle([last.centre, last_end, end]);
            layer.paint_triangle([last.centre, end, bar.centre]);
        }
        self.last = Some(bar);
    }
}

#[cfg(test)]
mod tests {
    use super::{CoverageGrid, Swath, SweptRun};
    use crate::mapping::cell::Cell;
    use crate::model::geometry::Pose2;
    use core::f64::consts::{FRAC_PI_2, PI};

    const SWATH_M: f64 = 0.30;

    /// Sweeps along an arc in steps of 5 mm or 0.02 rad. Returns the painted area.
    fn swept_along(start: Pose2, distance_m: f64, turn_rad: f64) -> f64 {
        let steps = ((distance_m.abs() / 0.005).max(turn_rad.abs() / 0.02)).ceil();
        let mut layer = CoverageGrid::default();
        let mut swath = Swath::new(SWATH_M);
        for step in 0..=steps as u32 {
            let share = f64::from(step) / steps;
            swath.sweep_to(start.after_arc(share * distance_m, share * turn_rad), &mut layer);
        }
        layer.area_m2()
    }

    fn check(start: Pose2, distance_m: f64, turn_rad: f64, area_m2: f64) {
        let painted = swept_along(start, distance_m, turn_rad);
        assert!(
            (painted / area_m2 - 1.0).abs() < 0.02,
            "painted {painted} m2 instead of {area_m2} m2 from {start:?}"
        );
    }

    #[test]
    fn a_straight_line_sweeps_length_times_swath() {
        for heading_rad in [0.0, 0.3, 0.7, FRAC_PI_2, -2.0] {
            check(
                Pose2 {
                    x_m: 0.1,
                    y_m: -0.2,
                    heading_rad,
                },
                3.0,
                0.0,
                3.0 * SWATH_M,
            );
        }
    }

    #[test]
    fn a_quarter_turn_sweeps_the_ring_segment() {
        let radius_m: f64 = 0.8;
        check(
            Pose2::IDENTITY,
            radius_m * FRAC_PI_2,
            FRAC_PI_2,
            FRAC_PI_2 * radius_m * SWATH_M,
        );
    }

    #[test]
    fn a_turn_on_the_spot_sweeps_the_disc() {
        check(
            Pose2 {
                x_m: 0.013,
                y_m: 0.007,
                heading_rad: 0.4,
            },
            0.0,
            2.0 * PI,
            PI * 0.25 * SWATH_M * SWATH_M,
        );
    }

    /// Two cells that a brush crosses at these times in seconds, for `dwell_s` each.
    fn crossed_at(times_s: &[u64], dwell_s: u64) -> CoverageGrid {
        let mut layer = CoverageGrid::default();
        for time_s in times_s {
            for second in 0..=dwell_s {
                layer.set_time((time_s + second) * 1_000_000);
                layer.paint_run(SweptRun {
                    start: Cell { x: -1, y: 70 },
                    length: 2,
                });
            }
        }
        layer
    }

    #[test]
    fn a_pass_counts_when_the_brush_returns_and_not_while_it_stays() {
        let passes = |times_s: &[u64], dwell_s| {
            let layer = crossed_at(times_s, dwell_s);
            assert_eq!(layer.cells().len(), 2, "each cell once");
            assert_eq!(layer.cell_passes(Cell { x: 1, y: 70 }), None);
            let sweeping = layer.cell_passes(Cell { x: -1, y: 70 }).unwrap();
            assert_eq!(layer.cell_passes(Cell { x: 0, y: 70 }), Some(sweeping));
            (sweeping.passes, sweeping.last_s)
        };
        assert_eq!(passes(&[500], 0), (1, 0));
        assert_eq!(passes(&[500], 300), (1, 300), "it stayed there");
        assert_eq!(passes(&[500, 506], 0), (1, 4), "it turned on the spot");
        assert_eq!(passes(&[500, 540, 600], 5), (3, 104));
        let often: Vec<u64> = (0..20).map(|pass| 100 * pass).collect();
        assert_eq!(passes(&often, 0), (7, 1900), "as many as are counted");
        assert_eq!(passes(&[0, 9_000_000], 0), (2, 32_764), "the latest time");
    }

    #[test]
    fn runs_are_the_cells_in_order_joined_where_they_touch() {
        let mut random = crate::model::random::Random::new(4);
        let mut layer = CoverageGrid::default();
        for _ in 0..400 {
            layer.paint_run(SweptRun {
                start: Cell {
                    x: random.between(-150.0, 150.0) as i32,
                    y: random.between(-70.0, 70.0) as i32,
                },
                length: random.between(1.0, 140.0) as u32,
            });
        }
        let mut cells: Vec<Cell> = layer.cells().to_vec();
        cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
        let mut expected: Vec<SweptRun> = Vec::new();
        for cell in cells {
            match expected.last_mut() {
                Some(run) if run.ends_before(cell) => run.length += 1,
                _ => expected.push(SweptRun {
                    start: cell,
                    length: 1,
                }),
            }
        }
        assert_eq!(layer.runs(), expected);
    }

    #[test]
    fn runs_carry_the_layer_over() {
        let mut layer = CoverageGrid::default();
        for run in [
            SweptRun {
                start: Cell { x: -70, y: 3 },
                length: 12,
            },
            SweptRun {
                start: Cell { x: 5, y: -2 },
                length: 1,
            },
        ] {
            layer.paint_run(run);
        }
        let mut copy = CoverageGrid::default();
        for run in layer.runs() {
            copy.paint_run(run);
        }
        assert_eq!(layer.runs(), copy.runs());
        assert_eq!(copy.cells().len(), 13);
        assert!(copy.contains(Cell { x: -59, y: 3 }) && !copy.contains(Cell { x: -58, y: 3 }));
    }
}
