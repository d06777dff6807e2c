//! What one observation says about the cells around the robot.
//!
//! *Sighting*: an observation as far as the map needs it, with the pose at which it was made. Sightings are kept, so that
//! the map can be drawn again when the poses turn out to have been others.

use super::carpet::FloorFelt;
use crate::model::config::PROXIMITY_MAX;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// An observation as far as the map needs it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sighting {
    pub(super) time_us: u64,
    pub(super) pose: Pose2,
    /// Pose by odometry.
    pub(super) odom: Pose2,
    /// Standard deviation of the pose in centimetres.
    pub(super) sigma_cm: u8,
    /// Levels of the proximity sensors, 255 = touching.
    pub(super) levels: [u8; PROXIMITY_MAX],
    /// Bumper halves left and right that were pressed, and cliff sensors left, middle and right that saw no floor.
    pub(super) touched: Touched,
    /// What the motors' loads say of the floor.
    pub(super) floor: Option<FloorFelt>,
}

/// Switches of a sighting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Touched {
    bits: u8,
}

impl Touched {
    fn of(observation: &Observation) -> Self {
        let (contacts, cliffs) = (observation.contacts, observation.cliffs);
        let switches = [
            contacts.left,
            contacts.right,
            cliffs.left,
            cliffs.middle,
            cliffs.right,
        ];
        let bits = switches
            .iter()
            .enumerate()
            .fold(0, |bits, (place, on)| bits | u8::from(*on) << place);
        Self { bits }
    }

    fn bit(self, place: u8) -> bool {
        self.bits & (1 << place) != 0
    }

    /// The cleaning parts ran.
    pub(super) fn sweeps(self) -> bool {
        self.bit(6)
    }

    /// Notes that the cleaning parts run.
    pub(super) fn note_sweeping(&mut self) {
        self.bits |= 1 << 6;
    }

    /// Without what came of the sighting before.
    fn switches(self) -> u8 {
        self.bits & 0b1_1111
    }

    /// The contact was not there at the sighting before.
    pub(super) fn begins(self) -> bool {
        self.bit(5)
    }

    /// The same after a sighting with those switches.
    pub(super) fn after(self, before: Self) -> Self {
        const CONTACTS: u8 = 0b11;
        let begins = self.bits & CONTACTS & !before.bits != 0;
        Self {
            bits: self.bits | u8::from(begins) << 5,
        }
    }

    /// Left and right half of the bumper.
    pub(super) fn contacts(self) -> (bool, bool) {
        (self.bit(0), self.bit(1))
    }

    /// Left, middle and right.
    pub(super) fn cliffs(self) -> [bool; 3] {
        [self.bit(2), self.bit(3), self.bit(4)]
    }
}

impl Sighting {
    pub(super) fn new(estimate: &PoseEstimate, observation: &Observation) -> Self {
        let mut levels = [0; PROXIMITY_MAX];
        for (kept, level) in levels.iter_mut().zip(&observation.proximity) {
            *kept = (255.0 * level) as u8;
        }
        Self {
            time_us: observation.time_us,
            pose: estimate.pose,
            odom: estimate.odom,
            sigma_cm: (100.0 * estimate.sigma_m) as u8,
            levels,
            touched: Touched::of(observation),
            floor: None,
        }
    }

    /// Whether so little happened since `before` that this one would only say the same again.
    pub(super) fn repeats(&self, before: &Self) -> bool {
        /// Half a cell.
        const STEP_M: f64 = 0.0125;
        /// Half a cell at the end of a beam.
        const TURN_RAD: f64 = 0.03;
        let way_m = self.pose.position().distance_m(before.pose.position());
        let turn_rad = crate::model::geometry::normalize_rad(self.pose.heading_rad - before.pose.heading_rad);
        self.touched.switches() == before.touched.switches() && way_m < STEP_M && turn_rad.abs() < TURN_RAD
    }
}
