//! What is made ready in steps before a brain can begin with it: the home of the next run, and the home of a floor.
//!
//! A home takes a small board seconds to save and to load. Meanwhile the present brain goes on; whatever is
//! commanded waits for the next one, in its order.

use brain::config::BrainConfig;
use brain::{Brain, CheckpointWork, LoadedHome, MapLoader, MapWriter, StoredMap};

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
}

impl LeavingHome {
    /// The home of `brain` as it is now, on this floor.
    pub(super) fn of(brain: &Brain, floor: u16) -> Self {
        Self {
            floor,
            home: brain.map().begin_storing(),
        }
    }

    /// Does the next step. Must not be called again after it returned the home.
    pub(super) fn go_on(&mut self) -> Option<FloorHome> {
        let home = self.home.go_on()?;
        Some(FloorHome {
            floor: self.floor,
            home,
        })
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
