//! How the time of a job was spent.
//!
//! Each sample belongs to one kind of motion, by the true motion of the robot. *Contact*: from a contact until the
//! robot cruises again. Beside these, *again*: seconds of moving ahead over floor that was swept before.

use home::Truth;
use serde::Serialize;

use super::MeasuredFloor;

/// Seconds by cause. All but `again_s` add up to the length of the job.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TimeSpent {
    /// Straight ahead, at 90 % of the cruise speed or more.
    pub cruise_s: f64,
    /// Straight ahead and slower: speeding up, braking, caution.
    pub slow_s: f64,
    /// In an arc.
    pub arc_s: f64,
    /// Turning on the spot.
    pub spot_turn_s: f64,
    /// Backwards, apart from contacts.
    pub back_s: f64,
    /// At rest, apart from contacts.
    pub still_s: f64,
    /// From contacts until the robot cruises again.
    pub contact_s: f64,
    /// Ahead or in an arc over floor of which less than a fifth was new.
    pub again_s: f64,
}

/// Slower motion does not count as moving ahead, m/s.
const STILL_M_PER_S: f64 = 0.03;
/// Slower rotation does not count as turning, rad/s.
const STRAIGHT_RAD_PER_S: f64 = 0.25;
/// Share of the cruise speed from which the robot cruises.
const CRUISE_SHARE: f64 = 0.9;
/// Share of the floor under the path that must be new.
const NEW_SHARE: f64 = 0.2;

/// Collects them.
#[derive(Clone, Copy, Debug)]
pub(super) struct TimeWatch {
    /// Width of the swath, metres.
    swath_m: f64,
    cruise_m_per_s: f64,
    spent: TimeSpent,
    contacts: u32,
    in_contact: bool,
    last: Option<(u64, f64)>,
}

impl TimeWatch {
    pub(super) fn new(floor: &MeasuredFloor) -> Self {
        Self {
            swath_m: floor.swath_m(),
            cruise_m_per_s: floor.cruise_m_per_s,
            spent: TimeSpent::default(),
            contacts: 0,
            in_contact: false,
            last: None,
        }
    }

    pub(super) fn sample(&mut self, truth: &Truth, job_runs: bool) {
        let now = (truth.time_ms, truth.swept_m2);
        let (before_ms, before_m2) = self.last.replace(now).unwrap_or(now);
        let begun = truth.contacts > self.contacts;
        self.contacts = truth.contacts;
        if !job_runs {
            self.in_contact = false;
            return;
        }
        let time_s = (truth.time_ms - before_ms) as f64 / 1000.0;
        let turns = truth.turn_rad_per_s.abs() > STRAIGHT_RAD_PER_S;
        let cruises = !turns && truth.speed_m_per_s >= CRUISE_SHARE * self.cruise_m_per_s;
        self.in_contact = begun || (self.in_contact && !cruises);
        let ahead = truth.speed_m_per_s > STILL_M_PER_S;
        let spent = &mut self.spent;
        let cause = if self.in_contact {
            &mut spent.contact_s
        } else if cruises {
            &mut spent.cruise_s
        } else if ahead && turns {
            &mut spent.arc_s
        } else if ahead {
            &mut spent.slow_s
        } else if truth.speed_m_per_s < -STILL_M_PER_S {
            &mut spent.back_s
        } else if turns {
            &mut spent.spot_turn_s
        } else {
            &mut spent.still_s
        };
        *cause += time_s;
        let could_m2 = self.swath_m * time_s * truth.speed_m_per_s;
        if ahead && !self.in_contact && truth.swept_m2 - before_m2 < NEW_SHARE * could_m2 {
            self.spent.again_s += time_s;
        }
    }

    pub(super) const fn spent(&self) -> TimeSpent {
        self.spent
    }
}

#[cfg(test)]
mod tests {
    use super::{MeasuredFloor, TimeWatch};
    use home::{Home, Noise, Pose, RobotModel, Truth, World};
    use std::sync::Arc;

    const PLAN: &str =
        "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0, 0], [2, 0], [2, 2], [0, 2]]\n";

    fn truth() -> Truth {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("room", PLAN, &model).unwrap();
        *World::new(Arc::new(home), &model, &Noise::ideal(), 1, Some(Pose::default())).truth()
    }

    #[test]
    fn each_second_of_the_job_has_one_cause() {
        let mut watch = TimeWatch::new(&MeasuredFloor {
            reachable_m2: 3.0,
            t0_s: 40.0,
            cruise_m_per_s: 0.25,
            rooms: None,
        });
        let mut truth = truth();
        watch.sample(&truth, false);
        // Speed, turn rate, contacts so far, swept area.
        let moments = [
            (0.25, 0.0, 0, 0.0075),
            (0.25, 0.0, 0, 0.0075),
            (0.10, 0.0, 0, 0.0105),
            (0.20, 1.0, 0, 0.0165),
            (0.0, 1.5, 0, 0.0165),
            (-0.1, 0.0, 0, 0.0165),
            (0.0, 0.0, 0, 0.0165),
            (0.0, 0.0, 1, 0.0165),
            (-0.1, 0.0, 1, 0.0165),
            (0.25, 0.0, 1, 0.0240),
        ];
        for (speed_m_per_s, turn_rad_per_s, contacts, swept_m2) in moments {
            truth.time_ms += 100;
            (truth.speed_m_per_s, truth.turn_rad_per_s) = (speed_m_per_s, turn_rad_per_s);
            (truth.contacts, truth.swept_m2) = (contacts, swept_m2);
            watch.sample(&truth, true);
        }
        truth.time_ms += 100;
        watch.sample(&truth, false);
        let spent = watch.spent();
        let tenths = [
            spent.cruise_s,
            spent.slow_s,
            spent.arc_s,
            spent.spot_turn_s,
            spent.back_s,
            spent.still_s,
            spent.contact_s,
            spent.again_s,
        ]
        .map(|time_s| (10.0 * time_s).round() as u32);
        assert_eq!(tenths, [3, 1, 1, 1, 1, 1, 2, 1]);
    }
}
