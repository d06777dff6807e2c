//! The map of the home and of one job in it.

mod edit;
mod editing;
mod known_home;
mod loader;
mod order_resolution;
mod place_editing;
mod reach;
mod redraw;
mod room_editing;
mod saving;
mod sureness;

pub use loader::{ReadyHome, TakingUp};
pub use sureness::Sureness;

use super::home::HomeMap;
use super::swept::{Swath, SweptLayer};
use super::traces::{Marks, Path};
use super::{Cell, Mark, PathPoint, Sweeping, SweptRun};
use crate::model::config::{Body, SensorLayout};
use crate::model::geometry::{Point2, Pose2};
use redraw::Redrawing;

/// The map of the home and of one job in it.
#[derive(Debug)]
pub struct Map {
    generation: u32,
    swept: SweptLayer,
    swath: Swath,
    path: Path,
    marks: Marks,
    home: HomeMap,
    job_base: JobBase,
    /// The map with better poses, while it is being drawn.
    redrawing: Option<Box<Redrawing>>,
}

/// What of a job does not come from the sightings that are kept.
#[derive(Clone, Debug, Default)]
struct JobBase {
    swept: SweptLayer,
    path: Path,
    /// Its first sighting.
    sightings: usize,
}

/// How much of a map somebody has seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapCursor {
    generation: u32,
    swept: usize,
    path: usize,
    marks: usize,
}

/// Part of a map, in the order in which it came to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPart<'map> {
    /// Number of the map, from 1.
    pub generation: u32,
    /// Swept cells.
    pub swept: &'map [Cell],
    /// The way, thinned to 2 cm.
    pub path: &'map [PathPoint],
    /// Contacts and cliffs.
    pub marks: &'map [Mark],
}

impl Map {
    /// An empty map, number 1.
    #[must_use]
    pub fn new(body: Body, sensors: SensorLayout) -> Self {
        Self {
            generation: 1,
            swept: SweptLayer::default(),
            swath: Swath::new(body.swath_m),
            path: Path::default(),
            marks: Marks::default(),
            home: HomeMap::new(body, sensors),
            job_base: JobBase::default(),
            redrawing: None,
        }
    }

    /// The whole map.
    #[must_use]
    pub fn snapshot(&self) -> MapPart<'_> {
        MapPart {
            generation: self.generation,
            swept: self.swept.cells(),
            path: self.path.points(),
            marks: self.marks.all(),
        }
    }

    /// A cursor that has seen everything up to now.
    #[must_use]
    pub fn cursor(&self) -> MapCursor {
        MapCursor {
            generation: self.generation,
            swept: self.swept.cells().len(),
            path: self.path.points().len(),
            marks: self.marks.all().len(),
        }
    }

    /// What came since `cursor`; `None` if that cursor belongs to another map, then a snapshot is needed.
    #[must_use]
    pub fn since(&self, cursor: MapCursor) -> Option<MapPart<'_>> {
        (cursor.generation == self.generation).then(|| MapPart {
            generation: self.generation,
            swept: self.swept.cells().get(cursor.swept..).unwrap_or_default(),
            path: self.path.points().get(cursor.path..).unwrap_or_default(),
            marks: self.marks.all().get(cursor.marks..).unwrap_or_default(),
        })
    }

    /// Length of the way of this job, metres.
    #[must_use]
    pub fn way_m(&self) -> f64 {
        self.path.length_m()
    }

    /// Swept area in square metres.
    #[must_use]
    pub fn swept_m2(&self) -> f64 {
        self.swept.area_m2()
    }

    /// Whether the cell under `point` was swept.
    #[must_use]
    pub fn is_swept(&self, point: Point2) -> bool {
        self.swept.contains(Cell::under(point))
    }

    /// How a cell was swept in this job; `None` = it was not.
    #[must_use]
    pub fn sweeping(&self, cell: Cell) -> Option<Sweeping> {
        self.swept.sweeping(cell)
    }

    /// The time that [`Sweeping::last_s`] of a cell has that is swept now.
    #[must_use]
    pub fn sweeping_now_s(&self) -> u32 {
        self.swept.now_s()
    }

    /// Swept cells joined to rows, in a fixed order.
    #[must_use]
    pub fn swept_runs(&self) -> Vec<SweptRun> {
        self.swept.runs()
    }

    /// Forgets the job and counts one map on; what is known of the home stays, except for places that were shut for the job.
    pub(crate) fn start_anew(&mut self) {
        self.generation += 1;
        self.swept = SweptLayer::default();
        self.path = Path::default();
        self.marks = Marks::default();
        self.open_pockets();
        self.swath.lift();
        self.job_base = JobBase {
            sightings: self.home.sightings.len(),
            ..JobBase::default()
        };
        self.redrawing = None;
    }

    /// Follows the robot to where it is at a time; with `Brushes::Sweeping` the floor under the swath becomes swept.
    pub(crate) fn follow(&mut self, pose: Pose2, brushes: Brushes, time_us: u64) {
        self.path.follow(pose.position());
        match brushes {
            Brushes::Sweeping => {
                self.home.note_sweeping();
                self.swept.set_time(time_us);
                self.swath.sweep_to(pose, &mut self.swept);
            }
            Brushes::Still => self.swath.lift(),
        }
    }

    /// Takes up an earlier map as a new generation.
    pub(crate) fn restore(&mut self, runs: &[SweptRun], path: &[PathPoint], marks: &[Mark]) {
        self.start_anew();
        for run in runs {
            self.swept.paint_run(*run);
        }
        self.path.extend(path);
        for mark in marks {
            self.marks.add(*mark, None);
        }
        self.job_base.swept = self.swept.clone();
        self.job_base.path = self.path.clone();
    }
}

/// Whether the cleaning parts run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Brushes {
    /// They run.
    Sweeping,
    /// They do not.
    Still,
}
