//! Sets of homes by name.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::Context;
use home::generate::{GeneratedHome, PUBLISHED};
use home::{Home, Noise, RobotModel};
use rvac_sim::Scene;

/// Where a home comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Place {
    File(PathBuf),
    Generated(GeneratedHome),
}

impl Place {
    /// Reads a list of sets.
    pub(crate) fn list(text: &str) -> anyhow::Result<Vec<Self>> {
        let mut places = Vec::new();
        for set in text.split(',').map(str::trim).filter(|set| !set.is_empty()) {
            places.extend(Self::set(set)?);
        }
        anyhow::ensure!(!places.is_empty(), "`{text}` names no home");
        Ok(places)
    }

    fn set(text: &str) -> anyhow::Result<Vec<Self>> {
        let numbered = |keep: fn(&u32) -> bool| -> Vec<Self> {
            let numbers = PUBLISHED.filter(keep);
            numbers
                .map(|number| Self::Generated(GeneratedHome::number(number)))
                .collect()
        };
        match text {
            "published" => return Ok(numbered(|_| true)),
            "traps" => return traps(),
            "tuning" => return Ok(numbered(|number| number % 2 == 1)),
            "report" => return Ok(numbered(|number| number % 2 == 0)),
            _ => {}
        }
        let Some(name) = text.strip_prefix("generated:") else {
            return Ok(vec![Self::File(text.into())]);
        };
        let Some((first, last)) = name.split_once("..") else {
            let home =
                GeneratedHome::parse(name).with_context(|| format!("`{name}` is no generated home"))?;
            return Ok(vec![Self::Generated(home)]);
        };
        let number = |text: &str| -> anyhow::Result<u32> {
            let number = text.parse().ok().filter(|number| *number > 0);
            number.with_context(|| format!("`{text}` is no number of a home"))
        };
        let homes = (number(first)?..=number(last)?).map(GeneratedHome::number);
        Ok(homes.map(Self::Generated).collect())
    }

    pub(crate) fn scene(&self, model: &RobotModel, noise: Noise) -> anyhow::Result<Scene> {
        let home = match self {
            Self::File(path) => Home::load(Path::new(path), model)?,
            Self::Generated(home) => home.home(model)?,
        };
        Ok(Scene::new(Arc::new(home), model.clone(), noise))
    }
}

/// The traps of the project, by name.
fn traps() -> anyhow::Result<Vec<Place>> {
    let entries = std::fs::read_dir(TRAPS).with_context(|| format!("cannot read {TRAPS}"))?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.sort();
    Ok(paths.into_iter().map(Place::File).collect())
}

const TRAPS: &str = "homes/traps";

#[cfg(test)]
mod tests {
    use super::Place;

    #[test]
    fn sets_are_read() {
        for (text, count) in [
            ("published", 50),
            ("report", 25),
            ("generated:3..5,homes/x.toml", 4),
            ("generated:7/1+people", 1),
        ] {
            assert_eq!(Place::list(text).unwrap().len(), count, "{text}");
        }
        for wrong in ["", ",", "generated:0", "generated:5..3", "generated:a..b"] {
            assert!(Place::list(wrong).is_err(), "{wrong}");
        }
    }
}
