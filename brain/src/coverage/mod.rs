//! Ways to cover a floor. A strategy is a [`Task`]; people choose it by name.

mod astray;
mod bounce;
mod perimeter;
pub mod plan;
pub(crate) mod systematic;
mod wall_bounce;

pub(crate) use bounce::Bounce;
use systematic::Systematic;
use wall_bounce::WallBounce;

use crate::command::StrategyName;
use crate::task::Task;

/// A fresh strategy of this name.
pub(crate) fn strategy(name: StrategyName) -> Box<dyn Task> {
    match name {
        StrategyName::Bounce => Box::new(Bounce::default()),
        StrategyName::Systematic => Box::new(Systematic::default()),
        StrategyName::WallBounce => Box::new(WallBounce::default()),
    }
}
