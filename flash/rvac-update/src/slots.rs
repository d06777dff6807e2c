//! The two folders of programs, and the link that says which is in use.

use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::disk::Disk;

/// One of two folders that updates fill in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Slot {
    /// One.
    A,
    /// The other.
    B,
}

impl Slot {
    const fn name(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
        }
    }
}

/// Which programs are started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Programs {
    /// Those of the installed package.
    Package,
    /// Those of an update.
    Update(Slot),
}

impl Programs {
    /// The folder that an update may fill while these run.
    #[must_use]
    pub const fn spare(self) -> Slot {
        match self {
            Self::Package | Self::Update(Slot::B) => Slot::A,
            Self::Update(Slot::A) => Slot::B,
        }
    }
}

/// The folder of updates.
#[derive(Clone, Debug)]
pub struct Slots {
    root: PathBuf,
}

impl Slots {
    /// The folder of updates at this place.
    #[must_use]
    pub fn at(root: &Path) -> Self {
        Self {
            root: root.to_owned(),
        }
    }

    /// The folder itself.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The folder of a slot.
    #[must_use]
    pub fn folder(&self, slot: Slot) -> PathBuf {
        self.root.join(slot.name())
    }

    fn link(&self) -> PathBuf {
        self.root.join("current")
    }

    /// What is started now. A link that leads elsewhere counts as none, as it does for the script that starts programs.
    #[must_use]
    pub fn current(&self) -> Programs {
        let target = std::fs::read_link(self.link()).ok();
        [Slot::A, Slot::B]
            .into_iter()
            .find(|slot| target.as_deref() == Some(Path::new(slot.name())))
            .map_or(Programs::Package, Programs::Update)
    }

    /// Lets these be started from now on.
    pub(crate) fn choose(&self, disk: &mut impl Disk, programs: Programs) -> io::Result<()> {
        match programs {
            Programs::Package => disk.remove(&self.link()),
            Programs::Update(slot) => disk.point(&self.link(), Path::new(slot.name())),
        }
    }
}
