//! Redrawing the map when past poses were corrected: the home, and the job in it.
//!
//! Some ten thousand sightings are drawn in small steps. The map stays as it is until the new one is complete.

use super::Map;
use crate::mapping::carpet::SurfaceObservation;
use crate::mapping::coverage_grid::{CoverageGrid, Swath};
use crate::mapping::derived::Derived;
use crate::mapping::home::HomeMap;
use crate::mapping::keyframe::Keyframe;
use crate::mapping::occupancy_grid::{Flag, OccupancyGrid};
use crate::mapping::path_and_hazards::Path;
use crate::mapping::sighting::Sighting;
use crate::mapping::{Cell, Hazard};
use crate::model::geometry::Pose2;

/// Sightings per step: a quarter of a millisecond on one core of a desktop.
const SIGHTINGS_A_STEP: usize = 40;
/// Most dirty tiles for the last step. There are always some, because the robot continues to draw.
const TILES_LEFT: usize = 2;

/// A map that is being redrawn.
#[derive(Clone, Debug)]
pub(super) struct Redrawing {
    keyframes: Vec<Keyframe>,
    next: usize,
    grid: OccupancyGrid,
    derived: Derived,
    swept: CoverageGrid,
    swath: Swath,
    path: Path,
}

impl Redrawing {
    /// Allows a cell again.
    pub(super) fn allow(&mut self, cell: Cell) {
        self.grid.change(cell, |evidence| evidence.clear(Flag::NoGo));
    }

    /// Adds a surface to a sighting that is already drawn.
    fn draw_surface(&mut self, mut sighting: Sighting, home: &HomeMap) {
        sighting.pose = corrected(&self.keyframes, sighting.time_us, sighting.odom);
        home.sensor_model.draw_surface(&sighting, &mut self.grid);
    }

    /// Draws up to `most` sightings; after the last one it derives the rasters of one tile per call. Returns `true` when hardly
    /// any is left.
    fn go_on(&mut self, home: &HomeMap, job_from: usize, most: usize) -> bool {
        let sightings = home.sightings.get(self.next..).unwrap_or_default();
        for sighting in sightings.iter().take(most) {
            let mut sighting = *sighting;
            sighting.pose = corrected(&self.keyframes, sighting.time_us, sighting.odom);
            home.sensor_model.draw(&sighting, None, &mut self.grid);
            if self.next >= job_from {
                self.path.follow(sighting.pose.position());
                if sighting.switches.sweeps() {
                    self.swept.set_time(sighting.time_us);
                    self.swath.sweep_to(sighting.pose, &mut self.swept);
                } else {
                    self.swath.lift();
                }
            }
            self.next += 1;
        }
        let is_drawn = self.next >= home.sightings.len();
        if is_drawn {
            self.derived.refresh_tile(&mut self.grid);
        }
        is_drawn && self.grid.dirty_tiles() <= TILES_LEFT
    }
}

impl Map {
    /// Begins to redraw the map with corrected poses, given in order of time. Poses between two keyframes are interpolated. Later
    /// calls of [`Self::insert`] do the work.
    pub fn redraw(&mut self, keyframes: &[Keyframe]) {
        if keyframes.is_empty() {
            return;
        }
        let mut swath = self.swath.clone();
        swath.lift();
        let mut grid = self.home.base.clone();
        grid.mark_all_dirty();
        self.redrawing = Some(Box::new(Redrawing {
            keyframes: keyframes.to_vec(),
            next: 0,
            grid,
            derived: Derived::default(),
            swept: self.job_base.swept.clone(),
            swath,
            path: self.job_base.path.clone(),
        }));
    }

    /// Drops everything observed and swept from `since_us` on, and begins to redraw the map without it.
    pub(crate) fn roll_back(&mut self, since_us: u64, keyframes: &[Keyframe]) {
        let sightings = &mut self.home.sightings;
        sightings.truncate(sightings.partition_point(|sighting| sighting.time_us < since_us));
        self.job_base.sightings = self.job_base.sightings.min(sightings.len());
        self.hazards.roll_back(since_us);
        self.redraw(keyframes);
    }

    /// Completes a redraw.
    pub fn finish_redraw(&mut self) {
        while self.redrawing.is_some() {
            self.draw_up_to(usize::MAX);
        }
    }

    pub(super) fn redraw_on(&mut self) {
        self.draw_up_to(SIGHTINGS_A_STEP);
    }

    fn draw_up_to(&mut self, most: usize) {
        let Some(redrawing) = &mut self.redrawing else {
            return;
        };
        if !redrawing.go_on(&self.home, self.job_base.sightings, most) {
            return;
        }
        let Some(redrawing) = self.redrawing.take() else {
            return;
        };
        let Redrawing {
            keyframes,
            grid,
            derived,
            swept,
            path,
            ..
        } = *redrawing;
        self.home.replace_grid(grid, derived);
        self.swept = swept;
        self.path = path;
        self.swath.lift();
        self.hazards.moved(|time_us, odom| {
            corrected(
                &keyframes,
                time_us,
                Pose2 {
                    x_m: odom.x_m,
                    y_m: odom.y_m,
                    heading_rad: 0.0,
                },
            )
            .position()
        });
        self.generation += 1;
    }

    /// Adds the surface at the last inserted observation, if that has this time.
    pub(crate) fn note_surface(&mut self, time_us: u64, observed: SurfaceObservation) {
        let Some(newest) = self.home.note_surface(time_us, observed) else {
            return;
        };
        if let Some(redrawing) = &mut self.redrawing
            && redrawing.next >= self.home.sightings.len()
        {
            redrawing.draw_surface(newest, &self.home);
        }
    }

    /// Makes everything up to now final, so that no redraw changes it.
    pub(super) fn finalize(&mut self) {
        self.home.finalize();
        self.job_base.swept = self.swept.clone();
        self.job_base.path = self.path.clone();
        self.job_base.sightings = 0;
        self.hazards.finalize();
    }

    /// Adds a hazard that was detected at `seen`.
    pub(crate) fn add_hazard(
        &mut self,
        hazard: Hazard,
        seen: crate::mapping::path_and_hazards::StampedOdometry,
    ) {
        self.hazards.add(hazard, Some(seen));
    }
}

/// The pose in the map at `time_us`, when odometry was at `odom`, interpolated between the keyframes before and after.
fn corrected(keyframes: &[Keyframe], time_us: u64, odom: Pose2) -> Pose2 {
    let after = keyframes.partition_point(|keyframe| keyframe.time_us <= time_us);
    let by = |keyframe: &Keyframe| keyframe.map_from_base * (keyframe.odom_from_base.inverse() * odom);
    let before = after.checked_sub(1).and_then(|index| keyframes.get(index));
    match (before, keyframes.get(after)) {
        (Some(before), Some(after)) => {
            let span_us = after.time_us.saturating_sub(before.time_us).max(1) as f64;
            let share = time_us.saturating_sub(before.time_us) as f64 / span_us;
            by(before).towards(by(after), share)
        }
        (Some(only), None) | (None, Some(only)) => by(only),
        (None, None) => odom,
    }
}
