//! Which firmware a robot runs, and how its image is read from a file.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use home::{RobotModel, World};
use pic32::board::serial::HostRate;
use pic32::board::{
    Blueprint, BlueprintError, CalibrationChoice, EmulatedRobot, EmulatedSettings, GyroFitted,
};
use pic32::image::{Image, ImageError};
use robot::{Outfit, Relax, RobotSettings, SimulatedRobot, Sr8730Outfit};

use crate::Robot;

/// A firmware, ready for any number of robots.
#[derive(Clone, Debug, Default)]
pub enum Firmware {
    /// cordlib as a part of this program.
    #[default]
    HostBuilt,
    /// An image for the robot's own chip, which is emulated.
    Image(Arc<Blueprint>),
}

/// No image is larger: the part has 268 KiB of flash, and an ELF carries names and lines besides.
const FILE_BYTES_MAX: u64 = 64 * 1024 * 1024;
/// First byte of an Intel HEX file.
const HEX_START: u8 = b':';

/// Why a firmware cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum FirmwareError {
    /// The file cannot be read.
    #[error("cannot read the firmware {}: {cause}; build it with `cargo xtask firmware sr8730` or check the path", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// The file is too large for an image.
    #[error("the firmware {} is {bytes} bytes long, more than any image of this chip; check the path", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// How long it is.
        bytes: u64,
    },
    /// The file is no image for this chip.
    #[error("the firmware {}: {cause}", path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what to do.
        cause: ImageError,
    },
    /// The project's own description of the board is wrong.
    #[error(transparent)]
    Board(#[from] BlueprintError),
}

impl Firmware {
    /// The firmware of this file (ELF or Intel HEX), or without a file the one that is built in. `record` says
    /// what the flash of its chip holds besides.
    ///
    /// # Errors
    /// One sentence that names the file, what is wrong with it and what to do.
    pub fn load(path: Option<&Path>, record: &CalibrationChoice) -> Result<Self, FirmwareError> {
        let Some(path) = path else {
            return Ok(Self::HostBuilt);
        };
        let bytes = read(path)?;
        let image = image_of(&bytes).map_err(|cause| FirmwareError::Image {
            path: path.to_owned(),
            cause,
        })?;
        Ok(Self::Image(Arc::new(Blueprint::sr8730(image, record)?)))
    }

    /// Whether a robot of this name can run it.
    #[must_use]
    pub fn suits(&self, robot: &str) -> bool {
        match self {
            Self::HostBuilt => [Sr8730Outfit::NAME, Relax::NAME].contains(&robot),
            Self::Image(_) => robot == Sr8730Outfit::NAME,
        }
    }

    /// The same with this gyro module on the board of an emulated chip; the firmware that is built in has its own.
    #[must_use]
    pub fn with_gyro(self, gyro: GyroFitted) -> Self {
        match self {
            Self::HostBuilt => Self::HostBuilt,
            Self::Image(blueprint) => Self::Image(Arc::new(Arc::unwrap_or_clone(blueprint).with_gyro(gyro))),
        }
    }

    /// A robot with this firmware that was just switched on. The firmware believes `model`.
    #[must_use]
    pub fn robot(&self, model: &RobotModel, world: World, settings: &RobotSettings) -> Robot {
        match self {
            Self::HostBuilt if model.name == Relax::NAME => {
                Robot::HostBuiltRelax(Box::new(SimulatedRobot::new(model, world, settings)))
            }
            Self::HostBuilt => Robot::HostBuilt(Box::new(SimulatedRobot::new(model, world, settings))),
            Self::Image(blueprint) => {
                let settings = EmulatedSettings {
                    rate: HostRate::exact(settings.baud),
                    seed: settings.seed,
                    bridges: settings.bridges,
                    miscalibration: settings.miscalibration,
                    ..EmulatedSettings::default()
                };
                Robot::Emulated(Box::new(EmulatedRobot::new(blueprint, world, &settings)))
            }
        }
    }
}

fn read(path: &Path) -> Result<Vec<u8>, FirmwareError> {
    let unreadable = |cause| FirmwareError::Unreadable {
        path: path.to_owned(),
        cause,
    };
    let bytes = std::fs::metadata(path).map_err(unreadable)?.len();
    if bytes > FILE_BYTES_MAX {
        return Err(FirmwareError::TooLarge {
            path: path.to_owned(),
            bytes,
        });
    }
    std::fs::read(path).map_err(unreadable)
}

fn image_of(bytes: &[u8]) -> Result<Image, ImageError> {
    match (bytes.first(), std::str::from_utf8(bytes)) {
        (Some(&HEX_START), Ok(text)) => Image::from_hex(text),
        _ => Image::from_elf(bytes),
    }
}
