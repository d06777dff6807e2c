//! What robots have learnt of themselves on disk: `learnt.json` in the state folder.

use std::io;
use std::path::Path;

use kept_file::{Newest, newest_json, replace_json};
use vthal_core::learnt::{Learnings, StoredLearnings};

/// What was kept, and what is wrong with it, for the log.
pub(crate) fn load(path: &Path) -> (Learnings, Vec<String>) {
    let Newest { value, complaints } =
        newest_json::<StoredLearnings, _>(path, "what the robot has learnt of itself");
    (value.unwrap_or_default(), complaints)
}

/// Keeps it in place of what was kept before.
///
/// # Errors
/// What the file system says.
pub(crate) fn save(path: &Path, learnt: &StoredLearnings) -> io::Result<()> {
    replace_json(path, learnt)
}

#[cfg(test)]
mod tests {
    use super::{load, save};
    use brain::{EnergyModel, GyroLearnt, Learnt};
    use std::fs;
    use vthal_bench::Scratch;
    use vthal_core::learnt::{Learnings, RobotRecord, StoredLearnings};

    /// Figures that no short decimal number is.
    fn learnings() -> Learnings {
        let mut learnings = Learnings::default();
        let gyro = GyroLearnt {
            scale: 0.1 / 3.0,
            scale_sigma: 0.001,
            bias_rad_per_s: -0.002 / 3.0,
        };
        let learnt = Learnt {
            gyro: Some(gyro),
            energy: EnergyModel {
                seen_s: 1e4 / 3.0,
                ..EnergyModel::default()
            },
        };
        learnings.take(RobotRecord {
            device: "sr8730".to_owned(),
            learnt,
            learnt_s: Some(1_800_000_000),
        });
        learnings
    }

    #[test]
    fn what_was_kept_is_found_bit_by_bit_and_what_cannot_be_is_put_aside() {
        let folder = Scratch::new().expect("creates");
        let path = folder.join("learnt.json");
        assert_eq!(load(&path), (Learnings::default(), Vec::new()));
        save(&path, &StoredLearnings::from(&learnings())).expect("saves");
        assert_eq!(load(&path), (learnings(), Vec::new()));

        let text = fs::read_to_string(&path).expect("is there");
        for wrong in [
            text.replacen("0.001", "-0.001", 1),
            text.replacen("\"version\":1", "\"version\":2", 1),
            text[..text.len() / 2].to_owned(),
        ] {
            fs::write(&path, wrong).expect("writes");
            let (found, complaints) = load(&path);
            assert_eq!(found, Learnings::default());
            assert!(complaints[0].contains("is kept as"), "{complaints:?}");
        }
    }
}
