//! The `bounce` run with which the runs of a page are compared.

use std::path::{Path, PathBuf};

use anyhow::Context;
use brain::command::StrategyName;
use serde::{Deserialize, Serialize};

use crate::page::LONGEST;
use crate::run::{RunEnd, RunSettings, household, run_until};
use crate::trace::KeptRun;
use crate::{CalibrationChoice, GyroFitted, Scene, SceneSettings};

/// The settings of a stored run; a comparable `bounce` run has the same.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// Home, as it was named.
    pub home: PathBuf,
    /// Robot by name.
    pub robot: String,
    /// Noise class by name.
    pub noise: String,
    /// Seed of everything random.
    pub seed: u64,
}

impl Origin {
    /// What a run of `bounce` in it is called.
    fn title(&self) -> String {
        title(StrategyName::Bounce.name(), &self.noise, self.seed)
    }

    /// Runs `bounce` until 95 % are swept, the pack is low, or the page shows no more.
    ///
    /// # Errors
    /// When the home cannot be loaded, or the robot does not answer.
    pub fn bounce(&self, progress: impl FnMut(f64)) -> anyhow::Result<KeptRun> {
        let scene = Scene::load(&self.scene()).with_context(|| {
            format!(
                "the home {} of a kept run; make the page where the run was made",
                self.home.display()
            )
        })?;
        let settings = RunSettings {
            strategy: StrategyName::Bounce,
            pattern: None,
            seed: self.seed,
            duration_ms: (1000.0 * LONGEST * scene.home().t0_s()) as u64,
        };
        let mut household = household(&scene, &settings).with_trace();
        run_until(&mut household, (&settings, RunEnd::Covered), progress)?;
        Ok(KeptRun {
            origin: Some(self.clone()),
            ..household.kept_run(self.title())?
        })
    }

    fn scene(&self) -> SceneSettings {
        SceneSettings {
            home: self.home.clone(),
            robot: self.robot.clone(),
            noise: self.noise.clone(),
            firmware: None,
            record: CalibrationChoice::Complete,
            gyro: GyroFitted::Placeholder,
        }
    }
}

/// What a run is called before what else was asked of it.
#[must_use]
pub fn title(strategy: &str, noise: &str, seed: u64) -> String {
    format!("{strategy}, {noise} noise, seed {seed}")
}

/// Runs `bounce` for all kept runs that have no such run beside them, and keeps that in the same folder. `progress` is
/// given shares of all of it.
///
/// # Errors
/// As [`Origin::bounce`], and when a run cannot be written.
pub fn add_missing(folder: &Path, runs: &[KeptRun], mut progress: impl FnMut(f64)) -> anyhow::Result<()> {
    let missing = missing(runs);
    for (number, origin) in missing.iter().enumerate() {
        let run = origin.bounce(|share| progress((number as f64 + share) / missing.len() as f64))?;
        run.keep(folder)?;
    }
    Ok(())
}

/// Each once, in the order of the runs. The relation is home, noise and seed; runs of an emulated chip have no origin.
fn missing(runs: &[KeptRun]) -> Vec<Origin> {
    let mut missing: Vec<Origin> = Vec::new();
    for run in runs {
        let Some(origin) = &run.origin else {
            continue;
        };
        let is_there = runs
            .iter()
            .any(|other| other.title == origin.title() && other.report["home"] == run.report["home"]);
        if !is_there && !missing.contains(origin) {
            missing.push(origin.clone());
        }
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::{Origin, missing};
    use crate::trace::{Drawing, KeptRun, Trace};

    fn kept(title: &str, origin: Option<Origin>) -> KeptRun {
        KeptRun {
            title: title.to_owned(),
            origin,
            report: serde_json::json!({ "home": "Flat" }),
            plan: Drawing {
                cell_m: 0.05,
                width: 1,
                origin: [0.0; 3],
                runs: Vec::new(),
            },
            dock: None,
            map: None,
            trace: Trace::default(),
        }
    }

    #[test]
    fn bounce_is_missing_once_for_each_home_noise_and_seed() {
        let origin = |seed| Origin {
            home: "flat.toml".into(),
            robot: "sr8730".to_owned(),
            noise: "nominal".to_owned(),
            seed,
        };
        let mut runs = vec![
            kept("systematic, nominal noise, seed 1", Some(origin(1))),
            kept("systematic, nominal noise, seed 1, known map", Some(origin(1))),
            kept("systematic, nominal noise, seed 2", Some(origin(2))),
            kept("systematic, nominal noise, seed 3", None),
        ];
        assert_eq!(missing(&runs), [origin(1), origin(2)]);
        runs.push(kept("bounce, nominal noise, seed 2", None));
        assert_eq!(missing(&runs), [origin(1)]);
    }
}
