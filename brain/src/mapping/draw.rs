//! From sightings to evidence: inverse models of the sensors.

use super::layers::{Evidence, Flag, Layers};
use super::sighting::Sighting;
use super::{CELL_M, Cell};
use crate::model::config::{Body, SensorLayout};
use crate::model::geometry::{Point2, Pose2};

/// What the body's presence says against an obstacle: few sightings outweigh anything that infrared saw before.
const BODY_STEP: i8 = -30;
/// What a beam that passes says against an obstacle in a cell.
const PASSED_STEP: i8 = -3;
/// What a beam that meets nothing says: dark things are not seen at the end of the range.
const NOTHING_STEP: i8 = -1;
/// A beam that meets nothing speaks for this share of its range.
const NOTHING_SHARE: f64 = 0.6;
/// What a touching thing says for an obstacle; half of it at [`HIT_HALF_M`] beyond the rim.
const HIT_STEP: f64 = 30.0;
/// As [`HIT_STEP`]. The error of a distance grows with it, because nobody knows how bright a wall is, and what a sighting says
/// falls with the square of its error: otherwise what was seen from afar stands as a crooked front before the wall.
const HIT_HALF_M: f64 = 0.07;
/// Most and least occupancy.
const OCCUPANCY_MAX: i8 = 100;
/// Levels below this are noise.
const LEVEL_MIN: f64 = 0.045;
/// So far before a hit the beam may already meet the obstacle, metres: rounding to cells. A rim that nothing shows as free keeps
/// the robot off its walls.
const MARGIN_M: f64 = CELL_M;
/// Evidence of a contact whose place on the bumper is known from infrared.
const CONTACT_SURE: u8 = 4;
/// Evidence of a contact that may be anywhere on a short piece of the bumper, up to [`SHORT_ARC_M`].
const CONTACT_NARROW: u8 = 2;
/// Evidence of a contact that may be anywhere on half of the bumper: most of these cells are free, so that only those are
/// believed in which two such contacts meet.
const CONTACT_VAGUE: u8 = 1;
/// Pieces of the bumper up to this length say where the thing is, metres.
const SHORT_ARC_M: f64 = 0.08;
/// Most contact and cliff evidence.
const COUNT_MAX: u8 = 8;
/// A contact is looked for within this angle of the sensor that sees it, radians: half of the angle between two sensors.
const CONTACT_SPREAD_RAD: f64 = 0.26;
/// Level from which on a sensor sees what the bumper touches.
const CONTACT_LEVEL: f64 = 0.35;
/// Loads are those of what most of the brush is on: this share of it in the middle says most, its ends say little, and less than
/// the middle of the next lane does.
const FLOOR_INNER: f64 = 0.5;
const FLOOR_INNER_STEP: i8 = 6;
const FLOOR_OUTER_STEP: i8 = 2;
/// Most by which the body is drawn smaller than it is, metres.
const SHRINK_MAX_M: f64 = CELL_M;

/// Draws sightings of one robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pencil {
    pub(super) body: Body,
    pub(super) sensors: SensorLayout,
}

impl Pencil {
    /// Takes what a sighting says into the layers.
    pub(super) fn draw(&self, sighting: &Sighting, layers: &mut Layers) {
        self.draw_body(sighting, layers);
        for (sensor, level) in self.sensors.proximity.sensors().iter().zip(sighting.levels) {
            self.draw_beam(sighting, (*sensor, level), layers);
        }
        self.draw_contacts(sighting, layers);
        self.draw_cliffs(sighting, layers);
        self.draw_floor(sighting, layers);
    }

    /// The kind of floor under the brush, as far as the body has been there: nothing else may come of it than that.
    pub(super) fn draw_floor(&self, sighting: &Sighting, layers: &mut Layers) {
        let Some(felt) = sighting.floor else { return };
        let behind_m = -0.001 * f64::from(felt.behind_mm);
        let half_m = 0.5 * self.body.swath_m;
        let steps = libm::ceil(half_m / (0.6 * CELL_M)).clamp(1.0, 64.0) as i32;
        let mut last = None;
        for step in -steps..=steps {
            let share = f64::from(step) / f64::from(steps);
            let cell = Cell::under(sighting.pose.transform(Point2 {
                x_m: behind_m,
                y_m: share * half_m,
            }));
            if last == Some(cell) || !layers.at(cell).has(Flag::Body) {
                continue;
            }
            last = Some(cell);
            let weight = if share.abs() <= FLOOR_INNER {
                FLOOR_INNER_STEP
            } else {
                FLOOR_OUTER_STEP
            };
            layers.change(cell, |evidence| evidence.feel(felt.kind, weight));
        }
    }

    /// Where the body is, nothing else can be. A contact speaks of what it touches now, so it is drawn after this.
    fn draw_body(&self, sighting: &Sighting, layers: &mut Layers) {
        let sigma_m = 0.01 * f64::from(sighting.sigma_cm);
        let radius_m = self.body.radius_m - sigma_m.clamp(0.5 * CELL_M, SHRINK_MAX_M);
        let centre = sighting.pose.position();
        let (low, high) = (centre.y_m - radius_m, centre.y_m + radius_m);
        for y in row_of(low)..=row_of(high) {
            let off_m = (f64::from(y) + 0.5) * CELL_M - centre.y_m;
            let half_m = libm::sqrt((radius_m * radius_m - off_m * off_m).max(0.0));
            let first = libm::ceil((centre.x_m - half_m) / CELL_M - 0.5) as i32;
            let last = libm::floor((centre.x_m + half_m) / CELL_M - 0.5) as i32;
            for x in first..=last {
                layers.change(Cell { x, y }, |evidence| {
                    add_occupancy(evidence, BODY_STEP);
                    evidence.contact = evidence.contact.saturating_sub(CONTACT_SURE);
                    evidence.set(Flag::Body);
                    note_sigma(evidence, sighting);
                });
            }
        }
    }

    fn draw_beam(&self, sighting: &Sighting, (sensor, level): (Pose2, u8), layers: &mut Layers) {
        let response = self.sensors.proximity.response;
        let beam = sighting.pose * sensor;
        let level = f64::from(level) / 255.0;
        let hit_m = if level < LEVEL_MIN {
            None
        } else {
            response.distance_m(level)
        };
        let (clear_m, step) = match hit_m {
            Some(hit_m) => (hit_m - MARGIN_M, PASSED_STEP),
            None => (NOTHING_SHARE * response.range_m, NOTHING_STEP),
        };
        walk(beam, (response.skin_m, clear_m), |cell| {
            layers.change(cell, |evidence| {
                add_occupancy(evidence, step);
                note_sigma(evidence, sighting);
            });
        });
        let Some(hit_m) = hit_m else { return };
        let beyond_m = (hit_m - response.skin_m).max(0.0);
        let beyond = beyond_m / HIT_HALF_M;
        let strength = (HIT_STEP / (1.0 + beyond * beyond)) as i8;
        // The surface lies before the cell that stands for it.
        let behind_m = hit_m + 0.5 * CELL_M;
        let reach_m = behind_m * libm::tan(response.half_angle_rad);
        let mut last = None;
        for off_m in [-reach_m, 0.0, reach_m] {
            let cell = Cell::under(beam.transform(Point2 {
                x_m: behind_m,
                y_m: off_m,
            }));
            if last == Some(cell) {
                continue;
            }
            last = Some(cell);
            let share = if off_m == 0.0 { strength } else { strength / 3 };
            layers.change(cell, |evidence| {
                add_occupancy(evidence, share);
                note_sigma(evidence, sighting);
            });
        }
    }

    fn draw_contacts(&self, sighting: &Sighting, layers: &mut Layers) {
        // While the bumper stays pressed it tells nothing new, and the robot backs away from what it met.
        if !sighting.touched.begins() {
            return;
        }
        let Some((from_rad, to_rad)) = self.touched_arc(sighting) else {
            return;
        };
        let seen = self.brightest_within(sighting, (from_rad, to_rad));
        let (from_rad, to_rad, evidence) = match seen {
            Some(at_rad) => (
                (at_rad - CONTACT_SPREAD_RAD).max(from_rad),
                (at_rad + CONTACT_SPREAD_RAD).min(to_rad),
                CONTACT_SURE,
            ),
            None if (to_rad - from_rad) * self.body.radius_m <= SHORT_ARC_M => {
                (from_rad, to_rad, CONTACT_NARROW)
            }
            None => (from_rad, to_rad, CONTACT_VAGUE),
        };
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
            layers.change(cell, |gathered| {
                gathered.contact = gathered.contact.saturating_add(evidence).min(COUNT_MAX);
                note_sigma(gathered, sighting);
            });
        }
    }

    /// The part of the bumper that a contact presses, in radians from straight ahead.
    fn touched_arc(&self, sighting: &Sighting) -> Option<(f64, f64)> {
        let bumper = self.sensors.bumper;
        match sighting.touched.contacts() {
            (false, false) => None,
            (true, true) => Some((-bumper.overlap_rad, bumper.overlap_rad)),
            (true, false) => Some((bumper.overlap_rad, bumper.half_arc_rad)),
            (false, true) => Some((-bumper.half_arc_rad, -bumper.overlap_rad)),
        }
    }

    /// Bearing of the proximity sensor that sees most of what the arc touches.
    fn brightest_within(&self, sighting: &Sighting, (from_rad, to_rad): (f64, f64)) -> Option<f64> {
        let mut best: Option<(f64, f64)> = None;
        for (sensor, level) in self.sensors.proximity.sensors().iter().zip(sighting.levels) {
            let bearing_rad = libm::atan2(sensor.y_m, sensor.x_m);
            let level = f64::from(level) / 255.0;
            let within = (from_rad - CONTACT_SPREAD_RAD..=to_rad + CONTACT_SPREAD_RAD).contains(&bearing_rad);
            if within && level >= CONTACT_LEVEL && best.is_none_or(|(brightest, _)| level > brightest) {
                best = Some((level, bearing_rad));
            }
        }
        best.map(|(_, bearing_rad)| bearing_rad)
    }

    fn draw_cliffs(&self, sighting: &Sighting, layers: &mut Layers) {
        let Some(places) = self.sensors.cliffs else { return };
        for (place, gone) in places.iter().zip(sighting.touched.cliffs()) {
            let cell = Cell::under(sighting.pose.transform(*place));
            layers.change(cell, |evidence| {
                evidence.cliff = if gone {
                    (evidence.cliff + CONTACT_SURE).min(COUNT_MAX)
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

fn add_occupancy(evidence: &mut Evidence, step: i8) {
    evidence.occupancy = evidence
        .occupancy
        .saturating_add(step)
        .clamp(-OCCUPANCY_MAX, OCCUPANCY_MAX);
}

/// Keeps how sure the pose was when the cell was seen best.
fn note_sigma(evidence: &mut Evidence, sighting: &Sighting) {
    if !evidence.has(Flag::Seen) || sighting.sigma_cm < evidence.sigma_cm {
        evidence.sigma_cm = sighting.sigma_cm;
    }
    evidence.set(Flag::Seen);
}

/// Visits the cells along a beam from one distance to another, each once.
fn walk(beam: Pose2, (from_m, to_m): (f64, f64), mut visit: impl FnMut(Cell)) {
    /// Fine enough that no cell is left out that the beam crosses by more than a corner.
    const STEP_M: f64 = 0.6 * CELL_M;
    let (sin, cos) = libm::sincos(beam.heading_rad);
    let mut last = None;
    let steps = libm::floor((to_m - from_m) / STEP_M).clamp(-1.0, 256.0);
    for step in 0..=steps as i32 {
        let way_m = from_m + f64::from(step) * STEP_M;
        let cell = Cell::under(Point2 {
            x_m: beam.x_m + cos * way_m,
            y_m: beam.y_m + sin * way_m,
        });
        if last != Some(cell) {
            visit(cell);
        }
        last = Some(cell);
    }
}
