//! Files that must be whole after a crash at any moment.
//!
//! A new file is written beside the present one, flushed, and renamed over it; the present one stays as `.old`, because SD
//! cards lie about flushing, and so that a person can go back.
#![forbid(unsafe_code)]

mod newest;

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

pub use newest::{Newest, folder_complaint, newest, newest_json, replace_json};

/// Mode of a file that nobody but its owner reads.
const SECRET: u32 = 0o600;

/// Puts `bytes` in place of the file. After a crash at any moment either it or its predecessor is there, whole.
///
/// # Errors
/// What the file system says.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let fresh = beside(path, "new");
    let file = File::create(&fresh)?;
    put(path, &fresh, file, bytes)
}

/// The same for a file that nobody but its owner may read.
///
/// # Errors
/// What the file system says.
pub fn replace_secret(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let fresh = beside(path, "new");
    let file = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(true)
        .mode(SECRET)
        .open(&fresh)?;
    // One that a crash left behind keeps the mode it had.
    file.set_permissions(fs::Permissions::from_mode(SECRET))?;
    put(path, &fresh, file, bytes)
}

fn put(path: &Path, fresh: &Path, mut file: File, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.sync_all()?;
    let old = beside(path, "old");
    let has_old = path.exists();
    if has_old {
        fs::rename(path, &old)?;
    }
    let result = fs::rename(fresh, path).and_then(|()| sync_folder_of(path));
    if result.is_err() {
        take_back(path, has_old.then_some(&old));
    }
    result
}

fn sync_folder_of(path: &Path) -> io::Result<()> {
    match path.parent() {
        Some(folder) => File::open(folder)?.sync_all(),
        None => Ok(()),
    }
}

/// What is told as not kept must not be there after the next start. On a disk that goes on failing nothing more can be done about it.
fn take_back(path: &Path, old: Option<&PathBuf>) {
    match old {
        Some(old) => fs::rename(old, path).ok(),
        None => fs::remove_file(path).ok(),
    };
}

/// No file that is kept is longer. Whoever puts an endless device in its place gets an answer.
const BYTES_MAX: u64 = 64 << 20;

/// Reads a whole file. A pipe, which would be waited for in silence, a folder or a device is refused, and so is what is longer than any
/// file of ours.
///
/// # Errors
/// What the file system says; [`io::ErrorKind::InvalidInput`] with a sentence for what is no plain file, or is too long.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let refused = |what: String| io::Error::new(io::ErrorKind::InvalidInput, what);
    let about = fs::metadata(path)?;
    if !about.is_file() {
        return Err(refused("it is no plain file".to_owned()));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(BYTES_MAX + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > BYTES_MAX {
        return Err(refused(format!("it is longer than {} MiB", BYTES_MAX >> 20)));
    }
    Ok(bytes)
}

/// The same for text.
///
/// # Errors
/// As [`read`]; [`io::ErrorKind::InvalidData`] when it is no text.
pub fn read_text(path: &Path) -> io::Result<String> {
    let no_text = |_| io::Error::new(io::ErrorKind::InvalidData, "it is no text (UTF-8)");
    String::from_utf8(read(path)?).map_err(no_text)
}

/// The present file and its predecessor, whether they are there or not.
#[must_use]
pub fn versions(path: &Path) -> [PathBuf; 2] {
    [path.to_owned(), beside(path, "old")]
}

fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{ending}"));
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::PermissionsExt as _;

    #[test]
    fn what_is_no_plain_file_is_refused_at_once() {
        let folder = std::env::temp_dir().join(format!("kept-file-read-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let pipe = folder.join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        for path in [pipe.as_path(), folder.as_path(), "/dev/zero".as_ref()] {
            let error = super::read(path).unwrap_err();
            assert_eq!(
                error.kind(),
                std::io::ErrorKind::InvalidInput,
                "{}",
                path.display()
            );
        }
        let text = folder.join("text");
        fs::write(&text, b"\xff").unwrap();
        assert_eq!(super::read(&text).unwrap(), b"\xff");
        assert_eq!(
            super::read_text(&text).unwrap_err().kind(),
            std::io::ErrorKind::InvalidData
        );
        let missing = super::read(&folder.join("missing")).unwrap_err();
        assert_eq!(missing.kind(), std::io::ErrorKind::NotFound);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_predecessor_stays_and_a_secret_is_the_owner_s_alone() {
        let folder = std::env::temp_dir().join(format!("kept-file-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("secret");
        fs::write(folder.join("secret.new"), "left by a crash").unwrap();
        for text in ["first", "second"] {
            super::replace_secret(&path, text.as_bytes()).unwrap();
        }
        let [present, old] = super::versions(&path);
        assert_eq!(fs::read_to_string(&present).unwrap(), "second");
        assert_eq!(fs::read_to_string(old).unwrap(), "first");
        assert_eq!(
            fs::metadata(&present).unwrap().permissions().mode() & 0o777,
            0o600
        );
        fs::remove_dir_all(&folder).unwrap();
    }
}
