//! What a system says of its zone, and how its changes are seen.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::{Unnamed, ZoneWatch, find};

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
        let zones = scratch.join("usr/share/zoneinfo/Europe");
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

    fn remove(&self, name: &str) {
        fs::remove_file(self.etc(name)).expect("removes");
    }

    /// Name of the zone, or what its absence is called; and a `TZ` that names none.
    fn zone(&self, variable: Option<&str>) -> (String, Option<String>) {
        let found = find(&self.0, variable.map(str::to_owned), is_known);
        let name = found.name.unwrap_or_else(|why| self.said(&why));
        (name, found.wrong_variable)
    }

    /// The sentence without the scratch folder.
    fn said(&self, why: &Unnamed) -> String {
        why.to_string().replace(&format!("{}/", self.0.display()), "/")
    }
}

fn is_known(name: &str) -> bool {
    ["Europe/Tallinn", "Europe/London", "Europe/Belfast"].contains(&name)
}

fn quietly(name: &str) -> (String, Option<String>) {
    (name.to_owned(), None)
}

#[test]
fn the_link_counts_and_a_name_that_stayed_behind_does_not() {
    let system = System::new();
    system.write("timezone", "Europe/London\n");
    assert_eq!(system.zone(None), quietly("Europe/London"), "there is no link");
    system.link("../usr/share/zoneinfo/posix/Europe/Tallinn");
    assert_eq!(system.zone(None), quietly("Europe/Tallinn"));
}

#[test]
fn links_are_followed_and_copies_are_found_by_what_they_hold() {
    let system = System::new();
    symlink(
        system.0.join("usr/share/zoneinfo/Europe/Tallinn"),
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
fn a_system_that_names_no_zone_says_why() {
    let system = System::new();
    assert_eq!(system.zone(None), quietly("there is no /etc/localtime"));
    // A name that stayed behind is no zone of a link that leads nowhere.
    system.write("timezone", "Europe/London");
    system.link("../usr/share/zoneinfo/Europe/Tallin");
    let dangling = "/etc/localtime is a link to ../usr/share/zoneinfo/Europe/Tallin, which is not there";
    assert_eq!(system.zone(None), quietly(dangling));
    let why = find(&system.0, None, is_known).name.expect_err("no zone");
    assert_eq!(why.tried(), Some("Europe/Tallin"));
    system.remove("localtime");
    system.link("localtime");
    assert_eq!(system.zone(None), quietly("/etc/localtime is a link in a circle"));
    system.remove("localtime");
    system.write("localtime", "of the moon");
    let of_no_zone = "/etc/localtime is the file of no time zone that is known here";
    assert_eq!(system.zone(None), quietly(of_no_zone));
    system.remove("localtime");
    fs::create_dir(system.etc("localtime")).expect("creates");
    let no_file = "/etc/localtime cannot be read: it is no plain file";
    assert_eq!(system.zone(None), quietly(no_file));
}

#[test]
fn the_variable_counts_if_it_names_a_zone_and_is_told_if_not() {
    let system = System::new();
    system.link("../usr/share/zoneinfo/Europe/London");
    for text in [
        "Europe/Tallinn",
        ":Europe/Tallinn",
        " Europe/Tallinn \n",
        "/usr/share/zoneinfo/Europe/Tallinn",
    ] {
        assert_eq!(system.zone(Some(text)), quietly("Europe/Tallinn"), "{text:?}");
    }
    for text in ["", " ", ":", ":/etc/localtime"] {
        assert_eq!(system.zone(Some(text)), quietly("Europe/London"), "{text:?}");
    }
    for (text, told) in [("Moon", "Moon"), (":Europe/Tallin ", "Europe/Tallin")] {
        let expected = ("Europe/London".to_owned(), Some(told.to_owned()));
        assert_eq!(system.zone(Some(text)), expected);
    }
}

/// What the second look sees; the first one gives nothing.
fn look_twice(watch: &mut ZoneWatch) -> Option<String> {
    assert_eq!(watch.look(), None);
    let found = watch.look()?;
    Some(found.name.clone().unwrap_or_else(|_| "unnamed".to_owned()))
}

#[test]
fn a_change_is_seen_whichever_way_it_is_made() {
    let system = System::new();
    system.link("../usr/share/zoneinfo/Europe/Tallinn");
    let mut watch = ZoneWatch::start(&system.0, None, is_known);
    assert_eq!(watch.zone().name.as_deref(), Ok("Europe/Tallinn"));
    assert_eq!(look_twice(&mut watch), None);
    // As timedatectl does: a new link takes the place of the old one.
    symlink("../usr/share/zoneinfo/Europe/London", system.etc("new")).expect("links");
    fs::rename(system.etc("new"), system.etc("localtime")).expect("renames");
    assert_eq!(look_twice(&mut watch).as_deref(), Some("Europe/London"));
    assert_eq!(look_twice(&mut watch), None, "told once");
    // A copy.
    system.remove("localtime");
    system.write("localtime", "east");
    assert_eq!(look_twice(&mut watch).as_deref(), Some("Europe/Tallinn"));
    // Other contents in the same file, of the same length.
    system.write("localtime", "west");
    system.write("timezone", "Europe/London");
    assert_eq!(look_twice(&mut watch).as_deref(), Some("Europe/London"));
    // Only the name.
    system.remove("localtime");
    system.write("timezone", "Europe/Tallinn");
    assert_eq!(look_twice(&mut watch).as_deref(), Some("Europe/Tallinn"));
    system.remove("timezone");
    assert_eq!(look_twice(&mut watch).as_deref(), Some("unnamed"));
}

#[test]
fn what_is_there_only_while_a_link_is_replaced_is_no_change() {
    let system = System::new();
    system.link("../usr/share/zoneinfo/Europe/Tallinn");
    system.write("timezone", "Europe/Belfast");
    let mut watch = ZoneWatch::start(&system.0, None, is_known);
    system.remove("localtime");
    assert_eq!(watch.look(), None, "for a moment the old name would count");
    system.link("../usr/share/zoneinfo/Europe/London");
    assert_eq!(look_twice(&mut watch).as_deref(), Some("Europe/London"));
    system.remove("localtime");
    assert_eq!(watch.look(), None);
    system.link("../usr/share/zoneinfo/Europe/London");
    assert_eq!(look_twice(&mut watch), None, "it is what it was");
}

#[test]
fn a_variable_that_names_a_zone_stands_above_the_files() {
    let system = System::new();
    system.link("../usr/share/zoneinfo/Europe/Tallinn");
    let mut watch = ZoneWatch::start(&system.0, Some("Europe/Belfast".to_owned()), is_known);
    system.remove("localtime");
    system.link("../usr/share/zoneinfo/Europe/London");
    assert_eq!(look_twice(&mut watch), None);
    assert_eq!(watch.zone().name.as_deref(), Ok("Europe/Belfast"));
}
