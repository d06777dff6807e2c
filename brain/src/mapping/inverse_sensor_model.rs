//! The inverse sensor model: turns sightings into evidence for cells.

mod parameters;
#[cfg(test)]
mod tests;

use parameters::{CONTACT, OCCUPANCY, SURFACE};

use super::kept_home::{Hit, KeptHome, Touched};
use super::occupancy_grid::{Evidence, Flag, OccupancyGrid, is_seen_solid};
use super::sighting::Sighting;
use super::{CELL_M, Cell};
use crate::model::config::{Body, SensorLayout};
use crate::model::geometry::{Point2, Pose2};

/// The level of one proximity sensor.
#[derive(Clone, Copy)]
struct ProximityReading {
    /// Pose of the sensor in the body's frame.
    sensor: Pose2,
    /// 255 = touching.
    level: u8,
}

/// An arc of the bumper, in radians from straight ahead.
#[derive(Clone, Copy)]
struct BumperArc {
    from_rad: f64,
    to_rad: f64,
}

/// The inverse sensor model of one robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct InverseSensorModel {
    pub(super) body: Body,
    pub(super) sensors: SensorLayout,
}

impl InverseSensorModel {
    /// Adds the evidence of a sighting to the grid. What obstacles of `kept` explain confirms these.
    pub(super) fn draw(&self, sighting: &Sighting, kept: Option<&KeptHome>, grid: &mut OccupancyGrid) {
        self.draw_body(sighting, kept, grid);
        for (sensor, level) in self.sensors.proximity.sensors().iter().zip(sighting.levels) {
            let sensor = *sensor;
            if let Some(hit_m) = self.clear_beam(sighting, ProximityReading { sensor, level }, (kept, grid)) {
                for hit in self.hit_cells(sighting.pose * sensor, hit_m) {
                    draw_hit(sighting, hit, kept, grid);
                }
            }
        }
        self.draw_contacts(sighting, kept, grid);
        self.draw_cliffs(sighting, grid);
        self.draw_surface(sighting, grid);
    }

    /// The surface under the brush, where the body has been.
    pub(super) fn draw_surface(&self, sighting: &Sighting, grid: &mut OccupancyGrid) {
        let Some(observed) = sighting.surface else { return };
        let behind_m = -0.001 * f64::from(observed.behind_mm);
        let half_m = 0.5 * self.body.swath_m;
        let steps = libm::ceil(half_m / (0.6 * CELL_M)).clamp(1.0, 64.0) as i32;
        let mut last = None;
        for step in -steps..=steps {
            let share = f64::from(step) / f64::from(steps);
            let cell = Cell::under(sighting.pose.transform(Point2 {
                x_m: behind_m,
                y_m: share * half_m,
            }));
            if last == Some(cell) || !grid.at(cell).has(Flag::Body) {
                continue;
            }
            last = Some(cell);
            let weight = if share.abs() <= SURFACE.inner_share {
                SURFACE.inner_step
            } else {
                SURFACE.outer_step
            };
            grid.change(cell, |evidence| evidence.add_surface(observed.kind, weight));
        }
    }

    /// Under the body is no obstacle. Contacts are newer evidence than this, so they are drawn after it.
    fn draw_body(&self, sighting: &Sighting, kept: Option<&KeptHome>, grid: &mut OccupancyGrid) {
        let sigma_m = 0.01 * f64::from(sighting.sigma_cm);
        let radius_m = self.body.radius_m - sigma_m.clamp(0.5 * CELL_M, OCCUPANCY.shrink_max_m);
        let centre = sighting.pose.position();
        let (low, high) = (centre.y_m - radius_m, centre.y_m + radius_m);
        for y in row_of(low)..=row_of(high) {
            let off_m = (f64::from(y) + 0.5) * CELL_M - centre.y_m;
            let half_m = libm::sqrt((radius_m * radius_m - off_m * off_m).max(0.0));
            let first = libm::ceil((centre.x_m - half_m) / CELL_M - 0.5) as i32;
            let last = libm::floor((centre.x_m + half_m) / CELL_M - 0.5) as i32;
            let sure_m = radius_m - OCCUPANCY.body_sure_m;
            let sure_half_m = libm::sqrt((sure_m * sure_m - off_m * off_m).max(0.0));
            for x in first..=last {
                let cell = Cell { x, y };
                let aside_m = ((f64::from(x) + 0.5) * CELL_M - centre.x_m).abs();
                let is_at_rim = off_m.abs() > sure_m || aside_m > sure_half_m;
                if is_at_rim && kept.is_some_and(|kept| is_seen_solid(kept.at(cell))) {
                    continue;
                }
                grid.change(cell, |evidence| {
                    add_occupancy(evidence, OCCUPANCY.body_step);
                    evidence.contact = evidence.contact.saturating_sub(CONTACT.located);
                    evidence.set(Flag::Body);
                    evidence.set(Flag::Driven);
                    note_sigma(evidence, sighting);
                });
            }
        }
    }

    /// Draws the floor up to the hit, whose distance it gives. A hit soon behind an obstacle of `kept` counts against that: hits scatter
    /// about the surface by the error of the pose, and each of them confirms some obstacle. Without this a wall would grow toward the
    /// robot until hardly any hit lies before it.
    fn clear_beam(
        &self,
        sighting: &Sighting,
        reading: ProximityReading,
        (kept, grid): (Option<&KeptHome>, &mut OccupancyGrid),
    ) -> Option<f64> {
        let response = self.sensors.proximity.response;
        let beam = sighting.pose * reading.sensor;
        let level = f64::from(reading.level) / 255.0;
        let hit_m = if level < OCCUPANCY.level_min {
            None
        } else {
            response.distance_m(level)
        };
        let (clear_m, step) = match hit_m {
            Some(hit_m) => (hit_m - OCCUPANCY.margin_m, OCCUPANCY.passed_step),
            None => (OCCUPANCY.nothing_share * response.range_m, OCCUPANCY.nothing_step),
        };
        if let (Some(kept), Some(hit_m)) = (kept, hit_m) {
            let refuting = -((OCCUPANCY.refuting_share * self.hit_strength(hit_m)) as i8);
            let from_m = (clear_m - OCCUPANCY.refuting_m).max(response.skin_m);
            walk(beam, from_m, clear_m, |cell| {
                if is_seen_solid(kept.at(cell)) {
                    grid.change(cell, |evidence| add_occupancy(evidence, refuting));
                }
            });
        }
        walk(beam, response.skin_m, clear_m, |cell| {
            grid.change(cell, |evidence| {
                add_occupancy(evidence, step);
                note_sigma(evidence, sighting);
            });
        });
        hit_m
    }

    /// Evidence of a hit at this distance.
    fn hit_strength(&self, hit_m: f64) -> f64 {
        let beyond_m = (hit_m - self.sensors.proximity.response.skin_m).max(0.0);
        let beyond = beyond_m / OCCUPANCY.hit_half_m;
        OCCUPANCY.hit_step / (1.0 + beyond * beyond)
    }

    /// The cells in which a hit at this distance lies, and how much it tells of each.
    fn hit_cells(&self, beam: Pose2, hit_m: f64) -> impl Iterator<Item = (Cell, i8)> {
        let response = self.sensors.proximity.response;
        let strength = self.hit_strength(hit_m) as i8;
        // The surface lies before the centre of its cell.
        let behind_m = hit_m + 0.5 * CELL_M;
        let reach_m = behind_m * libm::tan(response.half_angle_rad);
        let mut last = None;
        [-reach_m, 0.0, reach_m].into_iter().filter_map(move |off_m| {
            let cell = Cell::under(beam.transform(Point2 {
                x_m: behind_m,
                y_m: off_m,
            }));
            let share = if off_m == 0.0 { strength } else { strength / 3 };
            (last.replace(cell) != Some(cell)).then_some((cell, share))
        })
    }

    fn draw_contacts(&self, sighting: &Sighting, kept: Option<&KeptHome>, grid: &mut OccupancyGrid) {
        // A bumper that stays pressed is no new evidence, and the robot is backing off from the obstacle.
        if !sighting.switches.has_new_contact() {
            return;
        }
        let Some(pressed) = self.touched_arc(sighting) else {
            return;
        };
        let (arc, evidence) = match self.brightest_within(sighting, pressed) {
            Some(at_rad) => {
                let seen = BumperArc {
                    from_rad: (at_rad - CONTACT.spread_rad).max(pressed.from_rad),
                    to_rad: (at_rad + CONTACT.spread_rad).min(pressed.to_rad),
                };
                (seen, CONTACT.located)
            }
            None if (pressed.to_rad - pressed.from_rad) * self.body.radius_m <= CONTACT.short_arc_m => {
                (pressed, CONTACT.narrow)
            }
            None => (pressed, CONTACT.vague),
        };
        let BumperArc { from_rad, to_rad } = arc;
        let radius_m = self.body.radius_m + 0.5 * CELL_M;
        let steps = libm::ceil((to_rad - from_rad) * radius_m / (0.7 * CELL_M)).clamp(1.0, 64.0);
        let mut last = None;
        for step in 0..=steps as u32 {
            let bearing_rad = from_rad + (to_rad - from_rad) * f64::from(step) / steps;
            let cell = Cell::under(
                sighting
                    .pose
                    .transform(Point2::in_direction(bearing_rad, radius_m)),
            );
            if last == Some(cell) {
                continue;
            }
            last = Some(cell);
            let touched = match kept.map_or(Touched::New, |kept| kept.touched(cell)) {
                Touched::Seen => continue,
                Touched::Again(touched) => touched,
                Touched::New => cell,
            };
            grid.change(touched, |gathered| {
                gathered.contact = gathered.contact.saturating_add(evidence).min(CONTACT.limit);
                note_sigma(gathered, sighting);
            });
        }
    }

    /// The pressed arc of the bumper.
    fn touched_arc(&self, sighting: &Sighting) -> Option<BumperArc> {
        let bumper = self.sensors.bumper;
        let (from_rad, to_rad) = match sighting.switches.contacts() {
            (false, false) => return None,
            (true, true) => (-bumper.overlap_rad, bumper.overlap_rad),
            (true, false) => (bumper.overlap_rad, bumper.half_arc_rad),
            (false, true) => (-bumper.half_arc_rad, -bumper.overlap_rad),
        };
        Some(BumperArc { from_rad, to_rad })
    }

    /// Bearing of the proximity sensor that sees most of what the arc touches.
    fn brightest_within(&self, sighting: &Sighting, arc: BumperArc) -> Option<f64> {
        let mut best: Option<(f64, f64)> = None;
        for (sensor, level) in self.sensors.proximity.sensors().iter().zip(sighting.levels) {
            let bearing_rad = libm::atan2(sensor.y_m, sensor.x_m);
            let level = f64::from(level) / 255.0;
            let within =
                (arc.from_rad - CONTACT.spread_rad..=arc.to_rad + CONTACT.spread_rad).contains(&bearing_rad);
            if within && level >= CONTACT.level_min && best.is_none_or(|(brightest, _)| level > brightest) {
                best = Some((level, bearing_rad));
            }
        }
        best.map(|(_, bearing_rad)| bearing_rad)
    }

    fn draw_cliffs(&self, sighting: &Sighting, grid: &mut OccupancyGrid) {
        let Some(places) = self.sensors.cliffs else { return };
        for (place, gone) in places.iter().zip(sighting.switches.cliffs()) {
            let cell = Cell::under(sighting.pose.transform(*place));
            grid.change(cell, |evidence| {
                evidence.cliff = if gone {
                    (evidence.cliff + CONTACT.located).min(CONTACT.limit)
                } else {
                    evidence.cliff.saturating_sub(1)
                };
                note_sigma(evidence, sighting);
            });
        }
    }
}

fn row_of(y_m: f64) -> i32 {
    libm::floor(y_m / CELL_M) as i32
}

/// Draws a hit where it lies, or on the obstacle of `kept` that explains it.
fn draw_hit(
    sighting: &Sighting,
    (cell, share): (Cell, i8),
    kept: Option<&KeptHome>,
    grid: &mut OccupancyGrid,
) {
    let solid = match kept.map_or(Hit::New, |kept| kept.hit(cell)) {
        Hit::Known(solid) => solid,
        Hit::Near => return,
        Hit::New => cell,
    };
    grid.change(solid, |evidence| {
        add_occupancy(evidence, share);
        note_sigma(evidence, sighting);
    });
}

fn add_occupancy(evidence: &mut Evidence, step: i8) {
    evidence.occupancy = evidence
        .occupancy
        .saturating_add(step)
        .clamp(-OCCUPANCY.limit, OCCUPANCY.limit);
}

/// Keeps the smallest uncertainty of the pose.
fn note_sigma(evidence: &mut Evidence, sighting: &Sighting) {
    if !evidence.has(Flag::Seen) || sighting.sigma_cm < evidence.sigma_cm {
        evidence.sigma_cm = sighting.sigma_cm;
    }
    evidence.set(Flag::Seen);
}

/// Visits each cell along a part of a beam once.
fn walk(beam: Pose2, from_m: f64, to_m: f64, mut visit: impl FnMut(Cell)) {
    /// Small enough to miss no cell of which the beam crosses more than a corner.
    const STEP_M: f64 = 0.6 * CELL_M;
    let (sin, cos) = libm::sincos(beam.heading_rad);
    let mut last = None;
    let steps = libm::floor((to_m - from_m) / STEP_M).clamp(-1.0, 256.0);
    for step in 0..=steps as i32 {
        let distance_m = from_m + f64::from(step) * STEP_M;
        let cell = Cell::under(Point2 {
            x_m: beam.x_m + cos * distance_m,
            y_m: beam.y_m + sin * distance_m,
        });
        if last != Some(cell) {
            visit(cell);
        }
        last = Some(cell);
    }
}
