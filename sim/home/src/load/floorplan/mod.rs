//! Our own floor plans in TOML; `homes/README.md` is the reference of the format.

mod check;
mod draw;
mod raw;

use std::path::Path;

use super::{DockWish, Draft, HomeError, MARGIN_CELLS, WalkerWish, check_cells, stem};
use crate::plan::{Cell, Grid, SurfaceMap, WalkerKind};
use crate::pose::Pose;
use check::Check;
use draw::FloorplanPainter;
use raw::{RawDock, RawPlan, RawWalkerKind};

pub(crate) fn read(path: &Path, text: &str, climb_m: f64) -> Result<Draft, HomeError> {
    let plan: RawPlan = toml::from_str(text).map_err(|error| toml_error(path, text, &error))?;
    let check = Check { path };
    check.plan(&plan)?;
    let (mut grid, corner) = blank(path, &plan)?;
    let mut drawing = FloorplanPainter {
        corner,
        grid: &mut grid,
        surfaces: SurfaceMap::hard(),
    };
    drawing.floor(&plan);
    drawing.rugs(&check, &plan.rugs)?;
    drawing.solids(&plan);
    let mut doors = drawing.doors(&plan.doors);
    drawing.furniture(&plan.furniture);
    drawing.steps(&plan.thresholds, climb_m, &mut doors);
    drawing.thresholds(&check, &plan.thresholds, climb_m)?;
    let mirrors = drawing.mirrors(&plan.mirrors);
    doors.extend(drawing.visitors(&plan.visitors));
    let pose = |raw: &RawDock| {
        let (x_m, y_m) = drawing.place(raw.position);
        Pose::new(x_m, y_m, raw.heading_deg * core::f64::consts::PI / 180.0)
    };
    let dock = plan
        .dock
        .as_ref()
        .map_or(DockWish::Anywhere, |dock| DockWish::At(pose(dock)));
    let start = plan.start.as_ref().map(pose);
    let walkers = plan.walkers.iter().map(|walker| WalkerWish {
        kind: match walker.kind {
            RawWalkerKind::Person => WalkerKind::Person,
            RawWalkerKind::Pet => WalkerKind::Pet,
        },
        goals: walker.goals.iter().map(|goal| drawing.place(*goal)).collect(),
        rest_ms: moment_ms(walker.rest_s),
        from_ms: moment_ms(walker.from_s),
        until_ms: moment_ms(walker.until_s),
    });
    let walkers = walkers.collect();
    let surfaces = drawing.surfaces;
    Ok(Draft {
        name: plan.name.unwrap_or_else(|| stem(path)),
        rooms: Some(plan.rooms.len() as u32),
        grid,
        file_from_plan: Pose::new(corner.0, corner.1, 0.0),
        dock,
        surfaces,
        doors,
        mirrors,
        walkers,
        start,
        notices: Vec::new(),
    })
}

fn moment_ms(second: f64) -> u64 {
    (second * 1000.0) as u64
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
