//! Whole jobs on the PIC32 of the SR8730, over any lines.

use calibration_values::{MAGIC, RECORD_ADDRESS};
use pic32_icsp::{
    ErasedFirst, FlashImage, IcspError, IcspPins, PAGE_BYTES, PROGRAM_BYTES, Programmer, Progress, Task,
};

use crate::arguments::Safeguards;
use crate::backups::{Backup, BackupError, Backups, hash_of};
use crate::hex::Piece;
use crate::journal::{Journal, WriteState};

/// Why a job was not done.
#[derive(Debug, thiserror::Error)]
pub enum JobError<E: std::fmt::Debug + std::fmt::Display + 'static> {
    /// The chip or its lines.
    #[error(transparent)]
    Chip(IcspError<E>),
    /// A backup.
    #[error(transparent)]
    Backup(#[from] BackupError),
    /// The journal cannot be written: nothing was touched.
    #[error("cannot write the journal: {0}; nothing was touched")]
    Journal(std::io::Error),
    /// Two readings differ.
    #[error(
        "two readings of the chip differ at {0:#010x}. Shorten the wires or choose a slower clock; nothing was kept"
    )]
    ReadingsDiffer(u32),
    /// No backup is there.
    #[error(
        "there is no backup of this robot: run `rvac flash backup` first. If you can do without the maker's firmware, say so with \
         --i-have-no-way-back"
    )]
    NoWayBack,
    /// The page of the calibration is in use by something else.
    #[error(
        "the last page of the chip's flash holds something that is no calibration: the firmware in it is not LibreRVAC's. Write that \
         first with `rvac flash write`; nothing was touched"
    )]
    PageOccupied,
    /// The backup is of another part.
    #[error("the backup is of a chip {backup:#010x}, and this one is {chip:#010x}")]
    OtherBackup {
        /// Of the backup.
        backup: u32,
        /// Of the chip.
        chip: u32,
    },
}

impl<E: std::fmt::Debug + std::fmt::Display + 'static> From<IcspError<E>> for JobError<E> {
    fn from(error: IcspError<E>) -> Self {
        Self::Chip(error)
    }
}

/// Why a file is no image for this chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageFault {
    /// It is for something else.
    #[error(
        "the file has bytes at {0:#010x}, where a PIC32MX360F256L has no flash: it is for another chip. Nothing was touched"
    )]
    OtherChip(u32),
    /// It has no program at the reset vector.
    #[error("the file has nothing at the reset vector: the robot would not start. Nothing was touched")]
    NoStart,
}

/// The content of a chip from the pieces of a file.
///
/// # Errors
/// When a byte has no place, or the program no start.
pub fn image_of(pieces: &[Piece]) -> Result<FlashImage, ImageFault> {
    let mut image = FlashImage::erased();
    for (address, bytes) in pieces {
        if !image.write(*address, bytes) {
            return Err(ImageFault::OtherChip(*address));
        }
    }
    match image.boot().first_chunk() {
        Some([0xFF, 0xFF, 0xFF, 0xFF]) | None => Err(ImageFault::NoStart),
        Some(_) => Ok(image),
    }
}

/// What a job needs besides the lines.
#[derive(Debug)]
pub struct Keeping {
    /// Where backups are.
    pub backups: Backups,
    /// What was written last.
    pub journal: Journal,
    /// Now, UTC.
    pub date: String,
}

type Shown<'a> = &'a mut dyn FnMut(Progress);

/// What the chip says it is. The program runs again afterwards.
///
/// # Errors
/// No chip, another one, or one that is protected.
pub fn probe<P: IcspPins>(pins: &mut P, shown: Shown<'_>) -> Result<u32, JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    let mut programmer = Programmer::new(pins, shown);
    let found = programmer.probe();
    programmer.release()?;
    Ok(found?)
}

/// Reads the chip twice, compares, and keeps it; gives the name of the backup.
///
/// # Errors
/// See [`JobError`]; nothing in the chip was changed.
pub fn backup<P: IcspPins>(
    pins: &mut P,
    keeping: &Keeping,
    shown: Shown<'_>,
) -> Result<String, JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    let mut programmer = Programmer::new(pins, shown);
    let device_id = programmer.probe()?;
    let first = programmer.read()?;
    // From a new entry, so that nothing that went wrong in the first can do so in the same way.
    programmer.probe()?;
    let second = programmer.read()?;
    programmer.release()?;
    if let Some(address) = first_difference(&first, &second) {
        return Err(JobError::ReadingsDiffer(address));
    }
    Ok(keeping.backups.keep(device_id, &first, &keeping.date)?)
}

fn first_difference(first: &FlashImage, second: &FlashImage) -> Option<u32> {
    let differs = |one: &[u8], other: &[u8], start: u32| {
        let at = one.iter().zip(other).position(|(one, other)| one != other)?;
        Some(start + u32::try_from(at).ok()?)
    };
    differs(first.program(), second.program(), pic32_icsp::PROGRAM_START)
        .or_else(|| differs(first.boot(), second.boot(), pic32_icsp::BOOT_START))
}

/// Writes an image and verifies it. A calibration that is in the chip stays, unless the whole chip is erased.
///
/// # Errors
/// See [`JobError`]. Refusals come before anything is touched; later errors leave a chip that can be written again.
pub fn write<P: IcspPins>(
    pins: &mut P,
    (image, safeguards): (&FlashImage, Safeguards),
    keeping: &Keeping,
    shown: Shown<'_>,
) -> Result<(), JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    if let Some(risk) = image.configuration_risk() {
        return Err(IcspError::Configuration(risk).into());
    }
    if !safeguards.no_way_back {
        match keeping.backups.load(None) {
            Err(BackupError::None(_)) => return Err(JobError::NoWayBack),
            outcome => outcome.map(|_| ())?,
        }
    }
    if safeguards.erase_chip {
        return put(pins, (image, safeguards), keeping, shown);
    }
    let image = with_calibration(&mut Programmer::new(pins, shown), image)?;
    put(pins, (&image, safeguards), keeping, shown)
}

/// Writes a backup back and verifies it, configuration words as they were.
///
/// # Errors
/// See [`JobError`].
pub fn restore<P: IcspPins>(
    pins: &mut P,
    (backup, safeguards): (&Backup, Safeguards),
    keeping: &Keeping,
    shown: Shown<'_>,
) -> Result<(), JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    if !safeguards.erase_chip {
        let chip = Programmer::new(pins, shown).probe()?;
        // Revisions may differ: a chip that was changed for another of its kind takes the firmware as well.
        if (chip ^ backup.device_id) & 0x0FFF_FFFF != 0 {
            return Err(JobError::OtherBackup {
                backup: backup.device_id,
                chip,
            });
        }
    }
    put(pins, (&backup.image, safeguards), keeping, shown)
}

/// The same for a chip that a write which was cut off may have left in any state: pages or configuration words that refuse are erased with
/// the whole chip.
///
/// # Errors
/// See [`JobError`].
pub fn bring_back<P: IcspPins>(
    pins: &mut P,
    backup: &Backup,
    keeping: &Keeping,
    shown: Shown<'_>,
) -> Result<(), JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    let whole = Safeguards {
        erase_chip: true,
        ..Safeguards::default()
    };
    match restore(pins, (backup, Safeguards::default()), keeping, &mut *shown) {
        Err(JobError::Chip(
            IcspError::CodeProtected | IcspError::FlashRefused { .. } | IcspError::Differs { .. },
        )) => restore(pins, (backup, whole), keeping, shown),
        outcome => outcome,
    }
}

/// Writes a calibration record and verifies it. The firmware stays, and begins anew with the values.
///
/// A supply that fails meanwhile leaves a page that holds anything: the firmware takes it for no calibration, and the robot does not
/// drive until the record is written again.
///
/// # Errors
/// See [`JobError`]. A page that holds something else is not touched.
pub fn write_calibration<P: IcspPins>(
    pins: &mut P,
    record: &[u8],
    keeping: &Keeping,
    shown: Shown<'_>,
) -> Result<(), JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    let mut programmer = Programmer::new(pins, shown);
    programmer.probe()?;
    let outcome = put_record(&mut programmer, record, keeping);
    programmer.release()?;
    outcome
}

fn put_record<P: IcspPins>(
    programmer: &mut Programmer<'_, P>,
    record: &[u8],
    keeping: &Keeping,
) -> Result<(), JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    let journal = &keeping.journal;
    let present = programmer.read_page(RECORD_ADDRESS)?;
    let is_erased = present.iter().all(|byte| *byte == 0xFF);
    let is_ours = present.starts_with(&MAGIC.to_le_bytes()) || journal.calibration_cut_off().is_some();
    if !is_erased && !is_ours {
        return Err(JobError::PageOccupied);
    }
    let mut page = [0xFF; PAGE_BYTES];
    for (place, byte) in page.iter_mut().zip(record) {
        *place = *byte;
    }
    journal
        .calibration(WriteState::Writing, &keeping.date)
        .map_err(JobError::Journal)?;
    programmer.write_page(RECORD_ADDRESS, &page)?;
    journal
        .calibration(WriteState::Verified, &keeping.date)
        .map_err(JobError::Journal)
}

/// The image with the calibration that is in the chip, if it has one and the image leaves its page free.
fn with_calibration<P: IcspPins>(
    programmer: &mut Programmer<'_, P>,
    image: &FlashImage,
) -> Result<FlashImage, IcspError<P::Error>> {
    let mut image = image.clone();
    let is_free = image
        .program()
        .iter()
        .skip(PROGRAM_BYTES - PAGE_BYTES)
        .all(|byte| *byte == 0xFF);
    if is_free {
        let page = programmer.read_page(RECORD_ADDRESS)?;
        if page.starts_with(&MAGIC.to_le_bytes()) {
            let fits = image.write(RECORD_ADDRESS, &page);
            debug_assert!(fits, "it is a page of flash");
        }
    }
    Ok(image)
}

fn put<P: IcspPins>(
    pins: &mut P,
    (image, safeguards): (&FlashImage, Safeguards),
    keeping: &Keeping,
    shown: Shown<'_>,
) -> Result<(), JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    let erased = match safeguards.erase_chip {
        true => ErasedFirst::Chip,
        false => ErasedFirst::Pages,
    };
    let mut programmer = Programmer::new(pins, shown);
    if erased == ErasedFirst::Pages {
        programmer.probe()?;
    }
    let sha256 = hash_of(&[image.program(), image.boot()].concat());
    keeping
        .journal
        .begin(&sha256, &keeping.date)
        .map_err(JobError::Journal)?;
    programmer.write(image, erased)?;
    programmer.verify(image)?;
    programmer.release()?;
    keeping
        .journal
        .verified(&sha256, &keeping.date)
        .map_err(JobError::Journal)
}

/// Compares the chip with an image; a calibration may be there besides.
///
/// # Errors
/// The first word that differs, or why it cannot be read.
pub fn verify<P: IcspPins>(
    pins: &mut P,
    image: &FlashImage,
    shown: Shown<'_>,
) -> Result<(), JobError<P::Error>>
where
    P::Error: std::fmt::Debug + std::fmt::Display,
{
    let mut programmer = Programmer::new(pins, shown);
    let outcome = with_calibration(&mut programmer, image).and_then(|image| programmer.verify(&image));
    programmer.release()?;
    Ok(outcome?)
}

/// The word for a task.
pub const fn word(task: Task) -> &'static str {
    match task {
        Task::Read => "read",
        Task::Write => "write",
        Task::Verify => "verify",
    }
}
