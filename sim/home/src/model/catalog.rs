//! The robots that come with the project, embedded so that a binary needs no files beside it.

use std::path::Path;

use super::{ModelError, RobotModel, parse};

/// Name in the handshake, then the text of the description.
const CATALOG: [(&str, &str); 2] = [
    (
        "sr8730",
        include_str!("../../../../robots/samsung-sr8730/robot.toml"),
    ),
    (
        "relax",
        include_str!("../../../../robots/vileda-relax/robot.toml"),
    ),
];

/// A description is a few kilobytes; more is a mistake.
const FILE_BYTES_MAX: u64 = 256 * 1024;

/// Names of the robots that come with the project.
#[must_use]
pub fn robot_names() -> Vec<&'static str> {
    CATALOG.iter().map(|(name, _)| *name).collect()
}

impl RobotModel {
    /// The robot of this name that comes with the project.
    ///
    /// # Errors
    /// [`ModelError::Unknown`], which lists the known names.
    pub fn by_name(name: &str) -> Result<Self, ModelError> {
        match CATALOG.iter().find(|(known, _)| *known == name) {
            Some((origin, text)) => Self::parse(text, origin),
            None => Err(ModelError::Unknown {
                name: name.to_owned(),
                known: robot_names().join(", "),
            }),
        }
    }

    /// A robot from a file in the form of `robots/samsung-sr8730/robot.toml`.
    ///
    /// # Errors
    /// When the file cannot be read, is not such a description, or holds an impossible value.
    pub fn load(path: &Path) -> Result<Self, ModelError> {
        let unreadable = |cause| ModelError::Unreadable {
            path: path.to_owned(),
            cause,
        };
        let about = std::fs::metadata(path).map_err(unreadable)?;
        if !about.is_file() {
            return Err(ModelError::Format {
                origin: path.display().to_string(),
                message: "it is no plain file".to_owned(),
            });
        }
        let size = about.len();
        if size > FILE_BYTES_MAX {
            return Err(ModelError::Format {
                origin: path.display().to_string(),
                message: format!("it is {size} bytes long, more than {FILE_BYTES_MAX}"),
            });
        }
        let text = std::fs::read_to_string(path).map_err(unreadable)?;
        Self::parse(&text, &path.display().to_string())
    }

    /// A robot from the text of a description; `origin` names it in errors.
    ///
    /// # Errors
    /// When the text is not such a description or holds an impossible value.
    pub fn parse(text: &str, origin: &str) -> Result<Self, ModelError> {
        parse::robot_model(text, origin)
    }
}
