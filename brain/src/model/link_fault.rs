//! What can be wrong with the link to the firmware while it is not silent.

use super::inhibit::{Inhibit, Inhibits};
use super::named_enum::named_enum;

named_enum! {
    /// Why the link cannot be relied upon. Each has the name of the [`crate::Inhibit`] that reports it, and ends by itself when
    /// sound reports come again.
    LinkFault {
        /// What comes over the line is not the robot's.
        Garbled => "link-garbled",
        /// Reports arrive damaged.
        Corrupted => "link-corrupted",
        /// Reports come too seldom.
        Late => "link-late",
        /// Reports come, and the robot's clock in them stands.
        ClockFrozen => "clock-frozen",
        /// The robot's clock jumps.
        ClockJumped => "clock-jumped",
        /// Most commands reach the robot damaged.
        CommandsLost => "commands-lost",
        /// The robot refuses commands because they are too old when they reach it.
        CommandsStale => "commands-stale",
    }
}

impl LinkFault {
    /// The fault that this inhibit reports, if it is one of the link.
    pub(crate) fn of_inhibit(inhibit: Inhibit) -> Option<Self> {
        Self::from_name(inhibit.name())
    }

    /// What is wrong with the link by these inhibits, if anything.
    #[must_use]
    pub fn of_inhibits(inhibits: Inhibits) -> Option<Self> {
        inhibits.iter().find_map(Self::of_inhibit)
    }

    /// The inhibit that reports it.
    #[must_use]
    pub const fn inhibit(self) -> Inhibit {
        match self {
            Self::Garbled => Inhibit::LinkGarbled,
            Self::Corrupted => Inhibit::LinkCorrupted,
            Self::Late => Inhibit::LinkLate,
            Self::ClockFrozen => Inhibit::ClockFrozen,
            Self::ClockJumped => Inhibit::ClockJumped,
            Self::CommandsLost => Inhibit::CommandsLost,
            Self::CommandsStale => Inhibit::CommandsStale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::LinkFault;

    #[test]
    fn each_has_the_name_of_its_inhibit() {
        for fault in LinkFault::all() {
            assert_eq!(fault.name(), fault.inhibit().name());
            assert_eq!(LinkFault::of_inhibit(fault.inhibit()), Some(fault));
        }
    }
}
