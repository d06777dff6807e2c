//! A file by which the owner of the card, from which the robot's computer starts, has all devices forgotten.

use std::fs;
use std::io;
use std::path::Path;

use tracing::{error, warn};

/// Its name.
const NAME: &str = "librvac-reset";

/// Its name when it was obeyed.
const DONE: &str = "librvac-reset.done";

/// The word in it that has the robot's identity forgotten too.
const EVERYTHING: &str = "everything";

/// What the owner asks to delete.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wish {
    /// All devices.
    Devices,
    /// Those, and the robot's identity.
    Everything,
}

/// What the file in this folder asks for; it is renamed, so that it asks once. One that cannot be renamed would ask at each start: it is not
/// obeyed.
pub(crate) fn take(folder: &Path) -> Option<Wish> {
    let path = folder.join(NAME);
    match read_and_rename(&path, &folder.join(DONE)) {
        Ok(wish) => wish,
        Err(why) => {
            error!(path = %path.display(), %why, "the file is not obeyed, because it cannot be renamed: make its folder writable");
            None
        }
    }
}

fn read_and_rename(path: &Path, done: &Path) -> io::Result<Option<Wish>> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    fs::rename(path, done)?;
    warn!(path = %path.display(), "found, and renamed");
    let everything = text.trim().eq_ignore_ascii_case(EVERYTHING);
    Ok(Some(if everything {
        Wish::Everything
    } else {
        Wish::Devices
    }))
}

#[cfg(test)]
mod tests {
    use super::{DONE, NAME, Wish, take};
    use crate::folder::Folder;

    #[test]
    fn it_asks_once_for_what_is_in_it() {
        let folder = Folder::new();
        assert_eq!(take(&folder), None);
        for (text, wish) in [("", Wish::Devices), ("Everything\r\n", Wish::Everything)] {
            std::fs::write(folder.join(NAME), text).unwrap();
            assert_eq!(take(&folder), Some(wish));
            assert_eq!(take(&folder), None, "once");
            assert!(folder.join(DONE).exists());
        }
        // A folder in its place can be read no more than renamed over a file.
        std::fs::create_dir(folder.join(NAME)).unwrap();
        assert_eq!(take(&folder), None);
    }
}
