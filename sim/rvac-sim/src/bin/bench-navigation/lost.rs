//! How often the robot was lost, and whether it knew its place again soon.

use rvac_sim::LostStretch;
use serde::Serialize;

/// A robot that is lost shall know its place again after so long, seconds.
const FOUND_S: f64 = 180.0;

/// Figures over some runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct LostShares {
    /// Share of the runs in which the place was wrong by more than half a metre for more than a minute; `null` = no runs.
    pub(crate) runs_lost: Option<f64>,
    /// How often that happened in all runs.
    pub(crate) stretches: usize,
    /// Share of these periods that were over after three minutes; those that the run's end cut were not. `null` = none.
    pub(crate) found_in_180_s: Option<f64>,
}

impl LostShares {
    pub(crate) fn of<'runs>(runs: impl Iterator<Item = &'runs [LostStretch]>) -> Self {
        let runs: Vec<&[LostStretch]> = runs.collect();
        let lost = runs.iter().filter(|stretches| !stretches.is_empty()).count();
        let stretches = runs.concat();
        let found = stretches
            .iter()
            .filter(|stretch| stretch.found_again && stretch.length_s <= FOUND_S)
            .count();
        let share = |part: usize, all: usize| (all > 0).then(|| part as f64 / all as f64);
        Self {
            runs_lost: share(lost, runs.len()),
            stretches: stretches.len(),
            found_in_180_s: share(found, stretches.len()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LostShares, LostStretch};

    #[test]
    fn only_stretches_that_ended_soon_were_found() {
        let stretch = |length_s, found_again| LostStretch {
            begun_s: 600.0,
            length_s,
            found_again,
        };
        let runs = [
            vec![],
            vec![stretch(90.0, true), stretch(200.0, true)],
            vec![],
            vec![stretch(170.0, false), stretch(180.0, true)],
        ];
        let shares = LostShares::of(runs.iter().map(Vec::as_slice));
        assert_eq!((shares.runs_lost, shares.stretches), (Some(0.5), 4));
        assert_eq!(shares.found_in_180_s, Some(0.5));
        let none = LostShares::of([].into_iter());
        assert_eq!((none.runs_lost, none.found_in_180_s), (None, None));
    }
}
