//! What can be wrong with a line, as a closed list.

use core::fmt;

/// A fault of the line. All but those of a single moment last until they are taken away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineFault {
    /// Nothing is wrong.
    #[default]
    None,
    /// So many pieces of garbage a second between the packets, each a packet of its own.
    Garbage {
        /// Pieces a second.
        per_s: u32,
    },
    /// So many pieces of garbage a second without an end of their own: each damages the packet that follows.
    OpenGarbage {
        /// Pieces a second.
        per_s: u32,
    },
    /// Every n-th report has a wrong seal.
    WrongSeal {
        /// Which.
        every: u32,
    },
    /// Every n-th command has a wrong seal.
    WrongCommandSeal {
        /// Which.
        every: u32,
    },
    /// The tick of one report is off by so much.
    StrayTick {
        /// By how much, ms.
        by_ms: i32,
    },
    /// The robot's clock jumps and goes on from there, so often, two seconds apart.
    ClockJump {
        /// By how much, ms.
        by_ms: i32,
        /// How often.
        times: u32,
    },
    /// The ticks of reports are off by so much while commands are judged by the right clock.
    ShiftedTicks {
        /// By how much, ms.
        by_ms: i32,
    },
    /// The tick of all reports stays what it was, for so long.
    FrozenTick {
        /// How long, ms.
        for_ms: u64,
    },
    /// Each report comes so many times.
    Repeated {
        /// How often.
        times: u32,
    },
    /// Each two reports come in the wrong order.
    Swapped,
    /// Only every n-th report comes.
    Thinned {
        /// Which.
        keep_every: u32,
    },
    /// Each report comes so much later.
    Delayed {
        /// By how much, ms.
        ms: u64,
    },
    /// For a second all reports have a wrong seal, for the next one none, and so on.
    EverySecondSecond,
    /// The counts of the wheels stay what they were.
    FrozenCounts,
    /// The host is suspended for a minute.
    HostSuspended(HostClock),
    /// The cable is out for so long.
    CutOut {
        /// How long, ms.
        for_ms: u32,
    },
}

/// What the clock of a suspended host does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HostClock {
    /// It stands, as the monotonic clock of Linux does.
    Stands,
    /// It runs.
    Runs,
}

/// How long a suspended host is away, ms.
pub(super) const SUSPENDED_MS: u64 = 60_000;

/// Jumps of a clock that jumps more than once are so far apart, ms.
pub(super) const JUMP_PAUSE_MS: u64 = 2_000;

impl LineFault {
    /// Those of the table: mild and hard ones of each kind.
    pub const ALL: [Self; 40] = [
        Self::None,
        Self::Garbage { per_s: 1 },
        Self::Garbage { per_s: 20 },
        Self::Garbage { per_s: 200 },
        Self::Garbage { per_s: 2_000 },
        Self::OpenGarbage { per_s: 1 },
        Self::OpenGarbage { per_s: 10 },
        Self::OpenGarbage { per_s: 40 },
        Self::OpenGarbage { per_s: 200 },
        Self::WrongSeal { every: 100 },
        Self::WrongSeal { every: 10 },
        Self::WrongSeal { every: 4 },
        Self::WrongSeal { every: 2 },
        Self::WrongSeal { every: 1 },
        Self::WrongCommandSeal { every: 10 },
        Self::WrongCommandSeal { every: 4 },
        Self::WrongCommandSeal { every: 2 },
        Self::WrongCommandSeal { every: 1 },
        Self::StrayTick { by_ms: 60_000 },
        Self::StrayTick { by_ms: -60_000 },
        Self::ClockJump {
            by_ms: 60_000,
            times: 1,
        },
        Self::ClockJump {
            by_ms: 60_000,
            times: 2,
        },
        Self::ClockJump {
            by_ms: -60_000,
            times: 1,
        },
        Self::ShiftedTicks { by_ms: 60_000 },
        Self::ShiftedTicks { by_ms: -60_000 },
        Self::FrozenTick { for_ms: 60_000 },
        Self::FrozenTick { for_ms: 2_000 },
        Self::Repeated { times: 2 },
        Self::Repeated { times: 10 },
        Self::Swapped,
        Self::Thinned { keep_every: 2 },
        Self::Thinned { keep_every: 10 },
        Self::Thinned { keep_every: 25 },
        Self::Delayed { ms: 200 },
        Self::Delayed { ms: 600 },
        Self::EverySecondSecond,
        Self::FrozenCounts,
        Self::HostSuspended(HostClock::Stands),
        Self::HostSuspended(HostClock::Runs),
        Self::CutOut { for_ms: 2_000 },
    ];

    /// After what time it ends by itself, ms; `None` for one that lasts.
    #[must_use]
    pub(super) const fn lasts_ms(self) -> Option<u64> {
        match self {
            Self::StrayTick { .. } => Some(0),
            Self::ClockJump { times, .. } => Some((times as u64 - 1) * JUMP_PAUSE_MS),
            Self::FrozenTick { for_ms } => Some(for_ms),
            Self::HostSuspended(_) => Some(SUSPENDED_MS),
            Self::CutOut { for_ms } => Some(for_ms as u64),
            _ => None,
        }
    }

    /// Whether reports still tell all when it is there, so that the robot shall clean on.
    #[must_use]
    pub const fn is_mild(self) -> bool {
        match self {
            Self::None
            | Self::Garbage { .. }
            | Self::StrayTick { .. }
            | Self::Repeated { .. }
            | Self::Swapped => true,
            Self::OpenGarbage { per_s } => per_s <= 10,
            Self::WrongSeal { every } | Self::WrongCommandSeal { every } => every >= 2,
            Self::Thinned { keep_every } => keep_every <= 10,
            Self::Delayed { ms } => ms <= 200,
            Self::ClockJump { .. }
            | Self::ShiftedTicks { .. }
            | Self::FrozenTick { .. }
            | Self::EverySecondSecond
            | Self::FrozenCounts
            | Self::HostSuspended(_)
            | Self::CutOut { .. } => false,
        }
    }
}

impl fmt::Display for LineFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = |ms: i32| f64::from(ms) / 1_000.0;
        match *self {
            Self::None => write!(formatter, "none"),
            Self::Garbage { per_s } => write!(formatter, "{per_s} pieces of garbage a second"),
            Self::OpenGarbage { per_s } => write!(formatter, "{per_s} a second, each damages a packet"),
            Self::WrongSeal { every: 1 } => write!(formatter, "wrong seal on every report"),
            Self::WrongSeal { every } => write!(formatter, "wrong seal on 1 of {every} reports"),
            Self::WrongCommandSeal { every: 1 } => write!(formatter, "wrong seal on every command"),
            Self::WrongCommandSeal { every } => write!(formatter, "wrong seal on 1 of {every} commands"),
            Self::StrayTick { by_ms } => write!(formatter, "one tick off by {:+} s", seconds(by_ms)),
            Self::ClockJump { by_ms, times } => {
                write!(formatter, "clock jumps by {:+} s, {times} times", seconds(by_ms))
            }
            Self::ShiftedTicks { by_ms } => {
                write!(formatter, "ticks of reports off by {:+} s", seconds(by_ms))
            }
            Self::FrozenTick { for_ms } => write!(formatter, "tick frozen for {} s", for_ms / 1_000),
            Self::Repeated { times } => write!(formatter, "each report {times} times"),
            Self::Swapped => write!(formatter, "reports swapped in pairs"),
            Self::Thinned { keep_every } => write!(formatter, "only 1 of {keep_every} reports"),
            Self::Delayed { ms } => write!(formatter, "reports {ms} ms late"),
            Self::EverySecondSecond => write!(formatter, "wrong seals in every second second"),
            Self::FrozenCounts => write!(formatter, "counts of the wheels frozen"),
            Self::HostSuspended(HostClock::Stands) => write!(formatter, "host suspended, its clock too"),
            Self::HostSuspended(HostClock::Runs) => write!(formatter, "host suspended, its clock runs"),
            Self::CutOut { for_ms } => write!(formatter, "cable out for {} s", for_ms / 1_000),
        }
    }
}
