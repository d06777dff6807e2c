//! Encoders with one line count every edge upward in either direction: the board gives the count the sign of the
//! wheel's last command.

use cordlib::board::{WheelCounts, WheelDrive};

/// After a reversal the wheel first keeps its old direction, then stops, then turns the new way. The direction of an
/// edge in this time is unknown, so these edges are not counted.
const REVERSAL_MS: u8 = 100;

/// Both wheels' lines.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OneLine {
    left: WheelLine,
    right: WheelLine,
}

impl OneLine {
    /// Takes the edges counted so far and the drives of the last millisecond. Called every millisecond.
    pub(crate) fn take(&mut self, edges: [i32; 2], driven: [WheelDrive; 2]) -> WheelCounts {
        let [left, right] = edges;
        let [drive_left, drive_right] = driven;
        WheelCounts {
            left: self.left.take(left, drive_left),
            right: self.right.take(right, drive_right),
        }
    }
}

/// One wheel's line.
#[derive(Clone, Copy, Debug, Default)]
struct WheelLine {
    edges: Option<i32>,
    total: i32,
    /// Last direction that was commanded: 1, -1, or 0 before the first.
    direction: i32,
    /// Milliseconds for which edges are not counted.
    unsure_ms: u8,
}

impl WheelLine {
    fn take(&mut self, edges: i32, driven: WheelDrive) -> i32 {
        let commanded = driven.duty().millionths().signum();
        if commanded != 0 && commanded != self.direction {
            // From rest the direction is certain.
            if self.direction != 0 {
                self.unsure_ms = REVERSAL_MS;
            }
            self.direction = commanded;
        }
        let counted = edges.wrapping_sub(self.edges.replace(edges).unwrap_or(edges));
        if self.unsure_ms > 0 {
            self.unsure_ms -= 1;
        } else {
            // A wheel that turns without having been driven is pushed; its direction is unknown, forward is assumed.
            let sign = if self.direction < 0 { -1 } else { 1 };
            self.total = self.total.wrapping_add(counted.wrapping_mul(sign));
        }
        self.total
    }
}

#[cfg(test)]
mod tests {
    use super::{REVERSAL_MS, WheelLine};
    use cordlib::board::WheelDrive;
    use rvac_units::Throttle;

    fn drive(millionths: i32) -> WheelDrive {
        WheelDrive::Duty(Throttle::saturating_from_millionths(millionths))
    }

    #[test]
    fn edges_have_the_sign_of_the_command_and_those_of_a_reversal_none() {
        let mut line = WheelLine::default();
        line.take(10, drive(0));
        assert_eq!(line.take(14, drive(300_000)), 4);
        assert_eq!(
            line.take(15, WheelDrive::Brake),
            5,
            "it rolls out the way it went"
        );
        let mut edges = 15;
        for _ in 0..REVERSAL_MS {
            edges += 1;
            assert_eq!(line.take(edges, drive(-300_000)), 5);
        }
        assert_eq!(line.take(edges + 3, drive(-300_000)), 2);
        assert_eq!(line.take(edges + 4, WheelDrive::Brake), 1);
    }

    #[test]
    fn the_count_of_the_line_may_wrap() {
        let mut line = WheelLine::default();
        line.take(i32::MAX, drive(300_000));
        assert_eq!(line.take(i32::MIN + 1, drive(300_000)), 2);
    }
}
