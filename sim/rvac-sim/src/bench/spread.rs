//! Medians and 90th percentiles of figures.

use serde::Serialize;

/// Which end of a figure is good.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// Less.
    Less,
    /// More.
    More,
}

/// How a figure is taken from a run, and what it is called.
#[derive(Debug)]
pub struct RunFigure<Run> {
    /// Its key in JSON.
    pub name: &'static str,
    /// Which end of it is good.
    pub better: Better,
    /// `None` = the run has no such figure.
    pub of: fn(&Run) -> Option<f64>,
}

/// A figure over some runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// `null` = the median run has no such figure.
    pub median: Option<f64>,
    /// The 90th percentile toward the worse.
    pub p90: Option<f64>,
    /// Runs without the figure.
    pub missing: usize,
}

impl<Run> RunFigure<Run> {
    /// A figure of which less is better.
    #[must_use]
    pub const fn less(name: &'static str, of: fn(&Run) -> Option<f64>) -> Self {
        Self {
            name,
            better: Better::Less,
            of,
        }
    }

    /// A figure of which more is better.
    #[must_use]
    pub const fn more(name: &'static str, of: fn(&Run) -> Option<f64>) -> Self {
        Self {
            name,
            better: Better::More,
            of,
        }
    }

    /// Over some runs.
    #[must_use]
    pub fn spread(&self, runs: &[&Run]) -> Spread {
        let values: Vec<Option<f64>> = runs.iter().map(|run| (self.of)(run)).collect();
        Spread::of(&values, self.better)
    }
}

impl Spread {
    /// Nearest rank; a run without the figure is worse than all others.
    #[must_use]
    pub fn of(values: &[Option<f64>], better: Better) -> Self {
        let mut sorted: Vec<f64> = values.iter().flatten().copied().collect();
        sorted.sort_by(f64::total_cmp);
        if better == Better::More {
            sorted.reverse();
        }
        let rank = |share: f64| {
            let rank = (share * values.len() as f64).ceil() as usize;
            rank.checked_sub(1).and_then(|index| sorted.get(index)).copied()
        };
        Self {
            median: rank(0.5),
            p90: rank(0.9),
            missing: values.len() - sorted.len(),
        }
    }

    /// Median and 90th percentile for people.
    #[must_use]
    pub fn text(&self) -> String {
        let number = |value: Option<f64>| match value {
            None => "-".to_owned(),
            Some(value) if value.abs() >= 100.0 => format!("{value:.0}"),
            Some(value) if value.abs() >= 1.0 => format!("{value:.2}"),
            Some(value) => format!("{value:.3}"),
        };
        format!("{} ({})", number(self.median), number(self.p90))
    }
}

#[cfg(test)]
mod tests {
    use super::{Better, Spread};

    #[test]
    fn runs_that_did_not_arrive_count_as_the_worst() {
        let times: Vec<Option<f64>> = (1..=8).map(|n| Some(f64::from(n))).chain([None, None]).collect();
        let of_times = Spread::of(&times, Better::Less);
        assert_eq!(
            (of_times.median, of_times.p90, of_times.missing),
            (Some(5.0), None, 2)
        );
        let shares: Vec<Option<f64>> = (1..=10).map(|n| Some(f64::from(n) / 10.0)).collect();
        assert_eq!(Spread::of(&shares, Better::More).p90, Some(0.2));
        assert_eq!(Spread::of(&[], Better::Less).median, None);
    }
}
