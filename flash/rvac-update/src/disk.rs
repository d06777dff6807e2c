//! What an update does to files. Each call is whole on the disk when it returns.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write as _};
use std::os::unix::fs::{OpenOptionsExt as _, symlink};
use std::path::Path;

/// The files of the board.
pub trait Disk {
    /// Writes a new file and its folders.
    ///
    /// # Errors
    /// What the file system says; a part of the file may be there then.
    fn write(&mut self, path: &Path, mode: u32, content: &mut dyn Read) -> io::Result<()>;

    /// Puts bytes in place of a file: after a crash at any moment the old or the new one is there, whole.
    ///
    /// # Errors
    /// What the file system says; the old one is there then.
    fn replace(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()>;

    /// Lets the link `path` point at `target`: after a crash at any moment it points at the old or at the new one.
    ///
    /// # Errors
    /// What the file system says; the old one is there then.
    fn point(&mut self, path: &Path, target: &Path) -> io::Result<()>;

    /// Removes a file, a link or a folder with all that is in it, if it is there.
    ///
    /// # Errors
    /// What the file system says; a part of a folder may be gone then.
    fn remove(&mut self, path: &Path) -> io::Result<()>;

    /// Bytes that fit on the disk of this folder still.
    ///
    /// # Errors
    /// What the file system says.
    fn free_bytes(&mut self, folder: &Path) -> io::Result<u64>;
}

/// The files of this computer.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealDisk;

impl Disk for RealDisk {
    fn write(&mut self, path: &Path, mode: u32, content: &mut dyn Read) -> io::Result<()> {
        let folder = folder_of(path)?;
        fs::create_dir_all(folder)?;
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .mode(mode)
            .open(path)?;
        io::copy(content, &mut file)?;
        file.sync_all()?;
        sync(folder)
    }

    fn replace(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let folder = folder_of(path)?;
        fs::create_dir_all(folder)?;
        let fresh = path.with_extension("new");
        let mut file = File::create(&fresh)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&fresh, path)?;
        sync(folder)
    }

    fn point(&mut self, path: &Path, target: &Path) -> io::Result<()> {
        let fresh = path.with_extension("new");
        self.remove(&fresh)?;
        symlink(target, &fresh)?;
        fs::rename(&fresh, path)?;
        sync(folder_of(path)?)
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        let outcome = match fs::symlink_metadata(path) {
            Ok(about) if about.is_dir() => fs::remove_dir_all(path),
            Ok(_) => fs::remove_file(path),
            Err(error) => Err(error),
        };
        match outcome {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(error),
            Ok(()) => sync(folder_of(path)?),
        }
    }

    fn free_bytes(&mut self, folder: &Path) -> io::Result<u64> {
        fs::create_dir_all(folder)?;
        let about = rustix::fs::statvfs(folder)?;
        Ok(about.f_bavail.saturating_mul(about.f_frsize))
    }
}

fn folder_of(path: &Path) -> io::Result<&Path> {
    path.parent()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a path without a folder"))
}

fn sync(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}
