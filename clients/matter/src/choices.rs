//! What people chose by Matter for the jobs to come. The standard wants it kept.

use std::path::PathBuf;

use bridge::FanSpeed;
use serde::{Deserialize, Serialize};

use crate::store::Folder;

const FILE: &str = "choices.json";

/// As many parts as a job may have.
pub(crate) const AREAS_MAX: usize = 32;

/// The choices, and where they are kept.
#[derive(Debug)]
pub(crate) struct Choices {
    path: PathBuf,
    speed: FanSpeed,
    /// Rooms by their identities, in the order in which they shall be cleaned; none = all.
    areas: Vec<u16>,
}

#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Stored {
    speed: String,
    areas: Vec<u16>,
}

impl Choices {
    pub(crate) fn kept(folder: &Folder) -> Self {
        let path = folder.path(FILE);
        let found = kept_file::newest(&path, "the choices by Matter", |text| {
            serde_json::from_str::<Stored>(text).map_err(|error| error.to_string())
        });
        for complaint in &found.complaints {
            tracing::warn!("{complaint}");
        }
        let stored = found.value.unwrap_or_default();
        Self {
            path,
            speed: FanSpeed::from_name(&stored.speed).unwrap_or_default(),
            areas: stored.areas.into_iter().take(AREAS_MAX).collect(),
        }
    }

    pub(crate) fn speed(&self) -> FanSpeed {
        self.speed
    }

    pub(crate) fn areas(&self) -> &[u16] {
        &self.areas
    }

    pub(crate) fn choose_speed(&mut self, speed: FanSpeed) {
        self.speed = speed;
        self.keep();
    }

    pub(crate) fn choose_areas(&mut self, areas: Vec<u16>) {
        self.areas = areas;
        self.keep();
    }

    /// Forgets rooms that are no more; says whether there were any.
    pub(crate) fn keep_only(&mut self, is_there: impl Fn(u16) -> bool) -> bool {
        let before = self.areas.len();
        self.areas.retain(|room| is_there(*room));
        let is_changed = self.areas.len() != before;
        if is_changed {
            self.keep();
        }
        is_changed
    }

    /// A choice that the disk refuses holds until the program ends.
    fn keep(&self) {
        let stored = Stored {
            speed: self.speed.name().to_owned(),
            areas: self.areas.clone(),
        };
        if let Err(error) = kept_file::replace_json(&self.path, &stored) {
            tracing::warn!(%error, path = %self.path.display(), "what was chosen is not kept");
        }
    }
}

#[cfg(test)]
mod tests {
    use bridge::FanSpeed;

    use super::Choices;
    use crate::store::tests::scratch;

    #[test]
    fn what_was_chosen_outlives_the_program_and_rooms_that_are_gone_do_not() {
        let folder = scratch("choices");
        let mut choices = Choices::kept(&folder);
        assert_eq!((choices.speed(), choices.areas()), (FanSpeed::Rooms, &[][..]));
        choices.choose_speed(FanSpeed::Quiet);
        choices.choose_areas(vec![3, 1]);
        let mut again = Choices::kept(&folder);
        assert_eq!((again.speed(), again.areas()), (FanSpeed::Quiet, &[3, 1][..]));
        assert!(again.keep_only(|room| room == 1));
        assert!(!again.keep_only(|room| room == 1));
        assert_eq!(Choices::kept(&folder).areas(), [1]);
        std::fs::remove_dir_all(folder.path("")).unwrap();
    }
}
