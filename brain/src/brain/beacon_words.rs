//! Says when the robot looks for its place between its radio beacons, when it has found it, and which beacons it forgets.

use super::Brain;
use crate::localization::BeaconEvent;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;

impl Brain {
    /// Notes what the beacons have decided.
    pub(super) fn tell_beacons(&mut self) {
        for event in self.localization.take_beacon_events() {
            let (kind, reason, value) = match event {
                BeaconEvent::Carried => (DecisionKind::SearchPlace, Reason::PlaceUnknown, 0.0),
                BeaconEvent::SearchPlace => (DecisionKind::SearchPlace, Reason::PlaceContradicted, 0.0),
                BeaconEvent::PlaceFound { driven_m } => {
                    (DecisionKind::PlaceFound, Reason::BeaconsAgree, driven_m)
                }
                BeaconEvent::Moved { number } => (
                    DecisionKind::ForgetBeacons,
                    Reason::BeaconMoved,
                    f64::from(number),
                ),
                BeaconEvent::Refuted { number } => (
                    DecisionKind::ForgetBeacons,
                    Reason::BeaconsMoved,
                    f64::from(number),
                ),
            };
            self.mind.decide(kind, reason, value);
        }
    }
}
