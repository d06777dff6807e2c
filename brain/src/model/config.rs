//! Description of the robot that the brain controls.

use super::geometry::{Point2, Pose2};

/// Shape of a round robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Radius of the body in metres.
    pub radius_m: f64,
    /// Width that one pass cleans, in metres.
    pub swath_m: f64,
    /// Distance between the wheels' contact points, in metres.
    pub track_m: f64,
}

/// Speeds of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Cleaning speed, m/s.
    pub cruise_m_per_s: f64,
    /// Highest forward speed, m/s; only manual driving uses it.
    pub max_m_per_s: f64,
    /// Highest turn rate, rad/s.
    pub turn_max_rad_per_s: f64,
}

/// Most proximity sensors of a layout; as many as the wire carries.
pub const PROXIMITY_MAX: usize = 8;

/// Poses and responses of the sensors. From `robots/*/robot.toml`: the wire only carries their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorLayout {
    /// Infrared proximity sensors. Without any, only contacts and the body map the floor.
    pub proximity: ProximityLayout,
    /// The bumper.
    pub bumper: BumperLayout,
    /// Positions of the cliff sensors left, middle and right, in the body's frame; `None` = not known.
    pub cliffs: Option<[Point2; 3]>,
}

/// Infrared proximity sensors. The level falls with the square of the distance: `level = albedo / (1 + (beyond / half_level)^2)`,
/// where `beyond` begins at the rim and the albedo is 1 on average.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProximityLayout {
    sensors: [Pose2; PROXIMITY_MAX],
    count: usize,
    /// Response of the sensors.
    pub response: ProximityResponse,
}

/// Response of an infrared proximity sensor; the same for all sensors of a robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProximityResponse {
    /// Range from the sensor, metres.
    pub range_m: f64,
    /// Half of the beam's opening angle, radians.
    pub half_angle_rad: f64,
    /// Distance beyond the rim at which a white wall gives half of the full level, metres.
    pub half_level_m: f64,
    /// Distance from the sensor to the rim along its beam, metres.
    pub skin_m: f64,
    /// For a sensor with a single digital line: distance from the sensor within which a white wall reads near (1) instead of far
    /// (0), metres; `None` = the sensor reports levels.
    pub near_m: Option<f64>,
}

/// The bumper: an arc in front with a switch for each half.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BumperLayout {
    /// The bumper spans this angle to each side of straight ahead, radians.
    pub half_arc_rad: f64,
    /// A contact within this angle of straight ahead presses both halves, radians.
    pub overlap_rad: f64,
}

impl Default for SensorLayout {
    /// Only a bumper over the front half: the default for a robot without a description.
    fn default() -> Self {
        Self {
            proximity: ProximityLayout::new(&[], ProximityResponse::default()),
            bumper: BumperLayout {
                half_arc_rad: core::f64::consts::FRAC_PI_2,
                overlap_rad: 0.0,
            },
            cliffs: None,
        }
    }
}

impl SensorLayout {
    /// Positions of the cliff sensors from left to right; the brain supports three or none.
    #[must_use]
    pub fn three_cliffs(places: impl IntoIterator<Item = Point2>) -> Option<[Point2; 3]> {
        let places: Vec<Point2> = places.into_iter().collect();
        places.try_into().ok()
    }
}

impl ProximityLayout {
    /// Sensors at `poses` in the body's frame, each facing along its x axis, in the order of [`crate::Observation::proximity`].
    /// Poses beyond [`PROXIMITY_MAX`] are ignored.
    #[must_use]
    pub fn new(poses: &[Pose2], response: ProximityResponse) -> Self {
        let mut sensors = [Pose2::IDENTITY; PROXIMITY_MAX];
        for (sensor, pose) in sensors.iter_mut().zip(poses) {
            *sensor = *pose;
        }
        Self {
            sensors,
            count: poses.len().min(PROXIMITY_MAX),
            response,
        }
    }

    /// Sensors that face outward from a circle of `mount_radius_m` around the body's centre, in the order of `headings_rad`. Zero
    /// is ahead, counter-clockwise positive.
    #[must_use]
    pub fn ring(headings_rad: &[f64], mount_radius_m: f64, response: ProximityResponse) -> Self {
        let outward = |&heading_rad: &f64| {
            let turn = Pose2 {
                heading_rad,
                ..Pose2::IDENTITY
            };
            let out = Pose2 {
                x_m: mount_radius_m,
                ..Pose2::IDENTITY
            };
            turn * out
        };
        let poses: Vec<Pose2> = headings_rad.iter().map(outward).collect();
        Self::new(&poses, response)
    }

    /// Poses of the sensors in the body's frame.
    #[must_use]
    pub fn sensors(&self) -> &[Pose2] {
        self.sensors.get(..self.count).unwrap_or_default()
    }
}

impl ProximityResponse {
    /// Distance from the sensor to a white wall at `level` (0..=1), in metres; `None` beyond the range or without a level. For a
    /// digital sensor it is the middle of its near range.
    #[must_use]
    pub fn distance_m(&self, level: f64) -> Option<f64> {
        // Written so that NaN counts as no level.
        let seen = level > 0.0;
        if !seen {
            return None;
        }
        if let Some(near_m) = self.near_m {
            return Some(0.5 * (self.skin_m + near_m));
        }
        let beyond_m = self.half_level_m * libm::sqrt((1.0 / level - 1.0).max(0.0));
        let distance_m = self.skin_m + beyond_m;
        (distance_m <= self.range_m).then_some(distance_m)
    }

    /// Level (0..=1) of a white wall at `distance_m` from the sensor; 0 beyond the range.
    #[must_use]
    pub fn level(&self, distance_m: f64) -> f64 {
        if distance_m > self.range_m || self.half_level_m <= 0.0 {
            return 0.0;
        }
        if let Some(near_m) = self.near_m {
            return if distance_m <= near_m { 1.0 } else { 0.0 };
        }
        let beyond = (distance_m - self.skin_m).max(0.0) / self.half_level_m;
        1.0 / (1.0 + beyond * beyond)
    }
}

/// Geometry, speeds and budgets. Geometry comes from `robots/*/robot.toml` or from the robot's own description.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrainConfig {
    /// Shape.
    pub body: Body,
    /// Speeds.
    pub speeds: Speeds,
    /// Sensors.
    pub sensors: SensorLayout,
    /// Seconds of motion after which a job ends and the robot looks for its dock (S26).
    pub task_budget_s: f64,
    /// Seconds after which the search for the dock ends.
    pub dock_budget_s: f64,
    /// Battery charge, 0..1, below which a job ends and the robot looks for its dock.
    pub battery_low: f32,
    /// Battery charge, 0..1, above which an interrupted job continues.
    pub battery_charged: f32,
}

impl BrainConfig {
    /// A configuration with the project's budgets: 120 minutes of cleaning (S26), 60 minutes of dock search, low at 15 %,
    /// charged at 90 %, and no sensors but a bumper.
    #[must_use]
    pub fn new(body: Body, speeds: Speeds) -> Self {
        Self {
            body,
            speeds,
            sensors: SensorLayout::default(),
            task_budget_s: 7200.0,
            dock_budget_s: 3600.0,
            battery_low: 0.15,
            battery_charged: 0.9,
        }
    }
}

#[cfg(test)]
impl BrainConfig {
    /// A robot with nothing but a bumper, for tests that do not depend on its size and speeds.
    pub(crate) fn of_tests() -> Self {
        let body = Body {
            radius_m: 0.175,
            track_m: 0.23,
            swath_m: 0.3,
        };
        let speeds = Speeds {
            cruise_m_per_s: 0.25,
            max_m_per_s: 0.35,
            turn_max_rad_per_s: 1.5,
        };
        Self::new(body, speeds)
    }
}

#[cfg(test)]
mod tests {
    use super::ProximityResponse;

    #[test]
    fn level_and_distance_are_inverse_within_the_range() {
        let response = ProximityResponse {
            range_m: 0.25,
            half_angle_rad: 0.09,
            half_level_m: 0.06,
            skin_m: 0.01,
            near_m: None,
        };
        for distance_m in [0.01, 0.02, 0.07, 0.249] {
            let seen_m = response.distance_m(response.level(distance_m)).unwrap();
            assert!((seen_m - distance_m).abs() < 1e-9, "{seen_m} for {distance_m}");
        }
        assert_eq!(response.distance_m(response.level(0.26)), None);
        for level in [0.0, -1.0, f64::NAN, 1e-6] {
            assert_eq!(response.distance_m(level), None);
        }
        assert_eq!(
            response.distance_m(7.0),
            Some(0.01),
            "brighter than white is touching"
        );
    }
}
