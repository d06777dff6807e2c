//! From the firmware's reports to what the brain perceives.

mod charge;
mod odometer;

pub use odometer::{Odometer, RawTotals, Travel};

use brain::observation::{BeaconSignal, Cliffs, Contacts, MotorCurrents, Observation};
use rvac_protocol::message::{Battery, Inhibit, Inhibits, State};

use crate::device::{Description, Part};

/// Name under which inhibits of newer firmware reach the brain.
pub const UNKNOWN_INHIBIT: &str = "unknown-inhibit";

/// A heading of the Linux board's gyro older than this says nothing about the robot's present.
const BOARD_HEADING_FRESH_US: u64 = 200_000;

/// Signals of beacons that wait for the next step of the brain at most; a radio measures some in 20 ms, not dozens.
const BEACONS_MAX: usize = 32;

/// What the gyro on the Linux board said last.
#[derive(Clone, Copy, Debug)]
struct BoardHeading {
    at_us: u64,
    heading_urad: i32,
}

/// Keeps the present observation and fills it in place, so that a report costs no allocation.
#[derive(Debug)]
pub struct Observer {
    odometer: Odometer,
    board_heading: Option<BoardHeading>,
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
            odometer: Odometer::default(),
            board_heading: None,
            observation,
        }
    }

    /// The present view. Its time is that of the last change.
    #[must_use]
    pub fn observation(&self) -> &Observation {
        &self.observation
    }

    /// Takes the total of the gyro on the Linux board. From its first word on the heading is its own, and is missing while
    /// it is silent: two gyros with different drift are never mixed.
    pub fn take_board_heading(&mut self, now_us: u64, heading_urad: i32) {
        if self.board_heading.is_none() {
            self.odometer.rebase_heading();
        }
        self.board_heading = Some(BoardHeading {
            at_us: now_us,
            heading_urad,
        });
    }

    /// Takes what was measured of a beacon; the next step of the brain sees it. More than a step can be worth are dropped.
    pub fn take_beacon(&mut self, signal: BeaconSignal) {
        if self.observation.beacons.len() < BEACONS_MAX {
            self.observation.beacons.push(signal);
        }
    }

    /// What is told once only has been seen.
    pub fn seen(&mut self) {
        self.observation.beacons.clear();
    }

    fn heading_urad(&self, now_us: u64, state: &State, description: &Description) -> Option<i32> {
        match self.board_heading {
            Some(board) => (now_us < board.at_us + BOARD_HEADING_FRESH_US).then_some(board.heading_urad),
            None if description.has(Part::Gyro) => state.gyro.map(|gyro| gyro.heading.0),
            None => None,
        }
    }

    /// Takes a telemetry report, arrived at `now_us`, of a robot that is described by `description`.
    pub fn take_state(&mut self, now_us: u64, state: &State, description: &Description) {
        let heading_urad = self.heading_urad(now_us, state, description);
        let view = &mut self.observation;
        let raw = RawTotals {
            count_left: state.count_left,
            count_right: state.count_right,
            heading_urad,
        };
        let travel = self.odometer.take(raw, description.count_m);
        view.travel_left_m = travel.left_m;
        view.travel_right_m = travel.right_m;
        view.gyro_heading_rad = travel.heading_rad;
        view.contacts = contacts(state, description.sensors.bumpers);
        view.cliffs = Cliffs {
            left: state.cliffs.left,
            middle: state.cliffs.middle,
            right: state.cliffs.right,
        };
        view.wheel_drop = state.wheel_drops.left || state.wheel_drops.right;
        view.docked = state.docked;
        view.currents = currents_a(state, description).map(|[left, right, brush]| MotorCurrents {
            wheel_left_a: left,
            wheel_right_a: right,
            brush_main_a: brush,
        });
        refill(
            &mut view.proximity,
            &state.proximity,
            description.sensors.proximity,
            |raw| f32::from(raw) / 255.0,
        );
        refill(
            &mut view.dock_beams,
            &state.dock,
            description.sensors.dock_receivers,
            |symbol| symbol,
        );
        name_inhibits(&mut view.inhibits, state.inhibits);
    }

    /// Takes what is known of the battery.
    pub fn take_battery(&mut self, battery: Option<&Battery>) {
        self.observation.battery_charge = battery.map(|battery| battery.charge.as_f64() as f32);
        self.observation.charge_flow = battery.and_then(charge::flow);
    }

    /// The microcontroller was reset: its totals begin anew. Those of the board's own gyro go on.
    pub fn rebase(&mut self) {
        self.odometer.rebase_wheels();
        if self.board_heading.is_none() {
            self.odometer.rebase_heading();
        }
    }

    /// Dates the view and says how the link is. Times rise strictly whatever the caller gives.
    pub fn stamp(&mut self, now_us: u64, link: LinkView) {
        self.observation.time_us = now_us.max(self.observation.time_us + 1);
        self.observation.link_up = link.up;
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
    /// A session is open and telemetry is fresh.
    pub up: bool,
    /// Share of the commanded speed that quality allows, 0..1.
    pub speed_share: f64,
}

/// Currents of left wheel, right wheel and main brush in amperes, of a robot that measures them.
pub(crate) fn currents_a(state: &State, description: &Description) -> Option<[f32; 3]> {
    let currents = [
        state.currents.wheel_left,
        state.currents.wheel_right,
        state.currents.brush_main,
    ];
    description
        .has(Part::Currents)
        .then(|| currents.map(|current| current.as_a() as f32))
}

/// A robot with one zone reports it on the left; the brain sees both.
fn contacts(state: &State, zones: u8) -> Contacts {
    let any = state.bumpers.left || state.bumpers.right;
    if zones == 1 {
        Contacts {
            left: any,
            right: any,
        }
    } else {
        Contacts {
            left: state.bumpers.left,
            right: state.bumpers.right,
        }
    }
}

fn refill<T>(view: &mut Vec<T>, raw: &[u8], count: u8, convert: impl Fn(u8) -> T) {
    view.clear();
    view.extend(raw.iter().take(usize::from(count)).map(|raw| convert(*raw)));
}

fn name_inhibits(view: &mut Vec<&'static str>, inhibits: Inhibits) {
    view.clear();
    view.extend(inhibits.iter().map(Inhibit::name));
    let known = Inhibit::ALL.into_iter().fold(Inhibits::NONE, |mut all, inhibit| {
        all.insert(inhibit);
        all
    });
    if inhibits.bits() & !known.bits() != 0 {
        view.push(UNKNOWN_INHIBIT);
    }
}

#[cfg(test)]
mod tests {
    use rvac_protocol::message::{Inhibit, Inhibits};

    use super::{LinkView, Observer, name_inhibits};

    #[test]
    fn inhibits_of_newer_firmware_are_not_lost() {
        let mut names = Vec::new();
        let mut inhibits = Inhibits::from_bits(1 << 31);
        inhibits.insert(Inhibit::WheelDrop);
        name_inhibits(&mut names, inhibits);
        assert_eq!(names, ["wheel-drop", "unknown-inhibit"]);
        name_inhibits(&mut names, Inhibits::NONE);
        assert!(names.is_empty());
    }

    #[test]
    fn times_rise_strictly() {
        let mut observer = Observer::new();
        let link = LinkView {
            up: true,
            speed_share: 1.0,
        };
        for (given, stamped) in [(5, 5), (5, 6), (4, 7), (100, 100)] {
            observer.stamp(given, link);
            assert_eq!(observer.observation().time_us, stamped);
        }
    }
}
