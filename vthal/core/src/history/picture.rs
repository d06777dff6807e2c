//! The map of a run in the types of the interface to clients, of bounded size.

use brain::{Brain, CELL_M, CellKnowledge, Hazard, Map, PathPoint, SweptRun};
use rvac_api::{HomeView, RunJob, RunPicture};

use crate::home_view::{SurfaceSensing, home_view};
use crate::to_api;

/// Points of the path that lie nearer than this to the line between their neighbours are left out, millimetres.
const WAY_ERROR_MM: f64 = 15.0;
/// Points of a path that are stored at most. A longer path is simplified further.
const POINTS_MAX: usize = 20_000;
/// Rows of swept cells that are stored at most. More are merged into larger cells.
const ROWS_MAX: usize = 20_000;
/// Hazards that are kept at most, the first ones.
const HAZARDS_MAX: usize = 5_000;

/// A brain, and the revision of what it knows of the home; no two of this daemon's life with one robot are the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BrainAtHome<'a> {
    pub(crate) brain: &'a Brain,
    pub(crate) home_revision: u32,
}

/// Draws what runs have left. The home takes milliseconds, so it is drawn once for each revision: whoever orders one job after the other
/// must not keep everybody else waiting.
#[derive(Debug, Default)]
pub(super) struct Painter {
    home: Option<(u32, HomeView)>,
}

impl Painter {
    /// The picture of a run that has driven the map's path from this point on.
    pub(super) fn of_run(
        &mut self,
        at_home: BrainAtHome<'_>,
        (job, path_from): (&RunJob, usize),
    ) -> RunPicture {
        let home = Some(self.home(at_home)).filter(|home| !home.cells.is_empty());
        RunPicture {
            home: home.cloned(),
            ..of_job(at_home.brain.map(), (job, path_from))
        }
    }

    /// Another robot, whose revisions begin anew.
    pub(super) fn forget(&mut self) {
        self.home = None;
    }

    fn home(&mut self, BrainAtHome { brain, home_revision }: BrainAtHome<'_>) -> &HomeView {
        let drawn = self.home.take().filter(|(drawn, _)| *drawn == home_revision);
        let map = brain.map();
        let draw = || (home_revision, home_view(map, SurfaceSensing::in_map(map)));
        &self.home.insert(drawn.unwrap_or_else(draw)).1
    }
}

/// All but the home.
fn of_job(map: &Map, (job, path_from): (&RunJob, usize)) -> RunPicture {
    let part = map.snapshot();
    let path = part
        .path
        .get(path_from.min(part.path.len())..)
        .unwrap_or_default();
    let swept = match job {
        RunJob::Dock | RunJob::GoTo => Vec::new(),
        RunJob::Clean { .. } | RunJob::Spot => map.swept_runs(),
    };
    let hazards = match job {
        RunJob::Dock | RunJob::GoTo => &[],
        RunJob::Clean { .. } | RunJob::Spot => part.hazards,
    };
    drawn(&swept, path, hazards)
}

/// The picture of a run that was cut short.
pub(super) fn of_checkpoint(checkpoint: &brain::Checkpoint) -> RunPicture {
    let known = checkpoint.home.as_ref().filter(|stored| !stored.is_empty());
    let home = known.map(|stored| {
        // The body's size counts for what it can reach, which is not shown.
        let body = brain::Body {
            radius_m: 0.0,
            swath_m: 0.0,
            track_m: 0.0,
        };
        let mut map = Map::new(body, brain::SensorLayout::default());
        map.load(stored);
        home_view(&map, SurfaceSensing::in_map(&map))
    });
    RunPicture {
        home,
        ..drawn(&checkpoint.swept, &checkpoint.path, &checkpoint.hazards)
    }
}

fn drawn(swept: &[SweptRun], path: &[PathPoint], hazards: &[Hazard]) -> RunPicture {
    let (coarse, rows) = rows(swept);
    RunPicture {
        cell_m: CELL_M * f64::from(coarse),
        swept_rows: rows.into_iter().flatten().collect(),
        path_mm: simplified(path)
            .into_iter()
            .flat_map(|point| [point.x_mm, point.y_mm])
            .collect(),
        bumps: hazards.iter().take(HAZARDS_MAX).map(to_api::bump).collect(),
        home: None,
    }
}

/// Rows of swept cells, and how many of the map's cells one of theirs is wide.
fn rows(swept: &[SweptRun]) -> (i32, Vec<[i32; 3]>) {
    let mut coarse = 1;
    loop {
        let rows = rows_of(coarse, swept);
        if rows.len() <= ROWS_MAX {
            return (coarse, rows);
        }
        coarse *= 2;
    }
}

fn rows_of(coarse: i32, swept: &[SweptRun]) -> Vec<[i32; 3]> {
    let span = |run: &SweptRun| {
        let end = run.start.x.saturating_add_unsigned(run.length.saturating_sub(1));
        let (y, from, to) = (run.start.y, run.start.x, end);
        (
            y.div_euclid(coarse),
            from.div_euclid(coarse),
            to.div_euclid(coarse),
        )
    };
    let mut spans: Vec<(i32, i32, i32)> = swept.iter().map(span).collect();
    spans.sort_unstable();
    let mut rows: Vec<[i32; 3]> = Vec::new();
    for (y, from, to) in spans {
        match rows.last_mut() {
            Some([x, row, length]) if *row == y && from <= *x + *length => {
                *length = (*length).max(to - *x + 1);
            }
            _ => rows.push([from, y, to - from + 1]),
        }
    }
    rows
}

/// The path without points that change little of it.
fn simplified(path: &[PathPoint]) -> Vec<PathPoint> {
    let mut error_mm = WAY_ERROR_MM;
    loop {
        let kept = within(path, error_mm);
        if kept.len() <= POINTS_MAX {
            return kept;
        }
        error_mm *= 2.0;
    }
}

/// The points of a path that the Douglas-Peucker algorithm keeps, found without recursion: a path may have very many points.
fn within(path: &[PathPoint], error_mm: f64) -> Vec<PathPoint> {
    let Some(last) = path.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut keep = vec![false; path.len()];
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        for end in [from, to] {
            if let Some(kept) = keep.get_mut(end) {
                *kept = true;
            }
        }
        let farthest = farthest(path, (from, to));
        if let Some((between, distance_mm)) = farthest
            && distance_mm > error_mm
        {
            open.extend([(from, between), (between, to)]);
        }
    }
    path.iter()
        .zip(keep)
        .filter_map(|(point, kept)| kept.then_some(*point))
        .collect()
}

/// The point between two of a path that is farthest from the line through them, and how far.
fn farthest(path: &[PathPoint], (from, to): (usize, usize)) -> Option<(usize, f64)> {
    let place = |point: &PathPoint| (f64::from(point.x_mm), f64::from(point.y_mm));
    let (start, end) = (place(path.get(from)?), place(path.get(to)?));
    let along = (end.0 - start.0, end.1 - start.1);
    let length_mm = along.0.hypot(along.1);
    let between = path.get(from + 1..to)?.iter().enumerate();
    between
        .map(|(index, point)| {
            let (x_mm, y_mm) = place(point);
            let apart = (x_mm - start.0, y_mm - start.1);
            let inside = along.0 * apart.0 + along.1 * apart.1;
            let distance_mm = if length_mm == 0.0 || inside < 0.0 {
                apart.0.hypot(apart.1)
            } else if inside > length_mm * length_mm {
                (x_mm - end.0).hypot(y_mm - end.1)
            } else {
                (along.0 * apart.1 - along.1 * apart.0).abs() / length_mm
            };
            (from + 1 + index, distance_mm)
        })
        .max_by(|one, other| one.1.total_cmp(&other.1))
}

/// Floor that a job was to sweep, as far as it is mapped.
pub(super) fn floor_m2(map: &Map, job: &RunJob) -> Option<f64> {
    let RunJob::Clean {
        rooms,
        zones: 0,
        spots: 0,
        ..
    } = job
    else {
        return None;
    };
    let floor_m2 = if rooms.is_empty() {
        let cells = map.knowledge().values().iter();
        let free = cells.filter(|kind| **kind == CellKnowledge::Free).count();
        free as f64 * CELL_M * CELL_M
    } else {
        let known = map.rooms().rooms().iter();
        let ordered = known.filter(|known| rooms.iter().any(|room| room.id == known.id));
        ordered.map(|room| room.area_m2).sum()
    };
    (floor_m2 > 0.0).then_some(floor_m2)
}

#[cfg(test)]
mod tests {
    use brain::{Cell, PathPoint, SweptRun};

    use super::{POINTS_MAX, ROWS_MAX, rows, simplified};

    fn point(x_mm: i32, y_mm: i32) -> PathPoint {
        PathPoint { x_mm, y_mm }
    }

    #[test]
    fn a_path_keeps_its_corners_and_loses_what_lies_between() {
        let along = (0..=50).map(|step| point(20 * step, step % 2));
        let up = (1..=50).map(|step| point(1000, 20 * step));
        let path: Vec<PathPoint> = along.chain(up).collect();
        assert_eq!(
            simplified(&path),
            [point(0, 0), point(1000, 0), point(1000, 1000)]
        );
        assert_eq!(simplified(&[]), []);
        let there_and_back = [point(0, 0), point(500, 0), point(0, 0)];
        assert_eq!(simplified(&there_and_back), there_and_back);
    }

    #[test]
    fn whatever_was_driven_the_picture_is_bounded() {
        let scribble: Vec<PathPoint> = (0..100_000)
            .map(|step| point(step % 300, step * 7_919 % 4_001))
            .collect();
        assert!(simplified(&scribble).len() <= POINTS_MAX);
        let crumbs: Vec<SweptRun> = (0..60_000)
            .map(|index| SweptRun {
                start: Cell {
                    x: 3 * (index % 300),
                    y: index / 300,
                },
                length: 1,
            })
            .collect();
        let (coarse, rows) = rows(&crumbs);
        assert!(coarse > 1 && rows.len() <= ROWS_MAX, "{coarse}, {}", rows.len());
    }

    #[test]
    fn rows_that_touch_are_one() {
        let run = |x, length| SweptRun {
            start: Cell { x, y: -1 },
            length,
        };
        assert_eq!(
            rows(&[run(4, 2), run(0, 4), run(9, 1)]),
            (1, vec![[0, -1, 6], [9, -1, 1]])
        );
    }
}
