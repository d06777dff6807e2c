//! Backups: what was in a chip, with its hash, in a folder.
//!
//! A backup is two files with one name: `NAME.bin`, program flash and then boot flash, and `NAME.toml`, which says of which chip, when,
//! and what the hash is. The second is written last, so a backup that was cut off is none.

use std::path::{Path, PathBuf};

use pic32_icsp::{BOOT_BYTES, FlashImage, PROGRAM_BYTES};
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// The format of `NAME.toml`.
const FORMAT: u32 = 1;

/// What `NAME.toml` says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Label {
    format: u32,
    robot: String,
    /// Identity of the chip, as it told it.
    device_id: u32,
    /// When, UTC.
    date: String,
    bytes: usize,
    sha256: String,
}

/// A backup that is whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Backup {
    /// Its name.
    pub name: String,
    /// Identity of the chip.
    pub device_id: u32,
    /// What was in it.
    pub image: FlashImage,
}

/// Why a backup cannot be kept or used.
#[derive(Debug, thiserror::Error)]
pub enum BackupError {
    /// A file.
    #[error("{}: {error}", .path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// There is none.
    #[error("there is no backup in {}", .0.display())]
    None(PathBuf),
    /// Its label is not understood.
    #[error("{}: {error}", .path.display())]
    Label {
        /// Which.
        path: PathBuf,
        /// Why.
        error: String,
    },
    /// Its bytes are not those that were read then.
    #[error("{}: the bytes do not have the hash that was noted: the backup is damaged and is not used", .0.display())]
    Damaged(PathBuf),
}

/// A folder of backups.
#[derive(Clone, Debug)]
pub struct Backups {
    folder: PathBuf,
}

impl Backups {
    /// Backups in this folder; it is made with the first.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
        }
    }

    fn path(&self, name: &str, extension: &str) -> PathBuf {
        self.folder.join(format!("{name}.{extension}"))
    }

    /// Keeps what was in a chip; gives its name.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn keep(&self, device_id: u32, image: &FlashImage, date: &str) -> Result<String, BackupError> {
        let bytes = [image.program(), image.boot()].concat();
        let sha256 = hash_of(&bytes);
        let name = format!(
            "sr8730-{}-{}",
            date.replace(':', "-"),
            sha256.get(..8).unwrap_or_default()
        );
        let label = Label {
            format: FORMAT,
            robot: "sr8730".to_owned(),
            device_id,
            date: date.to_owned(),
            bytes: bytes.len(),
            sha256,
        };
        let label_path = self.path(&name, "toml");
        let text = toml::to_string(&label).map_err(|error| BackupError::Label {
            path: label_path.clone(),
            error: error.to_string(),
        })?;
        file(&self.folder, std::fs::create_dir_all(&self.folder))?;
        let bytes_path = self.path(&name, "bin");
        file(&bytes_path, kept_file::replace(&bytes_path, &bytes))?;
        file(&label_path, kept_file::replace(&label_path, text.as_bytes()))?;
        Ok(name)
    }

    /// Names of all backups, oldest first.
    ///
    /// # Errors
    /// When the folder cannot be read; one that does not exist has none.
    pub fn names(&self) -> Result<Vec<String>, BackupError> {
        let entries = match std::fs::read_dir(&self.folder) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => file(&self.folder, entries)?,
        };
        let mut names: Vec<String> = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
            .filter(|name| name.starts_with("sr8730-"))
            .collect();
        names.sort();
        Ok(names)
    }

    /// A backup, or the oldest: that is the maker's firmware.
    ///
    /// # Errors
    /// When there is none, or when it is not whole.
    pub fn load(&self, name: Option<&str>) -> Result<Backup, BackupError> {
        let name = match name {
            Some(name) => name.to_owned(),
            None => self
                .names()?
                .into_iter()
                .next()
                .ok_or_else(|| BackupError::None(self.folder.clone()))?,
        };
        let (label_path, bytes_path) = (self.path(&name, "toml"), self.path(&name, "bin"));
        let text = file(&label_path, kept_file::read_text(&label_path))?;
        let label: Label = toml::from_str(&text).map_err(|error| BackupError::Label {
            path: label_path,
            error: error.to_string(),
        })?;
        let bytes = file(&bytes_path, kept_file::read(&bytes_path))?;
        let is_whole =
            label.format == FORMAT && bytes.len() == label.bytes && hash_of(&bytes) == label.sha256;
        let image = (is_whole && bytes.len() == PROGRAM_BYTES + BOOT_BYTES)
            .then(|| bytes.split_at(PROGRAM_BYTES))
            .and_then(|(program, boot)| FlashImage::of(program, boot))
            .ok_or(BackupError::Damaged(bytes_path))?;
        Ok(Backup {
            name,
            device_id: label.device_id,
            image,
        })
    }
}

fn file<T>(path: &Path, outcome: std::io::Result<T>) -> Result<T, BackupError> {
    outcome.map_err(|error| BackupError::File {
        path: path.to_owned(),
        error,
    })
}

/// SHA-256 in hexadecimal digits.
pub(crate) fn hash_of(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
