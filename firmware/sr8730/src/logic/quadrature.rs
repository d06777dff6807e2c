//! Counting a wheel's two encoder lines.
//!
//! Both lines interrupt on every edge. Calibration by hand finds out which line leads when the wheel turns forward
//! (`wheel-left-order`, `wheel-right-order`). The interrupt counts line 1 leading as positive, and the order is applied
//! where the total is read.

/// Levels of both lines: bit 0 is line 1, bit 1 is line 2.
pub type Levels = u8;

/// Effect of a change of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// No change: the interrupt came for an edge that was already counted, or for a spike.
    None,
    /// One count with line 1 leading.
    Up,
    /// One count with line 2 leading.
    Down,
    /// Both lines changed at once: an edge was missed, and the direction is unknown.
    Illegal,
}

/// The step between two readings of the lines; only the lowest two bits of each matter.
#[must_use]
pub const fn step(before: Levels, now: Levels) -> Step {
    match (before & 3, now & 3) {
        (0b00, 0b01) | (0b01, 0b11) | (0b11, 0b10) | (0b10, 0b00) => Step::Up,
        (0b00, 0b10) | (0b10, 0b11) | (0b11, 0b01) | (0b01, 0b00) => Step::Down,
        (0b00, 0b11) | (0b11, 0b00) | (0b01, 0b10) | (0b10, 0b01) => Step::Illegal,
        _ => Step::None,
    }
}

/// Which line leads when the wheel turns forward.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhaseOrder {
    /// Line 1 (calibration value 0).
    #[default]
    FirstLeads,
    /// Line 2 (calibration value 1).
    SecondLeads,
}

impl PhaseOrder {
    /// From the calibration value. An unknown value counts as line 1; parts that need it are then absent.
    #[must_use]
    pub const fn from_calibration(value: Option<i32>) -> Self {
        match value {
            Some(1) => Self::SecondLeads,
            _ => Self::FirstLeads,
        }
    }

    /// The total with forward positive.
    #[must_use]
    pub const fn forward(self, total: i32) -> i32 {
        match self {
            Self::FirstLeads => total,
            Self::SecondLeads => total.wrapping_neg(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Levels, PhaseOrder, Step, step};

    const FORWARD: [Levels; 4] = [0b00, 0b01, 0b11, 0b10];

    #[test]
    fn a_turn_counts_four_each_way() {
        for place in 0..4 {
            let next = FORWARD[(place + 1) % 4];
            assert_eq!(step(FORWARD[place], next), Step::Up);
            assert_eq!(step(next, FORWARD[place]), Step::Down);
            assert_eq!(step(next, next), Step::None);
        }
    }

    #[test]
    fn both_lines_at_once_are_illegal_whatever_the_other_bits_say() {
        for levels in 0..4 {
            assert_eq!(step(levels | 0xF0, !levels & 3), Step::Illegal);
        }
    }

    #[test]
    fn the_order_turns_the_sign() {
        assert_eq!(PhaseOrder::from_calibration(Some(1)).forward(7), -7);
        assert_eq!(PhaseOrder::from_calibration(Some(0)).forward(7), 7);
        assert_eq!(PhaseOrder::from_calibration(None).forward(i32::MIN), i32::MIN);
        assert_eq!(PhaseOrder::SecondLeads.forward(i32::MIN), i32::MIN);
    }
}
