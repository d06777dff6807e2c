//! Who may know whom: the table of ARCHITECTURE.md as data.

use super::Finding;
use super::files::Files;
use crate::metadata::{Packages, WORKSPACES, packages, reach};

/// A crate of ours, the crates of ours it may depend on directly, and foreign crates it may not even reach.
struct Direction {
    of: &'static str,
    knows: &'static [&'static str],
    never: &'static [&'static str],
}

/// What would bring a clock, randomness, threads or I/O into a core.
const OUTSIDE: &[&str] = &[
    "tokio",
    "mio",
    "rand",
    "getrandom",
    "axum",
    "mcap",
    "serial2-tokio",
    "tracing-subscriber",
    "rustix",
];
/// The same for crates that run on a microcontroller, where there is no standard library either.
const STD: &[&str] = &[
    "tokio",
    "mio",
    "rand",
    "getrandom",
    "serde_json",
    "serde",
    "thiserror",
    "anyhow",
    "tracing",
];
/// The brain does not know how it is spoken to.
const BRAIN: &[&str] = &[
    "tokio",
    "mio",
    "getrandom",
    "serde",
    "serde_json",
    "axum",
    "mcap",
    "tracing",
];

/// The emulator judges a firmware, so it may not share its code.
const EMULATOR: &[&str] = &[
    "cordlib",
    "tokio",
    "mio",
    "rand",
    "getrandom",
    "tracing-subscriber",
    "rustix",
];

const WIRE: &[&str] = &["rvac-protocol", "rvac-units"];
/// A firmware joins the main loop to its chip.
const FIRMWARE: &[&str] = &[
    "cordlib",
    "pic32mx3-hal",
    "rvac-protocol",
    "rvac-units",
    "soft-uart",
];
const SIMULATED: &[&str] = &[
    "rvac-sim",
    "robot",
    "monitor",
    "pic32",
    "stc90",
    "home",
    "cordlib",
    "vthal-core",
    "brain",
    "mixer",
    "rvac-api",
    "rvac-channel",
    "rvac-protocol",
    "rvac-units",
    "system-zone",
];
/// Whole systems in the simulator, and what came of them as numbers.
const SCENARIOS: &[&str] = &[
    "content-hash",
    "rvac-sim",
    "robot",
    "monitor",
    "home",
    "vthal-core",
    "brain",
    "rvac-api",
];

// One crate a line, so that it reads as the table it is.
#[rustfmt::skip]
const DIRECTIONS: [Direction; 54] = [
    Direction { of: "rvac-units",    knows: &[],                                            never: STD },
    Direction { of: "rvac-protocol", knows: &["rvac-units"],                                never: STD },
    Direction { of: "rvac-channel",  knows: WIRE,                                           never: &["tokio"] },
    Direction { of: "cordlib",       knows: WIRE,                                           never: STD },
    Direction { of: "pic32mx3-hal",  knows: &[],                                            never: STD },
    Direction { of: "sr8730",        knows: FIRMWARE,                                       never: STD },
    Direction { of: "cordlib-c",     knows: &["cordlib", "rvac-protocol", "rvac-units"],    never: &["tokio"] },
    Direction { of: "cord-c",        knows: &["rvac-protocol", "rvac-units"],               never: &["tokio"] },
    Direction { of: "soft-uart",     knows: &[],                                            never: STD },
    Direction { of: "brain",         knows: &["rvac-units"],                                never: BRAIN },
    Direction { of: "rvac-api",      knows: &["rvac-units"],                                never: OUTSIDE },
    Direction { of: "mixer",         knows: &["rvac-api"],                                  never: OUTSIDE },
    Direction { of: "vthal-core",    knows: &["rvac-units", "rvac-protocol", "brain", "rvac-api"], never: OUTSIDE },
    Direction { of: "vthal",         knows: &["calibration", "calibration-values", "vthal-core", "rvac-units", "rvac-protocol", "brain", "rvac-api", "mixer", "kept-file", "robot-link", "system-zone", "systemd-notice", "vthal-bench", "content-hash"], never: &[] },
    Direction { of: "vthal-bench",   knows: &["brain", "mixer", "pairing", "rvac-api", "rvac-protocol", "rvac-units", "vthal-core"], never: &["tokio"] },
    Direction { of: "kept-file",     knows: &[],                                            never: &["tokio"] },
    Direction { of: "system-zone",   knows: &["kept-file"],                                 never: &[] },
    Direction { of: "robot-link",    knows: &["rvac-protocol", "rvac-units"],               never: OUTSIDE },
    Direction { of: "systemd-notice", knows: &[],                                           never: &[] },
    Direction { of: "bridge",        knows: &["kept-file", "rvac-api", "systemd-notice"],   never: &["axum"] },
    Direction { of: "dialect",       knows: &["bridge", "rvac-api"],                        never: &["axum"] },
    Direction { of: "rvac-dialect",  knows: &["bridge", "dialect", "rvac-api"],             never: &[] },
    Direction { of: "rvac-mqtt",     knows: &["bridge", "dialect", "rvac-api"],             never: &["axum"] },
    Direction { of: "rvac-metrics",  knows: &["bridge", "rvac-api"],                        never: &[] },
    Direction { of: "rvac-hooks",    knows: &["bridge", "rvac-api"],                        never: &[] },
    Direction { of: "rvac-foxglove", knows: &["bridge", "rvac-api"],                        never: &["axum"] },
    Direction { of: "rvac-matter",   knows: &["bridge", "kept-file", "rvac-api"],           never: &["axum"] },
    Direction { of: "rvac-ros2",     knows: &["bridge", "rvac-api"],                        never: &["axum"] },
    Direction { of: "joined-trials", knows: &["rvac-api"],                                  never: &["tokio"] },
    Direction { of: "pairing",       knows: &["rvac-api"],                                  never: OUTSIDE },
    Direction { of: "calibration-values", knows: &["kept-file", "rvac-protocol"],           never: &["tokio"] },
    Direction { of: "calibration",   knows: &["calibration-values", "rvac-protocol", "rvac-units"], never: &["tokio"] },
    Direction { of: "rvac-cli",      knows: &["calibration", "calibration-values", "kept-file", "mixer", "pairing", "rvac-api", "robot-link", "rvac-flash", "rvac-protocol", "rvac-units", "rvac-update", "system-zone", "update-bundle"], never: &[] },
    Direction { of: "panel-server",  knows: &["kept-file", "pairing", "rvac-api", "system-zone", "systemd-notice", "update-bundle"], never: &[] },
    Direction { of: "panel-bench",   knows: &["brain", "pairing", "rvac-api", "rvac-protocol", "vthal-bench", "vthal-core"], never: &["tokio"] },
    Direction { of: "panel",         knows: &["mixer", "pairing", "panel-logic", "rvac-api"], never: &["tokio"] },
    Direction { of: "panel-logic",   knows: &["mixer", "rvac-api"],                         never: &["tokio", "leptos", "web-sys"] },
    Direction { of: "home",          knows: &["rvac-units"],                                never: OUTSIDE },
    Direction { of: "monitor",       knows: &["rvac-protocol"],                             never: OUTSIDE },
    Direction { of: "pic32",         knows: &["home", "monitor", "rvac-channel", "rvac-protocol", "rvac-units"], never: EMULATOR },
    Direction { of: "stc90",         knows: &["home", "monitor", "rvac-channel", "rvac-protocol", "rvac-units"], never: EMULATOR },
    Direction { of: "pic32-icsp",    knows: &[],                                            never: OUTSIDE },
    Direction { of: "stc-isp",       knows: &[],                                            never: OUTSIDE },
    Direction { of: "rvac-flash",    knows: &["calibration-values", "kept-file", "pic32-icsp", "rvac-api", "stc-isp"], never: &["tokio"] },
    Direction { of: "update-bundle", knows: &[],                                            never: &["tokio", "minisign"] },
    Direction { of: "rvac-update",   knows: &["rvac-api", "rvac-flash", "update-bundle"],   never: &["tokio", "minisign"] },
    Direction { of: "flash-trials",  knows: &["calibration-values", "home", "pic32", "pic32-icsp", "rvac-flash", "rvac-update", "stc-isp", "stc90", "update-bundle"], never: &["tokio", "cordlib"] },
    Direction { of: "robot",         knows: &["cordlib", "home", "monitor", "rvac-channel", "rvac-protocol", "rvac-units"], never: OUTSIDE },
    Direction { of: "rvac-sim",      knows: SIMULATED,                                      never: &["vthal", "axum", "tokio"] },
    Direction { of: "trials",        knows: &["home", "monitor", "pic32", "robot-link", "rvac-channel", "rvac-protocol", "rvac-units", "stc90"], never: EMULATOR },
    Direction { of: "life",          knows: &["brain", "home", "robot", "rvac-sim", "vthal", "vthal-core"], never: &["axum"] },
    Direction { of: "content-hash",  knows: &["brain"],                                     never: OUTSIDE },
    Direction { of: "scenarios",     knows: SCENARIOS,                                      never: &["vthal", "axum", "tokio"] },
    Direction { of: "xtask",         knows: &["calibration-values", "rvac-api", "update-bundle"], never: &["tokio"] },
];

/// Most crates in what runs on a robot, ours included: the library for every board, and a board with its chip.
const CRATES_MAX: [(&str, usize); 2] = [("cordlib", 10), ("sr8730", 16)];

/// Compares the table with what cargo resolves.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let mut found = Vec::new();
    for workspace in WORKSPACES
        .iter()
        .take(4)
        .filter(|workspace| files.has(workspace.manifest))
    {
        found.extend(judge(&packages(workspace)?));
    }
    found.sort();
    found.dedup();
    Ok(Finding::Checked(found))
}

fn judge(packages: &Packages) -> Vec<String> {
    let mut found = Vec::new();
    for package in packages.values().filter(|package| package.ours) {
        let Some(direction) = DIRECTIONS.iter().find(|direction| direction.of == package.name) else {
            found.push(format!(
                "{}: not in the table of xtask/src/tidy/directions.rs; say whom it may know",
                package.name
            ));
            continue;
        };
        for way in reach(packages, &package.name) {
            let is_ours = |name: &str| packages.values().any(|other| other.ours && other.name == name);
            if let Some(reason) = direction.forbids(&way, is_ours) {
                found.push(format!("{}: {reason}", way.join(" -> ")));
            }
        }
        let reached = reach(packages, &package.name).len() + 1;
        for (name, most) in CRATES_MAX {
            if package.name == name && reached > most {
                found.push(format!(
                    "{name}: {reached} crates in the firmware, {most} at most"
                ));
            }
        }
    }
    found
}

impl Direction {
    fn forbids(&self, way: &[String], is_ours: impl Fn(&str) -> bool) -> Option<String> {
        let last = way.last()?;
        if way.len() == 2 && is_ours(last) && !self.knows.contains(&last.as_str()) {
            return Some(format!("{} may know only: {}", self.of, self.knows.join(", ")));
        }
        self.never
            .contains(&last.as_str())
            .then(|| format!("{} may never reach {last}", self.of))
    }
}

#[cfg(test)]
mod tests {
    use super::judge;
    use crate::metadata::{Package, Packages};

    fn package(name: &str, needs: &[&str]) -> (String, Package) {
        let ours = name != "tokio" && name != "middle";
        let needs = needs.iter().map(ToString::to_string).collect();
        (
            name.to_owned(),
            Package {
                name: name.to_owned(),
                ours,
                needs,
                ..Package::default()
            },
        )
    }

    #[test]
    fn the_offending_path_is_named() {
        let packages: Packages = [
            package("brain", &["middle", "vthal"]),
            package("middle", &["tokio"]),
            package("tokio", &[]),
            package("vthal", &[]),
        ]
        .into();
        let found = judge(&packages).join("\n");
        assert!(
            found.contains("brain -> middle -> tokio: brain may never reach tokio"),
            "{found}"
        );
        assert!(
            found.contains("brain -> vthal: brain may know only: rvac-units"),
            "{found}"
        );
    }

    #[test]
    fn a_crate_without_a_row_is_refused() {
        let found = judge(&[package("stranger", &[])].into());
        assert!(
            found
                .iter()
                .any(|place| place.starts_with("stranger: not in the table")),
            "{found:?}"
        );
    }
}
