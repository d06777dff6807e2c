//! What is made ready in steps before a brain can begin with it: the home of the next run, and the home of a floor.
//!
//! A home takes a small board seconds to save and to load. Meanwhile the present brain goes on; whatever is
//! commanded waits for the next one, in its order.

use brain::config::BrainConfig;
use brain::{Brain, CheckpointWork, LoadedHome, MapLoader, MapTrial, MapWriter, StoredMap};

use super::BrainSession;
use crate::{FloorHome, RunCause};

/// A run that is about to begin.
#[derive(Debug)]
pub(super) struct NextRun {
    pub(super) cause: RunCause,
    /// A person's stick was in the centre since the order, so it may drive (S23).
    pub(super) stick_was_centred: bool,
    stage: Stage,
}

#[derive(Debug)]
enum Stage {
    WritingDown(Box<CheckpointWork>),
    Loading {
        written: Box<StoredMap>,
        home: MapLoader,
    },
}

/// A home for the next brain: as it is recorded, and as it is used.
pub(super) struct NextHome {
    pub(super) written: StoredMap,
    pub(super) ready: LoadedHome,
}

impl NextRun {
    /// A run with the map of `brain`.
    pub(super) fn after(brain: &Brain, cause: RunCause) -> Self {
        Self {
            cause,
            stick_was_centred: false,
            stage: Stage::WritingDown(Box::new(brain.begin_checkpoint())),
        }
    }

    /// Does the next step.
    pub(super) fn go_on(&mut self, config: &BrainConfig) -> Option<NextHome> {
        match &mut self.stage {
            Stage::WritingDown(work) => {
                let written = work.go_on()?.home.unwrap_or_default();
                self.stage = Stage::Loading {
                    home: MapLoader::new(config, written.clone()),
                    written: Box::new(written),
                };
                None
            }
            Stage::Loading { written, home } => Some(NextHome {
                ready: home.go_on()?,
                written: core::mem::take(&mut **written),
            }),
        }
    }
}

/// A home that is being written down for the disk.
#[derive(Debug)]
pub(super) struct LeavingHome {
    floor: u16,
    home: MapWriter,
    trial: Option<MapTrial>,
}

impl LeavingHome {
    /// The home of `brain` as it is now, on this floor.
    pub(super) fn of(brain: &Brain, floor: u16) -> Self {
        Self {
            floor,
            home: brain.map().begin_storing(),
            trial: brain.map_trial(),
        }
    }

    /// Does the next step. Must not be called again after it returned the home.
    pub(super) fn go_on(&mut self) -> Option<FloorHome> {
        let home = self.home.go_on()?;
        Some(FloorHome {
            floor: self.floor,
            home,
            trial: self.trial,
        })
    }
}

impl BrainSession {
    /// Begins to write down the home as it is worth keeping; [`Self::prepare`] goes on. Nothing begins while the floor is unknown or
    /// the robot is lost.
    pub(crate) fn begin_keeping_home(&mut self) {
        let floor = self.floor.filter(|_| !self.brain.estimate().lost);
        self.leaving_home = floor.map(|floor| LeavingHome::of(&self.brain, floor));
    }

    /// The home as it is worth keeping, with its floor, at once: for a robot at rest. It replaces what is being written down. `None`
    /// while the floor is unknown or the robot is lost.
    pub(crate) fn home_to_keep(&mut self) -> Option<FloorHome> {
        self.leaving_home = None;
        let floor = self.floor.filter(|_| !self.brain.estimate().lost)?;
        let home = self.brain.map().stored();
        (!home.is_empty()).then_some(FloorHome {
            floor,
            home,
            trial: None,
        })
    }

    /// As [`Self::home_to_keep`], with what the run has shown of the map with which it began.
    pub(crate) fn home_left(&mut self) -> Option<FloorHome> {
        let trial = self.brain.map_trial();
        let home = self.home_to_keep()?;
        Some(self.with_trial_once(FloorHome { trial, ..home }))
    }

    /// A run's trial is of the map before it, so it must not be told again with the map that it has left.
    pub(super) fn with_trial_once(&mut self, home: FloorHome) -> FloorHome {
        let trial = home.trial.filter(|_| !self.is_trial_told);
        self.is_trial_told |= trial.is_some();
        FloorHome { trial, ..home }
    }
}

/// The home of a floor that is being loaded.
#[derive(Debug)]
pub(super) struct LoadingFloor {
    number: u16,
    home: MapLoader,
    ready: Option<LoadedHome>,
}

impl LoadingFloor {
    /// Goes on with the home of floor `number`, or begins with it; work on another floor's home is dropped.
    pub(super) fn for_floor(
        loading_floor: Option<Self>,
        (number, stored): (u16, &StoredMap),
        config: &BrainConfig,
    ) -> Self {
        loading_floor
            .filter(|floor| floor.number == number)
            .unwrap_or_else(|| Self {
                number,
                home: MapLoader::new(config, stored.clone()),
                ready: None,
            })
    }

    /// Does the next step, if one is left.
    pub(super) fn go_on(&mut self) {
        if self.ready.is_none() {
            self.ready = self.home.go_on();
        }
    }

    /// The home, once it is ready.
    pub(super) fn take(&mut self) -> Option<LoadedHome> {
        self.ready.take()
    }
}
