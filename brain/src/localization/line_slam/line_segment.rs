//! Extracts straight line segments from the infrared readings of a short path.
//!
//! *Local submap*: a short path on which something was seen; odometry is nearly exact on it. *Range point*: what one sensor saw at
//! one moment. *Line segment*: a straight line on which many range points of a submap lie. Beams are cones, so the nearest point of
//! a wall within a cone is closer than the wall on the cone's axis. The fit corrects for that.

use super::parameters::SEGMENT;
use crate::model::config::ProximityResponse;
use crate::model::geometry::{Point2, Pose2, normalize_rad};

/// One sensor reading, in the frame of the submap.
#[derive(Clone, Copy, Debug)]
pub(super) struct RangePoint {
    /// Position and direction of the sensor.
    pub(super) beam: Pose2,
    /// Measured distance, metres.
    pub(super) seen_m: f64,
}

/// A straight piece of wall, in the frame of the submap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineSegment {
    /// Its middle.
    pub(super) middle: Point2,
    /// Direction from the wall into the free space, radians.
    pub(super) normal_rad: f64,
    /// Half of its length, metres.
    pub(super) half_m: f64,
    /// Standard deviation of its direction, radians.
    pub(super) sigma_rad: f64,
    /// Standard deviation of its position across, metres.
    pub(super) sigma_m: f64,
}

/// A line in Hesse normal form: all points at the distance `offset_m` along the normal.
#[derive(Clone, Copy, Debug)]
struct HesseLine {
    normal_rad: f64,
    offset_m: f64,
}

impl HesseLine {
    /// How much closer than the line a point shows the wall, metres, and the derivative of that by the normal's direction; `None`
    /// when the beam does not hit the front of the line.
    fn off_m(self, point: &RangePoint, cone: f64) -> Option<(f64, f64)> {
        let (sin, cos) = libm::sincos(self.normal_rad);
        let (beam_y, beam_x) = libm::sincos(point.beam.heading_rad);
        let toward = -(cos * beam_x + sin * beam_y);
        if toward < SEGMENT.cosine_min {
            return None;
        }
        let share = (toward + cone) / (1.0 + cone);
        let (x_m, y_m) = (point.beam.x_m, point.beam.y_m);
        let clear_m = cos * x_m + sin * y_m - self.offset_m;
        let toward_slope = sin * beam_x - cos * beam_y;
        let slope = cos * y_m - sin * x_m - point.seen_m * toward_slope / (1.0 + cone);
        Some((clear_m - point.seen_m * share, slope))
    }

    /// Position of a point along the line.
    fn along_m(self, point: &RangePoint) -> f64 {
        let at = hit(point);
        let (sin, cos) = libm::sincos(self.normal_rad);
        cos * at.y_m - sin * at.x_m
    }
}

fn hit(point: &RangePoint) -> Point2 {
    point.beam.transform(Point2 {
        x_m: point.seen_m,
        y_m: 0.0,
    })
}

/// The segments of a submap, the one with the most points first.
pub(super) fn extract_segments(points: &[RangePoint], response: &ProximityResponse) -> Vec<LineSegment> {
    let cone = libm::tan(response.half_angle_rad);
    let mut left: Vec<RangePoint> = points.to_vec();
    let mut found = Vec::new();
    for _ in 0..2 * SEGMENT.segments_max {
        if left.len() < SEGMENT.points_min || found.len() >= SEGMENT.segments_max {
            break;
        }
        let Some(line) = strongest(&left, cone) else { break };
        let line = fitted(&left, line, cone);
        let lies_on = |point: &RangePoint, near_m: f64| {
            line.off_m(point, cone)
                .is_some_and(|(off_m, _)| off_m.abs() <= near_m)
        };
        let on_it: Vec<RangePoint> = left
            .iter()
            .filter(|point| lies_on(point, SEGMENT.fit_m))
            .copied()
            .collect();
        let before = left.len();
        left.retain(|point| !lies_on(point, SEGMENT.near_m));
        found.extend(segment_of(&on_it, line, cone));
        if left.len() == before {
            break;
        }
    }
    found
}

/// The line with the most points near it (Hough transform).
fn strongest(points: &[RangePoint], cone: f64) -> Option<HesseLine> {
    let middle = points.get(points.len() / 2)?.beam.position();
    let middle_step = SEGMENT.hough_offsets;
    let steps = 2 * middle_step + 1;
    let mut votes = vec![0_u32; SEGMENT.hough_directions * steps];
    for point in points {
        for direction in 0..SEGMENT.hough_directions {
            let line = line_of(direction, middle, 0.0);
            let Some((off_m, _)) = line.off_m(point, cone) else {
                continue;
            };
            let step = libm::round(off_m / SEGMENT.hough_step_m) + middle_step as f64;
            if (0.0..=2.0 * middle_step as f64).contains(&step)
                && let Some(vote) = votes.get_mut(direction * steps + step as usize)
            {
                *vote += 1;
            }
        }
    }
    let (place, count) = votes
        .iter()
        .enumerate()
        .max_by_key(|(place, count)| (**count, core::cmp::Reverse(*place)))?;
    let (direction, step) = (place / steps, place % steps);
    let offset_m = (step as f64 - middle_step as f64) * SEGMENT.hough_step_m;
    (*count as usize >= SEGMENT.points_min / 2).then(|| line_of(direction, middle, offset_m))
}

fn line_of(direction: usize, middle: Point2, beyond_m: f64) -> HesseLine {
    let normal_rad = core::f64::consts::TAU * direction as f64 / SEGMENT.hough_directions as f64;
    let (sin, cos) = libm::sincos(normal_rad);
    HesseLine {
        normal_rad,
        offset_m: cos * middle.x_m + sin * middle.y_m + beyond_m,
    }
}

/// Fits a line to the points near it by reweighted least squares.
fn fitted(points: &[RangePoint], mut line: HesseLine, cone: f64) -> HesseLine {
    for round in 0..6 {
        let near_m = SEGMENT.near_m * if round < 2 { 2.0 } else { 1.0 };
        let [mut aa, mut ab, mut bb, mut ra, mut rb] = [0.0; 5];
        for point in points {
            let Some((off_m, slope)) = line.off_m(point, cone) else {
                continue;
            };
            if off_m.abs() > near_m {
                continue;
            }
            let far = point.seen_m / 0.1;
            let tail = off_m / 0.015;
            let weight = 1.0 / ((1.0 + far * far) * (1.0 + tail * tail));
            aa += weight * slope * slope;
            ab -= weight * slope;
            bb += weight;
            ra -= weight * slope * off_m;
            rb += weight * off_m;
        }
        let determinant = aa * bb - ab * ab;
        if determinant <= 1e-9 {
            return line;
        }
        let turn_rad = ((ra * bb - rb * ab) / determinant).clamp(-0.1, 0.1);
        let shift_m = (rb - ab * turn_rad) / bb;
        line = HesseLine {
            normal_rad: normalize_rad(line.normal_rad + turn_rad),
            offset_m: line.offset_m + shift_m.clamp(-0.05, 0.05),
        };
    }
    line
}

/// The segment of the points of one line, if they are many, close and contiguous enough.
fn segment_of(points: &[RangePoint], line: HesseLine, cone: f64) -> Option<LineSegment> {
    let mut along_m: Vec<f64> = points.iter().map(|point| line.along_m(point)).collect();
    along_m.sort_by(f64::total_cmp);
    let piece = along_m
        .chunk_by(|one, next| next - one <= SEGMENT.gap_max_m)
        .max_by_key(|piece| piece.len())?;
    let (low_m, high_m) = (*piece.first()?, *piece.last()?);
    let squares_m2: f64 = points
        .iter()
        .filter_map(|point| line.off_m(point, cone))
        .map(|(off_m, _)| off_m * off_m)
        .sum();
    let scatter_m = libm::sqrt(squares_m2 / points.len().max(1) as f64);
    let length_m = high_m - low_m;
    if piece.len() < SEGMENT.points_min
        || length_m < SEGMENT.length_min_m
        || scatter_m > SEGMENT.scatter_max_m
    {
        return None;
    }
    let (sin, cos) = libm::sincos(line.normal_rad);
    let along_m = 0.5 * (low_m + high_m);
    let turn_rad = (SEGMENT.end_error_scatters * scatter_m).max(SEGMENT.end_error_min_m) / length_m;
    Some(LineSegment {
        middle: Point2 {
            x_m: cos * line.offset_m - sin * along_m,
            y_m: sin * line.offset_m + cos * along_m,
        },
        normal_rad: line.normal_rad,
        half_m: 0.5 * length_m,
        sigma_rad: libm::sqrt(turn_rad * turn_rad + SEGMENT.sigma_min_rad * SEGMENT.sigma_min_rad),
        sigma_m: (SEGMENT.sigma_scatters * scatter_m).max(SEGMENT.sigma_min_m),
    })
}

#[cfg(test)]
mod tests {
    use super::{RangePoint, extract_segments};
    use crate::model::config::ProximityResponse;
    use crate::model::geometry::Pose2;
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_6};

    const RESPONSE: ProximityResponse = ProximityResponse {
        range_m: 0.25,
        half_angle_rad: 0.087,
        half_level_m: 0.06,
        skin_m: 0.01,
        near_m: None,
    };

    /// Readings of seven sensors between a wall at x = 1 and one at y = `left_m`, both infinitely long.
    fn sense(pose: Pose2, left_m: f64, points: &mut Vec<RangePoint>) {
        let cone = RESPONSE.half_angle_rad.tan();
        for number in -3..=3 {
            let heading_rad = f64::from(number) * FRAC_PI_6;
            let mount = Pose2 {
                x_m: 0.165 * heading_rad.cos(),
                y_m: 0.165 * heading_rad.sin(),
                heading_rad,
            };
            let beam = pose * mount;
            let seen_m = [
                (1.0 - beam.x_m, beam.heading_rad.cos()),
                (left_m - beam.y_m, beam.heading_rad.sin()),
            ]
            .into_iter()
            .filter(|(_, toward)| *toward > 0.0)
            .map(|(clear_m, toward)| clear_m * (1.0 + cone) / (toward + cone))
            .fold(f64::INFINITY, f64::min);
            if seen_m < RESPONSE.range_m {
                points.push(RangePoint { beam, seen_m });
            }
        }
    }

    /// Readings along a path of so many centimetres from `x_m` on.
    fn driven(x_m: f64, centimetres: u32, heading_rad: f64, left_m: f64) -> Vec<RangePoint> {
        let mut points = Vec::new();
        for step in 0..centimetres {
            let pose = Pose2 {
                x_m: x_m + 0.01 * f64::from(step),
                y_m: 0.0,
                heading_rad,
            };
            sense(pose, left_m, &mut points);
        }
        points
    }

    #[test]
    fn a_wall_approached_at_an_angle_is_located() {
        let points = driven(0.65, 15, 0.35, 9.0);
        let found = extract_segments(&points, &RESPONSE);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            (found[0].normal_rad.abs() - core::f64::consts::PI).abs() < 0.01,
            "{found:?}"
        );
        assert!((found[0].middle.x_m - 1.0).abs() < 0.004, "{found:?}");
    }

    #[test]
    fn a_corner_gives_two_segments() {
        let points = driven(0.2, 60, 0.0, 0.25);
        let mut found = extract_segments(&points, &RESPONSE);
        found.sort_by(|one, other| one.normal_rad.abs().total_cmp(&other.normal_rad.abs()));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0].normal_rad + FRAC_PI_2).abs() < 0.02, "{found:?}");
        assert!((found[0].middle.y_m - 0.25).abs() < 0.005, "{found:?}");
        assert!((found[1].middle.x_m - 1.0).abs() < 0.006, "{found:?}");
    }

    #[test]
    fn scatter_of_the_points_raises_the_deviations_of_a_segment() {
        let sure = |noise_m: f64| {
            let mut random = crate::model::random::Random::new(4);
            let mut points = driven(0.65, 15, 0.35, 9.0);
            for point in &mut points {
                point.seen_m += noise_m * random.normal();
            }
            let found = extract_segments(&points, &RESPONSE);
            (found[0].sigma_m, found[0].sigma_rad)
        };
        let (calm, noisy) = (sure(0.003), sure(0.011));
        assert_eq!(calm.0, super::SEGMENT.sigma_min_m);
        assert!(noisy.0 > 1.1 * calm.0, "{noisy:?} after {calm:?}");
        assert!(noisy.1 > 1.1 * calm.1, "{noisy:?} after {calm:?}");
    }

    #[test]
    fn scattered_points_give_no_segment() {
        assert_eq!(extract_segments(&[], &RESPONSE), []);
        let points: Vec<RangePoint> = (0..40)
            .map(|number| RangePoint {
                beam: Pose2 {
                    x_m: 0.013 * f64::from(number * 17 % 41),
                    y_m: 0.011 * f64::from(number * 23 % 37),
                    heading_rad: f64::from(number),
                },
                seen_m: 0.05 + 0.005 * f64::from(number * 7 % 31),
            })
            .collect();
        assert_eq!(extract_segments(&points, &RESPONSE), []);
    }
}
