//! How much is tested: what people wait for, what the build machine runs, or more still.

use std::fmt;

/// From the least to the most: each does all that those before it do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Extent {
    /// What a person waits for before a change is sent.
    Short,
    /// With the campaigns: what takes minutes to find something rare, and all that needs a browser or the emulated chip.
    All,
    /// With many more seeds and corrupted packets in the campaigns.
    Long,
}

impl Extent {
    /// Picks what belongs to this extent; `all` stands for [`Self::All`] only.
    pub(super) fn pick<T>(self, short: T, all: T, long: T) -> T {
        match self {
            Self::Short => short,
            Self::All => all,
            Self::Long => long,
        }
    }

    /// Whether the campaigns run.
    pub(super) fn has_campaigns(self) -> bool {
        self >= Self::All
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.pick("short", "all", "long"))
    }
}

#[cfg(test)]
mod tests {
    use super::Extent;

    #[test]
    fn campaigns_begin_with_all() {
        let extents = [Extent::Short, Extent::All, Extent::Long];
        assert_eq!(extents.map(Extent::has_campaigns), [false, true, true]);
        assert_eq!(extents.map(|extent| extent.pick(1, 2, 3)), [1, 2, 3]);
    }
}
