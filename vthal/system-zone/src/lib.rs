//! The time zone of a Linux system, by its name: one rule for the daemon, which schedules by it, and for `rvac doctor`, which says
//! whether it can be told. Which names there are is the caller's knowledge.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};

/// Links that are followed: a link to a link is common, more than these are a circle.
const LINKS_MAX: usize = 8;

/// Where a system says in which zone it is.
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
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SystemZone {
    /// Name of the zone; none when it cannot be told.
    pub name: Option<String>,
    /// What people should know of how it was found, or why it was not.
    pub complaint: Option<String>,
}

/// The zone of the system below `root`, whose environment has this `TZ`. `is_known` tells whether a name is that of a zone.
pub fn find(root: &Path, variable: Option<String>, is_known: impl Fn(&str) -> bool) -> SystemZone {
    let sources = Sources {
        variable: variable.filter(|text| !text.is_empty()),
        localtime: root.join("etc/localtime"),
        timezone: root.join("etc/timezone"),
        zones: root.join("usr/share/zoneinfo"),
    };
    sources.zone(&is_known)
}

impl Sources {
    fn zone(&self, is_known: &dyn Fn(&str) -> bool) -> SystemZone {
        let mut complaint = None;
        if let Some(variable) = &self.variable {
            let name = variable.trim().trim_start_matches(':');
            if is_known(name) {
                return SystemZone {
                    name: Some(name.to_owned()),
                    complaint: None,
                };
            }
            complaint = Some(format!("TZ is {variable:?}, which names no time zone"));
        }
        let written = kept_file::read_text(&self.timezone).ok();
        let written = written.as_deref().map(str::trim);
        let found = self.linked(is_known).or_else(|| self.copied(written, is_known));
        if found.is_some() {
            return SystemZone {
                name: found,
                complaint: complaint.map(|text| format!("{text}: schedules follow the system's zone")),
            };
        }
        // Only now: the name stays behind when somebody changes the link.
        if fs::symlink_metadata(&self.localtime).is_err()
            && let Some(name) = written.filter(|name| is_known(name))
        {
            return SystemZone {
                name: Some(name.to_owned()),
                complaint,
            };
        }
        let localtime = self.localtime.display();
        let unknown = format!(
            "{localtime} does not say in which time zone this computer is, so schedules are in UTC: set it with timedatectl set-timezone, or choose a zone with the schedules"
        );
        let told = complaint.map_or_else(|| unknown.clone(), |text| format!("{text}; {unknown}"));
        SystemZone {
            name: None,
            complaint: Some(told),
        }
    }

    /// The zone whose file the links lead to. Each link counts by its name, because the file at the end may be that of another
    /// name: many zones are links themselves.
    fn linked(&self, is_known: &dyn Fn(&str) -> bool) -> Option<String> {
        let mut path = self.localtime.clone();
        for _ in 0..LINKS_MAX {
            let target = fs::read_link(&path).ok()?;
            // A target is relative to the folder of its link; an absolute one takes the place of that.
            path = path.parent()?.join(target);
            if let Some(name) = named_by(&path).filter(|name| is_known(name)) {
                return Some(name.to_owned());
            }
        }
        None
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

/// The zone that the path of a zone's file names.
fn named_by(path: &Path) -> Option<&str> {
    let (_, name) = path.to_str()?.split_once("/zoneinfo/")?;
    Some(name.trim_start_matches("posix/").trim_start_matches("right/"))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;
    use std::path::{Path, PathBuf};
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::Sources;

    /// A system with two zones, one of which has two names.
    struct System(PathBuf);

    impl Drop for System {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.0).ok();
        }
    }

    impl System {
        fn new() -> Self {
            static SYSTEMS: AtomicU32 = AtomicU32::new(0);
            let number = SYSTEMS.fetch_add(1, Ordering::Relaxed);
            let scratch = std::env::temp_dir().join(format!("rvac-zone-{}-{number}", std::process::id()));
            let zones = scratch.join("usr/zoneinfo/Europe");
            fs::create_dir_all(&zones).expect("creates");
            fs::create_dir_all(scratch.join("etc")).expect("creates");
            for (name, rules) in [("Tallinn", "east"), ("London", "west"), ("Belfast", "west")] {
                fs::write(zones.join(name), rules).expect("writes");
            }
            Self(scratch)
        }

        fn etc(&self, name: &str) -> std::path::PathBuf {
            self.0.join("etc").join(name)
        }

        fn link(&self, to: impl AsRef<Path>) {
            symlink(to, self.etc("localtime")).expect("links");
        }

        fn write(&self, name: &str, text: &str) {
            fs::write(self.etc(name), text).expect("writes");
        }

        /// Name of the zone, and whether something is said of it.
        fn zone(&self, variable: Option<&str>) -> (String, bool) {
            let sources = Sources {
                variable: variable.map(str::to_owned),
                localtime: self.etc("localtime"),
                timezone: self.etc("timezone"),
                zones: self.0.join("usr/zoneinfo"),
            };
            let is_known = |name: &str| ["Europe/Tallinn", "Europe/London", "Europe/Belfast"].contains(&name);
            let found = sources.zone(&is_known);
            (
                found.name.unwrap_or_else(|| "UTC".to_owned()),
                found.complaint.is_some(),
            )
        }
    }

    fn quietly(name: &str) -> (String, bool) {
        (name.to_owned(), false)
    }

    #[test]
    fn the_link_counts_and_a_name_that_stayed_behind_does_not() {
        let system = System::new();
        system.write("timezone", "Europe/London\n");
        assert_eq!(system.zone(None), quietly("Europe/London"), "there is no link");
        system.link("../usr/zoneinfo/posix/Europe/Tallinn");
        assert_eq!(system.zone(None), quietly("Europe/Tallinn"));
    }

    #[test]
    fn links_are_followed_and_copies_are_found_by_what_they_hold() {
        let system = System::new();
        symlink(
            system.0.join("usr/zoneinfo/Europe/Tallinn"),
            system.etc("zone-of-the-house"),
        )
        .expect("links");
        system.link("zone-of-the-house");
        assert_eq!(system.zone(None), quietly("Europe/Tallinn"));
        fs::remove_file(system.etc("localtime")).expect("removes");
        system.write("localtime", "west");
        system.write("timezone", "Europe/Tallinn");
        assert_eq!(
            system.zone(None),
            quietly("Europe/Belfast"),
            "the first of two that are alike"
        );
        system.write("timezone", "Europe/London");
        assert_eq!(system.zone(None), quietly("Europe/London"));
    }

    #[test]
    fn what_names_no_zone_is_said() {
        let system = System::new();
        let utc = || ("UTC".to_owned(), true);
        assert_eq!(system.zone(None), utc());
        system.link("nowhere");
        system.write("timezone", "Europe/London");
        assert_eq!(system.zone(None), utc(), "a link that leads nowhere");
        assert_eq!(system.zone(Some(":Europe/Tallinn")), quietly("Europe/Tallinn"));
        assert_eq!(system.zone(Some("Moon")), utc());
        fs::remove_file(system.etc("localtime")).expect("removes");
        system.write("localtime", "west");
        assert_eq!(system.zone(Some("Moon")), ("Europe/London".to_owned(), true));
    }
}
