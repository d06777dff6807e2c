//! What a line makes of its input, as a picture: readings to the right, values upwards.

use mixer::{Profile, Source, response};

use crate::words::Words;

/// Pieces of the line that is drawn.
const PIECES: u16 = 128;

/// The curve of a line from its input to what it gives, without delay and slow.
///
/// The picture has its middle at 0, readings -1..=1 across, and values upwards, `reach` of them from the middle to either edge.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineCurve {
    /// Reading and value.
    points: Vec<[f64; 2]>,
    reach: f64,
}

impl LineCurve {
    /// The curve of a line; none for a line whose input has nothing between off and on, and for one with which something is
    /// wrong.
    #[must_use]
    pub fn of(profile: &Profile, output: usize, line: usize) -> Option<Self> {
        profile.check().ok()?;
        let line = profile.outputs.get(output)?.lines.get(line)?;
        let low = lowest(&line.input)?;
        let point = |piece: u16| {
            let reading = low + (1.0 - low) * f64::from(piece) / f64::from(PIECES);
            [reading, response(profile, line, reading)]
        };
        let points: Vec<[f64; 2]> = (0..=PIECES).map(point).collect();
        let highest = points.iter().map(|[_, value]| value.abs()).fold(1.0, f64::max);
        // In halves, so that the picture does not breathe while a number is changed.
        let reach = (2.0 * highest).ceil() / 2.0;
        Some(Self { points, reach })
    }

    /// The value at the edges of the picture.
    #[must_use]
    pub const fn reach(&self) -> f64 {
        self.reach
    }

    /// The curve as `points` of an SVG polyline.
    #[must_use]
    pub fn polyline(&self) -> String {
        let places: Vec<String> = self.points.iter().map(|point| self.place(*point)).collect();
        places.join(" ")
    }

    /// Where the picture has a reading: its place across, and upside down that of its value, both -1..=1.
    #[must_use]
    pub fn dot(&self, reading: f64) -> Option<[f64; 2]> {
        let value = self.at(reading)?;
        Some([reading.clamp(-1.0, 1.0), -value / self.reach])
    }

    /// Some values, for those who do not see the picture.
    #[must_use]
    pub fn text(&self, words: &Words) -> String {
        let percent = |share: f64| words.unit.percent.fill([&words.number(whole_percent(share), 0)]);
        let pair = |reading: f64| {
            let value = self.at(reading)?;
            Some(words.mix.curve_gives.fill([&percent(reading), &percent(value)]))
        };
        let pairs: Vec<String> = [-1.0, -0.5, 0.0, 0.5, 1.0].into_iter().filter_map(pair).collect();
        words.mix.curve_told.fill([&pairs.join(", ")])
    }

    /// The value for a reading, if the input has it.
    fn at(&self, reading: f64) -> Option<f64> {
        let [first, last] = [*self.points.first()?, *self.points.last()?];
        if reading < first[0] - f64::EPSILON {
            return None;
        }
        let is_piece = |pair: &&[[f64; 2]]| matches!(pair, [_, [to, _]] if reading <= *to);
        let Some([[from, low], [to, high]]) = self.points.windows(2).find(is_piece) else {
            return Some(last[1]);
        };
        let share = ((reading - from) / (to - from)).clamp(0.0, 1.0);
        Some(low + share * (high - low))
    }

    fn place(&self, [reading, value]: [f64; 2]) -> String {
        format!("{reading:.4},{:.4}", -value / self.reach)
    }
}

/// The lower end of an input that has values in between.
const fn lowest(input: &Source) -> Option<f64> {
    match input {
        Source::PadAxis { .. }
        | Source::TouchRight
        | Source::TouchUp
        | Source::TiltForward
        | Source::TiltLeft
        | Source::Client(_) => Some(-1.0),
        Source::PadButton { .. } => Some(0.0),
        Source::Always | Source::Key(_) | Source::Switch(_) => None,
    }
}

/// Without a zero that has a sign.
fn whole_percent(share: f64) -> f64 {
    (100.0 * share).round() + 0.0
}

#[cfg(test)]
mod tests {
    use mixer::{Calibration, KeyCode, Line, Name, Output, OutputName, Profile, Source, VERSION};

    use super::LineCurve;
    use crate::words::Language;

    const AXIS: Source = Source::PadAxis { pad: 0, axis: 1 };

    fn profile(change: impl FnOnce(&mut Line)) -> Profile {
        let mut line = Line::new(Name::new("ahead").unwrap(), AXIS);
        change(&mut line);
        let mut output = Output::new(OutputName::Forward);
        output.lines = vec![line];
        Profile {
            version: VERSION,
            name: Name::new("mine").unwrap(),
            inputs: vec![Calibration::new(AXIS, 0.2)],
            switches: Vec::new(),
            trims: Vec::new(),
            modes: Vec::new(),
            outputs: vec![output],
        }
    }

    fn curve(change: impl FnOnce(&mut Line)) -> Option<LineCurve> {
        LineCurve::of(&profile(change), 0, 0)
    }

    fn close([one, other]: [[f64; 2]; 2]) -> bool {
        one.iter()
            .zip(other)
            .all(|(one, other)| (one - other).abs() < 1e-3)
    }

    #[test]
    fn dead_band_weight_and_offset_are_in_it() {
        let made = curve(|line| {
            line.invert = true;
            line.weight = 0.5;
            line.offset = 0.25;
        })
        .unwrap();
        let dots = [-1.0, -0.1, 0.1, 0.6, 1.0].map(|reading| made.dot(reading).unwrap());
        // Upside down: 0.75 at the lower end, 0.25 in the dead band, 0 halfway to the upper end, and -0.25 there.
        let wanted = [
            [-1.0, -0.75],
            [-0.1, -0.25],
            [0.1, -0.25],
            [0.6, 0.0],
            [1.0, 0.25],
        ];
        for pair in dots.into_iter().zip(wanted) {
            assert!(close(pair.into()), "{pair:?}");
        }
        let line = made.polyline();
        assert!(
            line.starts_with("-1.0000,-0.7500 ") && line.ends_with(" 1.0000,0.2500"),
            "{line}"
        );
    }

    #[test]
    fn it_is_shown_in_words() {
        let made = curve(|line| line.expo = 1.0).unwrap();
        let told = made.text(Language::English.words());
        // (0.5 - 0.2) / 0.8 = 0.375, and 0.375³ = 0.053.
        for part in [
            "-100 % gives -100 %",
            "-50 % gives -5 %",
            "0 % gives 0 %",
            "50 % gives 5 %",
        ] {
            assert!(
                told.replace('\u{a0}', " ")
                    .replace('\u{2212}', "-")
                    .contains(part),
                "{told}"
            );
        }
    }

    #[test]
    fn what_is_beyond_all_is_seen_in_the_picture() {
        let made = curve(|line| {
            line.weight = 2.0;
            line.offset = 0.7;
        })
        .unwrap();
        assert!((made.reach() - 3.0).abs() < 1e-9);
        assert!(close([made.dot(1.0).unwrap(), [1.0, -0.9]]));
    }

    #[test]
    fn a_line_without_values_in_between_has_none() {
        let pressed = Source::PadButton { pad: 0, button: 6 };
        let trigger = curve(|line| line.input = pressed).unwrap();
        assert_eq!(trigger.dot(-0.5), None, "a button is never pulled");
        for input in [Source::Always, Source::Key(KeyCode::new("KeyW").unwrap())] {
            assert_eq!(curve(|line| line.input = input), None);
        }
        assert_eq!(
            curve(|line| line.weight = 7.0),
            None,
            "what is wrong is told at its field"
        );
        assert_eq!(LineCurve::of(&profile(|_| ()), 0, 1), None);
    }
}
