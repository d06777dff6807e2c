//! The list of what is in an update.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

/// The format of the manifest.
pub const MANIFEST_FORMAT: u32 = 1;
/// Files of an update; today there are some forty.
const FILES_MAX: usize = 2_000;
/// One file.
const FILE_BYTES_MAX: u64 = 256 << 20;
/// An image as Intel HEX: a chip of 256 KiB takes 750 KiB.
pub const FIRMWARE_BYTES_MAX: u64 = 4 << 20;
/// A name in the header of a tar archive without extensions.
const PATH_BYTES_MAX: usize = 100;
/// Where images are.
const FIRMWARE_FOLDER: &str = "firmware/";
/// The daemon: without it there is no update.
const DAEMON: &str = "bin/vthal";

/// What is in an update, and for which robot and board.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// [`MANIFEST_FORMAT`].
    pub format: u32,
    /// Grows with each release: a lower one than what is installed is refused.
    pub epoch: u64,
    /// Version of daemon and panel, for people.
    pub version: String,
    /// The robot, as its firmware names itself.
    pub robot: String,
    /// The processor of the Linux board: arm, armv7, arm64 or amd64.
    pub machine: String,
    /// The robot's firmware, if there is one in it.
    pub firmware: Option<FirmwareImage>,
    /// All files, in their order in the archive.
    pub files: Vec<ListedFile>,
}

/// The firmware in an update.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FirmwareImage {
    /// Which of the files; Intel HEX.
    pub path: String,
    /// Its version, for people.
    pub version: String,
}

/// A file of an update.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ListedFile {
    /// Where it goes, below the folder of the update.
    pub path: String,
    /// Its length.
    pub bytes: u64,
    /// SHA-256 in hexadecimal digits.
    pub sha256: String,
    /// Whether it is a program.
    #[serde(default)]
    pub executable: bool,
}

/// Why a manifest that somebody signed is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ManifestFault {
    /// It is no manifest.
    #[error("{0}")]
    Json(String),
    /// It is newer than this program.
    #[error("its format is {0}, and this program knows {MANIFEST_FORMAT}: install the newer package first")]
    Format(u32),
    /// An update for everybody and nobody.
    #[error("{0} is empty")]
    Empty(&'static str),
    /// Too many files.
    #[error("it lists {0} files")]
    Files(usize),
    /// A path that leads elsewhere, or that is there twice.
    #[error("the path {0:?} is not plain, or is there twice")]
    Path(String),
    /// Too long a file.
    #[error("{0:?} is too long")]
    FileBytes(String),
    /// No daemon.
    #[error("it has no {DAEMON}")]
    NoDaemon,
    /// The firmware is not among the files in its folder.
    #[error("its firmware {0:?} is not among its files in {FIRMWARE_FOLDER}")]
    NoFirmware(String),
}

impl Manifest {
    /// Understands a manifest whose signature was checked.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(bytes: &[u8]) -> Result<Self, ManifestFault> {
        let manifest: Self =
            serde_json::from_slice(bytes).map_err(|error| ManifestFault::Json(error.to_string()))?;
        manifest.check().map(|()| manifest)
    }

    /// Looks for what no manifest may have.
    ///
    /// # Errors
    /// The first such thing.
    pub fn check(&self) -> Result<(), ManifestFault> {
        if self.format != MANIFEST_FORMAT {
            return Err(ManifestFault::Format(self.format));
        }
        let texts = [
            ("version", &self.version),
            ("robot", &self.robot),
            ("machine", &self.machine),
        ];
        if let Some((name, _)) = texts.iter().find(|(_, text)| text.is_empty()) {
            return Err(ManifestFault::Empty(name));
        }
        if self.files.len() > FILES_MAX {
            return Err(ManifestFault::Files(self.files.len()));
        }
        let mut seen = BTreeSet::new();
        for file in &self.files {
            if !is_plain(&file.path) || !seen.insert(file.path.as_str()) {
                return Err(ManifestFault::Path(file.path.clone()));
            }
            if file.bytes > FILE_BYTES_MAX {
                return Err(ManifestFault::FileBytes(file.path.clone()));
            }
        }
        if !seen.contains(DAEMON) {
            return Err(ManifestFault::NoDaemon);
        }
        match &self.firmware {
            Some(firmware) => self.check_firmware(firmware),
            None => Ok(()),
        }
    }

    fn check_firmware(&self, firmware: &FirmwareImage) -> Result<(), ManifestFault> {
        let is_listed = |file: &&ListedFile| file.path == firmware.path && is_firmware(&file.path);
        match self.files.iter().find(is_listed) {
            None => Err(ManifestFault::NoFirmware(firmware.path.clone())),
            Some(file) if file.bytes > FIRMWARE_BYTES_MAX => Err(ManifestFault::FileBytes(file.path.clone())),
            Some(_) => Ok(()),
        }
    }

    /// Bytes of all files.
    #[must_use]
    pub fn total_bytes(&self) -> u64 {
        self.files.iter().map(|file| file.bytes).sum()
    }

    /// The firmware's entry among the files.
    #[must_use]
    pub fn firmware_file(&self) -> Option<&ListedFile> {
        let firmware = self.firmware.as_ref()?;
        self.files.iter().find(|file| file.path == firmware.path)
    }
}

/// Whether a path is that of an image.
#[must_use]
pub fn is_firmware(path: &str) -> bool {
    path.starts_with(FIRMWARE_FOLDER)
}

/// Whether a path stays below the folder, and can be read by people: folders and a name of letters, digits, `.`, `-` and `_`, none of them
/// hidden.
fn is_plain(path: &str) -> bool {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"._-".contains(&byte);
    path.len() <= PATH_BYTES_MAX
        && path
            .split('/')
            .all(|part| !part.is_empty() && !part.starts_with('.') && part.bytes().all(plain))
}

#[cfg(test)]
mod tests {
    use super::{FirmwareImage, ListedFile, MANIFEST_FORMAT, Manifest, ManifestFault, is_plain};

    fn listed(path: &str) -> ListedFile {
        ListedFile {
            path: path.to_owned(),
            bytes: 4,
            sha256: "00".to_owned(),
            executable: false,
        }
    }

    fn manifest() -> Manifest {
        Manifest {
            format: MANIFEST_FORMAT,
            epoch: 1,
            version: "1".to_owned(),
            robot: "sr8730".to_owned(),
            machine: "arm".to_owned(),
            firmware: None,
            files: vec![listed("bin/vthal")],
        }
    }

    #[test]
    fn only_paths_that_stay_below_are_plain() {
        for path in ["bin/vthal", "panel/a-b_c.wasm"] {
            assert!(is_plain(path), "{path}");
        }
        let long = "a".repeat(101);
        for path in [
            "",
            "/etc/passwd",
            "../x",
            "a/../b",
            "a//b",
            "a/",
            ".ssh/x",
            "a b",
            "\u{e4}",
            &long,
        ] {
            assert!(!is_plain(path), "{path}");
        }
    }

    #[test]
    fn what_no_manifest_may_have_is_named() {
        assert_eq!(manifest().check(), Ok(()));
        let change = |change: fn(&mut Manifest)| {
            let mut changed = manifest();
            change(&mut changed);
            changed.check()
        };
        let twice = change(|one| one.files.push(listed("bin/vthal")));
        assert_eq!(twice, Err(ManifestFault::Path("bin/vthal".to_owned())));
        assert_eq!(change(|one| one.files.clear()), Err(ManifestFault::NoDaemon));
        assert_eq!(change(|one| one.format = 2), Err(ManifestFault::Format(2)));
        assert_eq!(
            change(|one| one.robot.clear()),
            Err(ManifestFault::Empty("robot"))
        );
        let without = change(|one| {
            one.firmware = Some(FirmwareImage {
                path: "firmware/x.hex".to_owned(),
                version: "1".to_owned(),
            });
        });
        assert_eq!(
            without,
            Err(ManifestFault::NoFirmware("firmware/x.hex".to_owned()))
        );
        let long = change(|one| one.files.iter_mut().for_each(|file| file.bytes = u64::MAX));
        assert_eq!(long, Err(ManifestFault::FileBytes("bin/vthal".to_owned())));
    }
}
