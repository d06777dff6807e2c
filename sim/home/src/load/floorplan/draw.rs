//! Draws the things of a home TOML into the grid.

use super::check::Check;
use super::raw::{DoorState, RawDoor, RawFurniture, RawPlan, RawRug, RawThreshold, RawVisitor, RawWall};
use crate::load::HomeError;
use crate::load::raster::Canvas;
use crate::plan::{Cell, Door, Grid, Surface, SurfaceMap};
use crate::point::Point;

/// Force that a wheel needs for each metre of a threshold's height, newton per metre.
const THRESHOLD_DRAG_N_PER_M: f64 = 250.0;
/// Slip on the edge of a threshold.
const THRESHOLD_SLIP: f64 = 0.05;

/// Draws things given in the file's frame.
pub(super) struct FloorplanPainter<'a> {
    pub(super) corner: (f64, f64),
    pub(super) grid: &'a mut Grid,
    pub(super) surfaces: SurfaceMap,
}

fn solid(cells: &mut [Cell], index: usize) {
    cells[index] = Cell::Obstacle;
}

impl FloorplanPainter<'_> {
    pub(super) fn place(&self, point: Point) -> (f64, f64) {
        (point[0] - self.corner.0, point[1] - self.corner.1)
    }

    fn corners(&self, polygon: &[Point]) -> Vec<(f64, f64)> {
        polygon.iter().map(|point| self.place(*point)).collect()
    }

    pub(super) fn floor(&mut self, plan: &RawPlan) {
        for (rooms, cell) in [(&plan.rooms, Cell::Floor), (&plan.cliffs, Cell::Cliff)] {
            for room in rooms {
                let corners = self.corners(&room.polygon);
                Canvas::of(self.grid).polygon(&corners, |cells, index| cells[index] = cell);
            }
        }
    }

    fn kind(&mut self, check: &Check<'_>, place: &str, surface: Surface) -> Result<u8, HomeError> {
        self.surfaces
            .add_kind(surface, self.grid.cells.len())
            .ok_or_else(|| check.invalid(place, "there are more than 254 rugs and thresholds".to_owned()))
    }

    pub(super) fn rugs(&mut self, check: &Check<'_>, rugs: &[RawRug]) -> Result<(), HomeError> {
        for rug in rugs {
            let surface = Surface {
                drag_n: rug.drag_n,
                slip: rug.slip,
                bias_rad_per_m: rug.bias_deg_per_m * core::f64::consts::PI / 180.0,
                black: rug.black,
                brush_load: Surface::brush_load_of_rug(rug.drag_n),
            };
            let kind = self.kind(check, "`rug`", surface)?;
            let corners = self.corners(&rug.polygon);
            let surfaces = &mut self.surfaces;
            Canvas::of(self.grid).polygon(&corners, |cells, index| {
                if cells[index].is_floor() {
                    cells[index] = Cell::Rug;
                    surfaces.lay(index, kind);
                }
            });
        }
        Ok(())
    }

    pub(super) fn solids(&mut self, plan: &RawPlan) {
        for wall in &plan.walls {
            let ends = [self.place(wall.from), self.place(wall.to)];
            Canvas::of(self.grid).strip(ends, wall.thickness_m, solid);
        }
    }

    /// Cuts each door out of its wall and hangs the leaf into it.
    pub(super) fn doors(&mut self, doors: &[RawDoor]) -> Vec<Door> {
        doors.iter().map(|door| self.door(door)).collect()
    }

    fn door(&mut self, raw: &RawDoor) -> Door {
        let ends = [self.place(raw.from), self.place(raw.to)];
        let open = raw.state == DoorState::Open;
        let mut leaf = Vec::new();
        Canvas::of(self.grid).strip(ends, raw.thickness_m, |cells, index| {
            let behind = if cells[index].is_solid() {
                Cell::Floor
            } else {
                cells[index]
            };
            leaf.push((index, behind));
            cells[index] = if open { behind } else { Cell::Obstacle };
        });
        Door {
            cells: leaf,
            open,
            schedule: raw
                .schedule
                .iter()
                .map(|event| ((event.at_s * 1000.0) as u64, event.state == DoorState::Open))
                .collect(),
        }
    }

    /// For each cell whether it belongs to a mirror; nothing when there is no mirror.
    pub(super) fn mirrors(&mut self, mirrors: &[RawWall]) -> Vec<bool> {
        if mirrors.is_empty() {
            return Vec::new();
        }
        let mut marked = vec![false; self.grid.cells.len()];
        for mirror in mirrors {
            let ends = [self.place(mirror.from), self.place(mirror.to)];
            Canvas::of(self.grid).strip(ends, mirror.thickness_m, |_, index| marked[index] = true);
        }
        marked
    }

    /// A person who blocks the path is like a door that closes for a while, and waits until the robot has left the
    /// place.
    pub(super) fn visitors(&mut self, visitors: &[RawVisitor]) -> Vec<Door> {
        visitors.iter().map(|visitor| self.visitor(visitor)).collect()
    }

    fn visitor(&mut self, visitor: &RawVisitor) -> Door {
        let mut cells = Vec::new();
        let centre = self.place(visitor.position);
        Canvas::of(self.grid).disc(centre, 0.5 * visitor.diameter_m, |plan, index| {
            if plan[index].is_floor() {
                cells.push((index, plan[index]));
            }
        });
        let moment_ms = |second: f64| (second * 1000.0) as u64;
        Door {
            cells,
            open: true,
            schedule: vec![
                (moment_ms(visitor.from_s), false),
                (moment_ms(visitor.until_s), true),
            ],
        }
    }

    pub(super) fn furniture(&mut self, furniture: &[RawFurniture]) {
        for piece in furniture {
            if let Some(polygon) = &piece.polygon {
                let corners = self.corners(polygon);
                Canvas::of(self.grid).polygon(&corners, solid);
            }
            for leg in &piece.legs {
                let centre = self.place(*leg);
                Canvas::of(self.grid).disc(centre, 0.5 * piece.leg_diameter_m, solid);
            }
        }
    }

    /// Thresholds that are too high for the robot: a wall, also in an open door.
    pub(super) fn steps(&mut self, thresholds: &[RawThreshold], climb_m: f64, doors: &mut [Door]) {
        for threshold in thresholds.iter().filter(|threshold| threshold.height_m > climb_m) {
            let ends = [self.place(threshold.from), self.place(threshold.to)];
            Canvas::of(self.grid).strip(ends, threshold.width_m, |cells, index| {
                solid(cells, index);
                let leaves = doors.iter_mut().flat_map(|door| &mut door.cells);
                for (_, behind) in leaves.filter(|(cell, _)| *cell == index) {
                    *behind = Cell::Obstacle;
                }
            });
        }
    }

    /// Thresholds that the robot climbs; for the others see [`Self::steps`].
    pub(super) fn thresholds(
        &mut self,
        check: &Check<'_>,
        thresholds: &[RawThreshold],
        climb_m: f64,
    ) -> Result<(), HomeError> {
        for threshold in thresholds
            .iter()
            .filter(|threshold| threshold.height_m <= climb_m)
        {
            let ends = [self.place(threshold.from), self.place(threshold.to)];
            let surface = Surface {
                drag_n: threshold.height_m * THRESHOLD_DRAG_N_PER_M,
                slip: THRESHOLD_SLIP,
                bias_rad_per_m: 0.0,
                black: false,
                // A smooth strip has no pile.
                brush_load: 0.0,
            };
            let kind = self.kind(check, "`threshold`", surface)?;
            let surfaces = &mut self.surfaces;
            Canvas::of(self.grid).strip(ends, threshold.width_m, |cells, index| {
                if cells[index].is_floor() {
                    surfaces.lay(index, kind);
                }
            });
        }
        Ok(())
    }
}
