//! Compact observations for the map.
//!
//! *Sighting*: the part of an observation that the map needs, with the pose at that time. The map keeps sightings to redraw
//! itself when past poses are corrected.

use super::carpet::SurfaceObservation;
use crate::model::config::PROXIMITY_MAX;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// The part of an observation that the map needs.
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
    /// Bumper halves left and right, and cliff sensors left, middle and right without floor.
    pub(super) switches: SwitchStates,
    /// The floor surface, from the motor currents.
    pub(super) surface: Option<SurfaceObservation>,
}

/// Switch states of a sighting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SwitchStates {
    bits: u8,
}

impl SwitchStates {
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
            .fold(0, |bits, (index, on)| bits | u8::from(*on) << index);
        Self { bits }
    }

    fn bit(self, index: u8) -> bool {
        self.bits & (1 << index) != 0
    }

    /// Whether the cleaning motors run.
    pub(super) fn sweeps(self) -> bool {
        self.bit(6)
    }

    /// Records that the cleaning motors run.
    pub(super) fn note_sweeping(&mut self) {
        self.bits |= 1 << 6;
    }

    /// The switches alone, without derived bits.
    fn without_history(self) -> u8 {
        self.bits & 0b1_1111
    }

    /// Whether a contact closed since the sighting before.
    pub(super) fn has_new_contact(self) -> bool {
        self.bit(5)
    }

    /// The same, marked with the contacts that closed since `before`.
    pub(super) fn after(self, before: Self) -> Self {
        const CONTACTS: u8 = 0b11;
        let has_new_contact = self.bits & CONTACTS & !before.bits != 0;
        Self {
            bits: self.bits | u8::from(has_new_contact) << 5,
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
            switches: SwitchStates::of(observation),
            surface: None,
        }
    }

    /// Whether the robot has moved so little since `before` that this sighting adds no information.
    pub(super) fn repeats(&self, before: &Self) -> bool {
        /// Half a cell.
        const STEP_M: f64 = 0.0125;
        /// Half a cell at the end of a beam.
        const TURN_RAD: f64 = 0.03;
        let distance_m = self.pose.position().distance_m(before.pose.position());
        let turn_rad = crate::model::geometry::normalize_rad(self.pose.heading_rad - before.pose.heading_rad);
        self.switches.without_history() == before.switches.without_history()
            && distance_m < STEP_M
            && turn_rad.abs() < TURN_RAD
    }
}
