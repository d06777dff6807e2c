//! How a system says in which time zone it is, as systems in homes do: the name must be found, or people are told that it is not.

use std::fs;
use std::io;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use brain::command::StrategyName;
use home::Pcg;
use vthal_core::CoreConfig;
use vthal_core::schedule::Zone;

use super::trial::BoardPassage;
use crate::run::core_config;
use crate::{Host, Scene, TICK_US};

/// What is unusual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZoneFault {
    /// `/etc/localtime` is a copy of a zone's file.
    CopiedFile,
    /// It is a link to a link.
    LinkToLink,
    /// `/etc/timezone` still has the name of before.
    StaleName,
    /// It is a link that leads nowhere.
    DanglingLink,
    /// `TZ` is set, and counts.
    VariableSet,
    /// `TZ` names no zone.
    VariableUnknown,
}

/// Zones that homes are in.
const ZONES: [&str; 5] = [
    "Europe/Tallinn",
    "America/New_York",
    "Asia/Kolkata",
    "Australia/Sydney",
    "Pacific/Auckland",
];
/// What a daemon schedules by that knows no zone.
const NO_ZONE: &str = "UTC";

/// What a system of a home is made of.
struct Drawn {
    home: &'static str,
    other: &'static str,
    random: Pcg,
}

/// What must come of it: the zone that schedules are in, and whether people are told something.
struct Expected {
    zone: &'static str,
    is_told: bool,
    variable: Option<String>,
}

/// The root of a system, which goes with this.
struct SystemRoot(PathBuf);

impl Drop for SystemRoot {
    fn drop(&mut self) {
        // What is left lies among temporary files.
        fs::remove_dir_all(&self.0).ok();
    }
}

impl Drawn {
    fn of(seed: u64) -> Self {
        let mut random = Pcg::new(seed, 0x20_4E);
        let place = (random.unit() * ZONES.len() as f64) as usize % ZONES.len();
        let step = 1 + (random.unit() * (ZONES.len() - 1) as f64) as usize;
        Self {
            home: ZONES[place],
            other: ZONES[(place + step) % ZONES.len()],
            random,
        }
    }

    fn coin(&mut self) -> bool {
        self.random.unit() < 0.5
    }
}

impl SystemRoot {
    fn new(seed: u64) -> io::Result<Self> {
        let root = Self(std::env::temp_dir().join(format!("rvac-zones-{}-{seed}", std::process::id())));
        fs::create_dir_all(root.0.join("etc"))?;
        for name in ZONES {
            let file = root.zone(name);
            fs::create_dir_all(file.parent().unwrap_or(&root.0))?;
            // What is in it does not matter, only that each has its own.
            fs::write(file, format!("the rules of {name}"))?;
        }
        Ok(root)
    }

    fn zone(&self, name: &str) -> PathBuf {
        self.0.join("usr/share/zoneinfo").join(name)
    }

    fn etc(&self, name: &str) -> PathBuf {
        self.0.join("etc").join(name)
    }

    fn link(&self, to: impl AsRef<Path>) -> io::Result<()> {
        symlink(to, self.etc("localtime"))
    }

    fn link_to_zone(&self, name: &str) -> io::Result<()> {
        self.link(format!("../usr/share/zoneinfo/{name}"))
    }

    fn write(&self, name: &str, text: &str) -> io::Result<()> {
        fs::write(self.etc(name), format!("{text}\n"))
    }

    /// Makes the system unusual in this way.
    fn make(&self, fault: ZoneFault, drawn: &mut Drawn) -> io::Result<Expected> {
        let (home, other) = (drawn.home, drawn.other);
        let mut expected = Expected {
            zone: home,
            is_told: false,
            variable: None,
        };
        match fault {
            ZoneFault::CopiedFile => {
                fs::copy(self.zone(home), self.etc("localtime"))?;
                if drawn.coin() {
                    self.write("timezone", if drawn.coin() { home } else { other })?;
                }
            }
            ZoneFault::LinkToLink => {
                symlink(self.zone(home), self.etc("zone-of-the-house"))?;
                self.link(if drawn.coin() {
                    self.etc("zone-of-the-house")
                } else {
                    "zone-of-the-house".into()
                })?;
            }
            ZoneFault::StaleName => {
                self.write("timezone", other)?;
                self.link_to_zone(home)?;
            }
            ZoneFault::DanglingLink => {
                self.write("timezone", home)?;
                if drawn.coin() {
                    self.link_to_zone("Moon/Tranquility")?;
                } else {
                    self.link("nowhere")?;
                }
                (expected.zone, expected.is_told) = (NO_ZONE, true);
            }
            ZoneFault::VariableSet => {
                self.link_to_zone(other)?;
                expected.variable = Some(match (drawn.coin(), drawn.coin()) {
                    (true, _) => format!(":{home}"),
                    (false, true) => format!("{home} "),
                    (false, false) => home.to_owned(),
                });
            }
            ZoneFault::VariableUnknown => {
                self.link_to_zone(home)?;
                expected.variable = Some("Moon/Tranquility".to_owned());
                expected.is_told = true;
            }
        }
        Ok(expected)
    }
}

/// A daemon that starts on such a system.
pub(super) fn passage(scene: &Scene, fault: ZoneFault, seed: u64) -> BoardPassage {
    try_passage(scene, fault, seed).unwrap_or_else(|_| BoardPassage {
        // A system that cannot be made is no proof of anything.
        untold: vec![fault.kind()],
        ..BoardPassage::default()
    })
}

fn try_passage(scene: &Scene, fault: ZoneFault, seed: u64) -> io::Result<BoardPassage> {
    let root = SystemRoot::new(seed)?;
    let expected = root.make(fault, &mut Drawn::of(seed))?;
    // As the daemon does.
    let found = system_zone::find(&root.0, expected.variable, |name| Zone::named(name).is_some());
    let zone = found
        .name
        .as_deref()
        .and_then(Zone::named)
        .unwrap_or_else(Zone::utc);
    let config = core_config(scene, seed, StrategyName::Bounce);
    let mut host = Host::start(
        0,
        CoreConfig {
            zone,
            complaints: found.complaint.into_iter().collect(),
            ..config
        },
    );
    let lines = host.read_log(TICK_US);
    let is_told = lines.iter().any(|entry| entry.text.contains("time zone"));
    let mut passed = BoardPassage::default();
    if expected.is_told && is_told {
        passed.told_s.insert(fault.kind(), 0.0);
    }
    // Schedules in the wrong zone, of which nobody is told, are what this is about.
    if host.schedules().zone != expected.zone || expected.is_told && !is_told {
        passed.untold.push(fault.kind());
    }
    if is_told && !expected.is_told {
        passed.wrong_causes.push(fault.kind());
    }
    Ok(passed)
}

impl ZoneFault {
    pub(super) const ALL: [Self; 6] = [
        Self::CopiedFile,
        Self::LinkToLink,
        Self::StaleName,
        Self::DanglingLink,
        Self::VariableSet,
        Self::VariableUnknown,
    ];

    /// Its kind, for tables.
    pub(super) const fn kind(self) -> &'static str {
        match self {
            Self::CopiedFile => "zone-file-copied",
            Self::LinkToLink => "zone-link-to-link",
            Self::StaleName => "zone-name-stale",
            Self::DanglingLink => "zone-link-dangling",
            Self::VariableSet => "zone-variable-set",
            Self::VariableUnknown => "zone-variable-unknown",
        }
    }
}
