//! Detects whether somebody has lifted the robot, or may have while nobody listened to it.
//!
//! The switch of a wheel alone does not decide: it may stick. One that hangs while the contacts of the dock are closed says nothing,
//! for a robot on its dock was not carried. One that never trips is made up for: no cliff sensor sees floor while the wheels stand,
//! and the robot turns without them or leaves the contacts without them. A black rug also hides the floor from all cliff sensors,
//! therefore they alone do not decide either.

use crate::model::advance::Advance;
use crate::model::observation::Observation;

/// A wheel that hangs for so long means that somebody holds the robot, seconds.
const LIFTED_S: f64 = 1.0;
/// In so long without a word from the robot somebody can have carried it elsewhere, microseconds.
const UNHEARD_US: u64 = 60_000_000;

/// A turn of so much without the wheels is somebody's, radians.
const TURNED_RAD: f64 = 0.17;

/// What speaks for a lift besides the switch of the wheels, since the cliff sensors lost the floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct FloorLoss {
    time_s: f64,
    turned_rad: f64,
    left_contacts: bool,
}

impl FloorLoss {
    /// Follows one step of a robot that sees no floor and does not move its wheels.
    fn follow(&mut self, advance: Advance, left_contacts: bool) {
        self.time_s += advance.time_s;
        self.turned_rad += advance.gyro_turn_rad.unwrap_or(0.0);
        self.left_contacts |= left_contacts;
    }

    fn is_lift(self) -> bool {
        self.time_s >= LIFTED_S && (self.left_contacts || self.turned_rad.abs() >= TURNED_RAD)
    }
}

/// Whether the robot stands where it drove to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lift {
    wheels: WheelContact,
    floor_loss: FloorLoss,
    was_docked: bool,
    /// When the robot was heard last.
    heard_us: Option<u64>,
}

/// State of the wheels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum WheelContact {
    /// All wheels are on the floor.
    #[default]
    OnFloor,
    /// A wheel has been hanging for so long.
    Hanging { time_s: f64 },
    /// Somebody has just put the robot down, or may have.
    PutDown,
}

impl Lift {
    /// Takes whether a wheel hangs, and whether the robot is heard.
    pub(super) fn update(&mut self, observation: &Observation, advance: Advance) {
        if !observation.link_up {
            if self.is_put_down() {
                self.settle();
            }
            return;
        }
        let heard_us = self.heard_us.replace(observation.time_us);
        let silence_us = heard_us.map_or(0, |heard_us| observation.time_us.saturating_sub(heard_us));
        // The dock says where it is.
        let is_unsure = silence_us >= UNHEARD_US && !observation.docked;
        let hanging_s = self.hanging_s();
        let was_lifted = self.sees_lift(observation, advance);
        self.wheels = if observation.wheel_drop && observation.docked {
            WheelContact::Hanging { time_s: 0.0 }
        } else if observation.wheel_drop {
            // Whoever holds it now may have held it all the time.
            let unheard_s = if is_unsure { LIFTED_S } else { 0.0 };
            WheelContact::Hanging {
                time_s: hanging_s + advance.time_s + unheard_s,
            }
        } else if hanging_s >= LIFTED_S || was_lifted || is_unsure {
            WheelContact::PutDown
        } else {
            WheelContact::OnFloor
        };
    }

    /// Whether it sees floor again after the other sensors have seen a lift.
    fn sees_lift(&mut self, observation: &Observation, advance: Advance) -> bool {
        let leaves_contacts =
            core::mem::replace(&mut self.was_docked, observation.docked) && !observation.docked;
        let wheels_stand = advance.distance_m == 0.0 && advance.wheel_turn_rad == 0.0;
        let cliffs = observation.cliffs;
        let sees_floor = !(cliffs.left && cliffs.middle && cliffs.right);
        if !wheels_stand || observation.docked {
            self.floor_loss = FloorLoss::default();
            return false;
        }
        if !sees_floor {
            self.floor_loss.follow(advance, leaves_contacts);
            return false;
        }
        // Contacts open a moment before the floor is out of sight.
        let before = FloorLoss {
            left_contacts: leaves_contacts || self.floor_loss.left_contacts && self.floor_loss.time_s == 0.0,
            ..FloorLoss::default()
        };
        core::mem::replace(&mut self.floor_loss, before).is_lift()
    }

    /// The robot is known to stand on the floor.
    pub(super) fn settle(&mut self) {
        self.wheels = WheelContact::OnFloor;
    }

    /// Time for which a wheel has been hanging, seconds.
    pub(super) fn hanging_s(self) -> f64 {
        match self.wheels {
            WheelContact::Hanging { time_s } => time_s,
            WheelContact::OnFloor | WheelContact::PutDown => 0.0,
        }
    }

    /// Whether somebody holds the robot up.
    pub(super) fn is_lifted(self) -> bool {
        self.hanging_s() >= LIFTED_S || self.floor_loss.is_lift()
    }

    /// Whether the robot seems to be off the floor at this moment.
    pub(super) fn is_in_air(self) -> bool {
        self.hanging_s() > 0.0 || self.floor_loss.is_lift()
    }

    /// Whether somebody has just put the robot down.
    pub(super) fn is_put_down(self) -> bool {
        self.wheels == WheelContact::PutDown
    }

    /// Whether the robot was put down since the last call.
    pub(super) fn take_put_down(&mut self) -> bool {
        let is_put_down = self.is_put_down();
        if is_put_down {
            self.settle();
        }
        is_put_down
    }
}

#[cfg(test)]
mod tests {
    use super::Lift;
    use crate::model::advance::Advance;
    use crate::model::observation::{Cliffs, Observation};

    /// How often it is put down when these are seen: second, link, hanging wheel.
    fn put_downs(seen: &[(u64, bool, bool)]) -> usize {
        let mut lift = Lift::default();
        let mut last_s = 0;
        let mut count = 0;
        for (second, link_up, wheel_drop) in seen {
            let observation = Observation {
                time_us: second * 1_000_000,
                link_up: *link_up,
                wheel_drop: *wheel_drop,
                ..Observation::default()
            };
            let advance = Advance {
                time_s: (second - last_s) as f64,
                ..Advance::default()
            };
            lift.update(&observation, advance);
            last_s = *second;
            count += usize::from(lift.take_put_down());
        }
        count
    }

    #[test]
    fn a_wheel_that_hung_for_a_second_means_that_somebody_put_it_down() {
        let seen = [
            (1, true, true),
            (3, true, true),
            (4, true, false),
            (5, true, false),
        ];
        assert_eq!(put_downs(&seen), 1);
    }

    /// How often it is put down in these seconds: all cliff sensors see no floor, turn by the gyro, contacts, switch.
    fn put_downs_by_others(seen: &[(bool, f64, bool, bool)]) -> usize {
        let mut lift = Lift::default();
        let mut count = 0;
        for (second, (no_floor, turned_rad, docked, wheel_drop)) in (1..).zip(seen) {
            let observation = Observation {
                time_us: second * 1_000_000,
                cliffs: Cliffs {
                    left: *no_floor,
                    middle: *no_floor,
                    right: *no_floor,
                },
                docked: *docked,
                wheel_drop: *wheel_drop,
                ..Observation::default()
            };
            let advance = Advance {
                time_s: 1.0,
                turn_rad: *turned_rad,
                gyro_turn_rad: Some(*turned_rad),
                ..Advance::default()
            };
            lift.update(&observation, advance);
            count += usize::from(lift.take_put_down());
        }
        count
    }

    #[test]
    fn a_switch_that_never_trips_is_made_up_for_by_what_else_tells() {
        let floor = (false, 0.0, false, false);
        let carried = [
            floor,
            (true, 0.1, false, false),
            (true, 0.1, false, false),
            floor,
            floor,
        ];
        assert_eq!(put_downs_by_others(&carried), 1);
        let docked = (false, 0.0, true, false);
        let off_dock = [
            docked,
            floor,
            (true, 0.0, false, false),
            (true, 0.0, false, false),
            floor,
        ];
        assert_eq!(put_downs_by_others(&off_dock), 1);
        let black_rug = [floor, (true, 0.0, false, false), (true, 0.0, false, false), floor];
        assert_eq!(put_downs_by_others(&black_rug), 0);
    }

    #[test]
    fn a_switch_that_sticks_on_the_dock_does_not_say_that_it_was_carried() {
        let stuck = (false, 0.0, true, true);
        assert_eq!(
            put_downs_by_others(&[stuck, stuck, stuck, (false, 0.0, true, false)]),
            0
        );
        let held = (true, 0.0, false, true);
        assert_eq!(
            put_downs_by_others(&[stuck, held, held, (false, 0.0, false, false)]),
            1
        );
    }

    #[test]
    fn after_a_minute_in_which_it_was_not_heard_it_may_be_elsewhere() {
        assert_eq!(put_downs(&[(1, true, false), (60, true, false)]), 0);
        assert_eq!(
            put_downs(&[(1, true, false), (62, true, false), (63, true, false)]),
            1
        );
        let told = [
            (1, true, false),
            (2, false, false),
            (61, false, true),
            (62, true, false),
        ];
        assert_eq!(put_downs(&told), 1, "what a silent link says does not count");
        let held = [(1, true, false), (1_200, true, true), (1_201, true, false)];
        assert_eq!(put_downs(&held), 1);
    }
}
