//! Which versions of the map of a floor are known to be right, and which were doubted: a small file beside them.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use brain::MapTrial;
use kept_file::{newest_json, replace_json};
use serde::{Deserialize, Serialize};

/// Name of the file.
const FILE: &str = "trials.json";

/// Numbers of versions. A damaged file is as none: it says nothing that the next run does not find out.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct MapTrials {
    /// A run with it has met much of what it shows.
    held: BTreeSet<u64>,
    /// A run with it has doubted it, or has left it after such a doubt.
    doubted: BTreeSet<u64>,
}

impl MapTrials {
    /// What is known of the versions in a folder.
    pub(crate) fn load(folder: &Path) -> Self {
        let kept = newest_json::<Self, Self>(&folder.join(FILE), "what runs have shown of the maps");
        for complaint in &kept.complaints {
            tracing::warn!(part = "vthal", "{complaint}");
        }
        kept.value.unwrap_or_default()
    }

    /// Changes what is known of the versions in a folder, which have these numbers, and writes it down if that is news.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn change(folder: &Path, numbers: &[u64], change: impl FnOnce(&mut Self)) -> io::Result<()> {
        let before = Self::load(folder);
        let mut trials = before.clone();
        change(&mut trials);
        trials.held.retain(|number| numbers.contains(number));
        trials.doubted.retain(|number| numbers.contains(number));
        if trials == before {
            return Ok(());
        }
        replace_json(&folder.join(FILE), &trials)
    }

    /// A run began with version `base` and has left `left`; these are the versions that there are. A doubt is also of what people have
    /// changed since the last version that held.
    pub(crate) fn note(&mut self, trial: MapTrial, (base, left): (u64, u64), numbers: &[u64]) {
        match trial {
            MapTrial::Held => {
                self.held.insert(base);
                self.doubted.remove(&base);
            }
            MapTrial::Doubted => {
                self.held.remove(&base);
                let held = self.held.last().map_or(base, |held| held.saturating_add(1));
                let since = held.min(base)..=left;
                self.doubted
                    .extend(numbers.iter().filter(|number| since.contains(number)));
            }
        }
    }

    /// Version `copy` is as `number` was.
    pub(crate) fn copy(&mut self, number: u64, copy: u64) {
        for versions in [&mut self.held, &mut self.doubted] {
            if versions.contains(&number) {
                versions.insert(copy);
            } else {
                versions.remove(&copy);
            }
        }
    }

    /// Whether this version was doubted.
    pub(crate) fn is_doubted(&self, number: u64) -> bool {
        self.doubted.contains(&number)
    }

    /// Which of these versions, newest first, to take up when the newest is bad: the newest that held, else the newest from before a
    /// doubt.
    pub(crate) fn last_good(&self, numbers: &[u64]) -> Option<u64> {
        let held = numbers.iter().find(|number| self.held.contains(number));
        let before = || {
            let newest_doubted = numbers.iter().position(|number| self.is_doubted(*number))?;
            let older = numbers.get(newest_doubted..)?;
            older.iter().find(|number| !self.is_doubted(**number))
        };
        held.or_else(before).copied()
    }
}

#[cfg(test)]
mod tests {
    use brain::MapTrial;

    use super::MapTrials;

    /// The versions that there are.
    const NUMBERS: [u64; 9] = [9, 8, 7, 6, 5, 4, 3, 2, 1];

    #[test]
    fn the_last_good_version_is_the_newest_that_a_run_has_found_right() {
        let mut trials = MapTrials::default();
        assert_eq!(trials.last_good(&[3, 2, 1]), None, "nothing is known of them");
        trials.note(MapTrial::Held, (1, 2), &NUMBERS);
        trials.note(MapTrial::Held, (2, 3), &NUMBERS);
        assert_eq!(
            trials.last_good(&[3, 2, 1]),
            Some(2),
            "no run has gone with what the last one left"
        );
        trials.note(MapTrial::Doubted, (3, 4), &NUMBERS);
        assert!(trials.is_doubted(3) && trials.is_doubted(4) && !trials.is_doubted(2));
        assert_eq!(trials.last_good(&[4, 3, 2, 1]), Some(2));
    }

    #[test]
    fn a_doubt_is_also_of_the_versions_that_people_made_of_the_bad_one() {
        let mut trials = MapTrials::default();
        trials.note(MapTrial::Held, (5, 6), &NUMBERS);
        // 7 and 8 are changes by people; the run began with 8 and left 9.
        trials.note(MapTrial::Doubted, (8, 9), &NUMBERS);
        assert!((6..=9).all(|number| trials.is_doubted(number)));
        assert_eq!(trials.last_good(&[9, 8, 7, 6, 5]), Some(5));
    }

    #[test]
    fn without_a_version_that_held_it_is_the_one_before_the_doubt() {
        let mut trials = MapTrials::default();
        trials.note(MapTrial::Doubted, (3, 4), &NUMBERS);
        assert_eq!(trials.last_good(&[5, 4, 3, 2, 1]), Some(2));
        assert_eq!(trials.last_good(&[4, 3]), None);
    }

    #[test]
    fn a_version_that_held_once_and_was_doubted_later_is_no_good_one_and_a_copy_is_as_its_original() {
        let mut trials = MapTrials::default();
        trials.note(MapTrial::Held, (1, 2), &NUMBERS);
        trials.note(MapTrial::Doubted, (1, 3), &NUMBERS);
        assert!(trials.is_doubted(1));
        trials.copy(1, 4);
        assert!(trials.is_doubted(4));
        trials.note(MapTrial::Held, (5, 6), &NUMBERS);
        trials.copy(5, 7);
        assert_eq!(trials.last_good(&[7, 6, 5, 4, 3, 2, 1]), Some(7));
    }

    /// Names of files come from outside, and a number may be any.
    #[test]
    fn a_number_far_from_the_others_costs_nothing() {
        let mut trials = MapTrials::default();
        trials.note(MapTrial::Held, (1, 2), &[1]);
        let far = u64::MAX - 1;
        trials.note(MapTrial::Doubted, (far, far), &[far, 2, 1]);
        assert!(trials.is_doubted(far) && trials.is_doubted(2) && !trials.is_doubted(1));
    }
}
