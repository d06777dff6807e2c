//! Valetudo map JSON, versions 1 (plain pixels) and 2 (compressed pixels).

use std::path::Path;

use serde::Deserialize;

use super::raster::{self, Canvas};
use super::{DockWish, Draft, HomeError, check_cells, fit, stem, stray};
use crate::plan::{Cell, Grid, Surface, SurfaceMap};
use crate::pose::Pose;

#[derive(Deserialize)]
struct RawMap {
    #[serde(rename = "__class")]
    class: String,
    #[serde(rename = "metaData", default)]
    meta: RawMeta,
    #[serde(rename = "pixelSize")]
    pixel_cm: f64,
    layers: Vec<RawLayer>,
    #[serde(default)]
    entities: Vec<RawEntity>,
}

#[derive(Default, Deserialize)]
struct RawMeta {
    version: Option<u32>,
}

#[derive(Deserialize)]
struct RawLayer {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    pixels: Vec<u32>,
    #[serde(rename = "compressedPixels", default)]
    compressed: Vec<u32>,
}

#[derive(Deserialize)]
struct RawEntity {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    points: Vec<f64>,
}

/// Consecutive pixels of one row.
struct PixelRun {
    column: u32,
    row: u32,
    count: u32,
}

/// Coordinates beyond this are a mistake: real maps have at most 6,554 pixels a side.
const PIXEL_MAX: u32 = 100_000;

/// A rug as the surface that lidar robots report without its pile height.
const CARPET: Surface = Surface {
    black: false,
    drag_n: 1.0,
    slip: 0.02,
    bias_rad_per_m: 0.005,
    brush_load: Surface::brush_load_of_rug(1.0),
};

pub(crate) fn read(path: &Path, text: &str) -> Result<Draft, HomeError> {
    let map: RawMap = serde_json::from_str(text).map_err(|error| json_error(path, &error))?;
    check_head(path, &map)?;
    let extent = PixelExtent::of(path, &map)?;
    let mut coarse = paint(&map, &extent);
    let notices = stray::leave_out(path, &mut coarse).into_iter().collect();
    let (mut grid, corner_x_m, corner_y_m) = fit(path, &coarse)?;
    let to_plan = |x_cm: f64, y_cm: f64| {
        (
            (x_cm / map.pixel_cm - f64::from(extent.left)) * coarse.cell_m - corner_x_m,
            (f64::from(extent.bottom) + 1.0 - y_cm / map.pixel_cm) * coarse.cell_m - corner_y_m,
        )
    };
    let surfaces = carpets(&map, &mut grid, &to_plan);
    let charger = map
        .entities
        .iter()
        .find(|entity| entity.kind == "charger_location" && entity.points.len() >= 2);
    let dock = match charger {
        Some(entity) => {
            let (x_m, y_m) = to_plan(entity.points[0], entity.points[1]);
            DockWish::Near(x_m, y_m)
        }
        None => DockWish::Anywhere,
    };
    let segments = map.layers.iter().filter(|layer| layer.kind == "segment").count() as u32;
    Ok(Draft {
        name: stem(path),
        rooms: (segments > 0).then_some(segments),
        grid,
        file_from_plan: Pose::new(
            f64::from(extent.left) * coarse.cell_m + corner_x_m,
            -(f64::from(extent.bottom) + 1.0) * coarse.cell_m + corner_y_m,
            0.0,
        ),
        dock,
        surfaces,
        doors: Vec::new(),
        mirrors: Vec::new(),
        walkers: Vec::new(),
        start: None,
        notices,
    })
}

fn check_head(path: &Path, map: &RawMap) -> Result<(), HomeError> {
    let invalid = |place: &str, problem: String| {
        Err(HomeError::Invalid {
            path: path.to_owned(),
            place: place.to_owned(),
            problem,
        })
    };
    if map.class != "ValetudoMap" {
        return invalid("`__class`", format!("`{}` must be `ValetudoMap`", map.class));
    }
    if let Some(version) = map.meta.version.filter(|version| !(1..=2).contains(version)) {
        let problem = format!("{version} is not known; versions 1 and 2 are");
        return invalid("`metaData.version`", problem);
    }
    if !(0.5..=50.0).contains(&map.pixel_cm) {
        let problem = format!("{} must lie between 0.5 and 50 cm", map.pixel_cm);
        return invalid("`pixelSize`", problem);
    }
    Ok(())
}

/// A parser that reaches the end of the text means a truncated file; everything else is a wrong file.
fn json_error(path: &Path, error: &serde_json::Error) -> HomeError {
    let place = format!("line {}, column {}", error.line(), error.column());
    if error.is_eof() {
        return HomeError::Truncated {
            path: path.to_owned(),
            place: format!("the JSON ends in {place}"),
        };
    }
    HomeError::Invalid {
        path: path.to_owned(),
        place,
        problem: format!("{error}; it must be a Valetudo map"),
    }
}

fn runs(layer: &RawLayer) -> impl Iterator<Item = PixelRun> + '_ {
    let plain = layer.pixels.chunks_exact(2).map(|pixel| PixelRun {
        column: pixel[0],
        row: pixel[1],
        count: 1,
    });
    let compressed = layer.compressed.chunks_exact(3).map(|run| PixelRun {
        column: run[0],
        row: run[1],
        count: run[2],
    });
    plain.chain(compressed)
}

fn cell_of(layer: &RawLayer) -> Option<Cell> {
    match layer.kind.as_str() {
        "floor" | "segment" => Some(Cell::Floor),
        "wall" => Some(Cell::Obstacle),
        _ => None,
    }
}

/// Pixels that are used; rows run downward.
struct PixelExtent {
    left: u32,
    right: u32,
    top: u32,
    bottom: u32,
}

impl PixelExtent {
    fn of(path: &Path, map: &RawMap) -> Result<Self, HomeError> {
        let mut extent = Self {
            left: u32::MAX,
            right: 0,
            top: u32::MAX,
            bottom: 0,
        };
        for layer in map.layers.iter().filter(|layer| cell_of(layer).is_some()) {
            for run in runs(layer).filter(|run| run.count > 0) {
                extent.add(path, &run)?;
            }
        }
        if extent.left == u32::MAX {
            return Err(HomeError::NoFloor {
                path: path.to_owned(),
            });
        }
        check_cells(path, extent.width() as u64, extent.height() as u64)?;
        Ok(extent)
    }

    fn add(&mut self, path: &Path, run: &PixelRun) -> Result<(), HomeError> {
        let last = run.column.saturating_add(run.count - 1);
        if last > PIXEL_MAX || run.row > PIXEL_MAX {
            return Err(HomeError::Invalid {
                path: path.to_owned(),
                place: format!("pixel ({}, {})", run.column, run.row),
                problem: format!("its run of {} reaches beyond {PIXEL_MAX}", run.count),
            });
        }
        self.left = self.left.min(run.column);
        self.right = self.right.max(last);
        self.top = self.top.min(run.row);
        self.bottom = self.bottom.max(run.row);
        Ok(())
    }

    fn width(&self) -> usize {
        (self.right - self.left) as usize + 1
    }

    fn height(&self) -> usize {
        (self.bottom - self.top) as usize + 1
    }
}

/// Floor first and walls over it, in any order of the file.
fn paint(map: &RawMap, extent: &PixelExtent) -> Grid {
    let (width, height) = (extent.width(), extent.height());
    let mut cells = vec![Cell::Outside; width * height];
    for wanted in [Cell::Floor, Cell::Obstacle] {
        for layer in map.layers.iter().filter(|layer| cell_of(layer) == Some(wanted)) {
            for run in runs(layer).filter(|run| run.count > 0) {
                let start = (extent.bottom - run.row) as usize * width + (run.column - extent.left) as usize;
                cells[start..start + run.count as usize].fill(wanted);
            }
        }
    }
    Grid {
        cell_m: map.pixel_cm / 100.0,
        width,
        height,
        cells,
    }
}

fn carpets(map: &RawMap, grid: &mut Grid, to_plan: &impl Fn(f64, f64) -> (f64, f64)) -> SurfaceMap {
    let mut surfaces = SurfaceMap::hard();
    let polygons = map
        .entities
        .iter()
        .filter(|entity| entity.kind == "carpet" && entity.points.iter().all(|point| point.is_finite()))
        .take(CARPETS_MAX);
    let Some(kind) = surfaces.add_kind(CARPET, grid.cells.len()) else {
        return surfaces;
    };
    let mut laid = false;
    for entity in polygons {
        let corners: Vec<(f64, f64)> = entity
            .points
            .chunks_exact(2)
            .take(raster::CORNERS_MAX)
            .map(|point| to_plan(point[0], point[1]))
            .collect();
        Canvas::of(grid).polygon(&corners, |cells, index| {
            if cells[index] == Cell::Floor {
                cells[index] = Cell::Rug;
                surfaces.lay(index, kind);
                laid = true;
            }
        });
    }
    if laid { surfaces } else { SurfaceMap::hard() }
}

/// Most carpets that are read.
const CARPETS_MAX: usize = 64;
