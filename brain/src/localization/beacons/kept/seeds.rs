//! Where a robot can be that hears kept beacons: multilateration of one hop.

use super::parameters::SEEDS;
use crate::localization::beacons::hop::Hop;
use crate::localization::beacons::weight::robust_square;
use crate::model::geometry::{Point2, Pose2};
use crate::model::known_beacon::KnownBeacon;
use crate::model::pose_estimate::PoseEstimate;

/// Number of kept beacons that a hop hears.
pub(super) fn count(reference: &[KnownBeacon], hop: &Hop) -> usize {
    heard(reference, hop).count()
}

/// Kept beacons with the range to each, and its standard deviation.
fn heard<'run>(
    reference: &'run [KnownBeacon],
    hop: &'run Hop,
) -> impl Iterator<Item = (&'run KnownBeacon, f64, f64)> {
    hop.ranges.iter().filter_map(|range| {
        let known = reference.iter().find(|known| known.number == range.beacon)?;
        let sigma_m = libm::hypot(range.sigma_m, libm::hypot(known.place_sigma_m, known.sigma_m));
        Some((
            known,
            range.range_m - known.bias_m,
            sigma_m.max(SEEDS.sigma_min_m),
        ))
    })
}

/// Poses at the end of a hop that its ranges allow: each position with all headings. Beacons in line allow the mirrored position as well.
pub(super) fn poses(reference: &[KnownBeacon], hop: &Hop) -> Vec<PoseEstimate> {
    let turn_rad = core::f64::consts::TAU / f64::from(SEEDS.headings);
    positions(reference, hop)
        .into_iter()
        .flat_map(|at| {
            (0..SEEDS.headings).map(move |heading| PoseEstimate {
                pose: Pose2 {
                    x_m: at.x_m,
                    y_m: at.y_m,
                    heading_rad: turn_rad * f64::from(heading),
                },
                sigma_m: SEEDS.sigma_m,
                sigma_rad: 0.5 * turn_rad,
                ..PoseEstimate::default()
            })
        })
        .collect()
}

/// Positions on circles about the nearest beacon that fit about as well as the best one.
fn positions(reference: &[KnownBeacon], hop: &Hop) -> Vec<Point2> {
    let heard: Vec<_> = heard(reference, hop).collect();
    let Some((nearest, range_m, _)) = heard.iter().min_by(|one, other| one.1.total_cmp(&other.1)) else {
        return Vec::new();
    };
    let cost = |at: Point2| -> f64 {
        heard
            .iter()
            .map(|(known, range_m, sigma_m)| robust_square((range_m - at.distance_m(known.place)) / sigma_m))
            .sum()
    };
    let mut tried: Vec<(f64, Point2)> = (0..SEEDS.directions)
        .flat_map(|direction| {
            let turned_rad = core::f64::consts::TAU * f64::from(direction) / f64::from(SEEDS.directions);
            let (sin, cos) = libm::sincos(turned_rad);
            SEEDS.off_m.map(|off_m| {
                let away_m = (range_m + off_m).max(0.0);
                Point2 {
                    x_m: nearest.place.x_m + away_m * cos,
                    y_m: nearest.place.y_m + away_m * sin,
                }
            })
        })
        .map(|at| (cost(at), at))
        .collect();
    tried.sort_by(|one, other| one.0.total_cmp(&other.0));
    let least = tried.first().map_or(0.0, |best| best.0);
    let mut found: Vec<Point2> = Vec::new();
    for (cost, at) in tried {
        if cost > least + SEEDS.worse_max || found.len() >= SEEDS.positions_max {
            break;
        }
        if found.iter().all(|other| other.distance_m(at) >= SEEDS.apart_m) {
            found.push(at);
        }
    }
    found
}
