//! Places where a robot can be put.

use home::{Cell, Home, Pcg, Pose};

/// Free floor around the place where a body is put down, metres.
const ROOM_M: f64 = 0.03;
/// Draws until any place will do.
const DRAWS_MAX: u32 = 100_000;

/// A place of the home where a body of `radius_m` fits, and a direction.
pub(crate) fn draw(home: &Home, radius_m: f64, random: &mut Pcg) -> Pose {
    let reachable: Vec<usize> = (0..home.reachable().len())
        .filter(|index| home.reachable().get(*index).copied().unwrap_or(false))
        .collect();
    for _ in 0..DRAWS_MAX {
        let Some(index) = reachable.get(random.below(reachable.len() as u32) as usize) else {
            break;
        };
        let (x_m, y_m) = home.grid().centre(*index);
        if home.clearance_m(x_m, y_m) > radius_m + ROOM_M && !is_by_a_drop(home, x_m, y_m, radius_m) {
            return Pose::new(x_m, y_m, std::f64::consts::PI * random.symmetric());
        }
    }
    home.start()
}

fn is_by_a_drop(home: &Home, x_m: f64, y_m: f64, radius_m: f64) -> bool {
    (0..16).any(|step| {
        let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 16.0).sin_cos();
        let reach_m = radius_m + ROOM_M;
        let cell = home.grid().index(x_m + reach_m * cos, y_m + reach_m * sin);
        cell.and_then(|index| home.grid().cells.get(index))
            .is_none_or(|cell| !matches!(cell, Cell::Floor | Cell::Rug))
    })
}
