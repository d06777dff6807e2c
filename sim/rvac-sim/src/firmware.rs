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
use stc90::board::{EmulatedRelax, RelaxBlueprint, RelaxSettings};

use crate::Robot;

/// A firmware, ready for any number of robots.
#[derive(Clone, Debug, Default)]
pub enum Firmware {
    /// cordlib as a part of this program.
    #[default]
    HostBuilt,
    /// An image for the SR8730's own chip, which is emulated.
    Image(Arc<Blueprint>),
    /// An image for the Relax's own chip, which is emulated.
    RelaxImage(Arc<RelaxBlueprint>),
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
    /// The file is no image for the Relax's chip.
    #[error("the firmware {}: {cause}", path.display())]
    RelaxImage {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what to do.
        cause: stc90::image::ImageError,
    },
    /// The file is no text, so it is no Intel HEX.
    #[error("the firmware {} is no Intel HEX, which is what SDCC writes as .ihx; check the path", .0.display())]
    NoText(PathBuf),
    /// The project's own description of the Relax's board is wrong.
    #[error(transparent)]
    RelaxBoard(#[from] stc90::board::BoardError),
    /// The project's own description of the board is wrong.
    #[error(transparent)]
    Board(#[from] BlueprintError),
}

impl Firmware {
    /// The firmware of this file (ELF or Intel HEX) for the chip of a robot with this name, or without a file the one that is
    /// built in. `record` says what the flash of an SR8730 holds besides.
    ///
    /// # Errors
    /// One sentence that names the file, what is wrong with it and what to do.
    pub fn load(robot: &str, path: Option<&Path>, record: &CalibrationChoice) -> Result<Self, FirmwareError> {
        let Some(path) = path else {
            return Ok(Self::HostBuilt);
        };
        let bytes = read(path)?;
        if robot == Relax::NAME {
            return Self::of_relax(path, &bytes);
        }
        let image = image_of(&bytes).map_err(|cause| FirmwareError::Image {
            path: path.to_owned(),
            cause,
        })?;
        Ok(Self::Image(Arc::new(Blueprint::sr8730(image, record)?)))
    }

    fn of_relax(path: &Path, bytes: &[u8]) -> Result<Self, FirmwareError> {
        let text = std::str::from_utf8(bytes).map_err(|_| FirmwareError::NoText(path.to_owned()))?;
        let image = stc90::image::Image::from_hex(text).map_err(|cause| FirmwareError::RelaxImage {
            path: path.to_owned(),
            cause,
        })?;
        Ok(Self::RelaxImage(Arc::new(RelaxBlueprint::new(image)?)))
    }

    /// Whether a robot of this name can run it.
    #[must_use]
    pub fn suits(&self, robot: &str) -> bool {
        match self {
            Self::HostBuilt => [Sr8730Outfit::NAME, Relax::NAME].contains(&robot),
            Self::Image(_) => robot == Sr8730Outfit::NAME,
            Self::RelaxImage(_) => robot == Relax::NAME,
        }
    }

    /// The same with this gyro module on the board of an emulated SR8730; the firmware that is built in has its own, and the
    /// Relax has none.
    #[must_use]
    pub fn with_gyro(self, gyro: GyroFitted) -> Self {
        match self {
            Self::HostBuilt | Self::RelaxImage(_) => self,
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
            Self::RelaxImage(blueprint) => {
                // This chip's UART is not faster than its own rate, which a host finds out.
                let own = RelaxSettings::default();
                let rate = stc90::board::HostRate {
                    baud: settings.baud.min(own.rate.baud),
                };
                let seed = settings.seed;
                let settings = RelaxSettings { rate, seed };
                Robot::EmulatedRelax(Box::new(EmulatedRelax::new(blueprint, world, &settings)))
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

#[cfg(test)]
mod tests {
    use super::{CalibrationChoice, Firmware};
    use crate::Robot;
    use home::{Home, Noise, RobotModel, World};
    use robot::RobotSettings;
    use std::path::PathBuf;
    use std::sync::Arc;

    /// MOV P1, #0xEF; MOV P2, #0x7D; SJMP to itself: both wheels of a Relax forward.
    const AHEAD: &str = ":080000007590EF75A07D80FEF4\n:00000001FF\n";

    fn file(name: &str, bytes: &[u8]) -> PathBuf {
        let path = std::env::temp_dir().join(format!("rvac-sim-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes).expect("a temporary file");
        path
    }

    fn load(name: &str, bytes: &[u8], robot: &str) -> Result<Firmware, String> {
        let path = file(name, bytes);
        let firmware = Firmware::load(robot, Some(&path), &CalibrationChoice::Complete);
        std::fs::remove_file(&path).expect("the temporary file is ours");
        firmware.map_err(|error| error.to_string())
    }

    #[test]
    fn an_image_of_the_relax_drives_its_robot() {
        let firmware = load("ahead.ihx", AHEAD.as_bytes(), "relax").expect("an image");
        assert!(firmware.suits("relax") && !firmware.suits("sr8730"));
        let model = RobotModel::by_name("relax").expect("it comes with the project");
        let plan = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n";
        let home = Home::from_floorplan("room", plan, &model).expect("a valid home");
        let world = World::new(Arc::new(home), &model, &Noise::ideal(), 1, None);
        let mut robot = firmware.robot(&model, world, &RobotSettings::default());
        assert!(matches!(robot, Robot::EmulatedRelax(_)));
        let mut bytes = Vec::new();
        for _ in 0..100 {
            robot.tick(&mut bytes);
        }
        assert!(robot.wheels_driven());
        assert!(!robot.monitor().violations().is_empty(), "nobody asked for it");
    }

    #[test]
    fn an_image_for_another_chip_is_refused_by_name() {
        let for_pic32 = ":020000041D00DD\n:0400100001020304E2\n:00000001FF\n";
        let cases: [(&[u8], &str, &str); 4] = [
            (for_pic32.as_bytes(), "relax", "STC90C58RD+"),
            (b"\x7fELF\xff\xff", "relax", "no Intel HEX"),
            (b"hello", "relax", "colon"),
            (AHEAD.as_bytes(), "sr8730", "PIC32MX360F256L"),
        ];
        for (number, (bytes, robot, named)) in cases.into_iter().enumerate() {
            let error = load(&number.to_string(), bytes, robot).expect_err(named);
            assert!(error.contains(named), "{error}");
        }
    }
}
