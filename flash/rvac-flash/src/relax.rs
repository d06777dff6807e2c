//! Whole jobs on the STC90 of the Relax, over any serial line.

use std::path::{Path, PathBuf};

use stc_isp::{Action, Entry, Flasher, IspError, Job, Report, Step};

use crate::arguments::Safeguards;
use crate::backups::hash_of;
use crate::hex::Piece;
use crate::journal::Journal;

/// Bytes of program flash.
const CODE_BYTES: usize = 0x8000;

/// A serial line with the robot's supply, and the time.
pub trait IspLine {
    /// Why the line cannot be used.
    type Error: std::fmt::Display;

    /// Sends bytes, and returns when they have left.
    ///
    /// # Errors
    /// When the line is gone.
    fn send(&mut self, bytes: &[u8]) -> Result<(), Self::Error>;

    /// Bytes that came, after at most so long.
    ///
    /// # Errors
    /// When the line is gone.
    fn receive(&mut self, wait_ms: u64) -> Result<Vec<u8>, Self::Error>;

    /// Changes the rate.
    ///
    /// # Errors
    /// When the line does not have it.
    fn set_baud(&mut self, baud: u32) -> Result<(), Self::Error>;

    /// Switches the supply of the robot's main board, or asks a person to switch it off and on when nobody else can.
    ///
    /// # Errors
    /// When it cannot be switched.
    fn switch(&mut self, power: Power) -> Result<(), Self::Error>;

    /// Time since any fixed moment.
    fn now_ms(&self) -> u64;
}

/// What happens to the supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Power {
    /// Off.
    Off,
    /// On.
    On,
    /// A person is asked.
    ByPerson,
}

/// Why a job was not done.
#[derive(Debug, thiserror::Error)]
pub enum LoaderJobError {
    /// The chip.
    #[error(transparent)]
    Chip(#[from] IspError),
    /// The line.
    #[error("the serial line: {0}")]
    Line(String),
    /// A file of ours.
    #[error("{}: {error}", .path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// The image is for something else.
    #[error(
        "the file has bytes at {0:#010x}, and the chip has 32 KiB: it is for another chip. Nothing was touched"
    )]
    OtherChip(u32),
    /// The maker's firmware cannot be read.
    #[error(
        "this chip cannot be read, so the maker's firmware would be lost, and no image of ours is known to run on this robot. If you \
         can do without, say so with --i-have-no-way-back"
    )]
    NoWayBack,
}

/// The program from the pieces of a file, from address 0 to its last byte.
///
/// # Errors
/// When a byte has no place.
pub fn image_of(pieces: &[Piece]) -> Result<Vec<u8>, LoaderJobError> {
    let mut image = vec![0xFF; CODE_BYTES];
    let mut end = 0;
    for (address, bytes) in pieces {
        let start = *address as usize;
        let past = start.saturating_add(bytes.len());
        let place = image
            .get_mut(start..past)
            .ok_or(LoaderJobError::OtherChip(*address))?;
        place.copy_from_slice(bytes);
        end = end.max(past);
    }
    image.truncate(end);
    Ok(image)
}

/// Images that were written to this robot, by their hashes: with a chip that cannot be read they are the way back.
#[derive(Debug)]
pub struct KeptImages {
    /// Where they are.
    pub folder: PathBuf,
    /// What was written last.
    pub journal: Journal,
    /// Now, UTC.
    pub date: String,
}

impl KeptImages {
    fn path(&self, sha256: &str) -> PathBuf {
        self.folder.join(format!("relax-{sha256}.bin"))
    }

    /// The last image that was verified in this robot, if it is still here and whole.
    pub fn way_back(&self) -> Option<Vec<u8>> {
        self.load(&self.journal.last()?.last_verified?)
    }

    /// The image with this hash, if it is here and whole.
    pub fn load(&self, sha256: &str) -> Option<Vec<u8>> {
        let bytes = kept_file::read(&self.path(sha256)).ok()?;
        (hash_of(&bytes) == sha256).then_some(bytes)
    }

    fn keep(&self, image: &[u8]) -> Result<String, LoaderJobError> {
        let sha256 = hash_of(image);
        let path = self.path(&sha256);
        file(&self.folder, std::fs::create_dir_all(&self.folder))?;
        file(&path, kept_file::replace(&path, image))?;
        Ok(sha256)
    }
}

fn file<T>(path: &Path, outcome: std::io::Result<T>) -> Result<T, LoaderJobError> {
    outcome.map_err(|error| LoaderJobError::File {
        path: path.to_owned(),
        error,
    })
}

/// How far a conversation is: the step, bytes that are confirmed, and of how many.
type ShownStep<'a> = &'a mut dyn FnMut(Step, (usize, usize));

/// What the chip says it is.
///
/// # Errors
/// See [`LoaderJobError`]; nothing was changed.
pub fn probe<L: IspLine>(line: &mut L, entry: Entry, shown: ShownStep<'_>) -> Result<Report, LoaderJobError> {
    converse(line, Flasher::new(Job::Probe, entry, line.now_ms())?, shown)
}

/// Writes a program; each block is verified by the sum that the chip answers.
///
/// # Errors
/// See [`LoaderJobError`]. Refusals come before anything is touched; later errors leave a chip whose loader takes the next try.
pub fn write<L: IspLine>(
    line: &mut L,
    (image, safeguards, entry): (&[u8], Safeguards, Entry),
    keeping: &KeptImages,
    shown: ShownStep<'_>,
) -> Result<Report, LoaderJobError> {
    if !safeguards.no_way_back && keeping.way_back().is_none() {
        return Err(LoaderJobError::NoWayBack);
    }
    let flasher = Flasher::new(Job::Write(image.to_vec()), entry, line.now_ms())?;
    let sha256 = keeping.keep(image)?;
    let journal = &keeping.journal;
    file(&keeping.folder, journal.begin(&sha256, &keeping.date))?;
    let report = converse(line, flasher, shown)?;
    file(&keeping.folder, journal.verified(&sha256, &keeping.date))?;
    Ok(report)
}

/// Holds a conversation with the loader to its end.
///
/// # Errors
/// Why it failed.
pub fn converse<L: IspLine>(
    line: &mut L,
    mut flasher: Flasher,
    shown: ShownStep<'_>,
) -> Result<Report, LoaderJobError> {
    let lost = |error: L::Error| LoaderJobError::Line(error.to_string());
    loop {
        shown(flasher.step(), flasher.progress());
        match flasher.next_action(line.now_ms()) {
            Some(Action::Finish(report)) => return Ok(report),
            Some(Action::Fail(error)) => return Err(error.into()),
            Some(Action::Send(bytes)) => line.send(&bytes).map_err(lost)?,
            Some(Action::SetBaud(baud)) => line.set_baud(baud).map_err(lost)?,
            Some(Action::PowerOff) => line.switch(Power::Off).map_err(lost)?,
            Some(Action::PowerOn) => line.switch(Power::On).map_err(lost)?,
            Some(Action::AskForPowerCycle) => line.switch(Power::ByPerson).map_err(lost)?,
            None => {
                let wait_ms = flasher.wake_at_ms().saturating_sub(line.now_ms()).max(1);
                let bytes = line.receive(wait_ms).map_err(lost)?;
                flasher.receive(&bytes, line.now_ms());
            }
        }
    }
}
