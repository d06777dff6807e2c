//! Builds a robot in a home from names and files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use home::generate::GeneratedHome;
use home::traps::{Trap, TrapKind};
use home::{Beacons, BoardGyro, Home, HomeError, ModelError, Noise, NoiseError, Pose, RobotModel, World};
use pic32::board::{CalibrationChoice, GyroFitted};
use robot::RobotSettings;

use crate::{Firmware, FirmwareError, Robot};

/// What people choose.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSettings {
    /// File of the home, `generated:N`, or `trap:KIND/SEED`.
    pub home: PathBuf,
    /// Name of the robot.
    pub robot: String,
    /// Name of the noise class.
    pub noise: String,
    /// File of the firmware image; `None` = the firmware that is built in.
    pub firmware: Option<PathBuf>,
    /// The calibration record in the robot's flash, which only an image for the chip reads.
    pub record: CalibrationChoice,
    /// The gyro module on the board of an emulated chip.
    pub gyro: GyroFitted,
}

/// A home, a model of robot and its firmware, ready for any number of runs.
#[derive(Clone, Debug)]
pub struct Scene {
    home: Arc<Home>,
    model: RobotModel,
    noise: Noise,
    firmware: Firmware,
}

impl Scene {
    /// Loads home and model.
    ///
    /// # Errors
    /// One sentence that names what is wrong and what to do; nothing was written.
    pub fn load(settings: &SceneSettings) -> Result<Self, SceneError> {
        let model = RobotModel::by_name(&settings.robot)?;
        let noise = settings.noise.parse()?;
        let firmware = Firmware::load(&model.name, settings.firmware.as_deref(), &settings.record)?
            .with_gyro(settings.gyro);
        if !firmware.suits(&model.name) {
            return Err(SceneError::NoBoard(model.name));
        }
        let home = load_home(&settings.home, &model)?;
        Ok(Self::new(Arc::new(home), model, noise).with_firmware(firmware))
    }

    /// A scene of parts that are at hand, with the firmware that is built in.
    #[must_use]
    pub fn new(home: Arc<Home>, model: RobotModel, noise: Noise) -> Self {
        Self {
            home,
            model,
            noise,
            firmware: Firmware::HostBuilt,
        }
    }

    /// The same with another firmware.
    #[must_use]
    pub fn with_firmware(self, firmware: Firmware) -> Self {
        Self { firmware, ..self }
    }

    /// A robot that was just switched on at its starting place.
    #[must_use]
    pub fn robot(&self, seed: u64, settings: &RobotSettings) -> Robot {
        self.robot_at(None, seed, settings)
    }

    /// As [`Self::robot`], at another place of the plan.
    #[must_use]
    pub fn robot_at(&self, start: Option<Pose>, seed: u64, settings: &RobotSettings) -> Robot {
        let built = settings.miscalibration.map(|seed| self.model.deviating(seed));
        let built = built.as_ref().unwrap_or(&self.model);
        let world = World::new(Arc::clone(&self.home), built, &self.noise, seed, start);
        self.firmware.robot(&self.model, world, settings)
    }

    /// A gyro on the robot's Linux board.
    #[must_use]
    pub fn board_gyro(&self, seed: u64) -> BoardGyro {
        BoardGyro::new(&self.noise, seed)
    }

    /// So many radio beacons at the edges of the home.
    #[must_use]
    pub fn beacons(&self, seed: u64, count: usize) -> Beacons {
        Beacons::around(&self.home, count, seed)
    }

    /// Where the robot's sensors sit, as its host must know it.
    #[must_use]
    pub fn sensors(&self) -> brain::SensorLayout {
        crate::sensor_layout(&self.model)
    }

    /// The home.
    #[must_use]
    pub fn home(&self) -> &Home {
        &self.home
    }

    /// Another home for the same robot.
    ///
    /// # Errors
    /// When it cannot be loaded.
    pub fn other_home(&self, source: &Path) -> Result<Home, SceneError> {
        load_home(source, &self.model)
    }
}

/// A home from a file, of the generator (`generated:N`), or a drawn trap (`trap:KIND/SEED`).
fn load_home(source: &Path, model: &RobotModel) -> Result<Home, SceneError> {
    if let Some(name) = source.to_str().and_then(|text| text.strip_prefix("trap:")) {
        return match Trap::parse(name) {
            Some(trap) => Ok(trap.home(model)?),
            None => Err(SceneError::Trap(name.to_owned())),
        };
    }
    let generated = source.to_str().and_then(|text| text.strip_prefix("generated:"));
    match generated {
        None => Ok(Home::load(source, model)?),
        Some(name) => match GeneratedHome::parse(name) {
            Some(home) => Ok(home.home(model)?),
            None => Err(SceneError::Generated(name.to_owned())),
        },
    }
}

/// Why a scene cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The home cannot be loaded.
    #[error(transparent)]
    Home(#[from] HomeError),
    /// There is no such robot, or its description is wrong.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The firmware cannot be run.
    #[error(transparent)]
    Firmware(#[from] FirmwareError),
    /// A robot whose chip is not emulated.
    #[error("the chip of `{0}` is not emulated; leave out --firmware, or use --robot sr8730 or relax")]
    NoBoard(String),
    /// No such generated home.
    #[error(
        "`{0}` is no generated home; give a number from 1, for example generated:7, generated:7/2 or generated:7+people"
    )]
    Generated(String),
    /// No such trap.
    #[error("`{0}` is no trap; known are {names}, each with a seed, for example trap:sofa/3", names = trap_names())]
    Trap(String),
    /// No such noise.
    #[error(transparent)]
    Noise(#[from] NoiseError),
}

fn trap_names() -> String {
    let names: Vec<_> = TrapKind::ALL.iter().map(|kind| kind.name()).collect();
    names.join(", ")
}
