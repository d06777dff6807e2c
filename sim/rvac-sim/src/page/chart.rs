//! Curves over time.

use std::fmt::Write;

/// One curve.
pub(super) struct Curve<'a> {
    pub(super) colour: &'a str,
    pub(super) dashed: bool,
    pub(super) points: Vec<(f64, f64)>,
}

/// Axes and curves; both axes begin with 0.
pub(super) struct Chart<'a> {
    pub(super) x_max: f64,
    pub(super) y_max: f64,
    pub(super) curves: &'a [Curve<'a>],
}

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 320.0;
const LEFT: f64 = 46.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = 24.0;
/// About so many lines of the grid.
const LINES: f64 = 6.0;

impl Chart<'_> {
    pub(super) fn svg(&self) -> String {
        let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\">");
        self.grid(&mut svg);
        for curve in self.curves {
            let points: Vec<String> = self
                .thinned(curve)
                .iter()
                .map(|(x, y)| format!("{x:.1},{y:.1}"))
                .collect();
            let dash = if curve.dashed {
                " stroke-dasharray=\"6 5\""
            } else {
                ""
            };
            // Writing into a string cannot fail, here and below.
            write!(
                svg,
                "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"{dash} points=\"{}\"/>",
                curve.colour,
                points.join(" ")
            )
            .ok();
        }
        svg.push_str("</svg>");
        svg
    }

    fn x(&self, value: f64) -> f64 {
        LEFT + value.min(self.x_max) / self.x_max * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, value: f64) -> f64 {
        HEIGHT - BOTTOM - value.min(self.y_max) / self.y_max * (HEIGHT - TOP - BOTTOM)
    }

    /// Points of the paper, without those that lie within the width of a line.
    fn thinned(&self, curve: &Curve<'_>) -> Vec<(f64, f64)> {
        let mut kept: Vec<(f64, f64)> = Vec::new();
        let count = curve.points.len();
        for (number, (x, y)) in curve.points.iter().enumerate() {
            let point = (self.x(*x), self.y(*y));
            let far = kept
                .last()
                .is_none_or(|last| (last.0 - point.0).hypot(last.1 - point.1) > 1.0);
            if far || number + 1 == count {
                kept.push(point);
            }
        }
        kept
    }

    fn grid(&self, svg: &mut String) {
        let (right, floor) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        for value in ticks(self.y_max) {
            let y = self.y(value);
            let label = label(value, self.y_max);
            write!(
                svg,
                "<path stroke=\"#e3e6e8\" d=\"M{LEFT} {y:.1}H{right}\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                LEFT - 6.0,
                y + 4.0
            )
            .ok();
        }
        for value in ticks(self.x_max) {
            let x = self.x(value);
            let label = label(value, self.x_max);
            write!(
                svg,
                "<path stroke=\"#e3e6e8\" d=\"M{x:.1} {TOP}V{floor}\"/><text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
                floor + 16.0
            )
            .ok();
        }
    }
}

/// Round numbers from 0 to the end of an axis.
fn ticks(max: f64) -> Vec<f64> {
    let rough = max / LINES;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= rough)
        .unwrap_or(10.0 * power);
    let count = (max / step + 1e-9) as usize;
    (0..=count).map(|number| number as f64 * step).collect()
}

fn label(value: f64, max: f64) -> String {
    if max >= LINES {
        format!("{value:.0}")
    } else if max >= 0.1 * LINES {
        format!("{value:.1}")
    } else {
        format!("{value:.2}")
    }
}

#[cfg(test)]
mod tests {
    use super::ticks;

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(ticks(100.0), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        for max in [0.13, 0.9, 2.0, 7.3, 61.0, 400.0] {
            let found = ticks(max);
            assert!((3..=8).contains(&found.len()), "{max}: {found:?}");
        }
    }
}
