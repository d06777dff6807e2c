//! Detects whether somebody has lifted the robot, or may have while nobody listened to it.

use crate::model::advance::Advance;
use crate::model::observation::Observation;

/// A wheel that hangs for so long means that somebody holds the robot, seconds.
const LIFTED_S: f64 = 1.0;
/// In so long without a word from the robot somebody can have carried it elsewhere, microseconds.
const UNHEARD_US: u64 = 60_000_000;

/// Whether the robot stands where it drove to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lift {
    wheels: WheelContact,
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
        self.wheels = if observation.wheel_drop {
            // Whoever holds it now may have held it all the time.
            let unheard_s = if is_unsure { LIFTED_S } else { 0.0 };
            WheelContact::Hanging {
                time_s: hanging_s + advance.time_s + unheard_s,
            }
        } else if hanging_s >= LIFTED_S || is_unsure {
            WheelContact::PutDown
        } else {
            WheelContact::OnFloor
        };
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
    use crate::model::observation::Observation;

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
