//! The load of one motor since a person reported that its part is clean, and whether it has changed.

use std::collections::VecDeque;

/// Samples of a mark: a minute of work at five samples a second.
pub(super) const SAMPLES: usize = 300;
/// Marks from which the usual load is learnt, and marks that make the present one.
pub(super) const MARKS: usize = 10;
/// A load that is so many times the usual one is a hard one, and stays one until it is below the second figure.
const HARD: f32 = 1.4;
const HARD_UNTIL: f32 = 1.25;
/// The same for a motor that has lost its load.
const LIGHT: f32 = 0.6;
const LIGHT_UNTIL: f32 = 0.75;
/// Below this a motor's usual load cannot be distinguished from the converter's noise, amperes.
const LOAD_MIN_A: f32 = 0.02;

/// What the load says of the part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoadVerdict {
    /// Too little was measured since the reset.
    #[default]
    Learning,
    /// As after the reset.
    Fine,
    /// It runs hard: something is wound around it or rubs.
    Hard,
    /// It runs light: it does not touch what it should, or its belt is broken.
    Light,
}

impl LoadVerdict {
    /// What clients receive for a part without a measured load.
    pub const UNMEASURED: &'static str = "unmeasured";

    /// As clients receive it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Learning => "learning",
            Self::Fine => "fine",
            Self::Hard => "hard",
            Self::Light => "light",
        }
    }
}

/// Loads of one motor. A mark is the lower quartile of a minute: carpets and edges load a motor now and then, hair and dirt
/// always.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gauge {
    /// Marks after the reset, amperes: at most [`MARKS`].
    pub(super) usual_a: Vec<f32>,
    /// The newest marks, amperes: at most [`MARKS`].
    pub(super) newest_a: VecDeque<f32>,
    /// Marks since the reset.
    pub(super) marks: u32,
    pub(super) verdict: LoadVerdict,
    samples_a: Vec<f32>,
}

impl Gauge {
    /// A gauge as it was kept.
    pub(super) fn kept(usual_a: Vec<f32>, newest_a: VecDeque<f32>, marks: u32) -> Self {
        let mut gauge = Self {
            usual_a,
            newest_a,
            marks,
            ..Self::default()
        };
        gauge.judge();
        gauge
    }

    /// Takes in a sample. `true` when a mark is complete.
    pub(super) fn take(&mut self, load_a: f32) -> bool {
        if !load_a.is_finite() {
            return false;
        }
        self.samples_a.push(load_a.abs());
        if self.samples_a.len() < SAMPLES {
            return false;
        }
        self.samples_a.sort_by(f32::total_cmp);
        let mark_a = self.samples_a.get(SAMPLES / 4).copied().unwrap_or_default();
        self.samples_a.clear();
        if self.usual_a.len() < MARKS {
            self.usual_a.push(mark_a);
        }
        if self.newest_a.len() == MARKS {
            self.newest_a.pop_front();
        }
        self.newest_a.push_back(mark_a);
        self.marks = self.marks.saturating_add(1);
        self.judge();
        true
    }

    /// The usual load, once it is learnt, amperes.
    #[must_use]
    pub fn usual_a(&self) -> Option<f32> {
        let known = self.usual_a.len() == MARKS;
        known.then(|| median(self.usual_a.iter().copied()))?
    }

    /// The present load, amperes.
    #[must_use]
    pub fn present_a(&self) -> Option<f32> {
        median(self.newest_a.iter().copied())
    }

    /// Minutes of work since the reset.
    #[must_use]
    pub const fn minutes(&self) -> u32 {
        self.marks
    }

    /// The present load over the usual one.
    #[must_use]
    pub fn share(&self) -> Option<f32> {
        let usual_a = self.usual_a().filter(|usual_a| *usual_a >= LOAD_MIN_A)?;
        Some(self.present_a()? / usual_a)
    }

    fn judge(&mut self) {
        let Some(share) = self.share() else {
            self.verdict = LoadVerdict::Learning;
            return;
        };
        let stays = match self.verdict {
            LoadVerdict::Hard => share > HARD_UNTIL,
            LoadVerdict::Light => share < LIGHT_UNTIL,
            LoadVerdict::Learning | LoadVerdict::Fine => false,
        };
        if !stays {
            self.verdict = match share {
                share if share >= HARD => LoadVerdict::Hard,
                share if share <= LIGHT => LoadVerdict::Light,
                _ => LoadVerdict::Fine,
            };
        }
    }
}

fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::{Gauge, LoadVerdict, MARKS, SAMPLES};

    /// Minutes of work at a load, every sixth second of it on a carpet that doubles it.
    fn work(gauge: &mut Gauge, minutes: usize, load_a: f32) {
        for sample in 0..minutes * SAMPLES {
            let on_carpet = sample % 30 < 5;
            gauge.take(if on_carpet { 2.0 * load_a } else { load_a });
        }
    }

    #[test]
    fn a_load_that_grows_is_seen_after_half_of_the_marks_and_not_before() {
        let mut gauge = Gauge::default();
        work(&mut gauge, MARKS - 1, 0.4);
        assert_eq!(gauge.verdict, LoadVerdict::Learning);
        work(&mut gauge, 60, 0.4);
        assert_eq!((gauge.verdict, gauge.share()), (LoadVerdict::Fine, Some(1.0)));
        work(&mut gauge, 60, 0.5);
        assert_eq!(gauge.verdict, LoadVerdict::Fine);
        work(&mut gauge, MARKS / 2 - 1, 0.6);
        assert_eq!(gauge.verdict, LoadVerdict::Fine);
        work(&mut gauge, 1, 0.6);
        assert_eq!(gauge.verdict, LoadVerdict::Hard);
        work(&mut gauge, MARKS, 0.52);
        assert_eq!(gauge.verdict, LoadVerdict::Hard, "it wavers");
        work(&mut gauge, MARKS, 0.48);
        assert_eq!(gauge.verdict, LoadVerdict::Fine);
    }

    #[test]
    fn a_broken_belt_is_light_and_a_motor_that_draws_nothing_is_not_judged() {
        let mut gauge = Gauge::default();
        work(&mut gauge, MARKS, 0.4);
        work(&mut gauge, MARKS, 0.1);
        assert_eq!(gauge.verdict, LoadVerdict::Light);
        let mut idle = Gauge::default();
        work(&mut idle, 3 * MARKS, 0.001);
        assert_eq!(idle.verdict, LoadVerdict::Learning);
        assert!(!idle.take(f32::NAN));
    }
}
