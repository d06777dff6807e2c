//! The two halves of the published set.

use super::PUBLISHED;

/// What is tuned on one half is reported on the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// Odd numbers: constants may be chosen by them.
    Tuning,
    /// Even numbers: nothing is chosen by them.
    Report,
}

impl Half {
    /// `tuning` or `report`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "tuning" => Some(Self::Tuning),
            "report" => Some(Self::Report),
            _ => None,
        }
    }

    /// Numbers of its homes.
    pub fn numbers(self) -> impl Iterator<Item = u32> {
        PUBLISHED.filter(move |number| number.is_multiple_of(2) == (self == Self::Report))
    }
}

#[cfg(test)]
mod tests {
    use super::{Half, PUBLISHED};

    #[test]
    fn each_published_home_is_in_one_half() {
        let mut both: Vec<u32> = Half::Tuning.numbers().chain(Half::Report.numbers()).collect();
        both.sort_unstable();
        assert_eq!(both, PUBLISHED.collect::<Vec<u32>>());
        assert_eq!(
            Half::named("tuning").map(|half| half.numbers().next()),
            Some(Some(1))
        );
        assert_eq!(
            Half::named("report").map(|half| half.numbers().next()),
            Some(Some(2))
        );
        assert_eq!(Half::named("tune"), None);
    }
}
