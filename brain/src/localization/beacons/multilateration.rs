//! Multilateration: locates a beacon from ranges along an approximate path.

use super::parameters::MULTILATERATION;
use super::weight::weight;
use crate::model::geometry::Point2;

/// A range and where it was measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeasuredRange {
    pub(super) from: Point2,
    pub(super) range_m: f64,
}

/// The position that fits best, if no alternative fits nearly as well. Along a straight path the mirrored one does.
pub(super) fn locate_beacon(ranges: &[MeasuredRange]) -> Option<Point2> {
    let nearest = ranges
        .iter()
        .min_by(|one, other| one.range_m.total_cmp(&other.range_m))?;
    let mut tried: Vec<(f64, Point2)> = Vec::new();
    for direction in 0..MULTILATERATION.directions {
        let (sin, cos) = libm::sincos(
            core::f64::consts::TAU * f64::from(direction) / f64::from(MULTILATERATION.directions),
        );
        for off_m in MULTILATERATION.off_m {
            let away_m = (nearest.range_m + off_m).max(0.0);
            let place = Point2 {
                x_m: nearest.from.x_m + away_m * cos,
                y_m: nearest.from.y_m + away_m * sin,
            };
            tried.push((misfit(ranges, place), place));
        }
    }
    let (least, best) = tried
        .iter()
        .min_by(|one, other| one.0.total_cmp(&other.0))
        .copied()?;
    let other_m = MULTILATERATION
        .other_m
        .max(MULTILATERATION.other_share * nearest.range_m);
    let alone = tried
        .iter()
        .filter(|(_, place)| place.distance_m(best) > other_m)
        .all(|(misfit, _)| *misfit > MULTILATERATION.worse_min * least);
    alone.then_some(best)
}

/// Weighted mean of the squared deviations.
pub(super) fn misfit(ranges: &[MeasuredRange], place: Point2) -> f64 {
    let sum: f64 = ranges
        .iter()
        .map(|range| {
            let off = (range.range_m - range.from.distance_m(place)) / MULTILATERATION.sigma_m;
            weight(off) * off * off
        })
        .sum();
    sum / ranges.len().max(1) as f64 + 0.05
}

#[cfg(test)]
mod tests {
    use super::{MeasuredRange, locate_beacon};
    use crate::model::geometry::Point2;

    const BEACON: Point2 = Point2 { x_m: 4.0, y_m: 3.0 };

    fn ranges(path: impl Fn(f64) -> Point2) -> Vec<MeasuredRange> {
        (0..60)
            .map(|number| {
                let from = path(0.1 * f64::from(number));
                // Every tenth range takes a detour.
                let detour_m = if number % 10 == 0 { 2.0 } else { 0.0 };
                MeasuredRange {
                    from,
                    range_m: from.distance_m(BEACON) + detour_m,
                }
            })
            .collect()
    }

    #[test]
    fn a_bent_path_locates_a_beacon_and_a_straight_one_does_not() {
        let bent = ranges(|distance_m| Point2 {
            x_m: distance_m.min(3.0),
            y_m: (distance_m - 3.0).max(0.0),
        });
        let found = locate_beacon(&bent).unwrap();
        assert!(found.distance_m(BEACON) < 0.6, "{found:?}");
        let straight = ranges(|distance_m| Point2 {
            x_m: distance_m,
            y_m: 0.0,
        });
        assert_eq!(locate_beacon(&straight), None);
    }
}
