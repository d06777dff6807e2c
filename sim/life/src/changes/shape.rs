//! Points and polygons of a home TOML.

use toml::{Table, Value};

/// Metres in the frame of the file.
pub(super) type Point = [f64; 2];

/// The tables of a kind.
pub(super) fn tables<'plan>(plan: &'plan Table, kind: &str) -> impl Iterator<Item = &'plan Table> {
    let all = plan.get(kind).and_then(Value::as_array);
    all.into_iter().flatten().filter_map(Value::as_table)
}

/// The points under a key; none without it.
pub(super) fn points(table: &Table, key: &str) -> Vec<Point> {
    let all = table.get(key).and_then(Value::as_array);
    all.into_iter().flatten().filter_map(point).collect()
}

/// A point.
pub(super) fn point(value: &Value) -> Option<Point> {
    let [x, y] = value.as_array()?.as_slice() else {
        return None;
    };
    Some([number(x)?, number(y)?])
}

fn number(value: &Value) -> Option<f64> {
    value
        .as_float()
        .or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// Points as they are written.
pub(super) fn written(points: &[Point]) -> Value {
    let rounded = |metres: f64| Value::Float((1000.0 * metres).round() / 1000.0);
    let point = |[x, y]: &Point| Value::Array(vec![rounded(*x), rounded(*y)]);
    Value::Array(points.iter().map(point).collect())
}

pub(super) fn distance_m([x, y]: Point, [other_x, other_y]: Point) -> f64 {
    (x - other_x).hypot(y - other_y)
}

/// The mean of some points.
pub(super) fn centre(points: &[Point]) -> Point {
    let count = points.len().max(1) as f64;
    let sum = points
        .iter()
        .fold([0.0, 0.0], |[x, y], point| [x + point[0], y + point[1]]);
    [sum[0] / count, sum[1] / count]
}

/// Whether a polygon contains a point: a ray to the right crosses its border an odd number of times.
pub(super) fn contains(polygon: &[Point], [x, y]: Point) -> bool {
    let before = polygon.iter().cycle().skip(polygon.len().saturating_sub(1));
    let crosses = |([from_x, from_y], [to_x, to_y]): &(&Point, &Point)| {
        (*from_y > y) != (*to_y > y) && x < from_x + (y - from_y) / (to_y - from_y) * (to_x - from_x)
    };
    before
        .map(|[x, y]| [*x, *y])
        .zip(polygon)
        .filter(|(from, to)| crosses(&(from, to)))
        .count()
        % 2
        == 1
}

/// Distance to the nearest edge of a polygon.
pub(super) fn edge_m(polygon: &[Point], at: Point) -> f64 {
    let before = polygon.iter().cycle().skip(polygon.len().saturating_sub(1));
    before
        .zip(polygon)
        .map(|(from, to)| segment_m(*from, *to, at))
        .fold(f64::INFINITY, f64::min)
}

fn segment_m(from: Point, to: Point, at: Point) -> f64 {
    let (along, off) = (
        [to[0] - from[0], to[1] - from[1]],
        [at[0] - from[0], at[1] - from[1]],
    );
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 {
        ((along[0] * off[0] + along[1] * off[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    distance_m([share * along[0], share * along[1]], off)
}

#[cfg(test)]
mod tests {
    use super::{Point, contains, edge_m};

    const SQUARE: [Point; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    #[test]
    fn points_lie_in_a_polygon_or_beside_it() {
        for (at, is_in, edge) in [
            ([1.0, 1.0], true, 1.0),
            ([1.9, 0.3], true, 0.1),
            ([2.1, 1.0], false, 0.1),
            ([-0.3, -0.4], false, 0.5),
        ] {
            assert_eq!(contains(&SQUARE, at), is_in, "{at:?}");
            assert!((edge_m(&SQUARE, at) - edge).abs() < 1e-9, "{at:?}");
        }
    }
}
