//! The points of a line's curve, as a person drags them: what comes in to the right, what it becomes upwards, both -1..=1.

use mixer::{POINTS_MAX, curved};

/// Points are nearer to each other than this at no time, so that the curve stays one.
const APART_MIN: f64 = 0.02;
/// Points are kept to so many parts of 1.
const PARTS: f64 = 100.0;
/// A curve begins with points at these places.
const FIRST_AT: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];

/// The points of a curve; none where the line is straight.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurvePoints(Vec<[f64; 2]>);

impl CurvePoints {
    /// Those of a line.
    #[must_use]
    pub fn of(points: &[[f64; 2]]) -> Self {
        Self(points.to_vec())
    }

    /// The points of a curve that changes nothing, to be dragged.
    #[must_use]
    pub fn straight() -> Self {
        Self(FIRST_AT.map(|at| [at, at]).to_vec())
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// As the field of the form has them.
    #[must_use]
    pub fn text(&self) -> String {
        let points: Vec<String> = self.0.iter().map(|[at, value]| format!("{at} {value}")).collect();
        points.join(", ")
    }

    /// With one of them here: between its neighbours, and at the ends on the edge.
    #[must_use]
    pub fn with_point_at(&self, place: usize, [at, value]: [f64; 2]) -> Self {
        let mut points = self.0.clone();
        let before = place.checked_sub(1).and_then(|before| points.get(before));
        let low = before.map_or(-1.0, |[at, _]| at + APART_MIN);
        let high = points.get(place + 1).map_or(1.0, |[at, _]| at - APART_MIN);
        let is_inner = place > 0 && place + 1 < points.len();
        if let Some(point) = points.get_mut(place)
            && low <= high
            && at.is_finite()
            && value.is_finite()
        {
            if is_inner {
                point[0] = rounded(at.clamp(low, high));
            }
            point[1] = rounded(value.clamp(-1.0, 1.0));
        }
        Self(points)
    }

    /// With one more in the middle of the widest gap, on the curve; the same where no more fit.
    #[must_use]
    pub fn with_one_more(&self) -> Self {
        let gaps = self.0.windows(2).enumerate();
        let widest = gaps
            .filter_map(|(place, pair)| match pair {
                [[from, _], [to, _]] => Some((place, *from, *to)),
                _ => None,
            })
            .max_by(|(_, from, to), (_, other_from, other_to)| {
                (to - from).total_cmp(&(other_to - other_from))
            });
        let Some((place, from, to)) = widest.filter(|_| self.0.len() < POINTS_MAX) else {
            return self.clone();
        };
        let at = rounded((from + to) / 2.0);
        let mut points = self.0.clone();
        points.insert(place + 1, [at, rounded(curved(at, &self.0))]);
        Self(points)
    }

    /// Without one of them; the ends stay, and without a point between them the curve is none.
    #[must_use]
    pub fn without(&self, place: usize) -> Self {
        let mut points = self.0.clone();
        if place > 0 && place + 1 < points.len() {
            points.remove(place);
        }
        Self(points)
    }
}

/// Without a zero that has a sign.
fn rounded(value: f64) -> f64 {
    (value * PARTS).round() / PARTS + 0.0
}

#[cfg(test)]
mod tests {
    use super::CurvePoints;

    #[test]
    fn a_point_stays_between_its_neighbours_and_the_ends_on_the_edge() {
        let curve = CurvePoints::straight();
        let dragged = curve.with_point_at(1, [0.9, -2.0]);
        assert_eq!(dragged.points()[1], [-0.02, -1.0]);
        let end = curve.with_point_at(4, [0.3, 0.25]);
        assert_eq!(end.points()[4], [1.0, 0.25]);
        assert_eq!(curve.with_point_at(9, [0.0, 0.0]), curve);
        assert_eq!(curve.with_point_at(2, [f64::NAN, 0.0]), curve);
    }

    #[test]
    fn points_are_added_on_the_curve_and_taken_away() {
        let curve = CurvePoints::of(&[[-1.0, -1.0], [0.5, 0.2], [1.0, 1.0]]);
        let more = curve.with_one_more();
        assert_eq!(more.points().len(), 4);
        let [at, value] = more.points()[1];
        assert!(
            (at + 0.25).abs() < 1e-9 && (-1.0..0.2).contains(&value),
            "{at} {value}"
        );
        assert_eq!(more.without(1), curve);
        assert_eq!(curve.without(0), curve, "the ends stay");
        let mut full = CurvePoints::straight();
        for _ in 0..40 {
            full = full.with_one_more();
        }
        assert_eq!(full.points().len(), mixer::POINTS_MAX);
        assert_eq!(
            CurvePoints::straight().text(),
            "-1 -1, -0.5 -0.5, 0 0, 0.5 0.5, 1 1"
        );
    }
}
