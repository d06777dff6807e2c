//! The zone while it may be changed: the files that say it are looked at, and read again only when they are others than before.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::{Sources, SystemZone};

/// Pause between two looks. A change counts when it is seen twice, so it is taken up within twice that time.
pub const LOOK_EVERY: Duration = Duration::from_secs(4);

/// Follows the zone of a system.
#[derive(Debug)]
pub struct ZoneWatch {
    sources: Sources,
    is_known: fn(&str) -> bool,
    zone: SystemZone,
    traces: Traces,
    /// A change that was seen once.
    seen: Option<SystemZone>,
}

/// By what a change of the files shows without reading them: finding out of which zone a file is a copy reads all zones.
#[derive(Debug, PartialEq)]
struct Traces {
    links: Vec<(PathBuf, PathBuf)>,
    localtime: Option<Stamp>,
    timezone: Option<Stamp>,
}

/// Another file, or the same one with other contents.
#[derive(Debug, PartialEq)]
struct Stamp {
    device: u64,
    inode: u64,
    bytes: u64,
    changed_s: i64,
    changed_ns: i64,
}

impl Stamp {
    fn of(path: &Path) -> Option<Self> {
        let about = fs::metadata(path).ok()?;
        Some(Self {
            device: about.dev(),
            inode: about.ino(),
            bytes: about.len(),
            changed_s: about.ctime(),
            changed_ns: about.ctime_nsec(),
        })
    }
}

impl Traces {
    fn of(sources: &Sources) -> Self {
        Self {
            links: sources.links(),
            localtime: Stamp::of(&sources.localtime),
            timezone: Stamp::of(&sources.timezone),
        }
    }
}

impl ZoneWatch {
    /// Reads the zone of the system below `root`, whose environment has this `TZ`. `is_known` tells whether a name is that of a zone.
    #[must_use]
    pub fn start(root: &Path, variable: Option<String>, is_known: fn(&str) -> bool) -> Self {
        let sources = Sources::below(root, variable);
        // Before they are read: what changes meanwhile is seen at the next look.
        let traces = Traces::of(&sources);
        let zone = sources.zone(&is_known);
        Self {
            sources,
            is_known,
            zone,
            traces,
            seen: None,
        }
    }

    /// What the system says.
    #[must_use]
    pub const fn zone(&self) -> &SystemZone {
        &self.zone
    }

    /// Looks again; gives what the system says if that has changed. A change counts when it is seen twice: whoever replaces a link
    /// or a file removes it first, and what is there in between is nobody's word.
    pub fn look(&mut self) -> Option<&SystemZone> {
        let traces = Traces::of(&self.sources);
        if traces == self.traces && self.seen.is_none() {
            return None;
        }
        self.traces = traces;
        let zone = self.sources.zone(&self.is_known);
        if zone == self.zone {
            self.seen = None;
            return None;
        }
        if self.seen.as_ref() != Some(&zone) {
            self.seen = Some(zone);
            return None;
        }
        self.seen = None;
        self.zone = zone;
        Some(&self.zone)
    }
}
