//! A Linux board and a robot for updates, whose power fails at any step.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Cursor, Read, Seek};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::signed_update::sign_and_pack;
use crate::update_model::{ModelBoard, ModelChip, ModelChipPort, RobotEnd};
use minisign::KeyPair;
use rvac_update::{
    Accepted, Chip, Disk, Outcome, Programs, RealDisk, Settled, Slots, UpdateError, Updater, WayBack,
};
use update_bundle::{FirmwareImage, MANIFEST_FORMAT, Manifest, PublicKeys, list_folder};

/// A folder that goes with the value; in memory where the system has such a place, because everything is flushed at once.
#[derive(Debug)]
pub struct UpdateFolder(PathBuf);

impl UpdateFolder {
    /// A new one.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn new() -> io::Result<Self> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let memory = Path::new("/dev/shm");
        let place = match memory.is_dir() {
            true => memory.to_owned(),
            false => std::env::temp_dir(),
        };
        let path = place.join(format!("update-{}-{number}", std::process::id()));
        fs::create_dir_all(&path)?;
        Ok(Self(path))
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for UpdateFolder {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).ok();
    }
}

/// The board's supply: it fails after so many steps.
#[derive(Debug, Default)]
pub struct Supply {
    used: Cell<u64>,
    lasts: Cell<Option<u64>>,
}

impl Supply {
    /// One step; every one after the cut fails, too.
    pub(crate) fn step(&self) -> io::Result<()> {
        let used = self.used.get();
        self.used.set(used + 1);
        match self.lasts.get() {
            Some(lasts) if used >= lasts => Err(io::Error::other("the supply has failed")),
            _ => Ok(()),
        }
    }

    /// Comes back, and lasts for so many steps.
    pub fn come_back(&self, lasts: Option<u64>) {
        self.used.set(0);
        self.lasts.set(lasts);
    }

    /// Fails now: something else has seen the end of it.
    pub fn fail(&self) {
        self.lasts.set(Some(0));
        self.used.set(1);
    }

    /// Steps since it came back.
    pub fn used(&self) -> u64 {
        self.used.get()
    }

    /// Whether it has failed.
    pub fn is_cut(&self) -> bool {
        self.lasts.get().is_some_and(|lasts| self.used.get() > lasts)
    }
}

/// Files that are half written when the supply fails, or when the disk is full.
#[derive(Debug)]
pub struct CutDisk {
    supply: Rc<Supply>,
    /// Bytes that fit still.
    pub room: u64,
    /// Bytes that are free by what the disk says.
    pub claimed: u64,
}

impl Disk for CutDisk {
    fn write(&mut self, path: &Path, mode: u32, content: &mut dyn Read) -> io::Result<()> {
        self.supply.step()?;
        let mut bytes = Vec::new();
        content.read_to_end(&mut bytes)?;
        let half = bytes.get(..bytes.len() / 2).unwrap_or_default();
        if let Err(error) = self.supply.step() {
            RealDisk.write(path, mode, &mut &half[..])?;
            return Err(error);
        }
        if bytes.len() as u64 > self.room {
            RealDisk.write(path, mode, &mut &half[..])?;
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.room -= bytes.len() as u64;
        RealDisk.write(path, mode, &mut &bytes[..])?;
        self.supply.step()
    }

    fn replace(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if let Err(error) = self.supply.step() {
            fs::create_dir_all(path.parent().unwrap_or(path))?;
            fs::write(path.with_extension("new"), &bytes[..bytes.len() / 2])?;
            return Err(error);
        }
        RealDisk.replace(path, bytes)?;
        self.supply.step()
    }

    fn point(&mut self, path: &Path, target: &Path) -> io::Result<()> {
        self.supply.step()?;
        RealDisk.point(path, target)?;
        self.supply.step()
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        if let Err(error) = self.supply.step() {
            // A folder goes file by file.
            fs::remove_dir_all(path.join("bin")).ok();
            return Err(error);
        }
        RealDisk.remove(path)?;
        self.supply.step()
    }

    fn free_bytes(&mut self, _: &Path) -> io::Result<u64> {
        Ok(self.claimed)
    }
}

/// What is in an update.
#[derive(Clone, Debug)]
pub struct Release {
    /// Its epoch.
    pub epoch: u64,
    /// Its robot.
    pub robot: &'static str,
    /// Its processor.
    pub machine: &'static str,
    /// The daemon's file.
    pub daemon: String,
    /// The panel server's file.
    pub panel: String,
    /// The firmware's file, if there is one.
    pub firmware: Option<String>,
}

impl Release {
    /// One that works, with firmware.
    pub fn good(epoch: u64) -> Self {
        Self {
            epoch,
            robot: "sr8730",
            machine: "arm",
            daemon: format!("daemon {epoch}"),
            panel: format!("panel {epoch}"),
            firmware: Some(format!("firmware {epoch}")),
        }
    }

    /// Its files, by their paths.
    fn files(&self) -> Vec<(&'static str, &str)> {
        let mut files = vec![
            ("bin/vthal", self.daemon.as_str()),
            ("bin/panel-server", &self.panel),
            ("panel/index.html", "<p>"),
        ];
        files.extend(self.firmware.as_deref().map(|text| ("firmware/robot.hex", text)));
        files
    }

    /// The archive, signed with this key.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn packed(&self, pair: &KeyPair) -> anyhow::Result<Vec<u8>> {
        let folder = UpdateFolder::new()?;
        for (path, text) in self.files() {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap_or(&path))?;
            fs::write(path, text)?;
        }
        let firmware = self.firmware.as_ref().map(|_| FirmwareImage {
            path: "firmware/robot.hex".to_owned(),
            version: self.epoch.to_string(),
        });
        let manifest = Manifest {
            format: MANIFEST_FORMAT,
            epoch: self.epoch,
            version: format!("0.{}.0", self.epoch),
            robot: self.robot.to_owned(),
            machine: self.machine.to_owned(),
            firmware,
            files: list_folder(folder.path())?,
        };
        let mut out = Vec::new();
        sign_and_pack(&mut out, (&manifest, pair), folder.path())?;
        Ok(out)
    }
}

/// A board with its robot.
#[derive(Debug)]
pub struct UpdateWorld<R, C> {
    folder: UpdateFolder,
    /// The supply of both.
    pub supply: Rc<Supply>,
    /// The robot, as the daemon hears it.
    pub robot: Rc<RefCell<R>>,
    /// The chip's port; none on a board that is not wired to it.
    pub chip: Option<C>,
    /// Room on the disk.
    pub room: u64,
    /// What the disk says of it.
    pub claimed_room: u64,
    runs: Programs,
}

impl UpdateWorld<ModelChip, ModelChipPort> {
    /// A board with the package's programs, and firmware in a chip that can be read.
    ///
    /// # Errors
    /// When its folder cannot be made.
    pub fn with_model() -> io::Result<Self> {
        let chip = ModelChip::with("firmware 0");
        let (supply, robot) = (Rc::new(Supply::default()), Rc::new(RefCell::new(chip)));
        let port = ModelChipPort {
            supply: Rc::clone(&supply),
            chip: Rc::clone(&robot),
        };
        Self::new((supply, robot), port)
    }
}

impl<R: RobotEnd, C: Chip> UpdateWorld<R, C> {
    /// A board with the package's programs.
    ///
    /// # Errors
    /// When its folder cannot be made.
    pub fn new((supply, robot): (Rc<Supply>, Rc<RefCell<R>>), chip: C) -> io::Result<Self> {
        Ok(Self {
            folder: UpdateFolder::new()?,
            supply,
            robot,
            chip: Some(chip),
            room: 1 << 30,
            claimed_room: 1 << 30,
            runs: Programs::Package,
        })
    }

    /// The folder of updates.
    pub fn slots(&self) -> Slots {
        Slots::at(self.folder.path())
    }

    fn with_updater<T>(&mut self, job: impl FnOnce(&mut Updater<'_, CutDisk, ModelBoard<R>, C>) -> T) -> T {
        let mut disk = CutDisk {
            supply: Rc::clone(&self.supply),
            room: self.room,
            claimed: self.claimed_room,
        };
        let mut board = ModelBoard {
            supply: Rc::clone(&self.supply),
            slots: self.slots(),
            runs: self.runs,
            robot: Rc::clone(&self.robot),
        };
        let slots = self.slots();
        let outcome = job(&mut Updater {
            slots,
            disk: &mut disk,
            board: &mut board,
            chip: self.chip.as_mut(),
        });
        self.runs = board.runs;
        outcome
    }

    /// Installs an archive.
    ///
    /// # Errors
    /// Why it is not in use.
    pub fn install(&mut self, archive: &[u8], accepted: &Accepted) -> Result<Outcome, UpdateError> {
        let mut archive = Cursor::new(archive);
        self.install_from(&mut archive, accepted)
    }

    /// The same from any file.
    ///
    /// # Errors
    /// Why it is not in use.
    pub fn install_from(
        &mut self,
        archive: &mut (impl Read + Seek),
        accepted: &Accepted,
    ) -> Result<Outcome, UpdateError> {
        self.with_updater(|updater| updater.install(archive, accepted, &mut |_| {}))
    }

    /// The board starts, and settles what was cut off.
    ///
    /// # Errors
    /// When it must be tried again.
    pub fn settle(&mut self) -> Result<Settled, UpdateError> {
        let outcome = self.with_updater(|updater| updater.settle(&mut |_| {}));
        if !self.supply.is_cut() {
            self.runs = self.slots().current();
        }
        outcome
    }

    /// What runs: the daemon's text, or nothing for the package's.
    pub fn daemon(&self) -> Option<String> {
        match self.runs {
            Programs::Package => None,
            Programs::Update(slot) => fs::read_to_string(self.slots().folder(slot).join("bin/vthal")).ok(),
        }
    }

    /// Whether what runs is whole: all files of this release, or the package.
    pub fn runs_whole(&self, releases: &[&Release]) -> bool {
        let Programs::Update(slot) = self.runs else {
            return true;
        };
        let folder = self.slots().folder(slot);
        releases.iter().any(|release| {
            release
                .files()
                .iter()
                .all(|(path, text)| fs::read_to_string(folder.join(path)).is_ok_and(|found| found == *text))
        })
    }

    /// All files of the folder of updates, with what is in them.
    pub fn files(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut files = BTreeMap::new();
        gather(self.folder.path(), &mut files);
        files
    }
}

fn gather(folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        match fs::read_link(&path) {
            Ok(target) => drop(files.insert(path, target.to_string_lossy().into_owned().into_bytes())),
            Err(_) if path.is_dir() => gather(&path, files),
            Err(_) => drop(files.insert(path.clone(), fs::read(&path).unwrap_or_default())),
        }
    }
}

/// What an SR8730 on a Pi Zero takes, from whoever has this key.
///
/// # Panics
/// Never: the key is one.
pub fn accepted(pair: &KeyPair) -> Accepted {
    Accepted {
        keys: PublicKeys::parse(&[pair.pk.to_base64()]).expect("a key"),
        robot: Some("sr8730".to_owned()),
        machine: "arm".to_owned(),
        firmware: true,
        way_back: WayBack::Needed,
    }
}

/// A key pair.
///
/// # Panics
/// When the system has no random numbers.
pub fn key_pair() -> KeyPair {
    KeyPair::generate_unencrypted_keypair().expect("random numbers")
}
