//! Sets of homes by name.

use std::path::{Path, PathBuf};

use anyhow::Context;
use home::generate::{GeneratedHome, Half, PUBLISHED};
use home::traps::Trap;
use home::{Home, RobotModel};

/// Where a home comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum NamedHome {
    /// A file.
    File(PathBuf),
    /// A home of the generator.
    Generated(GeneratedHome),
    /// A room with a trap.
    Trap(Trap),
}

impl NamedHome {
    /// Reads a list of sets, separated by commas: `tuning` and `report` (odd and even numbers of the published set), `published`
    /// (both), `generated:A..B` with B, `generated:N`, `trap:KIND/SEED`, or files.
    ///
    /// # Errors
    /// When a set is none, or the list is empty.
    pub fn list(text: &str) -> anyhow::Result<Vec<Self>> {
        let mut places = Vec::new();
        for set in text.split(',').map(str::trim).filter(|set| !set.is_empty()) {
            places.extend(Self::set(set)?);
        }
        anyhow::ensure!(!places.is_empty(), "`{text}` names no home");
        Ok(places)
    }

    fn set(text: &str) -> anyhow::Result<Vec<Self>> {
        let generated = |number| Self::Generated(GeneratedHome::number(number));
        if text == "published" {
            return Ok(PUBLISHED.map(generated).collect());
        }
        if let Some(half) = Half::named(text) {
            return Ok(half.numbers().map(generated).collect());
        }
        if let Some(name) = text.strip_prefix("trap:") {
            let trap = Trap::parse(name).with_context(|| format!("`{name}` is no trap"))?;
            return Ok(vec![Self::Trap(trap)]);
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

    /// The home itself.
    ///
    /// # Errors
    /// When it cannot be read or drawn.
    pub fn home(&self, model: &RobotModel) -> anyhow::Result<Home> {
        Ok(match self {
            Self::File(path) => Home::load(Path::new(path), model)?,
            Self::Generated(home) => home.home(model)?,
            Self::Trap(trap) => trap.home(model)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::NamedHome;

    #[test]
    fn sets_are_read() {
        for (text, count) in [
            ("published", 50),
            ("report", 25),
            ("generated:3..5,homes/x.toml", 4),
            ("generated:7/1+people", 1),
            ("trap:sofa/3", 1),
        ] {
            assert_eq!(NamedHome::list(text).unwrap().len(), count, "{text}");
        }
        for wrong in [
            "",
            ",",
            "generated:0",
            "generated:5..3",
            "generated:a..b",
            "trap:sea",
        ] {
            assert!(NamedHome::list(wrong).is_err(), "{wrong}");
        }
    }
}
