//! From names and files to a robot in a home.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use home::{Home, HomeError, ModelError, Noise, RobotModel, World};
use robot::{RobotSettings, SimulatedRobot};

/// What people choose.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSettings {
    /// File of the home.
    pub home: PathBuf,
    /// Name of the robot.
    pub robot: String,
    /// Name of the noise class.
    pub noise: String,
}

/// A home and a model of robot, ready for any number of runs.
#[derive(Clone, Debug)]
pub struct Scene {
    home: Arc<Home>,
    model: RobotModel,
    noise: Noise,
}

/// The one board the simulator has.
const BOARD: &str = "sr8730";

impl Scene {
    /// Loads home and model.
    ///
    /// # Errors
    /// One sentence that names what is wrong and what to do; nothing was written.
    pub fn load(settings: &SceneSettings) -> Result<Self, SceneError> {
        let model = RobotModel::by_name(&settings.robot)?;
        if model.name != BOARD {
            return Err(SceneError::NoBoard(model.name));
        }
        let noise =
            Noise::by_name(&settings.noise).ok_or_else(|| SceneError::Noise(settings.noise.clone()))?;
        let home = Home::load(Path::new(&settings.home), &model)?;
        Ok(Self::new(Arc::new(home), model, noise))
    }

    /// A scene of parts that are at hand.
    #[must_use]
    pub fn new(home: Arc<Home>, model: RobotModel, noise: Noise) -> Self {
        Self { home, model, noise }
    }

    /// A robot that was just switched on at its starting place.
    #[must_use]
    pub fn robot(&self, seed: u64, settings: &RobotSettings) -> SimulatedRobot {
        let world = World::new(Arc::clone(&self.home), &self.model, &self.noise, seed, None);
        SimulatedRobot::new(&self.model, world, settings)
    }

    /// The home.
    #[must_use]
    pub fn home(&self) -> &Home {
        &self.home
    }
}

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The home cannot be loaded.
    #[error(transparent)]
    Home(#[from] HomeError),
    /// There is no such robot, or its description is wrong.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A robot that is described, but whose board is not simulated.
    #[error("the board of `{0}` is not simulated; use --robot {BOARD}")]
    NoBoard(String),
    /// No such noise class.
    #[error("there is no noise class `{0}`; known are ideal, good, nominal and bad")]
    Noise(String),
}
