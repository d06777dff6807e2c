//! A rug that people lay.

use toml::{Table, Value};

use super::draw::Draw;
use super::shape::{Point, contains, points, tables, written};

/// Length and width, metres.
const SIZE_M: (f64, f64) = (1.6, 1.1);
/// Of a rug with a short pile, as in the homes of the project.
const DRAG_N: f64 = 1.2;
const SLIP: f64 = 0.03;
const BIAS_DEG_PER_M: f64 = 0.8;
const ATTEMPTS: u32 = 100;

/// Lays a rug into a room that has space for it.
pub(super) fn lay(plan: &mut Table, draw: &mut Draw) {
    let rooms: Vec<Vec<Point>> = tables(plan, "room").map(|room| points(room, "polygon")).collect();
    for _ in 0..ATTEMPTS {
        let index = draw.below(rooms.len());
        let Some(corners) = rooms.get(index).and_then(|room| place(room, draw)) else {
            continue;
        };
        let mut rug = Table::new();
        rug.insert("polygon".to_owned(), written(&corners));
        rug.insert("drag-n".to_owned(), DRAG_N.into());
        rug.insert("slip".to_owned(), SLIP.into());
        rug.insert("bias-deg-per-m".to_owned(), BIAS_DEG_PER_M.into());
        let rugs = plan.entry("rug").or_insert_with(|| Value::Array(Vec::new()));
        if let Some(rugs) = rugs.as_array_mut() {
            rugs.push(Value::Table(rug));
        }
        return;
    }
}

/// Corners within a room.
fn place(room: &[Point], draw: &mut Draw) -> Option<[Point; 4]> {
    let span = |axis: usize| {
        let along = room.iter().map(|corner| corner[axis]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        (low, along.fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (bottom, top)) = (span(0), span(1));
    let (width_m, height_m) = if draw.is_lucky(0.5) {
        SIZE_M
    } else {
        (SIZE_M.1, SIZE_M.0)
    };
    let (x, y) = (
        draw.between(left, right - width_m),
        draw.between(bottom, top - height_m),
    );
    let corners = [
        [x, y],
        [x + width_m, y],
        [x + width_m, y + height_m],
        [x, y + height_m],
    ];
    corners
        .iter()
        .all(|corner| contains(room, *corner))
        .then_some(corners)
}
