//! The faults, and by which names people hear of each.

use home::{Pcg, SensorFault};
use vthal_core::schedule::CLOCK_WAS_SET_S;

use super::gap::CarriedGap;
use super::pad::PadFault;
use super::zone::ZoneFault;

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
    /// Nobody listens for a while, and somebody carries the robot meanwhile.
    CarriedGap(CarriedGap),
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
    /// The system says in an unusual way in which time zone it is, or not at all.
    Zone(ZoneFault),
    /// A gamepad.
    Pad(PadFault),
}

/// Names by which faults are told; whichever is not of the present fault is a wrong cause.
const NAMES: [&str; 22] = [
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
    "clock-set",
    "zone-changed",
    "zone-unknown",
    "zone-variable-unknown",
];

/// Faults that come together.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardFaults(Vec<BoardFault>);

impl BoardFaults {
    /// The faults of this number: the kinds take turns; in every other round the disk, the clock or the cable fails as well.
    #[must_use]
    pub fn drawn(number: u64) -> Self {
        let first = BoardFault::drawn(number);
        let mut faults = vec![first];
        let round = number / KINDS;
        if round % 2 == 1 {
            faults.extend(first.companion(number, round));
        }
        Self(faults)
    }

    /// This one alone.
    pub(super) fn of(fault: BoardFault) -> Self {
        Self(vec![fault])
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = BoardFault> {
        self.0.iter().copied()
    }

    /// The one that nothing else is drawn beside: it leaves no robot on the line, or has a trial of its own.
    pub(super) fn lone(&self) -> Option<BoardFault> {
        self.iter().find(|fault| fault.is_lone())
    }

    /// Names of other faults in a line of the log.
    pub(super) fn wrong_causes(&self, line: &str) -> Vec<&'static str> {
        let is_allowed = |name: &str| {
            let mut names = self.iter().flat_map(BoardFault::may_name);
            names.any(|allowed| allowed == name)
        };
        NAMES
            .into_iter()
            .filter(|name| words(line).any(|word| word == *name) && !is_allowed(name))
            .collect()
    }
}

/// So many kinds take turns.
pub(super) const KINDS: u64 = 23;
/// Numbers of the first zone's and the first pad's kind.
const FIRST_ZONE: u64 = 10;
const FIRST_PAD: u64 = 18;

impl BoardFault {
    /// Whether nothing else is drawn beside it.
    const fn is_lone(self) -> bool {
        matches!(
            self,
            Self::WrongSpeed | Self::Console | Self::CarriedGap(_) | Self::Zone(_) | Self::Pad(_)
        )
    }

    /// What fails beside it; nothing beside a line without a robot, for which no robot is simulated.
    fn companion(self, number: u64, round: u64) -> Option<Self> {
        // Their kinds by number. A gyro shows only while the cable is in, so it gets the disk or the clock.
        let cable = Self::drawn(KINDS * number + 4);
        let disk = Self::drawn(KINDS * number + 7);
        let clock = Self::drawn(KINDS * number + 8);
        match self {
            _ if self.is_lone() => None,
            Self::DiskRefuses(_) if round % 4 == 1 => Some(cable),
            Self::DiskRefuses(_) => Some(clock),
            Self::ClockJump { .. } if round % 4 == 1 => Some(cable),
            Self::ClockJump { .. } => Some(disk),
            _ if round % 4 == 1 => Some(disk),
            _ => Some(clock),
        }
    }

    /// The fault of this number; kinds take turns, and what is not of the kind is drawn.
    fn drawn(number: u64) -> Self {
        let mut random = Pcg::new(number, 0xB0A2D);
        match number % KINDS {
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
            8 => Self::ClockJump {
                by_s: ((random.unit() - 0.5) * 7_200.0) as i64,
            },
            9 => Self::CarriedGap(CarriedGap::drawn(&mut random)),
            kind @ FIRST_ZONE..FIRST_PAD => Self::Zone(ZoneFault::ALL[(kind - FIRST_ZONE) as usize]),
            kind => Self::Pad(PadFault::ALL[(kind - FIRST_PAD) as usize]),
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
            Self::CarriedGap(_) => "carried-in-a-gap",
            Self::WrongSpeed => "wrong-speed",
            Self::Console => "console",
            Self::DiskRefuses(_) => "disk-refuses",
            Self::ClockJump { .. } => "clock-jump",
            Self::Zone(fault) => fault.kind(),
            Self::Pad(fault) => fault.kind(),
        }
    }

    /// Names of which one must be told; none for what is not worth telling.
    pub(super) const fn told_as(self) -> &'static [&'static str] {
        match self {
            Self::Gyro(SensorFault::StuckAt(_)) => &["gyro-frozen"],
            Self::Gyro(_) => &["gyro-disagrees"],
            Self::BoardGyroSilent => &["gyro-silent"],
            Self::LineCut { .. } => &["link-lost"],
            Self::CarriedGap(gap) if gap.is_told() => &["link-lost"],
            // The pieces of garbage may be judged before their kind is known.
            Self::WrongSpeed => &["line-wrong-speed"],
            Self::Console => &["line-has-console"],
            Self::DiskRefuses(_) => &["schedules-unwritable"],
            Self::Zone(fault) => fault.told_as(),
            // Less than a minute is not worth a word; a pad is told where a person drives, and judged by a trial of its own.
            Self::ClockJump { by_s } if by_s.unsigned_abs() >= CLOCK_WAS_SET_S => &["clock-set"],
            Self::ClockJump { .. } | Self::CarriedGap(_) | Self::Pad(_) => &[],
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

    /// Names that people may read while it stands.
    fn may_name(self) -> impl Iterator<Item = &'static str> {
        self.told_as().iter().chain(self.may_be_told_as()).copied()
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
    use super::{BoardFault, BoardFaults, KINDS};

    #[test]
    fn names_are_whole_words_and_those_of_others_are_wrong() {
        let fault = BoardFault::BoardGyroSilent;
        assert!(fault.is_told_in("leave-out-gyro (gyro-silent)"));
        assert!(!fault.is_told_in("gyro-silently"));
        let line = "state-stuck (slip), then gyro-silent and link-lost";
        assert_eq!(BoardFaults(vec![fault]).wrong_causes(line), ["link-lost", "slip"]);
        let with_cable = BoardFaults(vec![fault, BoardFault::LineCut { ms: 1 }]);
        assert_eq!(with_cable.wrong_causes(line), ["slip"]);
    }

    #[test]
    fn every_other_round_has_two_kinds_and_what_has_its_own_trial_stays_alone() {
        for number in 0..10 * KINDS {
            let faults = BoardFaults::drawn(number);
            let kinds: std::collections::BTreeSet<_> = faults.iter().map(BoardFault::kind).collect();
            let is_pair = number / KINDS % 2 == 1 && faults.lone().is_none();
            assert_eq!(kinds.len(), if is_pair { 2 } else { 1 }, "{faults:?}");
        }
    }
}
