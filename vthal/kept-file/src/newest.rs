//! The newest whole version of a kept file. What cannot be read is put aside, never overwritten.

use std::fmt::Display;
use std::fs;
use std::io;
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
    for version in versions(path).iter().filter(|version| version.exists()) {
        let text = read_text(version).map_err(|error| error.to_string());
        match text.and_then(|text| parse(&text)) {
            Ok(value) => {
                return Newest {
                    value: Some(value),
                    complaints,
                };
            }
            Err(error) => {
                let aside = put_aside(version);
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

/// Renames a damaged file to a name that nothing has; says how that went.
fn put_aside(path: &Path) -> String {
    let name = |number: u32| {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".damaged-{number}"));
        PathBuf::from(name)
    };
    let Some(free) = (1..1_000).map(name).find(|name| !name.exists()) else {
        return "it stays where it is, for there are too many damaged ones".to_owned();
    };
    match fs::rename(path, &free) {
        Ok(()) => format!("it is kept as {}", free.display()),
        Err(error) => format!("it cannot be put aside: {error}"),
    }
}
