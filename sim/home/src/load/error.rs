//! Why a home cannot be loaded.

use std::path::PathBuf;

use super::HomeNotice;

/// Why a home cannot be loaded: one sentence with the file, the place in it and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum HomeError {
    /// No such file.
    #[error("there is no home file {}; give the path of a ROS map .yaml, a Valetudo map .json or a home .toml", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("cannot read the home file {}: {}; give a file that you may read", path.display(), reason(cause))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// The file is too long.
    #[error("the file {} has {bytes} bytes, the limit is {limit}; crop the map or use a coarser resolution", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// Its length.
        bytes: u64,
        /// The longest that is accepted.
        limit: u64,
    },
    /// The plan has too many cells.
    #[error("the plan in {} would need {cells} cells, the limit is {limit}; crop the map or use a coarser resolution", path.display())]
    TooManyCells {
        /// The file.
        path: PathBuf,
        /// Cells that it would need.
        cells: u64,
        /// The most that are accepted.
        limit: u64,
    },
    /// The content is none of the known formats.
    #[error("{} is no home: {found}; it must be a ROS map .yaml, a Valetudo map .json or a home .toml (homes/README.md)", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// How it appears.
        found: String,
    },
    /// The file ends too early.
    #[error("the file {} is cut off: {place}; copy it again", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
        /// What is missing.
        place: String,
    },
    /// Something in the file is wrong.
    #[error("the home file {} is wrong at {place}: {problem}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Line, key or byte.
        place: String,
        /// What is wrong and what is required.
        problem: String,
    },
    /// The image that a ROS map names does not exist.
    #[error("the map {} names the image {}, which cannot be read: {}; put the image there or correct `image:`", yaml.display(), image.display(), reason(cause))]
    ImageMissing {
        /// The map.
        yaml: PathBuf,
        /// The image.
        image: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// The plan has no floor.
    #[error("the plan in {} has no floor at all; check the thresholds of the map or draw a room", path.display())]
    NoFloor {
        /// The file.
        path: PathBuf,
    },
    /// Floor, but nowhere enough for the robot.
    #[error("the plan in {} has no place where a robot of {radius_m} m radius fits; the largest clear circle has a radius of {clear_m:.3} m{}", path.display(), appended(notices))]
    NoPlace {
        /// The file.
        path: PathBuf,
        /// Radius of the robot.
        radius_m: f64,
        /// Radius of the largest circle of floor.
        clear_m: f64,
        /// What else its file may mean otherwise than its maker thinks.
        notices: Vec<HomeNotice>,
    },
}

/// What the system says, without the number that only programmers know.
fn reason(cause: &std::io::Error) -> String {
    let text = cause.to_string();
    match text.split_once(" (os error") {
        Some((said, _)) => said.to_owned(),
        None => text,
    }
}

fn appended(notices: &[HomeNotice]) -> String {
    notices.iter().map(|notice| format!("; {notice}")).collect()
}
