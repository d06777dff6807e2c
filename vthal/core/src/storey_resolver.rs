//! Finds out on which floor the robot is, while that is unknown.
//!
//! *Chosen*: a person has chosen the floor; then only the position on it is searched. *Asked*: neither the dock nor the path so far
//! determines the floor, so a person is asked.

use brain::config::BrainConfig;
use brain::{Observation, StoreyFinder, StoreyFinding, StoreyPose};

use crate::floors::Floors;

/// Why a person is asked for the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Question {
    /// Several floors have a dock, and the robot is on one of them.
    WhichDock,
    /// No map fits the robot's path, or several do.
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
pub(crate) struct StoreyResolver {
    pub(crate) chosen: Option<u16>,
    pub(crate) asked: Option<Question>,
    finder: Option<Box<StoreyFinder>>,
}

impl StoreyResolver {
    pub(crate) fn for_floor(chosen: u16) -> Self {
        Self {
            chosen: Some(chosen),
            ..Self::default()
        }
    }

    /// Compares the observation with the maps of all candidate floors.
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

    /// The floor whose dock this must be; asks a person if several have one.
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
