//! The faults, and by which names people hear of each.

use home::{Pcg, SensorFault};

/// Something that fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoardFault {
    /// The robot's gyro lies.
    Gyro(SensorFault),
    /// The gyro on the Linux board says nothing any more.
    BoardGyroSilent,
    /// The cable is out for so long.
    LineCut {
        /// Milliseconds.
        ms: u32,
    },
    /// The line is set to another speed than the robot's: its bytes look like noise.
    WrongSpeed,
    /// A login console answers in the place of the robot.
    Console,
    /// The disk refuses every write with these words.
    DiskRefuses(&'static str),
    /// The clock on the wall jumps by so much, which moves nothing by itself.
    ClockJump {
        /// Seconds.
        by_s: i64,
    },
}

/// Names by which faults are told; whichever is not of the present fault is a wrong cause.
const NAMES: [&str; 18] = [
    "gyro-frozen",
    "gyro-at-its-limit",
    "gyro-disagrees",
    "gyro-silent",
    "line-wrong-speed",
    "line-has-console",
    "link-lost",
    "link-garbled",
    "link-corrupted",
    "link-late",
    "clock-frozen",
    "clock-jumped",
    "commands-lost",
    "commands-stale",
    "schedule-unwritable",
    "slip",
    "wheel-stall",
    "encoder",
];

impl BoardFault {
    /// The fault of this number; kinds take turns, and what is not of the kind is drawn.
    #[must_use]
    pub fn drawn(number: u64) -> Self {
        let mut random = Pcg::new(number, 0xB0A2D);
        match number % 9 {
            0 => Self::Gyro(SensorFault::StuckAt(0)),
            1 => Self::Gyro(SensorFault::Inverted),
            2 => Self::Gyro(SensorFault::Noisy(20_000.0 + 30_000.0 * random.unit())),
            3 => Self::BoardGyroSilent,
            4 => Self::LineCut {
                ms: 3_000 + (5_000.0 * random.unit()) as u32,
            },
            5 => Self::WrongSpeed,
            6 => Self::Console,
            7 => {
                let words = [
                    "No space left on device (os error 28)",
                    "Read-only file system (os error 30)",
                    "Input/output error (os error 5)",
                ];
                let place = (random.unit() * words.len() as f64) as usize;
                Self::DiskRefuses(
                    words
                        .get(place)
                        .copied()
                        .unwrap_or("Input/output error (os error 5)"),
                )
            }
            _ => Self::ClockJump {
                by_s: ((random.unit() - 0.5) * 7_200.0) as i64,
            },
        }
    }

    /// Its kind, for tables.
    #[must_use]
    pub const fn kind(self) -> &'static str {
        match self {
            Self::Gyro(SensorFault::StuckAt(_)) => "gyro-stuck",
            Self::Gyro(SensorFault::Inverted) => "gyro-inverted",
            Self::Gyro(SensorFault::Noisy(_)) => "gyro-noisy",
            Self::BoardGyroSilent => "board-gyro-silent",
            Self::LineCut { .. } => "line-cut",
            Self::WrongSpeed => "wrong-speed",
            Self::Console => "console",
            Self::DiskRefuses(_) => "disk-refuses",
            Self::ClockJump { .. } => "clock-jump",
        }
    }

    /// Names of which one must be told; none for what is not worth telling.
    pub(super) const fn told_as(self) -> &'static [&'static str] {
        match self {
            Self::Gyro(SensorFault::StuckAt(_)) => &["gyro-frozen"],
            Self::Gyro(_) => &["gyro-disagrees"],
            Self::BoardGyroSilent => &["gyro-silent"],
            Self::LineCut { .. } => &["link-lost"],
            // The pieces of garbage may be judged before their kind is known.
            Self::WrongSpeed => &["line-wrong-speed"],
            Self::Console => &["line-has-console"],
            Self::DiskRefuses(_) => &["schedules-unwritable"],
            Self::ClockJump { .. } => &[],
        }
    }

    /// Names that may be told besides.
    const fn may_be_told_as(self) -> &'static [&'static str] {
        match self {
            Self::WrongSpeed | Self::Console => &["link-garbled", "link-corrupted", "link-lost"],
            // A gyro that counts backward turns a robot that steers by it in circles until it is left out.
            Self::Gyro(_) => &["slip"],
            _ => &[],
        }
    }

    /// Names of other faults in a line of the log.
    pub(super) fn wrong_causes(self, line: &str) -> Vec<&'static str> {
        let allowed = [self.told_as(), self.may_be_told_as()].concat();
        let is_named = |name: &&str| words(line).any(|word| word == *name);
        NAMES
            .into_iter()
            .filter(is_named)
            .filter(|name| !allowed.contains(name))
            .collect()
    }

    /// Whether a line of the log tells it.
    pub(super) fn is_told_in(self, line: &str) -> bool {
        self.told_as()
            .iter()
            .any(|name| words(line).any(|word| word == *name))
    }
}

/// Words of a line; a name of several parts is one.
fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '-')
}

#[cfg(test)]
mod tests {
    use super::BoardFault;

    #[test]
    fn names_are_whole_words_and_those_of_others_are_wrong() {
        let fault = BoardFault::BoardGyroSilent;
        assert!(fault.is_told_in("leave-out-gyro (gyro-silent)"));
        assert!(!fault.is_told_in("gyro-silently"));
        assert_eq!(
            fault.wrong_causes("state-stuck (slip), then gyro-silent"),
            ["slip"]
        );
    }
}
