//! Loading a stored home: the occupancy grid, the derived rasters and the rooms.
//!
//! A home has some hundred thousand cells. A small board needs seconds for them, so loading can run in steps beside other work.

use core::task::Poll;

use super::Map;
use crate::mapping::home::HomeMap;
use crate::mapping::{NextNumbers, StoredMap};
use crate::model::config::BrainConfig;
use crate::model::gradual::{Gradual, StepBudget, at_once};

/// Loads a stored home in steps.
#[derive(Debug)]
pub struct MapLoader(Gradual<LoadedHome>);

/// A loaded home, ready for use.
#[derive(Debug)]
pub struct LoadedHome(HomeMap);

impl MapLoader {
    /// Prepares the loading; nothing is done yet.
    #[must_use]
    pub fn new(config: &BrainConfig, stored: StoredMap) -> Self {
        let (body, sensors) = (config.body, config.sensors);
        Self(Gradual::new(async move {
            let blank = HomeMap::new(body, sensors);
            LoadedHome(blank.filled(&stored, &mut StepBudget::short()).await)
        }))
    }

    /// Does the next step. Must not be called again after it returned the home.
    pub fn go_on(&mut self) -> Option<LoadedHome> {
        match self.0.go_on() {
            Poll::Ready(home) => Some(home),
            Poll::Pending => None,
        }
    }
}

impl From<HomeMap> for LoadedHome {
    fn from(home: HomeMap) -> Self {
        Self(home)
    }
}

impl Map {
    /// Replaces the home by a stored one.
    pub fn load(&mut self, stored: &StoredMap) {
        let blank = HomeMap::new(self.home.sensor_model.body, self.home.sensor_model.sensors);
        self.replace_home(LoadedHome(at_once(
            blank.filled(stored, &mut StepBudget::unlimited()),
        )));
    }

    /// What is new from now on gets these numbers or higher ones.
    pub(crate) fn number_after(&mut self, next: NextNumbers) {
        self.home.number_after(next);
    }

    /// Replaces the home by a loaded one.
    pub(crate) fn replace_home(&mut self, ready: LoadedHome) {
        self.redrawing = None;
        self.finalize();
        let before = core::mem::replace(&mut self.home, ready.0);
        self.home.continue_counters(&before);
    }
}
