//! Learning which input a person means, and how far an axis goes.

use mixer::{Calibration, Readings, Source, first_moved};

use super::Field;
use crate::words::Words;

/// An axis that went less far was not moved to its ends.
const REACH_MIN: f64 = 0.2;
/// An input that is let go comes back to its rest within this share of its way.
const REST_SHARE: f64 = 0.15;
/// Share around the rest that counts as rest, for an axis that was calibrated here.
const DEAD_BAND: f64 = 0.1;

/// A field waits for the next input that is moved.
#[derive(Clone, Debug)]
pub struct Learning {
    /// The field.
    pub field: Field,
    before: Readings,
}

impl Learning {
    /// Waits from now on.
    #[must_use]
    pub fn begin(field: Field, now: &Readings) -> Self {
        Self {
            field,
            before: now.clone(),
        }
    }

    /// The input that was moved since. A pad that appears meanwhile is watched from then on, and so are inputs that a client begins
    /// to send.
    pub fn look(&mut self, now: &Readings) -> Option<Source> {
        if !has_the_same(&self.before, now) {
            self.before = now.clone();
        }
        first_moved(&self.before, now)
    }
}

/// Whether the same devices are there.
fn has_the_same(one: &Readings, other: &Readings) -> bool {
    one.pads.keys().eq(other.pads.keys())
        && one.clients.keys().eq(other.clients.keys())
        && one.tilt.is_some() == other.tilt.is_some()
}

/// An axis is moved to both of its ends.
#[derive(Clone, Debug)]
pub struct CalibrationRun {
    /// Which calibration of the profile.
    pub place: usize,
    input: Source,
    centre: f64,
    low: f64,
    high: f64,
    last: f64,
}

impl CalibrationRun {
    /// Begins with the input at rest; none when its device is not there.
    #[must_use]
    pub fn begin(place: usize, input: &Source, now: &Readings) -> Option<Self> {
        let centre = now.value(input)?;
        Some(Self {
            place,
            input: input.clone(),
            centre,
            low: centre,
            high: centre,
            last: centre,
        })
    }

    /// Follows the input.
    pub fn look(&mut self, now: &Readings) {
        if let Some(value) = now.value(&self.input) {
            self.low = self.low.min(value);
            self.high = self.high.max(value);
            self.last = value;
        }
    }

    /// Where the input rests: where it was at the beginning and is again. One that had said nothing at the beginning reads 0 until it
    /// is touched; a trigger among those is let go at one of its ends.
    fn rest(&self) -> Option<f64> {
        let near = REST_SHARE * (self.high - self.low);
        let is_near = |value: f64| (self.last - value).abs() <= near;
        if is_near(self.centre) {
            Some(self.centre)
        } else {
            let is_at_end = is_near(self.low) || is_near(self.high);
            (self.centre == 0.0 && is_at_end).then_some(self.last)
        }
    }

    /// What was seen so far.
    #[must_use]
    pub fn text(&self, words: &Words) -> String {
        let [low, high, centre] = [self.low, self.high, self.centre].map(|value| words.number(value, 2));
        words.mix.ends.fill([&low, &high, &centre])
    }

    /// The calibration of what was seen.
    ///
    /// # Errors
    /// A sentence when it was not moved.
    pub fn finish(&self, words: &Words) -> Result<Calibration, String> {
        if self.high - self.low < REACH_MIN {
            return Err(words.mix.not_moved.fill([&self.input]));
        }
        Ok(Calibration {
            low: rounded(self.low),
            centre: rounded(
                self.rest()
                    .ok_or_else(|| words.mix.not_let_go.fill([&self.input]))?,
            ),
            high: rounded(self.high),
            ..Calibration::new(self.input.clone(), DEAD_BAND)
        })
    }
}

/// To a thousandth: no stick repeats better.
fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
