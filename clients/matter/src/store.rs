//! The folder of what is kept: each thing a file that is whole after a crash, and that only its owner reads, because keys are among them.

use std::fs::{self, DirBuilder};
use std::io::{self, ErrorKind};
use std::os::unix::fs::DirBuilderExt as _;
use std::path::{Path, PathBuf};

use rs_matter::error::{Error, ErrorCode};
use rs_matter::persist::KvBlobStore;

/// Nobody but its owner looks into it.
const FOLDER_MODE: u32 = 0o700;

/// The folder.
#[derive(Clone, Debug)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn open(path: &Path) -> io::Result<Self> {
        DirBuilder::new().recursive(true).mode(FOLDER_MODE).create(path)?;
        Ok(Self(path.to_owned()))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// A value of the Matter stack, by its number.
    fn value(&self, key: u16) -> PathBuf {
        self.path(&format!("value-{key:04x}"))
    }
}

impl KvBlobStore for Folder {
    fn load<'a>(&mut self, key: u16, buffer: &'a mut [u8]) -> Result<Option<&'a [u8]>, Error> {
        let kept = match kept_file::read(&self.value(key)) {
            Ok(kept) => kept,
            // A crash between two renames leaves the predecessor alone.
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let [_, old] = kept_file::versions(&self.value(key));
                match kept_file::read(&old) {
                    Ok(kept) => kept,
                    Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
                    Err(error) => return Err(error.into()),
                }
            }
            Err(error) => return Err(error.into()),
        };
        let place = buffer.get_mut(..kept.len()).ok_or(ErrorCode::NoSpace)?;
        place.copy_from_slice(&kept);
        Ok(Some(place))
    }

    fn store(&mut self, key: u16, value: &[u8], _buffer: &mut [u8]) -> Result<(), Error> {
        Ok(kept_file::replace_secret(&self.value(key), value)?)
    }

    fn remove(&mut self, key: u16, _buffer: &mut [u8]) -> Result<(), Error> {
        for version in kept_file::versions(&self.value(key)) {
            match fs::remove_file(version) {
                Ok(()) => {}
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::fs;
    use std::os::unix::fs::PermissionsExt as _;

    use rs_matter::persist::KvBlobStore as _;

    use super::Folder;

    /// An empty folder, removed by whoever made it.
    pub(crate) fn scratch(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("rvac-matter-{}-{name}", std::process::id()));
        fs::remove_dir_all(&path).ok(); // Of an earlier run.
        Folder::open(&path).unwrap()
    }

    #[test]
    fn a_value_comes_back_until_it_is_removed_and_nobody_else_reads_it() {
        let mut folder = scratch("store");
        let mut buffer = [0; 8];
        assert_eq!(folder.load(7, &mut buffer).unwrap(), None);
        folder.store(7, b"first", &mut []).unwrap();
        folder.store(7, b"second", &mut []).unwrap();
        assert_eq!(folder.load(7, &mut buffer).unwrap(), Some(&b"second"[..]));
        let mode = fs::metadata(folder.path("value-0007"))
            .unwrap()
            .permissions()
            .mode();
        assert_eq!(mode & 0o077, 0);
        // As a crash between the two renames leaves it.
        fs::remove_file(folder.path("value-0007")).unwrap();
        assert_eq!(folder.load(7, &mut buffer).unwrap(), Some(&b"first"[..]));
        folder.remove(7, &mut []).unwrap();
        assert_eq!(folder.load(7, &mut buffer).unwrap(), None);
        folder.store(8, b"longer than the buffer", &mut []).unwrap();
        assert!(folder.load(8, &mut buffer).is_err());
        fs::remove_dir_all(folder.path("")).unwrap();
    }
}
