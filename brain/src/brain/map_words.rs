//! Says when the map of the home is doubted, and tells no share of it from then on.

use super::Brain;
use crate::model::decision::DecisionKind;
use crate::model::map_doubt::MapDoubt;
use crate::model::map_trial::MapTrial;
use crate::model::reason::Reason;

impl Brain {
    /// Why the map of the home is doubted; `None` = it is not.
    #[must_use]
    pub fn map_doubt(&self) -> Option<MapDoubt> {
        self.map_doubt
    }

    /// What this run has shown of the map with which it began; `None` = too little, or there was none.
    #[must_use]
    pub fn map_trial(&self) -> Option<MapTrial> {
        match self.map_doubt {
            Some(_) => Some(MapTrial::Doubted),
            None => self.localization.map_held().then_some(MapTrial::Held),
        }
    }

    /// Notes the first doubt of this run. What made it doubt is not forgotten when other parts of the map turn out to be right.
    pub(super) fn doubt_map(&mut self) {
        if self.map_doubt.is_some() {
            return;
        }
        if let Some((doubt, share)) = self.localization.map_doubt() {
            self.map_doubt = Some(doubt);
            self.mind
                .decide(DecisionKind::DoubtMap, Reason::Map(doubt), share);
        }
    }

    /// The share of a doubted map's floor that was covered is no share of the home.
    pub(super) fn tell_no_share(&mut self) {
        if self.map_doubt.is_none() {
            return;
        }
        for decision in &mut self.mind.journal {
            if decision.kind == DecisionKind::Covered {
                (decision.kind, decision.value) = (DecisionKind::CoveredByMap, 0.0);
            }
        }
    }
}
