//! The map of the home and of one job in it.

mod confidence;
mod edit;
mod editing;
mod forbidden;
mod known_home;
mod loader;
mod orders;
mod place_editing;
mod reach;
mod redrawing;
mod room_editing;
mod saving;

pub use confidence::MapConfidence;
pub use loader::{LoadedHome, MapLoader};
pub use saving::MapWriter;

use super::coverage_grid::{CoverageGrid, Swath};
use super::home::HomeMap;
use super::path_and_hazards::{HazardLog, Path};
use super::{Cell, CellPasses, Hazard, PathPoint, SweptRun};
use crate::model::config::{Body, SensorLayout};
use crate::model::geometry::{Point2, Pose2};
use redrawing::Redrawing;

/// The map of the home and of one job in it.
#[derive(Debug)]
pub struct Map {
    generation: u32,
    frame: u32,
    swept: CoverageGrid,
    swath: Swath,
    path: Path,
    hazards: HazardLog,
    home: HomeMap,
    job_base: JobBase,
    /// The map with corrected poses, while it is being drawn.
    redrawing: Option<Box<Redrawing>>,
}

/// The part of a job that does not come from the present sightings.
#[derive(Clone, Debug, Default)]
struct JobBase {
    swept: CoverageGrid,
    path: Path,
    /// Its first sighting.
    sightings: usize,
}

/// How much of a map a client has received.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapCursor {
    generation: u32,
    swept: usize,
    path: usize,
    hazards: usize,
}

/// A part of a map, in order of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPart<'map> {
    /// Number of the map, from 1.
    pub generation: u32,
    /// Swept cells.
    pub swept: &'map [Cell],
    /// The path, thinned to 2 cm.
    pub path: &'map [PathPoint],
    /// Contacts and cliffs.
    pub hazards: &'map [Hazard],
}

impl Map {
    /// An empty map, number 1.
    #[must_use]
    pub fn new(body: Body, sensors: SensorLayout) -> Self {
        Self {
            generation: 1,
            frame: 1,
            swept: CoverageGrid::default(),
            swath: Swath::new(body.swath_m),
            path: Path::default(),
            hazards: HazardLog::default(),
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
            hazards: self.hazards.all(),
        }
    }

    /// A cursor at the present state.
    #[must_use]
    pub fn cursor(&self) -> MapCursor {
        MapCursor {
            generation: self.generation,
            swept: self.swept.cells().len(),
            path: self.path.points().len(),
            hazards: self.hazards.all().len(),
        }
    }

    /// Everything since `cursor`; `None` if the cursor belongs to another generation and the client needs a snapshot.
    #[must_use]
    pub fn since(&self, cursor: MapCursor) -> Option<MapPart<'_>> {
        (cursor.generation == self.generation).then(|| MapPart {
            generation: self.generation,
            swept: self.swept.cells().get(cursor.swept..).unwrap_or_default(),
            path: self.path.points().get(cursor.path..).unwrap_or_default(),
            hazards: self.hazards.all().get(cursor.hazards..).unwrap_or_default(),
        })
    }

    /// Path length of this job, metres.
    #[must_use]
    pub fn path_length_m(&self) -> f64 {
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
    pub fn cell_passes(&self, cell: Cell) -> Option<CellPasses> {
        self.swept.cell_passes(cell)
    }

    /// [`CellPasses::last_s`] of a cell that is swept now.
    #[must_use]
    pub fn coverage_now_s(&self) -> u32 {
        self.swept.now_s()
    }

    /// Swept cells as runs, in a fixed order.
    #[must_use]
    pub fn swept_runs(&self) -> Vec<SweptRun> {
        self.swept.runs()
    }

    /// Starts a new job and generation. The home stays, except for places that were forbidden for the job.
    pub(crate) fn start_anew(&mut self) {
        self.generation += 1;
        self.swept = CoverageGrid::default();
        self.path = Path::default();
        self.hazards = HazardLog::default();
        self.allow_pockets();
        self.swath.lift();
        self.job_base = JobBase {
            sightings: self.home.sightings.len(),
            ..JobBase::default()
        };
        self.redrawing = None;
    }

    /// Adds a pose to the path. With `Brushes::Sweeping` the swath becomes swept.
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

    /// Restores the job of an earlier map, as a new generation.
    pub(crate) fn restore(&mut self, runs: &[SweptRun], path: &[PathPoint], hazards: &[Hazard]) {
        self.start_anew();
        for run in runs {
            self.swept.paint_run(*run);
        }
        self.path.extend(path);
        for mark in hazards {
            self.hazards.add(*mark, None);
        }
        self.job_base.swept = self.swept.clone();
        self.job_base.path = self.path.clone();
    }
}

/// Whether the cleaning motors run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Brushes {
    /// They run.
    Sweeping,
    /// They do not.
    Still,
}
