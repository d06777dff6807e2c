//! How a system says in which time zone it is, as systems in homes do: the name must be found, or people are told that it is not.

use std::fs;
use std::io;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use brain::command::StrategyName;
use home::Pcg;
use system_zone::{LOOK_EVERY, SystemZone, ZoneWatch};
use vthal_core::Input;
use vthal_core::schedule::{Zone, ZoneReading};

use super::fault::{BoardFault, BoardFaults};
use super::trial::{BoardPassage, WALL_S};
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
    /// Another zone is set while the daemon runs.
    ChangedWhileRunning,
    /// While the daemon runs the zone becomes one that cannot be told.
    LostWhileRunning,
}

/// A change is taken up within this time, milliseconds.
const CHANGE_MS: u64 = 10_000;

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

/// What must come of it.
struct Expected {
    /// The zone that schedules are in.
    zone: &'static str,
    /// A zone that people are asked whether they mean it.
    meant: Option<&'static str>,
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

    /// The zone of the home with a letter left out, as hands do, and that zone; or a name like none.
    fn misspelt(&mut self) -> (String, Option<&'static str>) {
        if self.coin() {
            return ("Moon/Tranquility".to_owned(), None);
        }
        let mut name = self.home.to_owned();
        let letters = name.find('/').map_or(0, |slash| slash + 1)..name.len() - 1;
        let place = letters.start + (self.random.unit() * letters.len() as f64) as usize;
        name.remove(place);
        (name, Some(self.home))
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
            meant: None,
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
                expected.meant = self.link_to_nothing(drawn)?;
                expected.zone = NO_ZONE;
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
                let (name, meant) = drawn.misspelt();
                (expected.variable, expected.meant) = (Some(name), meant);
            }
            ZoneFault::ChangedWhileRunning | ZoneFault::LostWhileRunning => self.link_to_zone(home)?,
        }
        Ok(expected)
    }

    /// Makes `/etc/localtime` a link that leads nowhere; gives the zone that is meant by it.
    fn link_to_nothing(&self, drawn: &mut Drawn) -> io::Result<Option<&'static str>> {
        if drawn.coin() {
            self.link("nowhere")?;
            return Ok(None);
        }
        let (name, meant) = drawn.misspelt();
        self.link_to_zone(&name)?;
        Ok(meant)
    }

    /// Changes the system of a daemon that runs.
    fn change(&self, fault: ZoneFault, drawn: &mut Drawn, expected: &mut Expected) -> io::Result<()> {
        fs::remove_file(self.etc("localtime"))?;
        let other = drawn.other;
        match (fault, drawn.coin(), drawn.coin()) {
            (ZoneFault::ChangedWhileRunning, true, _) => self.link_to_zone(other)?,
            (ZoneFault::ChangedWhileRunning, false, true) => {
                fs::copy(self.zone(other), self.etc("localtime"))?;
            }
            (ZoneFault::ChangedWhileRunning, false, false) => self.write("timezone", other)?,
            (ZoneFault::LostWhileRunning, true, _) => expected.meant = self.link_to_nothing(drawn)?,
            (ZoneFault::LostWhileRunning, false, true) => self.write("localtime", "of no zone")?,
            _ => {}
        }
        if fault == ZoneFault::ChangedWhileRunning {
            expected.zone = other;
        }
        Ok(())
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
    let mut drawn = Drawn::of(seed);
    let mut expected = root.make(fault, &mut drawn)?;
    let variable = expected.variable.clone();
    let mut watch = ZoneWatch::start(&root.0, variable, |name| Zone::named(name).is_some());
    let mut host = Host::start(0, core_config(scene, seed, StrategyName::Bounce));
    host.handle(0, Input::SystemZone(reading(watch.zone())));
    host.set_wall(0, WALL_S);
    let mut now_us = TICK_US;
    host.step(now_us, &[]);
    if fault.is_change() {
        root.change(fault, &mut drawn, &mut expected)?;
        let look_ms = u64::try_from(LOOK_EVERY.as_millis()).unwrap_or(CHANGE_MS);
        for ms in 1..=CHANGE_MS {
            now_us += TICK_US;
            if ms.is_multiple_of(look_ms)
                && let Some(zone) = watch.look()
            {
                host.handle(now_us, Input::SystemZone(reading(zone)));
            }
            host.step(now_us, &[]);
        }
    }
    Ok(judge((fault, &expected), &mut host, now_us))
}

/// As the daemon does.
fn reading(zone: &SystemZone) -> ZoneReading {
    ZoneReading::new(&zone.name, zone.tried(), zone.wrong_variable.as_deref())
}

/// What a client hears who comes now: the zone that schedules are in, and the reasons in the log.
fn judge((fault, expected): (ZoneFault, &Expected), host: &mut Host, now_us: u64) -> BoardPassage {
    let lines = host.read_log(now_us);
    let (of_board, faults) = (BoardFault::Zone(fault), BoardFaults::of(BoardFault::Zone(fault)));
    let asks = |text: &str| {
        let question = expected.meant.map(|meant| format!("did you mean {meant}?"));
        question.is_none_or(|question| text.contains(&question))
    };
    let told = lines
        .iter()
        .find(|line| of_board.is_told_in(&line.text) && asks(&line.text));
    let mut passed = BoardPassage::default();
    if let Some(line) = told {
        passed.told_s.insert(fault.kind(), line.t);
    }
    let must_be_told = !fault.told_as().is_empty();
    let zone = host.read_schedules(now_us).map(|schedules| schedules.zone);
    // Schedules in the wrong zone, of which nobody is told, are what this is about.
    if zone.as_deref() != Some(expected.zone) || must_be_told && told.is_none() {
        passed.untold.push(fault.kind());
    }
    passed.wrong_causes = lines
        .iter()
        .flat_map(|line| faults.wrong_causes(&line.text))
        .collect();
    passed
}

impl ZoneFault {
    pub(super) const ALL: [Self; 8] = [
        Self::CopiedFile,
        Self::LinkToLink,
        Self::StaleName,
        Self::DanglingLink,
        Self::VariableSet,
        Self::VariableUnknown,
        Self::ChangedWhileRunning,
        Self::LostWhileRunning,
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
            Self::ChangedWhileRunning => "zone-changed-while-running",
            Self::LostWhileRunning => "zone-lost-while-running",
        }
    }

    /// Names of which one must be told; none for what works as any other system.
    pub(super) const fn told_as(self) -> &'static [&'static str] {
        match self {
            Self::CopiedFile | Self::LinkToLink | Self::StaleName | Self::VariableSet => &[],
            Self::DanglingLink | Self::LostWhileRunning => &["zone-unknown"],
            Self::VariableUnknown => &["zone-variable-unknown"],
            Self::ChangedWhileRunning => &["zone-changed"],
        }
    }

    /// Whether it comes while the daemon runs.
    const fn is_change(self) -> bool {
        matches!(self, Self::ChangedWhileRunning | Self::LostWhileRunning)
    }
}
