//! The homes of a fault run: the project's own, and one drawn from each seed.

use std::sync::Arc;

use home::{Home, HomeError, Noise, RobotModel};

use super::rooms::floorplan;
use crate::Scene;

/// The project's own homes, embedded so that a seed means the same wherever the binary is run.
const OURS: [(&str, &str); 3] = [
    (
        "furnished-room.toml",
        include_str!("../../../../homes/furnished-room.toml"),
    ),
    ("stairs.toml", include_str!("../../../../homes/stairs.toml")),
    (
        "two-room-flat.toml",
        include_str!("../../../../homes/two-room-flat.toml"),
    ),
];

/// Every fourth seed lives in a home of the project, the others in one of their own.
const OURS_EVERY: u64 = 4;

/// Homes, loaded once for all seeds.
#[derive(Clone, Debug)]
pub(crate) struct Homes {
    ours: Vec<Arc<Home>>,
}

impl Homes {
    /// Prepares the project's homes for this model.
    ///
    /// # Errors
    /// When one of them does not suit the model.
    pub(crate) fn load(model: &RobotModel) -> Result<Self, HomeError> {
        let ours = OURS
            .iter()
            .map(|(name, text)| Home::from_floorplan(name, text, model).map(Arc::new))
            .collect::<Result<_, _>>()?;
        Ok(Self { ours })
    }

    /// The home of a seed.
    pub(crate) fn scene(&self, seed: u64, model: &RobotModel, noise: Noise) -> Scene {
        let turn = (seed / OURS_EVERY) as usize % self.ours.len();
        let home = match self.ours.get(turn) {
            Some(home) if seed.is_multiple_of(OURS_EVERY) => Arc::clone(home),
            _ => Arc::new(drawn(seed, model)),
        };
        Scene::new(home, model.clone(), noise)
    }
}

fn drawn(seed: u64, model: &RobotModel) -> Home {
    Home::from_floorplan("drawn", &floorplan(seed), model).expect("drawn homes have room for the robot")
}
