//! On which floor the robot is, while that is not known.
//!
//! *Chosen*: a person has said which; then only the place on it is looked for. *Asked*: neither the dock nor the way so far
//! tells the floor, so a person should.

use brain::config::BrainConfig;
use brain::{Observation, StoreyFinder, StoreyFinding, StoreyPose};

use crate::floors::Floors;

/// Why a person is asked for the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Question {
    /// Several floors have a dock, and the robot stands on one.
    WhichDock,
    /// No map fits the robot's way, or several do.
    FloorUnknown,
}

impl Question {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::WhichDock => "which-dock",
            Self::FloorUnknown => "floor-unknown",
        }
    }
}

/// The search for the floor.
#[derive(Debug, Default)]
pub(crate) struct Quest {
    pub(crate) chosen: Option<u16>,
    pub(crate) asked: Option<Question>,
    finder: Option<Box<StoreyFinder>>,
}

impl Quest {
    pub(crate) fn for_floor(chosen: u16) -> Self {
        Self {
            chosen: Some(chosen),
            ..Self::default()
        }
    }

    /// Compares what was perceived with the maps of all floors that come into question.
    pub(crate) fn follow(
        &mut self,
        observation: &Observation,
        (floors, config, seed): (&Floors, &BrainConfig, u64),
    ) -> Option<StoreyPose> {
        let chosen = self.chosen;
        let finder = self.finder.get_or_insert_with(|| {
            let homes = floors
                .homes()
                .filter(|(number, _)| chosen.is_none_or(|chosen| chosen == *number));
            Box::new(StoreyFinder::new(config, seed, homes))
        });
        match finder.follow(observation) {
            StoreyFinding::Open => None,
            StoreyFinding::Found(place) => Some(place),
            StoreyFinding::Unclear => {
                self.asked = Some(Question::FloorUnknown);
                None
            }
        }
    }

    /// The floor whose dock this must be; asks a person if it can be several ones'.
    pub(crate) fn by_dock(&mut self, floors: &Floors) -> Option<u16> {
        let known = |number: u16| floors.home(number).is_some();
        if let Some(chosen) = self.chosen.filter(|chosen| known(*chosen)) {
            return Some(chosen);
        }
        let mut all = floors.homes();
        if let (Some((only, _)), None) = (all.next(), all.next()) {
            return Some(only);
        }
        let mut with_dock = floors.homes().filter(|(_, home)| home.dock().is_some());
        match (with_dock.next(), with_dock.next()) {
            (Some((only, _)), None) => Some(only),
            _ => {
                self.asked = Some(Question::WhichDock);
                None
            }
        }
    }
}
