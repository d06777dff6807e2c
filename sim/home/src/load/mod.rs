//! Loading of homes: which format it is, and what all formats share.

mod error;
mod floorplan;
mod image;
mod map_yaml;
mod notice;
mod packed;
mod raster;
mod ros;
mod stray;
mod valetudo;

use std::io::Read;
use std::os::unix::fs::FileTypeExt as _;
use std::path::Path;

pub use error::HomeError;
pub(crate) use floorplan::read as read_floorplan;
pub use notice::HomeNotice;

use crate::plan::{Cell, Door, Grid, SurfaceMap, WalkerKind};
use crate::pose::Pose;

/// A plan as read from a file, before anything is derived.
pub(crate) struct Draft {
    pub(crate) name: String,
    /// Rooms that the file names; `None` = it knows none.
    pub(crate) rooms: Option<u32>,
    pub(crate) grid: Grid,
    pub(crate) file_from_plan: Pose,
    pub(crate) dock: DockWish,
    pub(crate) surfaces: SurfaceMap,
    pub(crate) doors: Vec<Door>,
    /// For each cell whether it belongs to a mirror; empty where there is none.
    pub(crate) mirrors: Vec<bool>,
    /// Who walks.
    pub(crate) walkers: Vec<WalkerWish>,
    /// Where the robot starts, if not where it usually does.
    pub(crate) start: Option<Pose>,
    /// What is told before a robot drives in it.
    pub(crate) notices: Vec<HomeNotice>,
}

/// A walker from goal to goal, as read from the file, in the plan frame.
#[derive(Clone, Debug)]
pub(crate) struct WalkerWish {
    pub(crate) kind: WalkerKind,
    pub(crate) goals: Vec<(f64, f64)>,
    pub(crate) rest_ms: u64,
    pub(crate) from_ms: u64,
    pub(crate) until_ms: u64,
}

/// The dock as read from a file, in the plan frame.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DockWish {
    /// Nothing.
    Anywhere,
    /// Its approximate position, metres.
    Near(f64, f64),
    /// Exactly there.
    At(Pose),
}

/// Longest text file: a Valetudo map of a real home has 0.3 MB, a ROS YAML some hundred bytes.
const TEXT_BYTES_MAX: u64 = 16 << 20;
/// Most cells of a prepared plan: 70 x 70 m at 2.5 cm. A loaded home takes about 12 bytes a cell.
const CELLS_MAX: u64 = 8_000_000;
/// Coarsest cell that the simulator drives on, metres.
const CELL_MAX_M: f64 = 0.025;
/// Solid margin that every plan gets, cells.
const MARGIN_CELLS: usize = 3;

/// Reads a file of any format; thresholds higher than `climb_m` become obstacles.
pub(crate) fn read_draft(path: &Path, climb_m: f64) -> Result<Draft, HomeError> {
    let bytes = read_limited(path, TEXT_BYTES_MAX).map_err(|error| match error {
        ReadError::TooLong(bytes) => HomeError::TooLong {
            path: path.to_owned(),
            bytes,
            limit: TEXT_BYTES_MAX,
        },
        ReadError::Io(cause) if cause.kind() == std::io::ErrorKind::NotFound => HomeError::Missing {
            path: path.to_owned(),
        },
        ReadError::Io(cause) => HomeError::Unreadable {
            path: path.to_owned(),
            cause,
        },
    })?;
    let bytes = packed::unpacked(path, &bytes)?;
    let text = text_of(path, &bytes)?;
    match format_of(text) {
        Some(Format::Valetudo) => valetudo::read(path, text),
        Some(Format::Ros) => ros::read(path, text),
        Some(Format::Floorplan) => floorplan::read(path, text, climb_m),
        // Its name says what it should be, so the answer is about its keys.
        None if path
            .extension()
            .is_some_and(|name| name == "yaml" || name == "yml") =>
        {
            ros::read(path, text)
        }
        None => Err(HomeError::UnknownFormat {
            path: path.to_owned(),
            found: "text without the keys of a home".to_owned(),
        }),
    }
}

enum Format {
    Ros,
    Valetudo,
    Floorplan,
}

fn format_of(text: &str) -> Option<Format> {
    if text.trim_start().starts_with('{') {
        // Braces are YAML as well.
        let has = |key: &str| text.contains(key);
        let is_ros = has("resolution") && has("image") && !has("__class");
        return Some(if is_ros { Format::Ros } else { Format::Valetudo });
    }
    let has_line = |start: &str, mark: char| {
        text.lines().any(|line| {
            line.trim_start_matches([' ', '\t', '"', '\''])
                .strip_prefix(start)
                .is_some_and(|rest| rest.trim_start_matches([' ', '\t', '"', '\'']).starts_with(mark))
        })
    };
    if has_line("image", ':') || has_line("resolution", ':') {
        return Some(Format::Ros);
    }
    has_line("format", '=').then_some(Format::Floorplan)
}

fn text_of<'a>(path: &Path, bytes: &'a [u8]) -> Result<&'a str, HomeError> {
    let unknown = |found: &str| {
        Err(HomeError::UnknownFormat {
            path: path.to_owned(),
            found: found.to_owned(),
        })
    };
    if bytes.is_empty() {
        return unknown("an empty file");
    }
    if image::is_image(bytes) {
        return unknown("an image; give the .yaml that belongs to it");
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return unknown("packed with zip; unpack it and give the file that was in it");
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return unknown("not text (byte 0) or text in UTF-16; save it as UTF-8");
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(text),
        Err(error) => unknown(&format!("not text (byte {})", error.valid_up_to())),
    }
}

pub(crate) enum ReadError {
    TooLong(u64),
    Io(std::io::Error),
}

/// Reads a regular file of at most `limit` bytes.
pub(crate) fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>, ReadError> {
    // Opening a pipe waits for whoever writes into it, in silence.
    if std::fs::metadata(path).is_ok_and(|about| about.file_type().is_fifo()) {
        return Err(ReadError::Io(std::io::Error::other("it is a pipe")));
    }
    let file = std::fs::File::open(path).map_err(ReadError::Io)?;
    let metadata = file.metadata().map_err(ReadError::Io)?;
    if metadata.is_dir() {
        return Err(ReadError::Io(std::io::Error::other("it is a folder")));
    }
    if metadata.len() > limit {
        return Err(ReadError::TooLong(metadata.len()));
    }
    let mut bytes = Vec::new();
    // A device or a growing file has no honest length, so the limit holds while reading as well.
    file.take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(ReadError::Io)?;
    let length = bytes.len() as u64;
    if length > limit {
        Err(ReadError::TooLong(length))
    } else {
        Ok(bytes)
    }
}

/// The file's name without extension.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(|| "home".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Cuts a plan down to what matters (floor and drops with a solid margin) and splits coarse cells. Gives the plan and
/// the place of its lower left corner in the frame of the given one, metres.
pub(crate) fn fit(path: &Path, coarse: &Grid) -> Result<(Grid, f64, f64), HomeError> {
    let Some(window) = GridWindow::around_floor(coarse) else {
        return Err(HomeError::NoFloor {
            path: path.to_owned(),
        });
    };
    let split = libm::ceil(coarse.cell_m / CELL_MAX_M - 1e-6).max(1.0) as usize;
    let (width, height) = (
        window.columns * split + 2 * MARGIN_CELLS,
        window.rows * split + 2 * MARGIN_CELLS,
    );
    check_cells(path, width as u64, height as u64)?;
    let cell_m = coarse.cell_m / split as f64;
    let mut grid = Grid {
        cell_m,
        width,
        height,
        cells: vec![Cell::Outside; width * height],
    };
    for row in 0..window.rows * split {
        let from = (window.row + row / split) * coarse.width + window.column;
        let to = (row + MARGIN_CELLS) * width + MARGIN_CELLS;
        for column in 0..window.columns * split {
            grid.cells[to + column] = coarse.cells[from + column / split];
        }
    }
    let corner = |first: usize| first as f64 * coarse.cell_m - MARGIN_CELLS as f64 * cell_m;
    let (x_m, y_m) = (corner(window.column), corner(window.row));
    Ok((grid, x_m, y_m))
}

/// Refuses a plan of too many cells before memory is taken for it.
pub(crate) fn check_cells(path: &Path, width: u64, height: u64) -> Result<(), HomeError> {
    let cells = width.saturating_mul(height);
    if cells > CELLS_MAX {
        return Err(HomeError::TooManyCells {
            path: path.to_owned(),
            cells,
            limit: CELLS_MAX,
        });
    }
    Ok(())
}

/// Columns and rows of a grid.
struct GridWindow {
    column: usize,
    row: usize,
    columns: usize,
    rows: usize,
}

impl GridWindow {
    /// All cells that are not solid, with one ring of their walls.
    fn around_floor(grid: &Grid) -> Option<Self> {
        let (mut left, mut low, mut right, mut top) = (usize::MAX, usize::MAX, 0, 0);
        for (index, cell) in grid.cells.iter().enumerate() {
            if !cell.is_solid() {
                let (column, row) = (index % grid.width, index / grid.width);
                left = left.min(column);
                right = right.max(column);
                low = low.min(row);
                top = top.max(row);
            }
        }
        if left == usize::MAX {
            return None;
        }
        let (column, row) = (left.saturating_sub(1), low.saturating_sub(1));
        Some(Self {
            column,
            row,
            columns: (right + 2).min(grid.width) - column,
            rows: (top + 2).min(grid.height) - row,
        })
    }
}
