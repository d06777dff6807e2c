//! What the dock receivers hear, with single words that were lost or misheard taken out.

/// Symbol of the beam in the left half, seen by a robot that comes to the dock.
const LOBE_LEFT: u8 = 1;
/// Symbol of the beam in the right half.
const LOBE_RIGHT: u8 = 2;
/// Symbol of the near field.
const NEAR_FIELD: u8 = 4;
/// A symbol counts up to this many observations.
const FULL: u8 = 6;
/// From this count on a silent symbol is heard, and below `LOSE` a heard one is not any more.
const HEAR: u8 = 4;
const LOSE: u8 = 2;

/// Counts of each symbol at each receiver. Receivers: front left, front right, rear left, rear right.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hearing {
    receivers: [Receiver; 4],
}

#[derive(Clone, Copy, Debug, Default)]
struct Receiver {
    counts: [u8; 3],
    heard: u8,
}

/// On which side of the line that leads straight in a robot is that faces the dock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lobe {
    /// On the line: both lobes are heard.
    Both,
    /// Left of the line.
    Left,
    /// Right of the line.
    Right,
    /// In neither; at most the near field is heard.
    None,
}

impl Hearing {
    /// Takes in what is heard in one observation; a robot with fewer receivers is deaf to the other sides.
    pub(crate) fn take(&mut self, beams: &[u8]) {
        for (number, receiver) in self.receivers.iter_mut().enumerate() {
            receiver.take(beams.get(number).copied().unwrap_or(0));
        }
    }

    fn at(&self, receiver: usize) -> u8 {
        self.receivers.get(receiver).map_or(0, |receiver| receiver.heard)
    }

    /// Any receiver hears any symbol.
    pub(crate) fn is_any(&self) -> bool {
        self.receivers.iter().any(|receiver| receiver.heard != 0)
    }

    /// Both front receivers hear the same dock: it lies ahead.
    pub(crate) fn is_ahead(&self) -> bool {
        self.at(0) != 0 && self.at(1) != 0
    }

    /// A front receiver hears something.
    pub(crate) fn is_in_front(&self) -> bool {
        (self.at(0) | self.at(1)) != 0
    }

    /// The near field is heard.
    pub(crate) fn is_near(&self) -> bool {
        self.all() & NEAR_FIELD != 0
    }

    /// The lobe that the receivers are in. All stand in the same beams, so what one misses another may hear.
    pub(crate) fn lobe(&self) -> Lobe {
        match (self.all() & LOBE_LEFT != 0, self.all() & LOBE_RIGHT != 0) {
            (true, true) => Lobe::Both,
            (true, false) => Lobe::Left,
            (false, true) => Lobe::Right,
            (false, false) => Lobe::None,
        }
    }

    /// +1 when the dock is rather on the left, -1 on the right, 0 when nothing tells.
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
            .fold(0, |all, receiver| all | receiver.heard)
    }
}

impl Receiver {
    fn take(&mut self, symbols: u8) {
        for (count, symbol) in self.counts.iter_mut().zip([LOBE_LEFT, LOBE_RIGHT, NEAR_FIELD]) {
            *count = if symbols & symbol == 0 {
                count.saturating_sub(1)
            } else {
                count.saturating_add(1).min(FULL)
            };
            if *count >= HEAR {
                self.heard |= symbol;
            } else if *count < LOSE {
                self.heard &= !symbol;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Hearing, Lobe};

    fn heard(words: &[[u8; 4]]) -> Hearing {
        let mut hearing = Hearing::default();
        for word in words {
            hearing.take(word);
        }
        hearing
    }

    #[test]
    fn single_words_neither_begin_nor_end_anything() {
        assert!(!heard(&[[3, 3, 0, 0], [0; 4]]).is_any());
        let steady = [[1, 1, 0, 0]; 8];
        let mut hearing = heard(&steady);
        hearing.take(&[0; 4]);
        hearing.take(&[2, 2, 0, 0]);
        assert_eq!(hearing.lobe(), Lobe::Left);
        assert!(hearing.is_ahead() && !hearing.is_near());
        for _ in 0..8 {
            hearing.take(&[]);
        }
        assert!(!hearing.is_any());
    }

    #[test]
    fn lobes_and_sides_are_told_apart() {
        for (word, lobe, side) in [
            ([3, 3, 0, 0], Lobe::Both, 0.0),
            ([1, 0, 0, 0], Lobe::Left, 1.0),
            ([0, 2, 0, 0], Lobe::Right, -1.0),
            ([0, 0, 6, 0], Lobe::Right, 1.0),
            ([0, 0, 0, 4], Lobe::None, -1.0),
        ] {
            let hearing = heard(&[word; 8]);
            assert_eq!((hearing.lobe(), hearing.side()), (lobe, side), "{word:?}");
        }
    }
}
