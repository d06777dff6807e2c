//! Our own floor plans in TOML; `homes/README.md` is the reference of the format.

use std::path::Path;

use serde::Deserialize;

use super::raster::{CORNERS_MAX, Canvas};
use super::{CELL_MAX_M, DockWish, Draft, HomeError, MARGIN_CELLS, check_cells, stem};
use crate::plan::{Cell, Door, Grid, Surface, SurfaceMap};
use crate::pose::Pose;

type Point = [f64; 2];

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawPlan {
    format: String,
    version: u32,
    name: Option<String>,
    #[serde(default = "usual_cell_m")]
    cell_m: f64,
    #[serde(default, rename = "room")]
    rooms: Vec<RawRoom>,
    #[serde(default, rename = "wall")]
    walls: Vec<RawWall>,
    #[serde(default, rename = "door")]
    doors: Vec<RawDoor>,
    #[serde(default)]
    furniture: Vec<RawFurniture>,
    #[serde(default, rename = "rug")]
    rugs: Vec<RawRug>,
    #[serde(default, rename = "threshold")]
    thresholds: Vec<RawThreshold>,
    #[serde(default, rename = "cliff")]
    cliffs: Vec<RawRoom>,
    dock: Option<RawDock>,
}

fn usual_cell_m() -> f64 {
    0.02
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawRoom {
    #[expect(
        dead_code,
        reason = "for people who read the file; the simulator needs no names of rooms"
    )]
    name: Option<String>,
    polygon: Vec<Point>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawWall {
    from: Point,
    to: Point,
    #[serde(default = "usual_wall_m")]
    thickness_m: f64,
}

fn usual_wall_m() -> f64 {
    0.1
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum DoorState {
    Open,
    Closed,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawDoor {
    from: Point,
    to: Point,
    #[serde(default = "usual_door_m")]
    thickness_m: f64,
    state: DoorState,
    #[serde(default)]
    schedule: Vec<RawDoorEvent>,
}

fn usual_door_m() -> f64 {
    0.12
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawDoorEvent {
    at_s: f64,
    state: DoorState,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawFurniture {
    #[expect(dead_code, reason = "for people who read the file")]
    name: Option<String>,
    polygon: Option<Vec<Point>>,
    #[serde(default)]
    legs: Vec<Point>,
    #[serde(default = "usual_leg_m")]
    leg_diameter_m: f64,
}

fn usual_leg_m() -> f64 {
    0.05
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawRug {
    polygon: Vec<Point>,
    #[serde(default = "usual_drag_n")]
    drag_n: f64,
    #[serde(default = "usual_slip")]
    slip: f64,
    #[serde(default)]
    bias_deg_per_m: f64,
}

fn usual_drag_n() -> f64 {
    1.0
}

fn usual_slip() -> f64 {
    0.02
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawThreshold {
    from: Point,
    to: Point,
    width_m: f64,
    height_m: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawDock {
    position: Point,
    heading_deg: f64,
}

/// Farthest coordinate, metres.
const COORDINATE_MAX_M: f64 = 1_000.0;
/// Most things of one kind.
const THINGS_MAX: usize = 2_000;
/// Most legs of one piece.
const LEGS_MAX: usize = 64;
/// Force that a wheel needs for each metre of a threshold's height, newton per metre.
const THRESHOLD_DRAG_N_PER_M: f64 = 250.0;
/// Slip on the edge of a threshold.
const THRESHOLD_SLIP: f64 = 0.05;

pub(crate) fn read(path: &Path, text: &str, climb_m: f64) -> Result<Draft, HomeError> {
    let plan: RawPlan = toml::from_str(text).map_err(|error| toml_error(path, text, &error))?;
    let check = Check { path };
    check.plan(&plan)?;
    let (mut grid, corner) = blank(path, &plan)?;
    let mut drawing = Drawing {
        corner,
        grid: &mut grid,
        surfaces: SurfaceMap::hard(),
    };
    drawing.floor(&plan);
    drawing.rugs(&check, &plan.rugs)?;
    drawing.solids(&plan);
    let doors = drawing.doors(&plan.doors);
    drawing.furniture(&plan.furniture);
    drawing.thresholds(&check, &plan.thresholds, climb_m)?;
    let surfaces = drawing.surfaces;
    let dock = plan.dock.as_ref().map_or(DockWish::Anywhere, |dock| {
        DockWish::At(Pose::new(
            dock.position[0] - corner.0,
            dock.position[1] - corner.1,
            dock.heading_deg * core::f64::consts::PI / 180.0,
        ))
    });
    Ok(Draft {
        name: plan.name.unwrap_or_else(|| stem(path)),
        grid,
        file_from_plan: Pose::new(corner.0, corner.1, 0.0),
        dock,
        surfaces,
        doors,
    })
}

fn toml_error(path: &Path, text: &str, error: &toml::de::Error) -> HomeError {
    let line = error
        .span()
        .and_then(|span| text.get(..span.start))
        .map(|before| before.matches('\n').count() + 1);
    HomeError::Invalid {
        path: path.to_owned(),
        place: line.map_or_else(|| "the TOML".to_owned(), |line| format!("line {line}")),
        problem: format!(
            "{}; homes/README.md tells the format",
            error.message().replace('\n', " ")
        ),
    }
}

/// An empty grid around all rooms and drops, and the place of its corner in the file's frame.
fn blank(path: &Path, plan: &RawPlan) -> Result<(Grid, (f64, f64)), HomeError> {
    let points = || {
        plan.rooms
            .iter()
            .chain(&plan.cliffs)
            .flat_map(|room| &room.polygon)
    };
    if plan.rooms.is_empty() {
        return Err(HomeError::NoFloor {
            path: path.to_owned(),
        });
    }
    let bound = |axis: usize, start: f64, pick: fn(f64, f64) -> f64| {
        points().map(|point| point[axis]).fold(start, pick)
    };
    let margin_m = MARGIN_CELLS as f64 * plan.cell_m;
    let corner = (
        bound(0, f64::INFINITY, f64::min) - margin_m,
        bound(1, f64::INFINITY, f64::min) - margin_m,
    );
    let cells = |low: f64, high: f64| libm::ceil((high + margin_m - low) / plan.cell_m - 1e-6) as u64;
    let width = cells(corner.0, bound(0, f64::NEG_INFINITY, f64::max));
    let height = cells(corner.1, bound(1, f64::NEG_INFINITY, f64::max));
    check_cells(path, width, height)?;
    let (width, height) = (width as usize, height as usize);
    let grid = Grid {
        cell_m: plan.cell_m,
        width,
        height,
        cells: vec![Cell::Outside; width * height],
    };
    Ok((grid, corner))
}

/// Draws things given in the file's frame.
struct Drawing<'a> {
    corner: (f64, f64),
    grid: &'a mut Grid,
    surfaces: SurfaceMap,
}

fn solid(cells: &mut [Cell], index: usize) {
    cells[index] = Cell::Obstacle;
}

impl Drawing<'_> {
    fn place(&self, point: Point) -> (f64, f64) {
        (point[0] - self.corner.0, point[1] - self.corner.1)
    }

    fn corners(&self, polygon: &[Point]) -> Vec<(f64, f64)> {
        polygon.iter().map(|point| self.place(*point)).collect()
    }

    fn floor(&mut self, plan: &RawPlan) {
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

    fn rugs(&mut self, check: &Check<'_>, rugs: &[RawRug]) -> Result<(), HomeError> {
        for rug in rugs {
            let surface = Surface {
                drag_n: rug.drag_n,
                slip: rug.slip,
                bias_rad_per_m: rug.bias_deg_per_m * core::f64::consts::PI / 180.0,
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

    fn solids(&mut self, plan: &RawPlan) {
        for wall in &plan.walls {
            let ends = [self.place(wall.from), self.place(wall.to)];
            Canvas::of(self.grid).strip(ends, wall.thickness_m, solid);
        }
    }

    /// Cuts each door out of its wall and hangs the leaf into it.
    fn doors(&mut self, doors: &[RawDoor]) -> Vec<Door> {
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

    fn furniture(&mut self, furniture: &[RawFurniture]) {
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

    fn thresholds(
        &mut self,
        check: &Check<'_>,
        thresholds: &[RawThreshold],
        climb_m: f64,
    ) -> Result<(), HomeError> {
        for threshold in thresholds {
            let ends = [self.place(threshold.from), self.place(threshold.to)];
            if threshold.height_m > climb_m {
                Canvas::of(self.grid).strip(ends, threshold.width_m, solid);
                continue;
            }
            let surface = Surface {
                drag_n: threshold.height_m * THRESHOLD_DRAG_N_PER_M,
                slip: THRESHOLD_SLIP,
                bias_rad_per_m: 0.0,
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

/// Complains with the file's name.
struct Check<'a> {
    path: &'a Path,
}

impl Check<'_> {
    fn invalid(&self, place: &str, problem: String) -> HomeError {
        HomeError::Invalid {
            path: self.path.to_owned(),
            place: place.to_owned(),
            problem,
        }
    }

    fn plan(&self, plan: &RawPlan) -> Result<(), HomeError> {
        if plan.format != "librervac-home" || plan.version != 1 {
            let problem = format!(
                "format `{}` version {} is not known; `librervac-home` version 1 is",
                plan.format, plan.version
            );
            return Err(self.invalid("`format`", problem));
        }
        self.size("`cell-m`", plan.cell_m, 0.01..=CELL_MAX_M)?;
        self.amounts(plan)?;
        for (index, room) in plan.rooms.iter().enumerate() {
            self.polygon(&format!("`room` {}", index + 1), &room.polygon)?;
        }
        for (index, cliff) in plan.cliffs.iter().enumerate() {
            self.polygon(&format!("`cliff` {}", index + 1), &cliff.polygon)?;
        }
        for (index, wall) in plan.walls.iter().enumerate() {
            let place = format!("`wall` {}", index + 1);
            self.points(&place, &[wall.from, wall.to])?;
            self.size(&place, wall.thickness_m, 0.01..=2.0)?;
        }
        for (index, door) in plan.doors.iter().enumerate() {
            self.door(&format!("`door` {}", index + 1), door)?;
        }
        for (index, piece) in plan.furniture.iter().enumerate() {
            self.piece(&format!("`furniture` {}", index + 1), piece)?;
        }
        self.surfaces(plan)?;
        if let Some(dock) = &plan.dock {
            self.points("`dock`", &[dock.position])?;
            self.size("`dock`", dock.heading_deg, -360.0..=360.0)?;
        }
        Ok(())
    }

    fn amounts(&self, plan: &RawPlan) -> Result<(), HomeError> {
        let counts = [
            ("`room`", plan.rooms.len()),
            ("`wall`", plan.walls.len()),
            ("`door`", plan.doors.len()),
            ("`furniture`", plan.furniture.len()),
            ("`rug`", plan.rugs.len()),
            ("`threshold`", plan.thresholds.len()),
            ("`cliff`", plan.cliffs.len()),
        ];
        match counts.iter().find(|(_, count)| *count > THINGS_MAX) {
            Some((place, count)) => Err(self.invalid(
                place,
                format!("there are {count}, at most {THINGS_MAX} are supported"),
            )),
            None => Ok(()),
        }
    }

    fn door(&self, place: &str, door: &RawDoor) -> Result<(), HomeError> {
        self.points(place, &[door.from, door.to])?;
        self.size(place, door.thickness_m, 0.01..=2.0)?;
        for event in &door.schedule {
            self.size(place, event.at_s, 0.0..=1e7)?;
        }
        if door.schedule.len() > THINGS_MAX
            || door.schedule.windows(2).any(|pair| pair[0].at_s >= pair[1].at_s)
        {
            return Err(self.invalid(
                place,
                "`schedule` must be short and its `at-s` must rise".to_owned(),
            ));
        }
        Ok(())
    }

    fn piece(&self, place: &str, piece: &RawFurniture) -> Result<(), HomeError> {
        match &piece.polygon {
            Some(polygon) => self.polygon(place, polygon)?,
            None if piece.legs.is_empty() => {
                return Err(self.invalid(place, "it has neither `polygon` nor `legs`".to_owned()));
            }
            None => {}
        }
        if piece.legs.len() > LEGS_MAX {
            return Err(self.invalid(place, format!("it has more than {LEGS_MAX} legs")));
        }
        self.points(place, &piece.legs)?;
        self.size(place, piece.leg_diameter_m, 0.005..=1.0)
    }

    fn surfaces(&self, plan: &RawPlan) -> Result<(), HomeError> {
        for (index, rug) in plan.rugs.iter().enumerate() {
            let place = format!("`rug` {}", index + 1);
            self.polygon(&place, &rug.polygon)?;
            self.size(&place, rug.drag_n, 0.0..=20.0)?;
            self.size(&place, rug.slip, 0.0..=0.5)?;
            self.size(&place, rug.bias_deg_per_m, -45.0..=45.0)?;
        }
        for (index, threshold) in plan.thresholds.iter().enumerate() {
            let place = format!("`threshold` {}", index + 1);
            self.points(&place, &[threshold.from, threshold.to])?;
            self.size(&place, threshold.width_m, 0.005..=1.0)?;
            self.size(&place, threshold.height_m, 0.0..=0.5)?;
        }
        Ok(())
    }

    fn polygon(&self, place: &str, polygon: &[Point]) -> Result<(), HomeError> {
        if !(3..=CORNERS_MAX).contains(&polygon.len()) {
            let problem = format!(
                "a polygon needs 3 to {CORNERS_MAX} corners, not {}",
                polygon.len()
            );
            return Err(self.invalid(place, problem));
        }
        self.points(place, polygon)
    }

    fn points(&self, place: &str, points: &[Point]) -> Result<(), HomeError> {
        let far = |value: &f64| !value.is_finite() || value.abs() > COORDINATE_MAX_M;
        match points.iter().flatten().find(|value| far(value)) {
            Some(value) => Err(self.invalid(
                place,
                format!("the coordinate {value} is not within {COORDINATE_MAX_M} m"),
            )),
            None => Ok(()),
        }
    }

    fn size(&self, place: &str, value: f64, range: core::ops::RangeInclusive<f64>) -> Result<(), HomeError> {
        if range.contains(&value) {
            Ok(())
        } else {
            let (low, high) = (range.start(), range.end());
            Err(self.invalid(place, format!("{value} must lie within {low} to {high}")))
        }
    }
}
