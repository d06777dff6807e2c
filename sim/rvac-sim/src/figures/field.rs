//! Measures that the field reports of cleaning robots, so that others can compare.

use home::Truth;
use serde::Serialize;

use super::MeasuredFloor;

/// Share at which the efficiency of the path is taken.
const EFFICIENCY_SHARE: f64 = 0.90;

/// The measures of one job.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FieldMeasures {
    /// Share of the reachable floor that was swept, 0..1.
    pub swept: f64,
    /// Minutes of the job for each room of the plan; `null` = the plan knows no rooms, or the job was not over.
    pub minutes_per_room: Option<f64>,
    /// Contacts during the job for each square metre of reachable floor.
    pub collisions_per_m2: f64,
    /// Share of the swept floor over which the swath came again later in the job, ten seconds or more after it left.
    pub swept_twice: f64,
    /// Ideal length of a sweep of the floor that was swept (its area over the width of the swath), over the length of the path
    /// until 90 % were swept; `null` = they were not.
    pub path_efficiency: Option<f64>,
}

/// What of the measures must be noted while the job runs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FieldWatch {
    begun_path_m: Option<f64>,
    efficiency: Option<f64>,
    swept_twice: f64,
}

impl FieldWatch {
    /// A sample of the running job.
    pub(super) fn sample(&mut self, truth: &Truth, floor: &MeasuredFloor) {
        let path_m = truth.path_m - *self.begun_path_m.get_or_insert(truth.path_m);
        if truth.swept_share >= EFFICIENCY_SHARE && path_m > 0.0 {
            self.efficiency
                .get_or_insert(truth.swept_m2 / floor.swath_m() / path_m);
        }
        if truth.swept_m2 > 0.0 {
            self.swept_twice = truth.swept_twice_m2 / truth.swept_m2;
        }
    }

    /// `job_s` is the length of a job that is over.
    pub(super) fn measures(
        &self,
        swept: f64,
        (contacts, job_s): (u32, Option<f64>),
        floor: &MeasuredFloor,
    ) -> FieldMeasures {
        let rooms = floor.rooms.filter(|rooms| *rooms > 0);
        FieldMeasures {
            swept,
            minutes_per_room: job_s.zip(rooms).map(|(s, rooms)| s / 60.0 / f64::from(rooms)),
            collisions_per_m2: f64::from(contacts) / floor.reachable_m2,
            swept_twice: self.swept_twice,
            path_efficiency: self.efficiency,
        }
    }
}

impl FieldMeasures {
    /// Names of the measures, in the order of [`Self::values`].
    pub const NAMES: [&str; 5] = [
        "swept",
        "minutes_per_room",
        "collisions_per_m2",
        "swept_twice",
        "path_efficiency",
    ];

    /// All measures.
    #[must_use]
    pub const fn values(&self) -> [Option<f64>; 5] {
        [
            Some(self.swept),
            self.minutes_per_room,
            Some(self.collisions_per_m2),
            Some(self.swept_twice),
            self.path_efficiency,
        ]
    }

    /// The means over some jobs, of those that have the measure.
    #[must_use]
    pub fn means(jobs: &[Self]) -> [Option<f64>; 5] {
        core::array::from_fn(|number| {
            let values: Vec<f64> = jobs.iter().filter_map(|job| job.values()[number]).collect();
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        })
    }
}

impl std::fmt::Display for FieldMeasures {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&field_line(self.values()))
    }
}

/// Values in the order of [`FieldMeasures::NAMES`] as one line for people.
#[must_use]
pub fn field_line([swept, minutes, collisions, twice, efficiency]: [Option<f64>; 5]) -> String {
    let text = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.3}"));
    format!(
        "swept {}, {} min a room, {} collisions a m2, swept twice {}, path efficiency at 90 % {}",
        text(swept),
        text(minutes),
        text(collisions),
        text(twice),
        text(efficiency)
    )
}

#[cfg(test)]
mod tests {
    use super::{FieldMeasures, FieldWatch, MeasuredFloor};
    use home::{Home, Noise, RobotModel, Truth, World};
    use std::sync::Arc;

    const PLAN: &str =
        "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0, 0], [2, 0], [2, 2], [0, 2]]\n";

    fn truth() -> Truth {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("room", PLAN, &model).unwrap();
        *World::new(Arc::new(home), &model, &Noise::ideal(), 1, None).truth()
    }

    /// 10 m2 with a swath of 0.25 m at 0.2 m/s.
    fn floor() -> MeasuredFloor {
        MeasuredFloor {
            reachable_m2: 10.0,
            t0_s: 200.0,
            cruise_m_per_s: 0.2,
            rooms: Some(4),
        }
    }

    #[test]
    fn the_efficiency_is_that_of_the_way_to_90_percent_and_what_comes_later_does_not_count() {
        let mut watch = FieldWatch::default();
        for (path_m, swept_m2, swept_twice_m2) in [
            (7.0, 0.0, 0.0),
            (30.0, 8.0, 0.8),
            (52.0, 9.0, 1.8),
            (90.0, 9.5, 3.8),
        ] {
            let sample = Truth {
                path_m,
                swept_m2,
                swept_share: swept_m2 / 10.0,
                swept_twice_m2,
                ..truth()
            };
            watch.sample(&sample, &floor());
        }
        let measures = watch.measures(0.95, (5, Some(480.0)), &floor());
        let wanted = FieldMeasures {
            swept: 0.95,
            minutes_per_room: Some(2.0),
            collisions_per_m2: 0.5,
            swept_twice: 3.8 / 9.5,
            // 9 m2 are 36 m of swath, and the way was 45 m.
            path_efficiency: Some(0.8),
        };
        assert_eq!(measures, wanted);
        assert_eq!(FieldMeasures::means(&[measures, measures]), measures.values());
    }

    #[test]
    fn what_was_not_reached_is_absent() {
        let mut watch = FieldWatch::default();
        watch.sample(&truth(), &floor());
        let measures = watch.measures(0.5, (0, None), &floor());
        assert_eq!(
            (measures.minutes_per_room, measures.path_efficiency),
            (None, None)
        );
        let without_rooms = MeasuredFloor {
            rooms: None,
            ..floor()
        };
        let measures = watch.measures(0.5, (0, Some(60.0)), &without_rooms);
        assert_eq!(measures.minutes_per_room, None);
    }
}
