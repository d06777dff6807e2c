//! The loads of motors on disk: `health.json` in the state folder.

use std::io;
use std::path::Path;

use kept_file::{Newest, newest_json, replace_json};
use vthal_core::health::{Health, StoredHealth};

/// The loads as they were kept, and what is wrong with what was kept, for the log.
pub(crate) fn load(path: &Path) -> (Health, Vec<String>) {
    let Newest { value, complaints } = newest_json::<StoredHealth, _>(path, "the loads of the motors");
    (value.unwrap_or_default(), complaints)
}

/// Keeps loads in place of those before.
///
/// # Errors
/// What the file system says.
pub(crate) fn save(path: &Path, health: &StoredHealth) -> io::Result<()> {
    replace_json(path, health)
}

#[cfg(test)]
mod tests {
    use super::{load, save};
    use std::fs;
    use vthal_bench::Scratch;
    use vthal_core::health::{Component, Health, Load, StoredHealth};

    fn measured() -> Health {
        let mut health = Health::default();
        for sample in 0..12_000_u64 {
            health.take(&Load {
                time_us: sample * 200_000,
                wheels_a: Some([0.25, 0.5]),
                brush_a: Some(0.75),
            });
        }
        health
    }

    #[test]
    fn what_was_kept_is_found_and_what_cannot_be_is_put_aside() {
        let folder = Scratch::new().expect("creates");
        let path = folder.join("health.json");
        assert_eq!(load(&path), (Health::default(), Vec::new()));
        save(&path, &StoredHealth::from(&measured())).expect("saves");
        let (found, complaints) = load(&path);
        assert_eq!(found.gauge(Component::BrushMain).usual_a(), Some(0.75));
        assert_eq!(found.gauge(Component::WheelRight).share(), Some(1.0));
        assert!(complaints.is_empty());

        let text = fs::read_to_string(&path).expect("is there");
        for wrong in [
            text.replacen("0.75", "-0.75", 1),
            text.replacen("\"version\":1", "\"version\":2", 1),
        ] {
            fs::write(&path, wrong).expect("writes");
            let (found, complaints) = load(&path);
            assert_eq!(found, Health::default());
            assert!(complaints[0].contains("is kept as"), "{complaints:?}");
        }
    }
}
