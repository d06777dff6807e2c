//! A stored home is taken up: grid, what is derived from them, and rooms.
//!
//! Some hundred thousand cells, which take a small board seconds, so it can be done in steps while something else goes on.

use core::task::Poll;

use super::Map;
use crate::mapping::StoredMap;
use crate::mapping::home::HomeMap;
use crate::model::config::BrainConfig;
use crate::model::gradual::{Gradual, Pace, at_once};

/// A stored home that is being taken up.
#[derive(Debug)]
pub struct MapLoader(Gradual<LoadedHome>);

/// A home that can be used.
#[derive(Debug)]
pub struct LoadedHome(HomeMap);

impl MapLoader {
    /// Begins; nothing is done yet.
    #[must_use]
    pub fn new(config: &BrainConfig, stored: StoredMap) -> Self {
        let (body, sensors) = (config.body, config.sensors);
        Self(Gradual::new(async move {
            let blank = HomeMap::new(body, sensors);
            LoadedHome(blank.filled(&stored, &mut Pace::in_steps()).await)
        }))
    }

    /// Does the next step. Not to be called again once the home is there.
    pub fn go_on(&mut self) -> Option<LoadedHome> {
        match self.0.go_on() {
            Poll::Ready(home) => Some(home),
            Poll::Pending => None,
        }
    }
}

impl Map {
    /// Takes up a stored home in place of what is known.
    pub fn load(&mut self, stored: &StoredMap) {
        let blank = HomeMap::new(self.home.sensor_model.body, self.home.sensor_model.sensors);
        self.replace_home(LoadedHome(at_once(blank.filled(stored, &mut Pace::at_once()))));
    }

    /// Puts a home in place of what is known.
    pub(crate) fn replace_home(&mut self, ready: LoadedHome) {
        self.redrawing = None;
        self.settle();
        let before = core::mem::replace(&mut self.home, ready.0);
        self.home.count_on(&before);
    }
}
