//! The map of the home on disk: `home.map` in the state folder, and the one before it as `home.map.old`.

use std::io;
use std::path::Path;

use brain::StoredMap;

use crate::kept_file;

/// Keeps `home`, and the present one as its predecessor. Writes nothing when they are equal, so that the predecessor stays
/// another one.
///
/// # Errors
/// What the file system says.
pub(crate) fn save(path: &Path, home: &StoredMap) -> io::Result<()> {
    let bytes = home.encode();
    let is_kept = std::fs::read(path).is_ok_and(|present| present == bytes);
    if is_kept {
        Ok(())
    } else {
        kept_file::replace(path, &bytes)
    }
}

/// The newest map that is whole, and why newer ones are not; nothing of both when there is none yet.
pub(crate) fn load(path: &Path) -> (Option<StoredMap>, Vec<String>) {
    let mut complaints = Vec::new();
    for version in kept_file::versions(path) {
        let bytes = match std::fs::read(&version) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            Err(error) => {
                complaints.push(format!("cannot read the map {}: {error}", version.display()));
                continue;
            }
        };
        match StoredMap::decode(&bytes) {
            Ok(home) => return (Some(home), complaints),
            Err(error) => complaints.push(format!("cannot use the map {}: {error}", version.display())),
        }
    }
    (None, complaints)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use brain::{Cell, CellKnowledge, Raster, StoredMap};

    use super::{load, save};

    fn home(width: usize) -> StoredMap {
        StoredMap::from_raster(
            &Raster::filled(Cell { x: 1, y: 2 }, width, 3, CellKnowledge::Free),
            None,
        )
    }

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("vthal-home-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("creates");
        folder
    }

    #[test]
    fn the_predecessor_is_another_map_and_stands_in_for_a_broken_one() {
        let folder = folder("kept");
        let path = folder.join("home.map");
        assert_eq!(load(&path), (None, Vec::new()));
        for width in [4, 5, 5] {
            save(&path, &home(width)).expect("saves");
        }
        assert_eq!(load(&path), (Some(home(5)), Vec::new()));
        let mut broken = fs::read(&path).expect("reads");
        broken[9] ^= 1;
        fs::write(&path, &broken).expect("writes");
        let (found, complaints) = load(&path);
        assert_eq!(found, Some(home(4)));
        assert!(
            complaints.len() == 1 && complaints[0].contains("checksum"),
            "{complaints:?}"
        );
        fs::remove_dir_all(folder).expect("cleans up");
    }
}
