//! The time zone of the system, by its name.

use std::fs;
use std::path::{Path, PathBuf};

use vthal_core::schedule::Zone;

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

/// The zone of the system, and what people should know of how it was found.
pub(crate) fn system_zone() -> (Zone, Option<String>) {
    let sources = Sources {
        variable: std::env::var("TZ").ok().filter(|text| !text.is_empty()),
        localtime: PathBuf::from("/etc/localtime"),
        timezone: PathBuf::from("/etc/timezone"),
        zones: PathBuf::from("/usr/share/zoneinfo"),
    };
    sources.zone()
}

impl Sources {
    fn zone(&self) -> (Zone, Option<String>) {
        let mut complaint = None;
        if let Some(variable) = &self.variable {
            match Zone::named(variable.trim().trim_start_matches(':')) {
                Some(zone) => return (zone, None),
                None => complaint = Some(format!("TZ is {variable:?}, which names no time zone")),
            }
        }
        let written = fs::read_to_string(&self.timezone).ok();
        let written = written.as_deref().map(str::trim);
        let found = self.linked().or_else(|| self.copied(written));
        if let Some(zone) = found {
            return (
                zone,
                complaint.map(|text| format!("{text}: schedules follow the system's zone")),
            );
        }
        // Only now: the name stays behind when somebody changes the link.
        if fs::symlink_metadata(&self.localtime).is_err()
            && let Some(zone) = written.and_then(Zone::named)
        {
            return (zone, complaint);
        }
        let localtime = self.localtime.display();
        let unknown = format!(
            "{localtime} does not say in which time zone this computer is, so schedules are in UTC: set it with timedatectl set-timezone, or choose a zone with the schedules"
        );
        let told = complaint.map_or_else(|| unknown.clone(), |text| format!("{text}; {unknown}"));
        (Zone::utc(), Some(told))
    }

    /// The zone whose file the links lead to. Each link counts by its name, because the file at the end may be that of another
    /// name: many zones are links themselves.
    fn linked(&self) -> Option<Zone> {
        let mut path = self.localtime.clone();
        for _ in 0..LINKS_MAX {
            let target = fs::read_link(&path).ok()?;
            // A target is relative to the folder of its link; an absolute one takes the place of that.
            path = path.parent()?.join(target);
            if let Some(zone) = named_by(&path) {
                return Some(zone);
            }
        }
        None
    }

    /// The zone whose file `/etc/localtime` is a copy of; `written` first, since several names may share their rules.
    fn copied(&self, written: Option<&str>) -> Option<Zone> {
        let copy = kept_file::read(&self.localtime).ok()?;
        let is_it = |path: &Path| {
            fs::metadata(path).is_ok_and(|about| about.len() == copy.len() as u64)
                && kept_file::read(path).is_ok_and(|bytes| bytes == copy)
        };
        if let Some(name) = written
            && is_it(&self.zones.join(name))
        {
            return Zone::named(name);
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
        names.iter().find_map(|name| Zone::named(name.to_str()?))
    }
}

/// The zone that the path of a zone's file names.
fn named_by(path: &Path) -> Option<Zone> {
    let (_, name) = path.to_str()?.split_once("/zoneinfo/")?;
    Zone::named(name.trim_start_matches("posix/").trim_start_matches("right/"))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;
    use std::path::Path;

    use vthal_bench::Scratch;

    use super::Sources;

    /// A system with two zones, one of which has two names.
    struct System(Scratch);

    impl System {
        fn new() -> Self {
            let scratch = Scratch::new().expect("creates");
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
            let (zone, complaint) = sources.zone();
            (zone.name().to_owned(), complaint.is_some())
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
