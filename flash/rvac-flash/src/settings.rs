//! How the Linux board is wired to the robot: a TOML file.

use std::path::{Path, PathBuf};

use serde::Deserialize;

/// A robot whose firmware can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RobotName {
    /// Samsung Navibot SR8730.
    Sr8730,
    /// Vileda Relax.
    Relax,
}

impl RobotName {
    /// As the robot's firmware names itself.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sr8730 => "sr8730",
            Self::Relax => "relax",
        }
    }
}

/// The wiring.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlashSettings {
    /// Which robot.
    pub robot: RobotName,
    /// Serial device of the robot, as in the daemon's configuration.
    pub serial: PathBuf,
    /// Folder of backups, images and the journal.
    #[serde(default = "usual_folder")]
    pub folder: PathBuf,
    /// Lines to the programming port of the SR8730.
    pub icsp: Option<IcspLines>,
    /// The power switch of the Relax's adapter.
    pub power: Option<PowerLine>,
}

/// Lines to the programming port.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IcspLines {
    /// GPIO chip, for example `/dev/gpiochip0`.
    pub chip: PathBuf,
    /// Line to MCLR.
    pub reset: u32,
    /// Line to PGC2.
    pub clock: u32,
    /// Line to PGD2.
    pub data: u32,
    /// Fastest clock, hertz.
    #[serde(default = "usual_clock")]
    pub clock_hz: u32,
}

/// A line that switches the robot's main board on while it is active.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PowerLine {
    /// GPIO chip.
    pub chip: PathBuf,
    /// Line.
    pub line: u32,
    /// Whether low switches on.
    #[serde(default)]
    pub active_low: bool,
}

fn usual_folder() -> PathBuf {
    PathBuf::from("/var/lib/rvac/flash")
}

const fn usual_clock() -> u32 {
    250_000
}

/// Why there is no wiring.
#[derive(Debug, thiserror::Error)]
pub enum SettingsError {
    /// The file cannot be read.
    #[error("cannot read {}: {error}. It says how the board is wired; the book's page \"Flashing\" shows one", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// It is not what it should be.
    #[error("{}: {error}", .path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Why.
        error: String,
    },
    /// The clock is too fast or zero.
    #[error("{}: icsp.clock_hz must be 1000 to 5000000", .0.display())]
    Clock(PathBuf),
}

impl FlashSettings {
    /// Reads the file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(path: &Path) -> Result<Self, SettingsError> {
        let text = kept_file::read_text(path).map_err(|error| SettingsError::Unreadable {
            path: path.to_owned(),
            error,
        })?;
        let settings: Self = toml::from_str(&text).map_err(|error| SettingsError::Invalid {
            path: path.to_owned(),
            error: error.to_string(),
        })?;
        let clock_hz = settings.icsp.as_ref().map_or(usual_clock(), |icsp| icsp.clock_hz);
        match clock_hz {
            1_000..=5_000_000 => Ok(settings),
            _ => Err(SettingsError::Clock(path.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{FlashSettings, RobotName};

    #[test]
    fn the_book_s_examples_are_understood() {
        let page = include_str!("../../../docs/book/src/flashing.md");
        let examples: Vec<&str> = page
            .split("```toml\n")
            .skip(1)
            .filter_map(|rest| rest.split("```").next())
            .collect();
        let robots: Vec<RobotName> = examples
            .iter()
            .map(|text| toml::from_str::<FlashSettings>(text).expect("an example").robot)
            .collect();
        assert_eq!(robots, [RobotName::Sr8730, RobotName::Relax]);
    }

    #[test]
    fn a_key_that_is_unknown_is_refused() {
        let text = "robot = \"sr8730\"\nserial = \"/dev/ttyS0\"\nfolde = \"x\"\n";
        assert!(toml::from_str::<FlashSettings>(text).is_err());
    }
}
