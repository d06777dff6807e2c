//! Debounces the symbols of the dock receivers: a single lost or false symbol changes nothing.

/// Symbol of the left beam, as seen by a robot that approaches the dock.
const LOBE_LEFT: u8 = 1;
/// Symbol of the right beam, as seen by a robot that approaches the dock.
const LOBE_RIGHT: u8 = 2;
/// Symbol of the near field.
const NEAR_FIELD: u8 = 4;
/// Largest count of a symbol.
const COUNT_MAX: u8 = 6;
/// A symbol becomes received at this count, and is lost when its count falls below `LOST_BELOW`.
const RECEIVED_MIN: u8 = 4;
const LOST_BELOW: u8 = 2;

/// Counts of each symbol at each receiver. Receivers: front left, front right, rear left, rear right.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DockBeamFilter {
    receivers: [Receiver; 4],
}

#[derive(Clone, Copy, Debug, Default)]
struct Receiver {
    counts: [u8; 3],
    received: u8,
}

/// The side of the dock's centre line on which the robot is, when it faces the dock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lobe {
    /// On the centre line: both beams are received.
    Both,
    /// Left of the centre line.
    Left,
    /// Right of the centre line.
    Right,
    /// In neither beam; at most the near field is received.
    None,
}

impl DockBeamFilter {
    /// Adds the symbols of one observation. Receivers that the robot lacks receive nothing.
    pub(crate) fn update(&mut self, beams: &[u8]) {
        for (number, receiver) in self.receivers.iter_mut().enumerate() {
            receiver.update(beams.get(number).copied().unwrap_or(0));
        }
    }

    fn at(&self, receiver: usize) -> u8 {
        self.receivers
            .get(receiver)
            .map_or(0, |receiver| receiver.received)
    }

    /// Whether any receiver receives any symbol.
    pub(crate) fn is_any(&self) -> bool {
        self.receivers.iter().any(|receiver| receiver.received != 0)
    }

    /// Whether both front receivers receive the dock: it lies ahead.
    pub(crate) fn is_ahead(&self) -> bool {
        self.at(0) != 0 && self.at(1) != 0
    }

    /// Whether a front receiver receives anything.
    pub(crate) fn is_in_front(&self) -> bool {
        (self.at(0) | self.at(1)) != 0
    }

    /// Whether the near field is received.
    pub(crate) fn is_near(&self) -> bool {
        self.all() & NEAR_FIELD != 0
    }

    /// The beam in which the robot is. All receivers are in the same beams, so one makes up for what another misses.
    pub(crate) fn lobe(&self) -> Lobe {
        match (self.all() & LOBE_LEFT != 0, self.all() & LOBE_RIGHT != 0) {
            (true, true) => Lobe::Both,
            (true, false) => Lobe::Left,
            (false, true) => Lobe::Right,
            (false, false) => Lobe::None,
        }
    }

    /// +1 when the dock is to the left, -1 to the right, 0 when unknown.
    pub(crate) fn side(&self) -> f64 {
        let side = |left: u8, right: u8| f64::from(i8::from(left != 0) - i8::from(right != 0));
        let front = side(self.at(0), self.at(1));
        if self.is_in_front() {
            front
        } else {
            side(self.at(2), self.at(3))
        }
    }

    fn all(&self) -> u8 {
        self.receivers
            .iter()
            .fold(0, |all, receiver| all | receiver.received)
    }
}

impl Receiver {
    fn update(&mut self, symbols: u8) {
        for (count, symbol) in self.counts.iter_mut().zip([LOBE_LEFT, LOBE_RIGHT, NEAR_FIELD]) {
            *count = if symbols & symbol == 0 {
                count.saturating_sub(1)
            } else {
                count.saturating_add(1).min(COUNT_MAX)
            };
            if *count >= RECEIVED_MIN {
                self.received |= symbol;
            } else if *count < LOST_BELOW {
                self.received &= !symbol;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DockBeamFilter, Lobe};

    fn received(words: &[[u8; 4]]) -> DockBeamFilter {
        let mut filter = DockBeamFilter::default();
        for word in words {
            filter.update(word);
        }
        filter
    }

    #[test]
    fn single_symbols_change_nothing() {
        assert!(!received(&[[3, 3, 0, 0], [0; 4]]).is_any());
        let steady = [[1, 1, 0, 0]; 8];
        let mut filter = received(&steady);
        filter.update(&[0; 4]);
        filter.update(&[2, 2, 0, 0]);
        assert_eq!(filter.lobe(), Lobe::Left);
        assert!(filter.is_ahead() && !filter.is_near());
        for _ in 0..8 {
            filter.update(&[]);
        }
        assert!(!filter.is_any());
    }

    #[test]
    fn lobes_and_sides_are_distinguished() {
        for (word, lobe, side) in [
            ([3, 3, 0, 0], Lobe::Both, 0.0),
            ([1, 0, 0, 0], Lobe::Left, 1.0),
            ([0, 2, 0, 0], Lobe::Right, -1.0),
            ([0, 0, 6, 0], Lobe::Right, 1.0),
            ([0, 0, 0, 4], Lobe::None, -1.0),
        ] {
            let filter = received(&[word; 8]);
            assert_eq!((filter.lobe(), filter.side()), (lobe, side), "{word:?}");
        }
    }
}
