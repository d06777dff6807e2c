//! Numbers that stand for what a robot knows and does.
//!
//! A [`ContentHash`] takes in plain numbers only: cells, poses, motions, times. It takes in no name, no text of the program and
//! no stored form, so that it stays the same when these are spelled in another way, and differs when a single bit of the
//! content does.
#![forbid(unsafe_code)]

mod annotations;
mod checkpoint;
mod map;

use brain::{Actions, Motion, Point2, Pose2};

/// Start and factor of FNV-1a with 64 bits.
const START: u64 = 0xcbf2_9ce4_8422_2325;
const FACTOR: u64 = 0x0100_0000_01b3;

/// FNV-1a over numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContentHash(u64);

impl Default for ContentHash {
    fn default() -> Self {
        Self(START)
    }
}

impl ContentHash {
    /// What all numbers so far make.
    #[must_use]
    pub const fn value(self) -> u64 {
        self.0
    }

    /// Takes in bytes, for words that people have chosen.
    pub fn add_bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(FACTOR);
        }
    }

    /// Takes in a whole number.
    pub fn add(&mut self, number: impl Into<i128>) {
        self.add_bytes(&number.into().to_le_bytes());
    }

    /// Takes in the bits of a number.
    pub fn add_bits(&mut self, number: f64) {
        self.add_bytes(&number.to_bits().to_le_bytes());
    }

    /// Takes in a text that people have chosen.
    pub fn add_text(&mut self, text: &str) {
        self.add(text.len() as u64);
        self.add_bytes(text.as_bytes());
    }

    /// Takes in whether there is something.
    pub fn add_flag(&mut self, is_so: bool) {
        self.add_bytes(&[u8::from(is_so)]);
    }

    /// Takes in a place.
    pub fn add_point(&mut self, point: Point2) {
        self.add_bits(point.x_m);
        self.add_bits(point.y_m);
    }

    /// Takes in a pose.
    pub fn add_pose(&mut self, pose: Pose2) {
        self.add_point(pose.position());
        self.add_bits(pose.heading_rad);
    }

    /// Takes in an answer of the brain: its time, what it moves, and how many decisions with which numbers it tells.
    pub fn add_actions(&mut self, time_us: u64, actions: &Actions) {
        self.add(time_us);
        match actions.motion {
            Motion::Rest => self.add(0),
            Motion::Halt => self.add(1),
            Motion::Drive {
                speed_m_per_s,
                turn_rad_per_s,
            } => {
                self.add(2);
                self.add_bits(speed_m_per_s);
                self.add_bits(turn_rad_per_s);
            }
        }
        self.add_flag(actions.cleaners);
        self.add_flag(actions.arm.is_some());
        self.add_flag(actions.arm.is_some_and(|arm| arm.undock));
        for tone in &actions.tones {
            self.add(tone.pitch_hz);
            self.add(tone.duration_ms);
        }
        self.add(actions.decisions.len() as u64);
        for decision in &actions.decisions {
            self.add_bits(decision.value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ContentHash;

    #[test]
    fn bytes_make_the_published_number() {
        let mut hash = ContentHash::default();
        hash.add_bytes(b"foobar");
        assert_eq!(hash.value(), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn order_and_sign_count() {
        let of = |numbers: [f64; 2]| {
            let mut hash = ContentHash::default();
            for number in numbers {
                hash.add_bits(number);
            }
            hash
        };
        assert_ne!(of([1.0, 2.0]), of([2.0, 1.0]));
        assert_ne!(of([0.0, 0.0]), of([0.0, -0.0]));
    }
}
