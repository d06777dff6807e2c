//! What a run drew, as paths of vector graphics in centimetres, y downwards.

use std::fmt::Write as _;

use rvac_api::{HomeView, RunPicture};

/// Room around everything, centimetres.
const MARGIN_CM: i32 = 30;
/// Cells of a home that are drawn at most.
const CELLS_MAX: u64 = 1 << 24;
/// Least extent, so that a run that went nowhere has a picture.
const LEAST_CM: i32 = 200;

/// The picture of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunDrawing {
    /// Left, top, width and height, as a view box says them.
    pub view_box: [i32; 4],
    /// Floor that the robot knew.
    pub floor: String,
    /// The obstacle cells.
    pub walls: String,
    /// Swept floor.
    pub swept: String,
    /// The path.
    pub path: String,
}

#[derive(Clone, Copy, Debug)]
struct Extent {
    low: (i32, i32),
    high: (i32, i32),
}

impl Extent {
    fn hold(&mut self, x: i32, y: i32) {
        self.low = (self.low.0.min(x), self.low.1.min(y));
        self.high = (self.high.0.max(x), self.high.1.max(y));
    }
}

/// Draws it.
#[must_use]
pub fn run_drawing(picture: &RunPicture) -> RunDrawing {
    let mut extent = Extent {
        low: (i32::MAX, i32::MAX),
        high: (i32::MIN, i32::MIN),
    };
    let (floor, walls) = picture
        .home
        .as_ref()
        .map_or_else(Default::default, |home| home_paths(home, &mut extent));
    let swept = swept_path(picture, &mut extent);
    let path = driven_path(&picture.path_mm, &mut extent);
    RunDrawing {
        view_box: view_box(extent),
        floor,
        walls,
        swept,
        path,
    }
}

fn view_box(extent: Extent) -> [i32; 4] {
    if extent.low.0 > extent.high.0 {
        return [-LEAST_CM / 2, -LEAST_CM / 2, LEAST_CM, LEAST_CM];
    }
    let span = |low: i32, high: i32| {
        let size = high
            .saturating_sub(low)
            .saturating_add(2 * MARGIN_CM)
            .max(LEAST_CM);
        let middle = low.saturating_add(high.saturating_sub(low) / 2);
        (middle.saturating_sub(size / 2), size)
    };
    let (left, width) = span(extent.low.0, extent.high.0);
    let (top, height) = span(extent.low.1, extent.high.1);
    [left, top, width, height]
}

/// A row of cells in metres.
#[derive(Clone, Copy, Debug)]
struct CellRow {
    from_m: f64,
    to_m: f64,
    low_m: f64,
}

/// Adds the rectangle of a row, which is one cell high.
fn add_row(path: &mut String, row: CellRow, cell_m: f64, extent: &mut Extent) {
    let (left, right) = (cm(row.from_m), cm(row.to_m));
    let (top, bottom) = (cm(-(row.low_m + cell_m)), cm(-row.low_m));
    extent.hold(left, top);
    extent.hold(right, bottom);
    // Writing to a string does not fail.
    write!(path, "M{left} {top}H{right}V{bottom}H{left}Z").ok();
}

fn home_paths(home: &HomeView, extent: &mut Extent) -> (String, String) {
    let (mut floor, mut walls) = (String::new(), String::new());
    let width = u64::from(home.width.max(1));
    let total = (width * u64::from(home.height)).min(CELLS_MAX);
    let mut index = 0_u64;
    for run in home.cells.chunks_exact(2) {
        let &[kind, length] = run else { continue };
        let end = (index + u64::from(length)).min(total);
        let path = match kind {
            1 => Some(&mut floor),
            2 | 3 => Some(&mut walls),
            _ => None,
        };
        if let Some(path) = path {
            let mut from = index;
            while from < end {
                let to = end.min((from / width + 1) * width);
                let x = |cell: u64| (f64::from(home.x) + cell as f64) * home.cell_m;
                let low_m = (f64::from(home.y) + (from / width) as f64) * home.cell_m;
                let left = from % width;
                let row = CellRow {
                    from_m: x(left),
                    to_m: x(left + to - from),
                    low_m,
                };
                add_row(path, row, home.cell_m, extent);
                from = to;
            }
        }
        index = end;
    }
    (floor, walls)
}

fn swept_path(picture: &RunPicture, extent: &mut Extent) -> String {
    let mut path = String::new();
    for row in picture.swept_rows.chunks_exact(3) {
        let &[x, y, length] = row else { continue };
        let metres = |cells: f64| cells * picture.cell_m;
        let from = f64::from(x);
        let span = CellRow {
            from_m: metres(from),
            to_m: metres(from + f64::from(length)),
            low_m: metres(f64::from(y)),
        };
        add_row(&mut path, span, picture.cell_m, extent);
    }
    path
}

fn driven_path(path_mm: &[i32], extent: &mut Extent) -> String {
    let mut path = String::new();
    for point in path_mm.chunks_exact(2) {
        let &[x_mm, y_mm] = point else { continue };
        let (x, y) = (x_mm / 10, y_mm.saturating_neg() / 10);
        extent.hold(x, y);
        let letter = if path.is_empty() { 'M' } else { 'L' };
        write!(path, "{letter}{x} {y}").ok();
    }
    path
}

/// Whole centimetres; saturates.
pub(super) fn cm(metres: f64) -> i32 {
    (100.0 * metres).round() as i32
}

#[cfg(test)]
mod tests {
    use rvac_api::{HomeView, RunPicture};

    use super::run_drawing;

    #[test]
    fn a_picture_is_in_centimetres_with_y_downwards() {
        let picture = RunPicture {
            cell_m: 0.05,
            swept_rows: vec![0, 2, 4],
            path_mm: vec![0, 0, 1000, 500],
            bumps: vec![],
            home: Some(HomeView {
                cell_m: 0.1,
                x: -1,
                y: 0,
                width: 3,
                height: 2,
                // One wall cell, then floor that goes on in the next row.
                cells: vec![2, 1, 1, 4, 0, 1],
                ..HomeView::default()
            }),
        };
        let drawing = run_drawing(&picture);
        assert_eq!(drawing.swept, "M0 -15H20V-10H0Z");
        assert_eq!(drawing.path, "M0 0L100 -50");
        assert_eq!(drawing.walls, "M-10 -10H0V0H-10Z");
        assert_eq!(drawing.floor, "M0 -10H20V0H0ZM-10 -20H10V-10H-10Z");
        assert_eq!(drawing.view_box, [-55, -125, 200, 200]);
    }

    #[test]
    fn whatever_comes_is_drawn_or_left_out() {
        let strange = RunPicture {
            cell_m: f64::MAX,
            swept_rows: vec![i32::MIN, i32::MAX, i32::MIN, 7],
            path_mm: vec![i32::MIN, i32::MAX, 3],
            bumps: vec![],
            home: Some(HomeView {
                cell_m: f64::NAN,
                width: 0,
                height: u32::MAX,
                cells: vec![1, 5, 2],
                ..HomeView::default()
            }),
        };
        assert!(run_drawing(&strange).view_box[2] > 0);
        assert_eq!(
            run_drawing(&RunPicture::default()).view_box,
            [-100, -100, 200, 200]
        );
    }
}
