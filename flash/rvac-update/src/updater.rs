//! The course of an update, and how one that was cut off ends.

use std::io::{self, Read, Seek, SeekFrom};

use update_bundle::{
    FIRMWARE_BYTES_MAX, ListedFile, Manifest, PublicKeys, VerifiedBundle, is_firmware, unpack, verify,
};

use crate::board::{Board, Health};
use crate::chip::{Attempt, Chip};
use crate::disk::Disk;
use crate::error::UpdateError;
use crate::journal::{Installed, InstalledFirmware, Pending, PendingStep};
use crate::slots::{Programs, Slots};

/// What stays free for maps and logs.
const SPARE_BYTES: u64 = 16 << 20;

/// What this robot takes.
#[derive(Debug)]
pub struct Accepted {
    /// Who may sign.
    pub keys: PublicKeys,
    /// Its name; none if nobody could tell.
    pub robot: Option<String>,
    /// The processor of its board.
    pub machine: String,
    /// Whether firmware is written.
    pub firmware: bool,
    /// Whether the chip's present content may be lost.
    pub way_back: WayBack,
}

/// Whether the chip's present content may be lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WayBack {
    /// Without one nothing is written.
    Needed,
    /// The owner can do without.
    None,
}

/// What the updater is about to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UpdateStep {
    /// Check the file.
    Verify,
    /// Nothing: the file is checked, and this is what it brings.
    Verified {
        /// Its epoch.
        epoch: u64,
        /// Its version.
        version: String,
        /// Whether the chip is written.
        flashes: bool,
    },
    /// Put its files into their folder.
    Unpack,
    /// Start its programs and wait for them.
    TryPrograms,
    /// Keep what is in the chip.
    KeepFirmware,
    /// Write the chip.
    WriteFirmware,
    /// Wait for the robot.
    TryFirmware,
    /// Go back.
    GoBack,
}

/// An update that is in use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// What is installed now.
    pub installed: Installed,
    /// Whether the robot's firmware was written.
    pub flashed: bool,
}

/// How an update that was cut off has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// There was none.
    Nothing,
    /// Everything is as it was before.
    WentBack,
    /// It is in use.
    WentOn,
}

/// One run.
#[derive(Debug)]
pub struct Updater<'a, D, B, C> {
    /// The folder of updates.
    pub slots: Slots,
    /// Files.
    pub disk: &'a mut D,
    /// Programs.
    pub board: &'a mut B,
    /// The robot's chip, if the board is wired to it.
    pub chip: Option<&'a mut C>,
}

/// An update that may be put in use, and what for.
struct Offer {
    bundle: VerifiedBundle,
    /// The image, unless it is in the chip already.
    hex: Option<Vec<u8>>,
    healthy: Health,
}

impl<D: Disk, B: Board, C: Chip> Updater<'_, D, B, C> {
    /// Puts an update in use, or leaves everything as it was.
    ///
    /// # Errors
    /// Why it is not in use. What begins with "refused" came before anything was touched.
    pub fn install(
        &mut self,
        archive: &mut (impl Read + Seek),
        accepted: &Accepted,
        say: &mut dyn FnMut(UpdateStep),
    ) -> Result<Outcome, UpdateError> {
        self.settle(say)?;
        say(UpdateStep::Verify);
        let offer = self.examine(archive, accepted)?;
        let manifest = &offer.bundle.manifest;
        say(UpdateStep::Verified {
            epoch: manifest.epoch,
            version: manifest.version.clone(),
            flashes: offer.hex.is_some(),
        });
        let before = self.slots.current();
        let mut pending = Pending {
            epoch: manifest.epoch,
            version: manifest.version.clone(),
            slot: before.spare(),
            before,
            firmware: None,
            step: PendingStep::Unpacking,
        };
        let outcome = self.put_in_use(archive, (&offer, &mut pending), (accepted.way_back, &mut *say));
        match outcome {
            Ok(outcome) => Ok(outcome),
            Err(cause) => {
                let cause = Box::new(cause);
                Err(match self.settle(say) {
                    Ok(Settled::WentOn) => UpdateError::WentOn(cause),
                    Ok(Settled::Nothing | Settled::WentBack) => UpdateError::WentBack(cause),
                    Err(error) => UpdateError::NotSettled {
                        cause,
                        error: Box::new(error),
                    },
                })
            }
        }
    }

    /// Everything that can be known before anything is touched.
    fn examine(
        &mut self,
        archive: &mut (impl Read + Seek),
        accepted: &Accepted,
    ) -> Result<Offer, UpdateError> {
        let mut images = Vec::new();
        rewind(archive)?;
        let bundle = verify(&mut *archive, &accepted.keys, &mut |listed, content| {
            keep_image(listed, content, &mut images)
        })?;
        let manifest = &bundle.manifest;
        let installed = self.slots.installed()?;
        self.compare(manifest, accepted, &installed)?;
        let listed = manifest.firmware_file().filter(|_| accepted.firmware);
        let mut hex = listed.and_then(|file| images.into_iter().find(|(path, _)| *path == file.path));
        if let (Some(file), Some((_, image))) = (listed, &hex) {
            let chip = self.chip.as_mut().ok_or(UpdateError::NoWiring)?;
            if is_in_the_chip(file, installed.firmware.as_ref(), chip.verified()) {
                hex = None;
            } else {
                chip.check(image)?;
            }
        }
        // With firmware the daemon has been asked for its line.
        if self.board.works() {
            return Err(UpdateError::RobotWorks);
        }
        let healthy = Health {
            daemon: true,
            ..self.board.look()
        };
        Ok(Offer {
            bundle,
            hex: hex.map(|(_, image)| image),
            healthy,
        })
    }

    fn compare(
        &mut self,
        manifest: &Manifest,
        accepted: &Accepted,
        installed: &Installed,
    ) -> Result<(), UpdateError> {
        if manifest.machine != accepted.machine {
            return Err(UpdateError::OtherMachine {
                here: accepted.machine.clone(),
                offered: manifest.machine.clone(),
            });
        }
        let here = accepted.robot.clone().ok_or(UpdateError::RobotUnknown)?;
        if manifest.robot != here {
            let offered = manifest.robot.clone();
            return Err(UpdateError::OtherRobot { here, offered });
        }
        if manifest.epoch <= installed.epoch {
            return Err(UpdateError::OldEpoch {
                installed: installed.epoch,
                offered: manifest.epoch,
            });
        }
        let needed_bytes = manifest.total_bytes().saturating_add(SPARE_BYTES);
        let root = self.slots.root().to_owned();
        let free_bytes = self
            .disk
            .free_bytes(&root)
            .map_err(|error| UpdateError::File { path: root, error })?;
        if free_bytes < needed_bytes {
            return Err(UpdateError::DiskFull {
                needed_bytes,
                free_bytes,
            });
        }
        Ok(())
    }

    fn put_in_use(
        &mut self,
        archive: &mut (impl Read + Seek),
        (offer, pending): (&Offer, &mut Pending),
        (way_back, say): (WayBack, &mut dyn FnMut(UpdateStep)),
    ) -> Result<Outcome, UpdateError> {
        say(UpdateStep::Unpack);
        self.slots.note_pending(self.disk, pending)?;
        self.fill(archive, &offer.bundle, pending)?;
        // Unpacking takes a while, in which somebody may have sent it out.
        if self.board.works() {
            return Err(UpdateError::RobotWorks);
        }
        say(UpdateStep::TryPrograms);
        pending.step = PendingStep::Trying;
        self.slots.note_pending(self.disk, pending)?;
        self.start(Programs::Update(pending.slot))?;
        self.await_health(offer.healthy)?;
        if let (Some(hex), Some(file)) = (&offer.hex, offer.bundle.manifest.firmware_file()) {
            self.flash((hex, file), pending, (way_back, &mut *say))?;
            say(UpdateStep::TryFirmware);
            // A daemon that starts knows no robot from before.
            self.board.restart()?;
            self.await_health(Health {
                robot: true,
                ..offer.healthy
            })?;
        }
        let installed = self.confirm(pending)?;
        Ok(Outcome {
            installed,
            flashed: offer.hex.is_some(),
        })
    }

    /// Puts the files into the spare folder.
    fn fill(
        &mut self,
        archive: &mut (impl Read + Seek),
        bundle: &VerifiedBundle,
        pending: &Pending,
    ) -> Result<(), UpdateError> {
        let folder = self.slots.folder(pending.slot);
        self.remove(&folder)?;
        rewind(archive)?;
        unpack(archive, bundle, &mut |listed, content| {
            let mode = if listed.executable { 0o755 } else { 0o644 };
            self.disk.write(&folder.join(&listed.path), mode, content)
        })?;
        Ok(())
    }

    fn remove(&mut self, folder: &std::path::Path) -> Result<(), UpdateError> {
        self.disk.remove(folder).map_err(|error| UpdateError::File {
            path: folder.to_owned(),
            error,
        })
    }

    fn start(&mut self, programs: Programs) -> Result<(), UpdateError> {
        self.choose(programs)?;
        Ok(self.board.restart()?)
    }

    fn choose(&mut self, programs: Programs) -> Result<(), UpdateError> {
        self.slots
            .choose(self.disk, programs)
            .map_err(|error| UpdateError::File {
                path: self.slots.root().to_owned(),
                error,
            })
    }

    fn await_health(&mut self, wanted: Health) -> Result<(), UpdateError> {
        match self.board.wait_for(wanted).missing(wanted) {
            None => Ok(()),
            Some(what) => Err(UpdateError::Silent(what)),
        }
    }

    fn flash(
        &mut self,
        (hex, file): (&[u8], &ListedFile),
        pending: &mut Pending,
        (way_back, say): (WayBack, &mut dyn FnMut(UpdateStep)),
    ) -> Result<(), UpdateError> {
        let chip = self.chip.as_mut().ok_or(UpdateError::NoWiring)?;
        say(UpdateStep::KeepFirmware);
        let kept = chip.keep()?;
        if kept.is_none() && way_back == WayBack::Needed {
            return Err(UpdateError::NoWayBack);
        }
        say(UpdateStep::WriteFirmware);
        pending.step = PendingStep::Flashing {
            path: file.path.clone(),
            kept,
        };
        pending.firmware = Some(InstalledFirmware {
            file_sha256: file.sha256.clone(),
            verified: String::new(),
        });
        self.slots.note_pending(self.disk, pending)?;
        Ok(chip.write(hex, Attempt::First)?)
    }

    /// The update works: from now on nothing goes back.
    fn confirm(&mut self, pending: &Pending) -> Result<Installed, UpdateError> {
        let verified = self.chip.as_ref().and_then(|chip| chip.verified());
        let written = pending.firmware.clone().map(|firmware| InstalledFirmware {
            verified: verified.unwrap_or_default(),
            ..firmware
        });
        let installed = Installed {
            epoch: pending.epoch,
            version: pending.version.clone(),
            // An update that left the chip alone leaves what is known of it.
            firmware: match written {
                Some(firmware) => Some(firmware),
                None => self.slots.installed()?.firmware,
            },
            before: Some(pending.before),
            given_up: false,
        };
        self.slots.note_installed(self.disk, &installed)?;
        self.slots.forget_pending(self.disk)?;
        Ok(installed)
    }

    /// Brings an update that was cut off to an end. Programs are runnable after each step of it, and it can be cut off itself.
    ///
    /// # Errors
    /// When it must be tried again.
    pub fn settle(&mut self, say: &mut dyn FnMut(UpdateStep)) -> Result<Settled, UpdateError> {
        let Some(pending) = self.slots.pending()? else {
            return Ok(Settled::Nothing);
        };
        if self.slots.installed()?.epoch >= pending.epoch {
            self.slots.forget_pending(self.disk)?;
            return Ok(Settled::WentOn);
        }
        match &pending.step {
            PendingStep::Flashing { path, kept: None } => {
                say(UpdateStep::WriteFirmware);
                let place = self.slots.folder(pending.slot).join(path);
                let hex = std::fs::read(&place).map_err(|error| UpdateError::File { path: place, error })?;
                let chip = self.chip.as_mut().ok_or(UpdateError::NoWiring)?;
                chip.write(&hex, Attempt::Again)?;
                self.confirm(&pending)?;
                return Ok(Settled::WentOn);
            }
            PendingStep::Flashing { kept: Some(kept), .. } => {
                say(UpdateStep::GoBack);
                // The programs first: they are runnable whatever becomes of the chip.
                self.choose(pending.before)?;
                let chip = self.chip.as_mut().ok_or(UpdateError::NoWiring)?;
                chip.restore(kept)?;
                self.board.restart()?;
            }
            PendingStep::Trying => {
                say(UpdateStep::GoBack);
                self.start(pending.before)?;
            }
            PendingStep::Unpacking => {}
        }
        let folder = self.slots.folder(pending.slot);
        self.remove(&folder)?;
        self.slots.forget_pending(self.disk)?;
        Ok(Settled::WentBack)
    }
}

fn rewind(archive: &mut impl Seek) -> Result<(), UpdateError> {
    archive
        .seek(SeekFrom::Start(0))
        .map_err(|error| UpdateError::Bundle(update_bundle::BundleError::Unreadable(error)))?;
    Ok(())
}

/// Images are looked at before anything is touched; they are small.
fn keep_image(
    listed: &ListedFile,
    content: &mut dyn Read,
    images: &mut Vec<(String, Vec<u8>)>,
) -> io::Result<()> {
    if is_firmware(&listed.path) {
        let mut bytes = Vec::new();
        content.take(FIRMWARE_BYTES_MAX).read_to_end(&mut bytes)?;
        images.push((listed.path.clone(), bytes));
    }
    Ok(())
}

/// Whether an update has written this very file, and nobody anything since.
fn is_in_the_chip(
    file: &ListedFile,
    installed: Option<&InstalledFirmware>,
    verified: Option<String>,
) -> bool {
    installed.is_some_and(|installed| {
        installed.file_sha256 == file.sha256 && verified.as_ref() == Some(&installed.verified)
    })
}
