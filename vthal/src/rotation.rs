//! A log file of bounded size: `vthal.log` is the present one, `vthal.log.1` the one before, and so on.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Bounds of a rotated log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RotationLimits {
    /// Size in bytes at which a new file is begun.
    pub size_max: u64,
    /// Files kept, the present one included; at least 1.
    pub files_max: u32,
}

/// A writer that begins a new file when the present one is full. A write is never split over two files.
#[derive(Debug)]
pub(crate) struct RotatingFile {
    path: PathBuf,
    limits: RotationLimits,
    file: File,
    size: u64,
}

impl RotatingFile {
    /// Opens `path` for appending and creates the folders above it.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn open(path: &Path, limits: RotationLimits) -> io::Result<Self> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let file = append_to(path)?;
        let size = file.metadata()?.len();
        Ok(Self {
            path: path.to_owned(),
            limits,
            file,
            size,
        })
    }

    fn rotate(&mut self) -> io::Result<()> {
        for number in (1..self.limits.files_max).rev() {
            let from = if number == 1 {
                self.path.clone()
            } else {
                numbered(&self.path, number - 1)
            };
            if from.exists() {
                fs::rename(from, numbered(&self.path, number))?;
            }
        }
        if self.limits.files_max <= 1 {
            fs::remove_file(&self.path)?;
        }
        self.file = append_to(&self.path)?;
        self.size = 0;
        Ok(())
    }
}

fn append_to(path: &Path) -> io::Result<File> {
    OpenOptions::new().create(true).append(true).open(path)
}

fn numbered(path: &Path, number: u32) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{number}"));
    PathBuf::from(name)
}

impl Write for RotatingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let length = bytes.len() as u64;
        if self.size > 0 && self.size + length > self.limits.size_max {
            self.rotate()?;
        }
        self.file.write_all(bytes)?;
        self.size += length;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Write;

    use vthal_bench::Scratch;

    use super::{RotatingFile, RotationLimits, numbered};

    #[test]
    fn old_files_move_up_and_the_oldest_goes() {
        let folder = Scratch::new().expect("creates");
        let path = folder.join("log/vthal.log");
        let mut log = RotatingFile::open(
            &path,
            RotationLimits {
                size_max: 10,
                files_max: 3,
            },
        )
        .expect("opens");
        for line in ["first 890", "second 90", "third 890", "fourth 90"] {
            log.write_all(line.as_bytes()).expect("writes");
        }
        let read = |path| fs::read_to_string(path).expect("exists");
        assert_eq!(read(path.clone()), "fourth 90");
        assert_eq!(read(numbered(&path, 1)), "third 890");
        assert_eq!(read(numbered(&path, 2)), "second 90");
        assert!(!numbered(&path, 3).exists(), "only three files are kept");
    }
}
