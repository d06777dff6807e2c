//! What was measured during a run, as lines over time.

use std::fmt::Write as _;

use rvac_api::{RunTrack, TrackReading};

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

/// What a measured value can be.
const PERCENT: (f64, f64) = (0.0, 100.0);
const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

type Reading = fn(&TrackReading) -> Option<f32>;

/// The plots of a run that lasted `end_s`; only of what was measured.
#[must_use]
pub fn plots(words: &Words, track: &RunTrack, end_s: f64) -> Vec<Plot> {
    let told = &words.history;
    let battery: [(&str, Reading); 1] =
        [(told.charge, |reading| reading.charge.map(|charge| 100.0 * charge))];
    let battery_a: [(&str, Reading); 1] = [(told.battery, |reading| reading.battery_a)];
    let motors: [(&str, Reading); 3] = [
        (told.left_wheel, |reading| {
            reading.motors_a.map(|[left, _, _]| left)
        }),
        (told.right_wheel, |reading| {
            reading.motors_a.map(|[_, right, _]| right)
        }),
        (told.main_brush, |reading| {
            reading.motors_a.map(|[_, _, brush]| brush)
        }),
    ];
    let link: [(&str, Reading); 1] = [(told.bad_packets, |reading| Some(100.0 * reading.bad_share))];
    [
        plot(words, (told.plot_charge, &battery, PERCENT), (track, end_s)),
        plot(words, (told.plot_battery, &battery_a, ANY), (track, end_s)),
        plot(words, (told.plot_motors, &motors, ANY), (track, end_s)),
        plot(words, (told.plot_link, &link, PERCENT), (track, end_s)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The values at the edges of a plot from those that it shows: a line that hardly moves is drawn as one, not as its last
/// digits, and no edge is a value that cannot be.
fn edges((low, high): (f64, f64), (least, most): (f64, f64)) -> (f64, f64) {
    let middle = 0.5 * (low + high);
    let half = (0.5 * (high - low)).max(0.5);
    let inwards = (least - (middle - half)).max(0.0) - (middle + half - most).max(0.0);
    (middle - half + inwards, middle + half + inwards)
}

fn plot(
    words: &Words,
    (title, lines, range): (&'static str, &[(&'static str, Reading)], (f64, f64)),
    (track, end_s): (&RunTrack, f64),
) -> Option<Plot> {
    let values = |reading: Reading| {
        let points = track
            .readings
            .iter()
            .filter_map(move |entry| Some((entry.t, reading(entry)?)));
        points.filter(|(t, value)| t.is_finite() && value.is_finite())
    };
    let all = lines
        .iter()
        .flat_map(|(_, reading)| values(*reading))
        .map(|(_, value)| f64::from(value));
    let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return None;
    }
    let (low, high) = edges((low, high), range);
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
        title,
        lines: lines
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
    fn no_edge_is_a_share_that_cannot_be() {
        assert_eq!(super::edges((0.0, 0.0), super::PERCENT), (0.0, 1.0));
        assert_eq!(super::edges((99.75, 100.0), super::PERCENT), (99.0, 100.0));
        assert_eq!(super::edges((0.0, 100.0), super::PERCENT), (0.0, 100.0));
        assert_eq!(super::edges((0.0, 0.0), super::ANY), (-0.5, 0.5));
    }
}
