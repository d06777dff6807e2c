//! Floor that people have forbidden, and floor around it.

use super::Map;
use crate::mapping::home_floor::forbid;
use crate::mapping::reach::passable;
use crate::mapping::{CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};
use crate::model::no_go::NoGo;

impl Map {
    /// Whether a no-go zone, a virtual wall or one of `avoid` covers a place.
    pub(crate) fn is_forbidden(&self, at: Point2, avoid: &[NoGo]) -> bool {
        let zones = self.home.annotations.no_go.values().chain(avoid);
        zones.map(NoGo::area).any(|area| area.contains(at))
    }

    /// The knowledge with cells to avoid in a job as no-go cells.
    pub(crate) fn knowledge_avoiding(&self, avoid: &[NoGo]) -> Raster<CellKnowledge> {
        let mut knowledge = self.knowledge().clone();
        at_once(forbid(&mut knowledge, avoid.iter(), &mut StepBudget::unlimited()));
        knowledge
    }

    /// Where the centre of a body with `clearance_m` around it may be if nothing were forbidden, and where over allowed floor only.
    pub(crate) fn around_forbidden(&self, clearance_m: f64, avoid: &[NoGo]) -> [Raster<bool>; 2] {
        let allowed = self.knowledge_avoiding(avoid);
        let open = self.home.knowledge_without_no_go();
        let open = open.as_ref().unwrap_or_else(|| self.knowledge());
        [open, &allowed]
            .map(|knowledge| at_once(passable(knowledge, clearance_m, &mut StepBudget::unlimited())))
    }
}
