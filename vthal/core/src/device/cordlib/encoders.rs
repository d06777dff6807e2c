//! Encoder counts to way and speed, across wraps, resets and lost links.

use rvac_protocol::message::State;
use rvac_units::Tick;

use super::super::{WheelSpeeds, WheelTravel, WrappingTotal};

/// Reports farther apart tell no speed.
const GAP_MAX_MS: u32 = 10_000;

/// The encoders of both wheels.
#[derive(Clone, Debug, Default)]
pub(super) struct Encoders {
    /// Model of the robot they belong to, once it has described itself.
    device: Option<String>,
    /// Way of the rim per count, metres.
    count_m: f64,
    left: WrappingTotal,
    right: WrappingTotal,
    travel: WheelTravel,
    last: Option<Counts>,
    /// Counts per second of the left and the right wheel.
    rates_hz: [f64; 2],
}

/// What a report told.
#[derive(Clone, Copy, Debug)]
struct Counts {
    tick: Tick,
    left: i32,
    right: i32,
}

impl Encoders {
    /// A robot of this model has described itself. Those of another model begin anew.
    pub(super) fn described(&mut self, device: &str, count_m: f64) {
        if self.device.as_deref() != Some(device) {
            *self = Self {
                device: Some(device.to_owned()),
                last: self.last,
                rates_hz: self.rates_hz,
                ..Self::default()
            };
        }
        self.count_m = count_m;
    }

    /// A session has begun, or the robot's clock has jumped: no speed is told over that.
    pub(super) const fn forget_newest(&mut self) {
        self.last = None;
    }

    /// The microcontroller was reset: the totals begin anew at a value that says nothing about the past. The way made so
    /// far stays.
    pub(super) const fn rebase(&mut self) {
        self.left.rebase();
        self.right.rebase();
    }

    /// The link was lost, and the wheels may have done anything since.
    pub(super) const fn forget_speeds(&mut self) {
        self.rates_hz = [0.0; 2];
    }

    /// Takes the counts of a report of a robot that has described itself on this line.
    pub(super) fn take(&mut self, state: &State) -> WheelTravel {
        self.take_rates(state);
        self.travel = WheelTravel {
            left_m: self.left.take(state.count_left) as f64 * self.count_m,
            right_m: self.right.take(state.count_right) as f64 * self.count_m,
            speeds: None,
        };
        self.travel()
    }

    /// Takes the counts of a report of which nobody knows yet whose it is.
    pub(super) fn take_unknown(&mut self, state: &State) -> WheelTravel {
        self.take_rates(state);
        self.travel()
    }

    fn travel(&self) -> WheelTravel {
        let [left_hz, right_hz] = self.rates_hz;
        WheelTravel {
            speeds: Some(WheelSpeeds {
                left_m_per_s: left_hz * self.count_m,
                right_m_per_s: right_hz * self.count_m,
            }),
            ..self.travel
        }
    }

    fn take_rates(&mut self, state: &State) {
        let now = Counts {
            tick: state.tick,
            left: state.count_left,
            right: state.count_right,
        };
        if let Some(last) = self.last.replace(now) {
            let ms = now.tick.since(last.tick);
            if ms > 0 && ms < GAP_MAX_MS {
                let rate = |counts: i32| f64::from(counts) * 1000.0 / f64::from(ms);
                self.rates_hz = [
                    rate(now.left.wrapping_sub(last.left)),
                    rate(now.right.wrapping_sub(last.right)),
                ];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use rvac_protocol::message::State;
    use rvac_units::Tick;

    use super::Encoders;
    use crate::device::WheelSpeeds;

    fn state(ms: u32, count_left: i32, count_right: i32) -> State {
        State {
            tick: Tick(ms),
            count_left,
            count_right,
            ..State::default()
        }
    }

    fn of_robot() -> Encoders {
        let mut encoders = Encoders::default();
        encoders.described("paper", 0.001);
        encoders
    }

    #[test]
    fn counts_are_ways_since_the_first_report_and_speeds() {
        let mut encoders = of_robot();
        let first = encoders.take(&state(0, 1000, -7));
        assert_eq!((first.left_m, first.right_m), (0.0, 0.0));
        let next = encoders.take(&state(100, 1050, -17));
        assert_eq!((next.left_m, next.right_m), (0.05, -0.01));
        assert_eq!(
            next.speeds,
            Some(WheelSpeeds {
                left_m_per_s: 0.5,
                right_m_per_s: -0.1
            })
        );
    }

    #[test]
    fn a_reset_keeps_the_way_and_another_robot_does_not() {
        let mut encoders = of_robot();
        encoders.take(&state(0, 0, 0));
        encoders.take(&state(20, 500, 400));
        encoders.forget_newest();
        encoders.rebase();
        encoders.described("paper", 0.001);
        assert_eq!(encoders.take(&state(0, 3, 0)).left_m, 0.5);
        assert_eq!(encoders.take(&state(20, 13, 0)).left_m, 0.51);
        encoders.described("pencil", 0.001);
        assert_eq!(encoders.take(&state(40, 90, 0)).left_m, 0.0);
    }
}
