//! Beam model: how likely the infrared readings are at a pose in the map.

use super::parameters::{BEAM, SURFACE};
use super::surface::{Range, Reflectance, Reflectances, bell};
use super::surroundings::Surroundings;
use crate::model::config::{PROXIMITY_MAX, ProximityLayout, ProximityResponse};
use crate::model::geometry::Point2;

/// One sensor and its reading.
#[derive(Clone, Copy, Debug, Default)]
struct Beam {
    /// Position of the sensor in the body's frame, metres.
    x_m: f64,
    y_m: f64,
    /// Direction of the sensor in the body's frame.
    cos: f64,
    sin: f64,
    seen: Option<BeamReading>,
}

/// A reading of a sensor that sees something.
#[derive(Clone, Copy, Debug, PartialEq)]
enum BeamReading {
    /// A distance.
    At(Range),
    /// Something within the range, by a sensor with one threshold only.
    Near,
}

/// All sensors at one moment.
#[derive(Clone, Debug)]
pub(super) struct BeamModel {
    beams: [Beam; PROXIMITY_MAX],
    count: usize,
    range_m: f64,
    spread: f64,
    /// No beam reaches obstacles farther from the centre than this, metres.
    reach_m: f64,
    /// Farthest sensor from the centre, metres.
    mount_m: f64,
}

/// What a beam says of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::localization) enum BeamAgreement {
    /// Something is where the map has something.
    Agrees,
    /// Nothing is where the map has something.
    Missing,
    /// Something is where the map has nothing.
    Unforeseen,
}

/// A beam compared with the map.
#[derive(Clone, Copy, Debug)]
pub(in crate::localization) struct ComparedBeam {
    pub(in crate::localization) agreement: BeamAgreement,
    /// Where the thing is that is there or missing.
    pub(in crate::localization) at: Point2,
}

/// How well the map explains the beams at a pose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::localization) struct BeamScore {
    /// Beams for which the map or the sensor has an obstacle.
    pub(in crate::localization) informative: u32,
    /// Informative beams for which both agree.
    pub(in crate::localization) consistent: u32,
}

impl BeamScore {
    /// Sum of both.
    pub(in crate::localization) fn and(self, other: Self) -> Self {
        Self {
            informative: self.informative.saturating_add(other.informative),
            consistent: self.consistent.saturating_add(other.consistent),
        }
    }
}

impl BeamModel {
    pub(super) fn new(layout: &ProximityLayout) -> Self {
        let mut beams = [Beam::default(); PROXIMITY_MAX];
        let mut mount_m: f64 = 0.0;
        for (beam, pose) in beams.iter_mut().zip(layout.sensors()) {
            let (sin, cos) = libm::sincos(pose.heading_rad);
            *beam = Beam {
                x_m: pose.x_m,
                y_m: pose.y_m,
                cos,
                sin,
                seen: None,
            };
            mount_m = mount_m.max(pose.position().distance_m(Point2::ORIGIN));
        }
        let range_m = layout.response.near_m.unwrap_or(layout.response.range_m);
        Self {
            beams,
            count: layout.sensors().len(),
            range_m,
            spread: libm::tan(layout.response.half_angle_rad),
            reach_m: mount_m + range_m + 4.0 * BEAM.range_band_m,
            mount_m,
        }
    }

    /// Takes the levels of an observation.
    pub(super) fn read(&mut self, levels: &[f32], response: &ProximityResponse) {
        self.count = self.count.min(levels.len());
        for (beam, level) in self.beams.iter_mut().zip(levels) {
            beam.seen = seen(f64::from(*level), response);
        }
    }

    /// Likelihood of all levels at a pose; 1 at best.
    pub(super) fn likelihood(
        &self,
        map: &impl Surroundings,
        place: &BodyPose,
        surfaces: &mut Reflectances,
    ) -> f64 {
        let beams = self.beams.get(..self.count).unwrap_or_default();
        if place.clearance_m > self.reach_m {
            let hits = beams.iter().filter(|beam| beam.seen.is_some());
            return hits.fold(1.0, |likelihood, beam| {
                let into_unknown = looks_into_unknown(map, place, beam, None);
                likelihood * if into_unknown { BEAM.unknown } else { BEAM.unmapped }
            });
        }
        let each = beams.iter().zip(&mut surfaces.surfaces);
        each.fold(1.0, |likelihood, (beam, surface)| {
            let expected_m = self.cast(map, place, beam);
            let measured = self.beam_likelihood(beam.seen, expected_m, surface);
            if measured < BEAM.unknown && looks_into_unknown(map, place, beam, expected_m) {
                likelihood * BEAM.unknown
            } else {
                likelihood * measured
            }
        })
    }

    /// Counts the beams that the map explains at a pose.
    pub(super) fn score(&self, map: &impl Surroundings, place: &BodyPose) -> BeamScore {
        let mut score = BeamScore::default();
        for compared in self.compared(map, place) {
            score.informative += 1;
            score.consistent += u32::from(compared.agreement == BeamAgreement::Agrees);
        }
        score
    }

    /// Compares each beam that tells something with the map at a pose.
    pub(super) fn compared<'compared>(
        &'compared self,
        map: &'compared impl Surroundings,
        place: &'compared BodyPose,
    ) -> impl Iterator<Item = ComparedBeam> + 'compared {
        let beams = self.beams.get(..self.count).unwrap_or_default();
        beams
            .iter()
            .filter_map(move |beam| self.compare(map, place, beam))
    }

    fn compare(&self, map: &impl Surroundings, place: &BodyPose, beam: &Beam) -> Option<ComparedBeam> {
        let cast_m = self.cast(map, place, beam);
        let expected_m = cast_m.filter(|expected_m| *expected_m < self.range_m - BEAM.range_band_m);
        let (is_consistent, seen_m) = match (beam.seen, expected_m) {
            (None, None) => return None,
            (Some(BeamReading::At(range)), Some(expected_m)) => {
                let off = (range.seen_m - expected_m) * range.per_sigma;
                (off.abs() < 3.0, Some(range.seen_m))
            }
            (Some(BeamReading::At(range)), None) => {
                let short = (self.range_m - range.seen_m) * range.per_sigma;
                (short < 3.0, Some(range.seen_m))
            }
            (Some(BeamReading::Near), _) => (cast_m.is_some(), Some(self.range_m)),
            (None, Some(_)) => (false, None),
        };
        if !is_consistent && looks_into_unknown(map, place, beam, expected_m) {
            return None;
        }
        let (agreement, distance_m) = match (expected_m, seen_m) {
            (expected_m, Some(seen_m)) if is_consistent => {
                (BeamAgreement::Agrees, expected_m.unwrap_or(seen_m))
            }
            (Some(expected_m), seen_m) if seen_m.is_none_or(|seen_m| seen_m > expected_m) => {
                (BeamAgreement::Missing, expected_m)
            }
            (_, seen_m) => (BeamAgreement::Unforeseen, seen_m?),
        };
        let start = place.point(beam.x_m, beam.y_m);
        let (dx, dy) = place.direction(beam.cos, beam.sin);
        Some(ComparedBeam {
            agreement,
            at: Point2 {
                x_m: start.x_m + dx * distance_m,
                y_m: start.y_m + dy * distance_m,
            },
        })
    }

    fn beam_likelihood(
        &self,
        seen: Option<BeamReading>,
        expected_m: Option<f64>,
        surface: &mut Reflectance,
    ) -> f64 {
        if seen.is_none() {
            *surface = Reflectance::default();
        }
        match (seen, expected_m) {
            (None, None) => 1.0,
            (None, Some(expected_m)) => {
                let beyond = (expected_m - self.range_m) / BEAM.range_band_m + 0.5;
                BEAM.unseen + (1.0 - BEAM.unseen) * beyond.clamp(0.0, 1.0)
            }
            (Some(BeamReading::Near), Some(expected_m)) => {
                let within = (self.range_m - expected_m) / BEAM.range_band_m + 0.5;
                BEAM.unmapped + (1.0 - BEAM.unmapped) * within.clamp(0.0, 1.0)
            }
            (Some(BeamReading::Near), None) => BEAM.unmapped,
            (Some(BeamReading::At(range)), Some(expected_m)) => surface.likelihood(range, expected_m),
            // The nearest obstacle in the map may be just beyond the range.
            (Some(BeamReading::At(range)), None) => {
                let off = (self.range_m + 2.0 * BEAM.range_band_m - range.seen_m) * range.per_sigma;
                BEAM.unmapped + (1.0 - BEAM.unmapped) * bell(off * off)
            }
        }
    }

    /// Expected distance from the sensor to the first obstacle in its cone.
    fn cast(&self, map: &impl Surroundings, place: &BodyPose, beam: &Beam) -> Option<f64> {
        let start = place.point(beam.x_m, beam.y_m);
        let (dx, dy) = place.direction(beam.cos, beam.sin);
        let limit_m = self.range_m + BEAM.range_band_m;
        let mut distance_m = (0.95 * (place.clearance_m - self.mount_m)).max(0.0);
        for _ in 0..BEAM.steps_max {
            if distance_m > limit_m {
                return None;
            }
            let clear_m = map.clearance_m(Point2 {
                x_m: start.x_m + dx * distance_m,
                y_m: start.y_m + dy * distance_m,
            });
            if clear_m <= self.spread * distance_m + BEAM.meet_m {
                return Some(distance_m + clear_m.max(0.0));
            }
            distance_m += (0.95 * clear_m).max(BEAM.step_min_m);
        }
        None
    }
}

/// Whether a beam ends in unknown space with no known obstacle in front.
fn looks_into_unknown(
    map: &impl Surroundings,
    place: &BodyPose,
    beam: &Beam,
    expected_m: Option<f64>,
) -> bool {
    let Some(BeamReading::At(Range { seen_m, .. })) = beam.seen else {
        return false;
    };
    if expected_m.is_some_and(|expected_m| expected_m <= seen_m) {
        return false;
    }
    let start = place.point(beam.x_m, beam.y_m);
    let (dx, dy) = place.direction(beam.cos, beam.sin);
    !map.is_known(Point2 {
        x_m: start.x_m + dx * seen_m,
        y_m: start.y_m + dy * seen_m,
    })
}

fn seen(level: f64, response: &ProximityResponse) -> Option<BeamReading> {
    // Written so that NaN is no reading.
    let shows = level > BEAM.level_min && response.half_level_m > 0.0;
    if !shows {
        return None;
    }
    if response.near_m.is_some() {
        return Some(BeamReading::Near);
    }
    let beyond = libm::sqrt((1.0 / level - 1.0).max(0.0));
    let distance_m = response.skin_m + response.half_level_m * beyond;
    // Derivative of the distance by the reflectance. Close to the rim the level saturates.
    let by_reflection_m = 0.5 * response.half_level_m * (1.0 + beyond * beyond) / beyond.max(0.5);
    let level_sigma_m = by_reflection_m * SURFACE.reflectance_sigma;
    let sigma_m =
        libm::sqrt(level_sigma_m * level_sigma_m + SURFACE.distance_sigma_m * SURFACE.distance_sigma_m);
    Some(BeamReading::At(Range {
        seen_m: distance_m.min(response.range_m),
        by_reflection_m,
        per_sigma: 1.0 / sigma_m,
    }))
}

/// A pose with everything that the sensor models need.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyPose {
    pub(super) centre: Point2,
    pub(super) cos: f64,
    pub(super) sin: f64,
    /// Distance from the centre to the nearest obstacle, metres.
    pub(super) clearance_m: f64,
}

impl BodyPose {
    pub(super) fn point(&self, x_m: f64, y_m: f64) -> Point2 {
        let (dx, dy) = self.direction(x_m, y_m);
        Point2 {
            x_m: self.centre.x_m + dx,
            y_m: self.centre.y_m + dy,
        }
    }

    fn direction(&self, x: f64, y: f64) -> (f64, f64) {
        (self.cos * x - self.sin * y, self.sin * x + self.cos * y)
    }
}
