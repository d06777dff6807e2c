//! Mean signal strength of each beacon in each cell of the floor.

use super::parameters::FINGERPRINT;
use std::collections::BTreeMap;

use super::mean_rssi::MeanRssi;
use crate::model::geometry::Point2;

/// Signal strengths by beacon and cell.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct FingerprintMap {
    cells: BTreeMap<(u16, i32, i32), FingerprintCell>,
}

#[derive(Clone, Copy, Debug, Default)]
struct FingerprintCell {
    count: f64,
    dbm: f64,
}

impl FingerprintMap {
    pub(super) fn learn(&mut self, at: Point2, levels: &[MeanRssi]) {
        let Some((x, y)) = cell(at) else { return };
        for level in levels {
            let cell = self.cells.entry((level.beacon, x, y)).or_default();
            cell.count = (cell.count + 1.0).min(FINGERPRINT.count_max);
            cell.dbm += (level.dbm - cell.dbm) / cell.count;
        }
    }

    /// Expected strength of a beacon at a position; `None` where too few means are known.
    pub(super) fn expected_dbm(&self, beacon: u16, at: Point2) -> Option<f64> {
        let (middle_x, middle_y) = cell(at)?;
        let (mut weight, mut sum) = (0.0, 0.0);
        for x in middle_x - FINGERPRINT.neighbours..=middle_x + FINGERPRINT.neighbours {
            let row = (beacon, x, middle_y - FINGERPRINT.neighbours)
                ..=(beacon, x, middle_y + FINGERPRINT.neighbours);
            for ((_, _, y), cell) in self.cells.range(row) {
                let off_m = centre(x, *y).distance_m(at) / FINGERPRINT.reach_m;
                let contribution =
                    cell.count.min(FINGERPRINT.contribution_max) * libm::exp(-0.5 * off_m * off_m);
                weight += contribution;
                sum += contribution * cell.dbm;
            }
        }
        (weight >= FINGERPRINT.known_min).then(|| sum / weight)
    }

    /// No signal was received yet.
    pub(super) fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }
}

/// The cell of a position, if that is in any home.
fn cell(at: Point2) -> Option<(i32, i32)> {
    let number = |value_m: f64| {
        let number = libm::floor(value_m / FINGERPRINT.cell_m);
        (number.abs() < 10_000.0).then_some(number as i32)
    };
    Some((number(at.x_m)?, number(at.y_m)?))
}

fn centre(x: i32, y: i32) -> Point2 {
    Point2 {
        x_m: (f64::from(x) + 0.5) * FINGERPRINT.cell_m,
        y_m: (f64::from(y) + 0.5) * FINGERPRINT.cell_m,
    }
}

#[cfg(test)]
mod tests {
    use super::{FingerprintMap, MeanRssi};
    use crate::model::geometry::Point2;

    fn at(x_m: f64) -> Point2 {
        Point2 { x_m, y_m: 0.25 }
    }

    #[test]
    fn a_fingerprint_covers_its_neighbourhood_only() {
        let mut map = FingerprintMap::default();
        assert!(map.is_empty());
        for number in 0..20 {
            let x_m = 0.1 * f64::from(number);
            let dbm = if x_m < 1.0 { -50.0 } else { -70.0 };
            map.learn(at(x_m), &[MeanRssi { beacon: 2, dbm }]);
        }
        assert!((map.expected_dbm(2, at(0.1)).unwrap() + 50.0).abs() < 3.0);
        assert!((map.expected_dbm(2, at(1.9)).unwrap() + 70.0).abs() < 3.0);
        assert_eq!(map.expected_dbm(2, at(4.0)), None);
        assert_eq!(map.expected_dbm(1, at(0.1)), None);
        assert_eq!(map.expected_dbm(2, at(f64::NAN)), None);
    }

    #[test]
    fn the_last_means_count_most() {
        let mut map = FingerprintMap::default();
        for dbm in [-80.0, -60.0] {
            for _ in 0..60 {
                map.learn(at(0.2), &[MeanRssi { beacon: 0, dbm }]);
            }
        }
        let now_dbm = map.expected_dbm(0, at(0.2)).unwrap();
        assert!((now_dbm + 60.0).abs() < 1.0, "{now_dbm}");
    }
}
