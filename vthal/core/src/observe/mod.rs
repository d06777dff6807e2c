//! Turns a device's reports into the brain's observations.

mod charge;
mod heard_beacons;

use brain::observation::{BeaconSignal, Contacts, Observation};
use brain::{Inhibit, LinkFault};

use heard_beacons::HeardBeacons;

use crate::device::{Battery, Description, Report, WrappingTotal};

/// A heading of the Linux board's gyro older than this is not used.
const BOARD_HEADING_FRESH_US: u64 = 200_000;

/// Signals of beacons that wait for the next step of the brain at most; a radio measures some in 20 ms, not dozens.
const BEACONS_MAX: usize = 32;

/// The last heading of the gyro on the Linux board.
#[derive(Clone, Copy, Debug)]
struct BoardHeading {
    at_us: u64,
    heading_urad: i32,
}

/// Keeps the present observation and fills it in place, so that a report costs no allocation.
#[derive(Debug)]
pub struct Observer {
    /// Heading of whichever gyro counts, microradians.
    heading: WrappingTotal,
    board_heading: Option<BoardHeading>,
    not_calibrated: bool,
    heard_beacons: HeardBeacons,
    observation: Observation,
}

impl Observer {
    /// Nothing is known yet.
    #[must_use]
    pub fn new() -> Self {
        let observation = Observation {
            link_up: false,
            ..Observation::default()
        };
        Self {
            heading: WrappingTotal::default(),
            board_heading: None,
            not_calibrated: false,
            heard_beacons: HeardBeacons::default(),
            observation,
        }
    }

    /// The present view. Its time is that of the last change.
    #[must_use]
    pub fn observation(&self) -> &Observation {
        &self.observation
    }

    /// Takes the total of the gyro on the Linux board. From its first report on, the heading is its own, and is missing while
    /// it is silent: two gyros with different drift are never mixed.
    pub fn take_board_heading(&mut self, now_us: u64, heading_urad: i32) {
        if self.board_heading.is_none() {
            self.heading.rebase();
        }
        self.board_heading = Some(BoardHeading {
            at_us: now_us,
            heading_urad,
        });
    }

    /// Takes what was measured of a beacon; the next step of the brain sees it. More than a step can be worth are dropped.
    pub fn take_beacon(&mut self, now_us: u64, signal: BeaconSignal) {
        if let BeaconSignal::Range(range) = signal {
            self.heard_beacons.hear(now_us, range.beacon);
        }
        if self.observation.beacons.len() < BEACONS_MAX {
            self.observation.beacons.push(signal);
        }
    }

    /// Clears what an observation carries only once.
    pub fn seen(&mut self) {
        self.observation.beacons.clear();
    }

    fn heading_urad(&self, now_us: u64, report: &Report) -> Option<i32> {
        match self.board_heading {
            Some(board) => (now_us < board.at_us + BOARD_HEADING_FRESH_US).then_some(board.heading_urad),
            None => report.heading_urad,
        }
    }

    /// Takes a report, arrived at `now_us`, of a robot that is described by `description`.
    pub fn take_report(&mut self, now_us: u64, report: &Report, description: &Description) {
        let heading_urad = self.heading_urad(now_us, report);
        let view = &mut self.observation;
        view.travel_left_m = report.travel.left_m;
        view.travel_right_m = report.travel.right_m;
        view.gyro_heading_rad =
            heading_urad.map(|heading_urad| self.heading.take(heading_urad) as f64 * 1e-6);
        view.contacts = contacts(report.contacts, description.sensors.bumpers);
        view.cliffs = report.cliffs;
        view.wheel_drop = report.wheel_drops.any();
        view.docked = report.docked;
        view.currents = report.currents;
        refill(
            &mut view.proximity,
            &report.proximity,
            description.sensors.proximity,
        );
        refill(
            &mut view.dock_beams,
            &report.dock_beams,
            description.sensors.dock_receivers,
        );
        view.inhibits = report.inhibits;
        if self.not_calibrated {
            view.inhibits.insert(Inhibit::NotCalibrated);
        }
    }

    /// Whether values that the robot needs to move were never measured; in force from the next report on.
    pub fn set_not_calibrated(&mut self, not_calibrated: bool) {
        self.not_calibrated = not_calibrated;
    }

    /// Takes what is known of the battery.
    pub fn take_battery(&mut self, battery: Option<&Battery>) {
        self.observation.battery_charge = battery.map(|battery| battery.charge as f32);
        self.observation.charge_flow = battery.and_then(charge::flow);
    }

    /// The robot has restarted: the total of its gyro starts again. That of the board's own gyro goes on.
    pub fn rebase(&mut self) {
        if self.board_heading.is_none() {
            self.heading.rebase();
        }
    }

    /// Stamps the observation with the time and the state of the link. Times always rise strictly.
    pub fn stamp(&mut self, now_us: u64, link: LinkView) {
        self.observation.time_us = now_us.max(self.observation.time_us + 1);
        self.observation.beacons_in_range = self.heard_beacons.count(now_us);
        self.observation.link_up = link.up;
        for fault in LinkFault::all() {
            self.observation.inhibits.remove(fault.inhibit());
        }
        if let Some(fault) = link.fault {
            self.observation.inhibits.insert(fault.inhibit());
        }
        self.observation.speed_share = link.speed_share;
    }
}

impl Default for Observer {
    fn default() -> Self {
        Self::new()
    }
}

/// How the link is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkView {
    /// A session is open, telemetry is fresh and nothing is wrong with it.
    pub up: bool,
    /// Why it is not up, unless it is silent.
    pub fault: Option<LinkFault>,
    /// Share of the commanded speed that quality allows, 0..1.
    pub speed_share: f64,
}

/// Currents of left wheel, right wheel and main brush in amperes, of a robot that measures them.
pub(crate) fn currents_a(report: &Report) -> Option<[f32; 3]> {
    report.currents.map(|currents| {
        [
            currents.wheel_left_a,
            currents.wheel_right_a,
            currents.brush_main_a.unwrap_or(0.0),
        ]
    })
}

/// A robot with one zone reports it on the left; the brain is given both.
fn contacts(zones: Contacts, count: u8) -> Contacts {
    let any = zones.any();
    if count == 1 {
        Contacts {
            left: any,
            right: any,
        }
    } else {
        zones
    }
}

fn refill<T: Copy>(view: &mut Vec<T>, all: &[T], count: u8) {
    view.clear();
    view.extend(all.iter().take(usize::from(count)));
}

#[cfg(test)]
mod tests {
    use super::{LinkView, Observer};

    #[test]
    fn times_rise_strictly() {
        let mut observer = Observer::new();
        let link = LinkView {
            up: true,
            fault: None,
            speed_share: 1.0,
        };
        for (given, stamped) in [(5, 5), (5, 6), (4, 7), (100, 100)] {
            observer.stamp(given, link);
            assert_eq!(observer.observation().time_us, stamped);
        }
    }
}
