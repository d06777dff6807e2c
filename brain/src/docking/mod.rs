//! Dock when the way leads there: bounce on without cleaning; who hears the dock's beams drives towards it.
//!
//! Terms. *Lobe*: half of the space before the dock, filled by one of its two side beams; where both are heard is the
//! line that leads straight in. *Near field*: a weak beam around the dock. A receiver reports the sum of what it hears.

use crate::action::Motion;
use crate::behavior::Reason;
use crate::coverage::Bounce;
use crate::manoeuvre::{Evasion, EvasionStep};
use crate::task::{Mind, Plan, Situation, Task};

/// Symbol of the beam in the left half, seen by a robot that comes to the dock.
const LOBE_LEFT: u8 = 1;
/// Symbol of the beam in the right half.
const LOBE_RIGHT: u8 = 2;
/// Symbol of the near field.
const NEAR_FIELD: u8 = 4;
/// Speed towards the dock.
const APPROACH_M_PER_S: f64 = 0.12;
/// Speed in the near field: contacts are met softly.
const FINAL_M_PER_S: f64 = 0.05;
/// Turn towards the side where the dock is heard.
const BEARING_RAD_PER_S: f64 = 0.5;
/// Turn towards the line between the lobes.
const LOBE_RAD_PER_S: f64 = 0.25;
/// Way back after the dock was hit beside its contacts.
const RETRY_BACK_M: f64 = 0.15;
/// Approaches until beams are left alone for a while.
const RETRIES_MAX: u32 = 5;
/// How long beams are left alone after that: elsewhere the approach may be better.
const IGNORE_S: f64 = 20.0;

/// The task.
#[derive(Clone, Debug, Default)]
pub(crate) struct DockSearch {
    search: Bounce,
    elapsed_s: f64,
    approaching: bool,
    retry: Option<Evasion>,
    retries: u32,
    ignore_s: f64,
}

impl Task for DockSearch {
    fn step(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        self.elapsed_s += situation.advance.time_s;
        self.ignore_s = (self.ignore_s - situation.advance.time_s).max(0.0);
        if self.elapsed_s > situation.config.dock_budget_s {
            return Plan::Finished(Reason::DockNotFound);
        }
        if let Some(retry) = &mut self.retry {
            match retry.step(situation) {
                EvasionStep::Going(motion) => return Plan::Go(motion),
                EvasionStep::Free => self.retry = None,
                EvasionStep::Held(reason) => {
                    self.retry = None;
                    return Plan::Trouble(reason);
                }
            }
        }
        self.drive(situation, mind)
    }

    fn interrupted(&mut self) {
        self.retry = None;
        self.approaching = false;
        self.search.interrupted();
    }
}

impl DockSearch {
    fn drive(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        let steering = if self.ignore_s > 0.0 || self.search.is_evading() {
            None
        } else {
            steer(&situation.observation.dock_beams)
        };
        let Some(motion) = steering else {
            self.approaching = false;
            return self.search.step(situation, mind);
        };
        if !self.approaching {
            mind.decide("approach", Reason::DockBeam, 0.0);
            self.approaching = true;
        }
        if situation.touching || situation.at_cliff {
            return self.miss(situation, mind);
        }
        Plan::Go(motion)
    }

    /// Hit something before the contacts closed.
    fn miss(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        self.retries += 1;
        if self.retries > RETRIES_MAX || situation.at_cliff {
            self.retries = 0;
            self.ignore_s = IGNORE_S;
            return self.search.step(situation, mind);
        }
        let turn_rad = mind.random.between(-0.35, 0.35);
        mind.decide("retry", Reason::BumpFront, f64::from(self.retries));
        self.retry = Some(Evasion::from_contact(RETRY_BACK_M, turn_rad));
        Plan::Go(Motion::Halt)
    }
}

/// The motion towards the dock; `None` when nothing is heard. Receivers: front left, front right, rear left, rear right.
fn steer(beams: &[u8]) -> Option<Motion> {
    let heard = |receiver: usize| beams.get(receiver).copied().unwrap_or(0);
    let (left, right) = (heard(0), heard(1));
    let front = left | right;
    if front == 0 {
        let turn = sign(heard(2), heard(3));
        return (turn != 0.0).then_some(Motion::Drive {
            speed_m_per_s: 0.0,
            turn_rad_per_s: turn * BEARING_RAD_PER_S,
        });
    }
    let bearing = sign(left, right) * BEARING_RAD_PER_S;
    // In the left lobe alone the line lies to the right.
    let lobe = sign(front & LOBE_RIGHT, front & LOBE_LEFT) * LOBE_RAD_PER_S;
    let speed_m_per_s = if front & NEAR_FIELD != 0 {
        FINAL_M_PER_S
    } else {
        APPROACH_M_PER_S
    };
    Some(Motion::Drive {
        speed_m_per_s,
        turn_rad_per_s: bearing + lobe,
    })
}

/// +1 for left alone, -1 for right alone, 0 for both or none.
fn sign(left: u8, right: u8) -> f64 {
    f64::from(i8::from(left != 0) - i8::from(right != 0))
}

#[cfg(test)]
mod tests {
    use super::{FINAL_M_PER_S, steer};
    use crate::action::Motion;

    fn turn_of(beams: [u8; 4]) -> f64 {
        match steer(&beams) {
            Some(Motion::Drive { turn_rad_per_s, .. }) => turn_rad_per_s,
            other => panic!("{other:?} is no drive for {beams:?}"),
        }
    }

    #[test]
    fn it_turns_to_where_the_dock_is_heard() {
        assert_eq!(steer(&[0; 4]), None);
        assert_eq!(steer(&[]), None);
        assert!(turn_of([3, 0, 0, 0]) > 0.0);
        assert!(turn_of([0, 3, 0, 0]) < 0.0);
        assert!(turn_of([0, 0, 3, 0]) > 0.0);
        assert!(turn_of([0, 0, 0, 3]) < 0.0);
        assert_eq!(turn_of([3, 3, 0, 0]), 0.0);
    }

    #[test]
    fn it_steers_to_the_line_between_the_lobes() {
        assert!(turn_of([1, 1, 0, 0]) < 0.0);
        assert!(turn_of([2, 2, 0, 0]) > 0.0);
        let slow = Motion::Drive {
            speed_m_per_s: FINAL_M_PER_S,
            turn_rad_per_s: 0.0,
        };
        assert_eq!(steer(&[7, 7, 0, 0]), Some(slow));
    }
}
