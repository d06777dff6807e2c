//! The time zone of a Linux system, by its name: one rule for the daemon, which schedules by it and follows its changes, and for
//! `rvac doctor`, which says whether it can be told. Which names there are is the caller's knowledge.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod watch;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

pub use watch::{LOOK_EVERY, ZoneWatch};

/// Links that are followed: a link to a link is common, more than these are a circle.
const LINKS_MAX: usize = 8;

/// Where a system says in which zone it is.
#[derive(Debug)]
struct Sources {
    /// The environment's `TZ`.
    variable: Option<String>,
    /// `/etc/localtime`, a link to a zone's file or a copy of one.
    localtime: PathBuf,
    /// `/etc/timezone`, a name, which only Debian's own tools keep true.
    timezone: PathBuf,
    /// The folder of all zones' files.
    zones: PathBuf,
}

/// What a system says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SystemZone {
    /// Name of the zone.
    pub name: Result<String, Unnamed>,
    /// The environment's `TZ`, if it is set and names no zone.
    pub wrong_variable: Option<String>,
}

impl SystemZone {
    /// Without a name: the name that a link has in the place of a zone's.
    #[must_use]
    pub fn tried(&self) -> Option<&str> {
        self.name.as_ref().err().and_then(Unnamed::tried)
    }
}

/// Why a system names no zone.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unnamed {
    /// Nothing says a zone.
    #[error("there is no {}", .0.display())]
    NoFile(PathBuf),
    /// A link leads nowhere.
    #[error("{} is a link to {}, which is not there", .link.display(), .target.display())]
    DanglingLink {
        /// The last one.
        link: PathBuf,
        /// Where it leads, as it is written.
        target: PathBuf,
    },
    /// Links lead to each other.
    #[error("{} is a link in a circle", .0.display())]
    Circle(PathBuf),
    /// The file is none of a zone that is known.
    #[error("{} is the file of no time zone that is known here", .0.display())]
    OfNoZone(PathBuf),
    /// The file cannot be read.
    #[error("{} cannot be read: {reason}", .path.display())]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// Why, by the system.
        reason: String,
    },
}

impl Unnamed {
    /// The name that a link has in the place of a zone's.
    #[must_use]
    pub fn tried(&self) -> Option<&str> {
        match self {
            Self::DanglingLink { target, .. } => named_by(target),
            _ => None,
        }
    }
}

/// The zone of the system below `root`, whose environment has this `TZ`. `is_known` tells whether a name is that of a zone.
pub fn find(root: &Path, variable: Option<String>, is_known: impl Fn(&str) -> bool) -> SystemZone {
    Sources::below(root, variable).zone(&is_known)
}

impl Sources {
    fn below(root: &Path, variable: Option<String>) -> Self {
        Self {
            variable,
            localtime: root.join("etc/localtime"),
            timezone: root.join("etc/timezone"),
            zones: root.join("usr/share/zoneinfo"),
        }
    }

    fn zone(&self, is_known: &dyn Fn(&str) -> bool) -> SystemZone {
        let variable = self.variable.as_deref().and_then(named_by_variable);
        if let Some(name) = variable.filter(|name| is_known(name)) {
            return SystemZone {
                name: Ok(name.to_owned()),
                wrong_variable: None,
            };
        }
        SystemZone {
            name: self.zone_of_files(is_known),
            wrong_variable: variable.map(str::to_owned),
        }
    }

    fn zone_of_files(&self, is_known: &dyn Fn(&str) -> bool) -> Result<String, Unnamed> {
        let written = kept_file::read_text(&self.timezone).ok();
        let written = written.as_deref().map(str::trim);
        let links = self.links();
        if let Some(name) = linked(&links, is_known).or_else(|| self.copied(written, is_known)) {
            return Ok(name);
        }
        // Only now: the name stays behind when somebody changes the link.
        if fs::symlink_metadata(&self.localtime).is_err()
            && let Some(name) = written.filter(|name| is_known(name))
        {
            return Ok(name.to_owned());
        }
        Err(self.obstacle(links))
    }

    /// The links from `/etc/localtime` on, each with where it leads.
    fn links(&self) -> Vec<(PathBuf, PathBuf)> {
        let mut links = Vec::new();
        let mut path = self.localtime.clone();
        while links.len() < LINKS_MAX
            && let Ok(target) = fs::read_link(&path)
        {
            // A target is relative to the folder of its link; an absolute one takes the place of that.
            let next = path.parent().map(|folder| folder.join(&target));
            links.push((path, target));
            match next {
                Some(next) => path = next,
                None => break,
            }
        }
        links
    }

    /// Why there is no name.
    fn obstacle(&self, mut links: Vec<(PathBuf, PathBuf)>) -> Unnamed {
        let path = self.localtime.clone();
        let is_circle = links.len() == LINKS_MAX;
        match kept_file::read(&path) {
            Ok(_) => Unnamed::OfNoZone(path),
            Err(_) if is_circle => Unnamed::Circle(path),
            Err(error) if error.kind() == io::ErrorKind::NotFound => match links.pop() {
                Some((link, target)) => Unnamed::DanglingLink { link, target },
                None => Unnamed::NoFile(path),
            },
            Err(error) => Unnamed::Unreadable {
                path,
                reason: error.to_string(),
            },
        }
    }

    /// The zone whose file `/etc/localtime` is a copy of; `written` first, since several names may share their rules.
    fn copied(&self, written: Option<&str>, is_known: &dyn Fn(&str) -> bool) -> Option<String> {
        let copy = kept_file::read(&self.localtime).ok()?;
        let is_it = |path: &Path| {
            fs::metadata(path).is_ok_and(|about| about.len() == copy.len() as u64)
                && kept_file::read(path).is_ok_and(|bytes| bytes == copy)
        };
        if let Some(name) = written
            && is_it(&self.zones.join(name))
        {
            return is_known(name).then(|| name.to_owned());
        }
        let mut folders = vec![self.zones.clone()];
        let mut names = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
                let path = entry.path();
                match entry.file_type() {
                    Ok(kind) if kind.is_dir() => folders.push(path),
                    Ok(_) if is_it(&path) => {
                        names.extend(path.strip_prefix(&self.zones).ok().map(Path::to_owned))
                    }
                    _ => {}
                }
            }
        }
        names.sort();
        let mut known = names.iter().filter_map(|name| name.to_str());
        known.find(|name| is_known(name)).map(str::to_owned)
    }
}

/// The zone whose file the links lead to. Each link counts by its name, because the file at the end may be that of another name: many
/// zones are links themselves.
fn linked(links: &[(PathBuf, PathBuf)], is_known: &dyn Fn(&str) -> bool) -> Option<String> {
    let mut names = links.iter().filter_map(|(_, target)| named_by(target));
    names.find(|name| is_known(name)).map(str::to_owned)
}

/// The zone that a `TZ` means to name, by its name or by the path of its file; none when it leaves that to the system.
fn named_by_variable(text: &str) -> Option<&str> {
    let name = text.trim().trim_start_matches(':').trim_start();
    let is_system = name.is_empty() || name == "/etc/localtime";
    (!is_system).then(|| named_by(Path::new(name)).unwrap_or(name))
}

/// The zone that the path of a zone's file names.
fn named_by(path: &Path) -> Option<&str> {
    let (_, name) = path.to_str()?.split_once("/zoneinfo/")?;
    Some(name.trim_start_matches("posix/").trim_start_matches("right/"))
}

#[cfg(test)]
mod tests;
