//! Coverage strategies. A strategy is a [`Task`]; people choose it by name.

mod bounce;
mod escape_bounce;
mod estimate;
mod order_reach;
mod parameters;
mod perimeter;
pub mod plan;
mod recent_coverage;
mod spiral;
mod spot;
mod statistical;
pub(crate) mod systematic;
mod target_floor;
mod wall_bounce;
mod whole_turns;

pub(crate) use bounce::Bounce;
pub use estimate::JobEstimate;
pub(crate) use estimate::{EstimateBasis, JobConditions};
pub use order_reach::OrderRefusal;
pub(crate) use order_reach::{ReachQuestion, is_off_order, left_most};
pub(crate) use perimeter::{LapStep, Perimeter};
pub(crate) use spot::Spot;
pub(crate) use statistical::Statistical;
use systematic::Systematic;
use wall_bounce::WallBounce;

use crate::model::command::StrategyName;
use crate::model::order::CleaningOrder;
use crate::navigation::Task;

/// A new strategy of this name. Only `systematic` can clean parts of a home; the others clean all of it.
pub(crate) fn strategy(name: StrategyName, order: &CleaningOrder) -> Box<dyn Task> {
    match name {
        StrategyName::Bounce => Box::new(Bounce::default()),
        StrategyName::Statistical => Box::new(Statistical::default()),
        StrategyName::Systematic => Box::new(Systematic::with(order.clone())),
        StrategyName::WallBounce => Box::new(WallBounce::default()),
    }
}
