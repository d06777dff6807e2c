//! What was measured during a run, as lines over time.

use std::fmt::Write as _;

use rvac_api::{RunTrack, TrackReading};

use crate::device_rows::UNMEASURED_A;
use crate::words::Words;

/// Width and height of a plot in its own units.
const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 60.0;

/// A plot: 300 wide, 60 high, y downwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What it shows, with its unit.
    pub title: &'static str,
    /// Its lines: what each shows, and its path.
    pub lines: Vec<(&'static str, String)>,
    /// The value at the lower edge.
    pub low: String,
    /// The value at the upper edge.
    pub high: String,
}

/// From the least value to the greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ValueRange {
    low: f64,
    high: f64,
}

impl ValueRange {
    /// Of no value.
    const NONE: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    fn with(self, value: f64) -> Self {
        Self {
            low: self.low.min(value),
            high: self.high.max(value),
        }
    }
}

/// What a measured value can be.
const PERCENT: ValueRange = ValueRange {
    low: 0.0,
    high: 100.0,
};
const ANY: ValueRange = ValueRange {
    low: f64::NEG_INFINITY,
    high: f64::INFINITY,
};

/// What a plot shows.
#[derive(Clone, Copy, Debug)]
struct Subject<'a> {
    title: &'static str,
    lines: &'a [(&'static str, Reading)],
    possible: ValueRange,
}

type Reading = fn(&TrackReading) -> Option<f32>;

/// The plots of a run that lasted `end_s`; only of what was measured.
#[must_use]
pub fn plots(words: &Words, track: &RunTrack, end_s: f64) -> Vec<Plot> {
    let texts = &words.history;
    let battery: [(&str, Reading); 1] = [(texts.charge, |reading| {
        reading.charge.map(|charge| 100.0 * charge)
    })];
    let battery_a: [(&str, Reading); 1] = [(texts.battery, |reading| reading.battery_a)];
    // All that a robot reports of a run without a charger, when that has the only meter.
    let is_metered = |reading: &TrackReading| {
        let battery_a = reading.battery_a.unwrap_or_default();
        f64::from(battery_a).abs() >= UNMEASURED_A
    };
    let battery_a = &battery_a[..usize::from(track.readings.iter().any(is_metered))];
    let motors: [(&str, Reading); 3] = [
        (texts.left_wheel, |reading| {
            reading.motors_a.map(|[left, _, _]| left)
        }),
        (texts.right_wheel, |reading| {
            reading.motors_a.map(|[_, right, _]| right)
        }),
        (texts.main_brush, |reading| {
            reading.motors_a.map(|[_, _, brush]| brush)
        }),
    ];
    let link: [(&str, Reading); 1] = [(texts.bad_packets, |reading| Some(100.0 * reading.bad_share))];
    let subject = |title, lines, possible| Subject {
        title,
        lines,
        possible,
    };
    [
        subject(texts.plot_charge, &battery[..], PERCENT),
        subject(texts.plot_battery, battery_a, ANY),
        subject(texts.plot_motors, &motors[..], ANY),
        subject(texts.plot_link, &link[..], PERCENT),
    ]
    .into_iter()
    .filter_map(|subject| plot(words, subject, track, end_s))
    .collect()
}

/// The values at the edges of a plot from those that it shows: a line that hardly moves is drawn as one, not as its last
/// digits, and no edge is a value that cannot be.
fn edges(shown: ValueRange, possible: ValueRange) -> ValueRange {
    let middle = 0.5 * (shown.low + shown.high);
    let half = (0.5 * (shown.high - shown.low)).max(0.5);
    let inwards = (possible.low - (middle - half)).max(0.0) - (middle + half - possible.high).max(0.0);
    ValueRange {
        low: middle - half + inwards,
        high: middle + half + inwards,
    }
}

fn plot(words: &Words, subject: Subject<'_>, track: &RunTrack, end_s: f64) -> Option<Plot> {
    let values = |reading: Reading| {
        let points = track
            .readings
            .iter()
            .filter_map(move |entry| Some((entry.t, reading(entry)?)));
        points.filter(|(t, value)| t.is_finite() && value.is_finite())
    };
    let all = subject
        .lines
        .iter()
        .flat_map(|(_, reading)| values(*reading))
        .map(|(_, value)| f64::from(value));
    let shown = all.fold(ValueRange::NONE, ValueRange::with);
    if shown.low > shown.high {
        return None;
    }
    let ValueRange { low, high } = edges(shown, subject.possible);
    let place = |(t, value): (f32, f32)| {
        let x = WIDTH * (f64::from(t) / end_s.max(1.0)).clamp(0.0, 1.0);
        (x, HEIGHT * (high - f64::from(value)) / (high - low))
    };
    let path = |reading: Reading| {
        let mut path = String::new();
        for (x, y) in values(reading).map(place) {
            let letter = if path.is_empty() { 'M' } else { 'L' };
            // Writing to a string does not fail.
            write!(path, "{letter}{x:.1} {y:.1}").ok();
        }
        path
    };
    Some(Plot {
        title: subject.title,
        lines: subject
            .lines
            .iter()
            .map(|(name, reading)| (*name, path(*reading)))
            .collect(),
        low: words.number(low, 1),
        high: words.number(high, 1),
    })
}

#[cfg(test)]
mod tests {
    use rvac_api::{RunTrack, TrackReading};

    use super::plots;
    use crate::words::{Language, Words};

    const ENGLISH: &Words = Language::English.words();

    #[test]
    fn only_what_was_measured_has_a_plot() {
        let reading = |t, charge| TrackReading {
            t,
            charge,
            bad_share: 0.01,
            ..TrackReading::default()
        };
        let track = RunTrack {
            readings: vec![
                reading(0.0, Some(0.9)),
                reading(50.0, None),
                reading(100.0, Some(0.7)),
            ],
            ..RunTrack::default()
        };
        let plots = plots(ENGLISH, &track, 100.0);
        let titles: Vec<&str> = plots.iter().map(|plot| plot.title).collect();
        assert_eq!(titles, ["Battery charge in %", "Bad packets on the cable in %"]);
        assert_eq!(plots[0].lines, [("Charge", "M0.0 0.0L300.0 60.0".to_owned())]);
        assert_eq!((plots[0].low.as_str(), plots[0].high.as_str()), ("70.0", "90.0"));
        assert_eq!(plots[1].lines[0].1, "M0.0 30.0L150.0 30.0L300.0 30.0");
        assert!(super::plots(ENGLISH, &RunTrack::default(), 5.0).is_empty());
    }

    #[test]
    fn a_battery_whose_current_nothing_measures_has_no_flat_line() {
        let titles = |battery_a: [f32; 2]| {
            let reading = |t, battery_a| TrackReading {
                t,
                battery_a: Some(battery_a),
                ..TrackReading::default()
            };
            let track = RunTrack {
                readings: vec![reading(0.0, battery_a[0]), reading(9.0, battery_a[1])],
                ..RunTrack::default()
            };
            let plots = plots(ENGLISH, &track, 9.0);
            plots.iter().map(|plot| plot.title).collect::<Vec<_>>()
        };
        let link = "Bad packets on the cable in %";
        assert_eq!(titles([0.0, 0.0]), [link]);
        assert_eq!(titles([0.0, -0.4]), ["Current into the battery in A", link]);
    }

    #[test]
    fn no_edge_is_a_share_that_cannot_be() {
        let range = |low, high| super::ValueRange { low, high };
        assert_eq!(super::edges(range(0.0, 0.0), super::PERCENT), range(0.0, 1.0));
        assert_eq!(
            super::edges(range(99.75, 100.0), super::PERCENT),
            range(99.0, 100.0)
        );
        assert_eq!(super::edges(range(0.0, 100.0), super::PERCENT), range(0.0, 100.0));
        assert_eq!(super::edges(range(0.0, 0.0), super::ANY), range(-0.5, 0.5));
    }
}
