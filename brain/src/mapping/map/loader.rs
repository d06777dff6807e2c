//! A stored home is taken up: layers, what is derived from them, and rooms.
//!
//! Some hundred thousand cells, which take a small board seconds, so it can be done in steps while something else goes on.

use core::task::Poll;

use super::Map;
use crate::mapping::StoredMap;
use crate::mapping::home::HomeMap;
use crate::model::config::BrainConfig;
use crate::model::gradual::{Gradual, StepBudget, at_once};

/// A stored home that is being taken up.
#[derive(Debug)]
pub struct TakingUp(Gradual<ReadyHome>);

/// A home that can be used.
#[derive(Debug)]
pub struct ReadyHome(HomeMap);

impl TakingUp {
    /// Begins; nothing is done yet.
    #[must_use]
    pub fn new(config: &BrainConfig, stored: StoredMap) -> Self {
        let (body, sensors) = (config.body, config.sensors);
        Self(Gradual::new(async move {
            let blank = HomeMap::new(body, sensors);
            ReadyHome(blank.filled(&stored, &mut StepBudget::limited()).await)
        }))
    }

    /// Does the next step. Not to be called again once the home is there.
    pub fn go_on(&mut self) -> Option<ReadyHome> {
        match self.0.go_on() {
            Poll::Ready(home) => Some(home),
            Poll::Pending => None,
        }
    }
}

impl Map {
    /// Takes up a stored home in place of what is known.
    pub fn take_up(&mut self, stored: &StoredMap) {
        let blank = HomeMap::new(self.home.pencil.body, self.home.pencil.sensors);
        self.put(ReadyHome(at_once(
            blank.filled(stored, &mut StepBudget::unlimited()),
        )));
    }

    /// Puts a home in place of what is known.
    pub(crate) fn put(&mut self, ready: ReadyHome) {
        self.redrawing = None;
        self.settle();
        let before = core::mem::replace(&mut self.home, ready.0);
        self.home.count_on(&before);
    }
}
