//! What a plan passes.

use brain::coverage::plan::CoveragePlan;
use brain::{CELL_M, Cell, Raster};

use crate::plane::BODY;

/// Share of free cells that the way passes nearer than half a swath.
pub(crate) fn passed(plan: &CoveragePlan, ground: &Raster<bool>) -> f64 {
    let mut near = Raster::filled(ground.origin(), ground.width(), ground.height(), false);
    let reach = (0.5 * BODY.swath_m / CELL_M) as i32;
    for segment in &plan.segments {
        for step in 0..=(segment.length_m / 0.02) as i32 + 1 {
            let share = f64::from(step) / f64::from((segment.length_m / 0.02) as i32 + 1);
            let middle = Cell::under(segment.at(share).position());
            for (dx, dy) in (-reach..=reach).flat_map(|dx| (-reach..=reach).map(move |dy| (dx, dy))) {
                if dx * dx + dy * dy <= reach * reach
                    && let Some(cell) = near.get_mut(Cell {
                        x: middle.x + dx,
                        y: middle.y + dy,
                    })
                {
                    *cell = true;
                }
            }
        }
    }
    let all = ground.values().iter().filter(|free| **free).count();
    let both = near.values().iter().zip(ground.values());
    both.filter(|(near, free)| **near && **free).count() as f64 / all as f64
}
