//! The newest whole version of a kept file. What cannot be read is put aside, never overwritten.

use std::fmt::Display;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::{read_text, replace, versions};

/// What was found.
#[derive(Debug)]
pub struct Newest<T> {
    /// The newest that is whole.
    pub value: Option<T>,
    /// What is wrong with newer ones, a sentence each.
    pub complaints: Vec<String>,
}

/// Reads versions of `path`, the newest first, until one is whole. `what` is in the file, for people.
#[must_use]
pub fn newest<T>(path: &Path, what: &str, parse: impl Fn(&str) -> Result<T, String>) -> Newest<T> {
    let mut complaints = Vec::new();
    for version in &versions(path) {
        let text = match read_text(version) {
            Ok(text) => parse(&text).map_err(|error| (error, Aside::Damaged)),
            Err(error) if error.kind() == ErrorKind::NotFound => continue,
            Err(error) => Err((error.to_string(), Aside::of(error.kind()))),
        };
        match text {
            Ok(value) => {
                return Newest {
                    value: Some(value),
                    complaints,
                };
            }
            Err((error, aside)) => {
                let aside = put_aside(version, aside);
                complaints.push(format!(
                    "{what} in {} cannot be read: {error}; {aside}",
                    version.display()
                ));
            }
        }
    }
    Newest {
        value: None,
        complaints,
    }
}

/// The same for JSON, which is read as `Stored` and then believed or not.
#[must_use]
pub fn newest_json<Stored, T>(path: &Path, what: &str) -> Newest<T>
where
    Stored: DeserializeOwned,
    T: TryFrom<Stored, Error: Display>,
{
    newest(path, what, |text| {
        let stored: Stored = serde_json::from_str(text).map_err(|error| error.to_string())?;
        T::try_from(stored).map_err(|error| error.to_string())
    })
}

/// Keeps JSON in place of what was kept before.
///
/// # Errors
/// What the file system says.
pub fn replace_json(path: &Path, stored: &impl Serialize) -> io::Result<()> {
    let text = serde_json::to_string(stored).map_err(io::Error::other)?;
    replace(path, text.as_bytes())
}

/// Why a folder of kept things cannot be listed, for people; none when it can, or is not there yet. What is in it is not gone, and must
/// not be taken for nothing.
#[must_use]
pub fn folder_complaint(path: &Path, what: &str) -> Option<String> {
    match fs::read_dir(path) {
        Ok(_) => None,
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => Some(format!(
            "{what} in {} cannot be listed: {error}; check whose the folder is and that it is one",
            path.display()
        )),
    }
}

/// What a file that is put aside may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Aside {
    /// It was read, and is not what it should be.
    Damaged,
    /// It could not be read: whether it is whole nobody knows.
    Unread,
}

impl Aside {
    const fn of(kind: ErrorKind) -> Self {
        match kind {
            ErrorKind::InvalidData | ErrorKind::InvalidInput => Self::Damaged,
            _ => Self::Unread,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Damaged => "damaged",
            Self::Unread => "unread",
        }
    }
}

/// Renames a file that cannot be used to a name that nothing has; says how that went.
fn put_aside(path: &Path, aside: Aside) -> String {
    let name = |number: u32| {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".{}-{number}", aside.name()));
        PathBuf::from(name)
    };
    let Some(free) = (1..1_000).map(name).find(|name| !name.exists()) else {
        return "it stays where it is, for there are too many damaged ones".to_owned();
    };
    match fs::rename(path, &free) {
        Ok(()) if aside == Aside::Unread => format!(
            "it may be whole and is kept as {}: give it its name back when it can be read",
            free.display()
        ),
        Ok(()) => format!("it is kept as {}", free.display()),
        Err(error) => format!("it cannot be put aside: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::ErrorKind;

    use super::{Aside, folder_complaint, put_aside};

    #[test]
    fn what_could_not_be_read_is_not_called_damaged() {
        assert_eq!(Aside::of(ErrorKind::PermissionDenied), Aside::Unread);
        assert_eq!(Aside::of(ErrorKind::Other), Aside::Unread, "a card that fails");
        assert_eq!(Aside::of(ErrorKind::InvalidData), Aside::Damaged);
        let folder = std::env::temp_dir().join(format!("kept-file-unread-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("learnt.json");
        fs::write(&path, "{}").unwrap();
        let told = put_aside(&path, Aside::Unread);
        assert!(told.contains("learnt.json.unread-1"), "{told}");
        assert!(folder.join("learnt.json.unread-1").exists());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_file_in_the_place_of_a_folder_is_told_and_a_missing_one_is_not() {
        let path = std::env::temp_dir().join(format!("kept-file-folder-{}", std::process::id()));
        assert_eq!(folder_complaint(&path, "maps"), None);
        fs::write(&path, "").unwrap();
        let told = folder_complaint(&path, "maps").unwrap();
        assert!(told.starts_with("maps in"), "{told}");
        fs::remove_file(&path).unwrap();
    }
}
