//! Sequencing of a motor bridge.
//!
//! The A3950 of a wheel and the DRV8840 of the main brush both have an ENABLE line with PWM and a PHASE line for the
//! direction, and both brake in the off-time as this board sets them. PHASE changes only while ENABLE has been low for
//! at least one whole PWM period: a change under current would throw the motor from full forward to full backward
//! within a microsecond. The compare register is taken over at the end of a PWM period of 50 µs, so a change of
//! direction waits for two of the service calls that come once in a millisecond.

use rvac_units::Throttle;

/// Counts of one PWM period: Timer3 with PR 3999 at 80 MHz gives 20 kHz.
pub const PERIOD_COUNTS: u16 = 4_000;
/// Service calls with ENABLE low before PHASE may change.
const QUIET_CALLS: u8 = 2;

const MILLIONTHS_PER_COUNT: i32 = 1_000_000 / PERIOD_COUNTS as i32;

/// Direction of a motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotorDirection {
    /// As the robot drives forward, or the brush cleans.
    #[default]
    Forward,
    /// The opposite direction.
    Backward,
}

/// Present levels of a bridge's lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BridgeLines {
    /// Counts of a PWM period in which ENABLE is high, 0..=4000. 0 brakes.
    pub compare: u16,
    /// Direction on PHASE.
    pub turn: MotorDirection,
}

/// State of one bridge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BridgeSequence {
    lines: BridgeLines,
    wanted: BridgeLines,
    quiet: u8,
}

impl BridgeSequence {
    /// Braking, PHASE forward, as the start-up code leaves it.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            lines: BridgeLines {
                compare: 0,
                turn: MotorDirection::Forward,
            },
            wanted: BridgeLines {
                compare: 0,
                turn: MotorDirection::Forward,
            },
            quiet: 0,
        }
    }

    /// Takes a new duty and returns what to write at once. A reversal begins with compare 0.
    pub const fn command(&mut self, duty: Throttle) -> BridgeLines {
        self.wanted.compare = compare_for(duty);
        if duty.millionths() != 0 {
            self.wanted.turn = if duty.millionths() < 0 {
                MotorDirection::Backward
            } else {
                MotorDirection::Forward
            };
        }
        self.settle()
    }

    /// Called once a millisecond; returns what to write.
    pub const fn service(&mut self) -> BridgeLines {
        if self.lines.compare == 0 {
            self.quiet = self.quiet.saturating_add(1);
        }
        self.settle()
    }

    /// Whether current may flow.
    #[must_use]
    pub const fn is_driven(&self) -> bool {
        self.lines.compare != 0
    }

    const fn settle(&mut self) -> BridgeLines {
        let turns = matches!(
            (self.lines.turn, self.wanted.turn),
            (MotorDirection::Forward, MotorDirection::Backward)
                | (MotorDirection::Backward, MotorDirection::Forward)
        );
        let compare = if turns && self.quiet < QUIET_CALLS {
            0
        } else {
            self.lines.turn = self.wanted.turn;
            self.wanted.compare
        };
        if compare != 0 {
            self.quiet = 0;
        }
        self.lines.compare = compare;
        self.lines
    }
}

/// Counts with ENABLE high for a duty. Full duty lies above PR, so that the output never switches off.
const fn compare_for(duty: Throttle) -> u16 {
    // At most 1,000,000 / 250 = 4,000: fits.
    (duty.millionths().saturating_abs() / MILLIONTHS_PER_COUNT) as u16
}

#[cfg(test)]
mod tests {
    use super::{BridgeLines, BridgeSequence, MotorDirection, PERIOD_COUNTS};
    use rvac_units::Throttle;

    fn duty(millionths: i32) -> Throttle {
        Throttle::from_millionths(millionths).unwrap()
    }

    fn lines(compare: u16, turn: MotorDirection) -> BridgeLines {
        BridgeLines { compare, turn }
    }

    #[test]
    fn duties_become_counts_of_the_period() {
        for (millionths, compare) in [
            (0, 0),
            (249, 0),
            (250, 1),
            (500_000, 2_000),
            (1_000_000, PERIOD_COUNTS),
        ] {
            assert_eq!(
                BridgeSequence::new().command(duty(millionths)),
                lines(compare, MotorDirection::Forward)
            );
        }
    }

    #[test]
    fn a_reversal_is_quiet_for_a_whole_millisecond_before_phase_changes() {
        let mut bridge = BridgeSequence::new();
        assert_eq!(
            bridge.command(duty(800_000)),
            lines(3_200, MotorDirection::Forward)
        );
        assert_eq!(bridge.command(duty(-800_000)), lines(0, MotorDirection::Forward));
        assert_eq!(bridge.service(), lines(0, MotorDirection::Forward));
        assert_eq!(bridge.service(), lines(3_200, MotorDirection::Backward));
    }

    #[test]
    fn a_stop_between_two_directions_counts_as_quiet() {
        let mut bridge = BridgeSequence::new();
        bridge.command(duty(100_000));
        assert_eq!(bridge.command(Throttle::ZERO), lines(0, MotorDirection::Forward));
        bridge.service();
        bridge.service();
        assert_eq!(
            bridge.command(duty(-100_000)),
            lines(400, MotorDirection::Backward)
        );
    }

    #[test]
    fn a_stop_during_a_reversal_is_a_stop() {
        let mut bridge = BridgeSequence::new();
        bridge.command(duty(500_000));
        bridge.command(duty(-500_000));
        assert_eq!(bridge.command(Throttle::ZERO).compare, 0);
        for _ in 0..5 {
            assert_eq!(bridge.service().compare, 0);
        }
        assert!(!bridge.is_driven());
    }

    /// Whatever is commanded in whatever order, PHASE never differs between two writes of which one has current.
    #[test]
    fn no_order_of_commands_changes_phase_under_current() {
        let mut bridge = BridgeSequence::new();
        let mut seed = 7_u32;
        let mut before = bridge.service();
        for _ in 0..100_000 {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let now = match seed >> 29 {
                0 | 1 => bridge.command(duty((seed >> 9) as i32 % 1_000_001)),
                2 | 3 => bridge.command(duty(-((seed >> 9) as i32 % 1_000_001))),
                4 => bridge.command(Throttle::ZERO),
                _ => bridge.service(),
            };
            assert!(now.turn == before.turn || before.compare == 0);
            before = now;
        }
    }
}
