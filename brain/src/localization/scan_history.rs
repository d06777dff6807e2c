//! What the robot saw and touched on its last metres, in a frame that only odometry moves. [`super::global_localizer`] matches it
//! against the whole map.

use std::collections::VecDeque;

use super::rssi_fingerprint::MeanRssi;
use crate::model::advance::Advance;
use crate::model::config::ProximityLayout;
use crate::model::geometry::{Point2, Pose2};
use crate::model::observation::{Contacts, Observation};

/// What is remembered of the last metres.
struct HistoryParameters {
    /// Distance that is remembered, metres: odometry bends a longer path too much.
    length_m: f64,
    /// Distance between two samples, metres.
    sample_m: f64,
    /// Turn between two samples, radians.
    sample_rad: f64,
    /// A beam without a reading is free up to this share of its range.
    open_share: f64,
    /// Levels below this are no reading, 0..1.
    level_min: f64,
}

const PARAMETERS: HistoryParameters = HistoryParameters {
    length_m: 14.0,
    sample_m: 0.08,
    sample_rad: 0.35,
    open_share: 0.75,
    level_min: 0.02,
};

/// Kind of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PointKind {
    /// The body's centre was there.
    Body,
    /// Something solid was seen or touched there.
    Solid,
    /// A beam passed there.
    Open,
}

#[derive(Clone, Copy, Debug)]
struct ScanPoint {
    at: Point2,
    kind: PointKind,
    distance_m: f64,
}

/// Signal strength of a beacon at a point.
#[derive(Clone, Copy, Debug)]
struct ReceivedRssi {
    at: Point2,
    level: MeanRssi,
    distance_m: f64,
}

/// Points of the last metres.
#[derive(Clone, Debug, Default)]
pub(super) struct ScanHistory {
    history_from_base: Pose2,
    distance_m: f64,
    sampled_at_m: f64,
    turned_rad: f64,
    points: VecDeque<ScanPoint>,
    received: VecDeque<ReceivedRssi>,
}

impl ScanHistory {
    pub(super) fn advance(&mut self, advance: Advance) {
        self.history_from_base = self
            .history_from_base
            .after_arc(advance.distance_m, advance.turn_rad);
        self.distance_m += advance.distance_m.abs();
        self.turned_rad += advance.turn_rad.abs();
    }

    /// The robot was carried away, so nothing of the history is near any more.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Length of the history in metres.
    pub(super) fn length_m(&self) -> f64 {
        self.points
            .front()
            .map_or(0.0, |oldest| self.distance_m - oldest.distance_m)
    }

    /// Samples the sensors, as often as the robot has moved enough.
    pub(super) fn sample(&mut self, observation: &Observation, layout: &ProximityLayout) {
        if self.distance_m - self.sampled_at_m < PARAMETERS.sample_m
            && self.turned_rad < PARAMETERS.sample_rad
        {
            return;
        }
        self.sampled_at_m = self.distance_m;
        self.turned_rad = 0.0;
        self.put(Point2::ORIGIN, PointKind::Body);
        for (sensor, level) in layout.sensors().iter().zip(&observation.proximity) {
            let level = f64::from(*level);
            let (distance_m, kind) = match layout.response.distance_m(level) {
                Some(distance_m) => (distance_m, PointKind::Solid),
                None if level > PARAMETERS.level_min => continue,
                None => (PARAMETERS.open_share * layout.response.range_m, PointKind::Open),
            };
            let at = sensor.transform(Point2 {
                x_m: distance_m,
                y_m: 0.0,
            });
            self.put(at, kind);
        }
        while self
            .points
            .front()
            .is_some_and(|oldest| self.distance_m - oldest.distance_m > PARAMETERS.length_m)
        {
            self.points.pop_front();
        }
    }

    /// Stores signal strengths received here.
    pub(super) fn receive(&mut self, levels: &[MeanRssi]) {
        let (at, distance_m) = (self.history_from_base.position(), self.distance_m);
        let received = levels.iter().map(|&level| ReceivedRssi {
            at,
            level,
            distance_m,
        });
        self.received.extend(received);
        while self
            .received
            .front()
            .is_some_and(|oldest| distance_m - oldest.distance_m > PARAMETERS.length_m)
        {
            self.received.pop_front();
        }
    }

    /// Signal strengths and their positions in the present frame of the robot.
    pub(super) fn received(&self) -> Vec<(Point2, MeanRssi)> {
        let base_from_history = self.history_from_base.inverse();
        self.received
            .iter()
            .map(|received| (base_from_history.transform(received.at), received.level))
            .collect()
    }

    /// Stores a contact at the rim of a body of this radius.
    pub(super) fn touch(&mut self, contacts: Contacts, radius_m: f64) {
        if !contacts.any() {
            return;
        }
        let side = f64::from(u8::from(contacts.left)) - f64::from(u8::from(contacts.right));
        self.put(
            Point2::in_direction(side * core::f64::consts::FRAC_PI_4, radius_m),
            PointKind::Solid,
        );
    }

    fn put(&mut self, in_base: Point2, kind: PointKind) {
        self.points.push_back(ScanPoint {
            at: self.history_from_base.transform(in_base),
            kind,
            distance_m: self.distance_m,
        });
    }

    /// Points of one kind in the present frame of the robot, about `most` at most, evenly picked.
    pub(super) fn points(&self, kind: PointKind, most: usize) -> Vec<Point2> {
        let base_from_history = self.history_from_base.inverse();
        let of_kind = || self.points.iter().filter(|point| point.kind == kind);
        let every = of_kind().count() / most.max(1) + 1;
        of_kind()
            .step_by(every)
            .map(|point| base_from_history.transform(point.at))
            .collect()
    }
}
