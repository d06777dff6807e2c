//! A robot's chip as this board is wired to it, for programs that write firmware as part of something larger.

use stc_isp::{Entry, Step};

use crate::arguments::Safeguards;
use crate::backups::{BackupError, Backups};
use crate::gpio_lines::GpioLines;
use crate::hex::{self, HexError};
use crate::journal::Journal;
use crate::line_loan::{LineLoan, LoanError, RobotAnswers};
use crate::relax::{self, KeptImages, LoaderJobError};
use crate::run::{DaemonSocket, now, shown_on_terminal};
use crate::serial_line::{SerialLine, SerialLineError};
use crate::settings::{FlashSettings, RobotName};
use crate::sr8730::{self, ImageFault, JobError, Keeping};

/// Why something was not done.
#[derive(Debug, thiserror::Error)]
pub enum WiredError {
    /// The daemon keeps its line.
    #[error(transparent)]
    Loan(#[from] LoanError),
    /// The lines of the board.
    #[error("cannot use the GPIO lines of [icsp]: {0}")]
    Lines(#[from] gpiocdev::Error),
    /// The serial line, or the power switch.
    #[error(transparent)]
    Serial(#[from] SerialLineError),
    /// The wiring has no such lines.
    #[error("the wiring has no [icsp]: the lines to the programming port")]
    NoLines,
    /// The file.
    #[error(transparent)]
    Hex(#[from] HexError),
    /// It is no image for this chip.
    #[error(transparent)]
    Image(#[from] ImageFault),
    /// A backup.
    #[error(transparent)]
    Backup(#[from] BackupError),
    /// The PIC32.
    #[error(transparent)]
    Sr8730(#[from] JobError<gpiocdev::Error>),
    /// The STC90.
    #[error(transparent)]
    Relax(#[from] LoaderJobError),
    /// An image that was written once is not there any more.
    #[error("the image {0} is not kept here, or is damaged")]
    NotKept(String),
}

/// The chip. Each call borrows the daemon's line and gives it back.
#[derive(Debug)]
pub struct WiredRobot {
    settings: FlashSettings,
    socket: DaemonSocket,
}

/// How the loader of the Relax is entered.
pub(crate) const fn entry_of(settings: &FlashSettings) -> Entry {
    match settings.power {
        Some(_) => Entry::PowerSwitch,
        None => Entry::Person,
    }
}

impl WiredRobot {
    /// The chip of this wiring. Nothing is opened yet.
    pub fn new(settings: FlashSettings, socket: DaemonSocket) -> Self {
        Self { settings, socket }
    }

    fn keeping(&self) -> Keeping {
        Keeping {
            backups: Backups::new(&self.settings.folder),
            journal: Journal::new(&self.settings.folder),
            date: now(),
        }
    }

    fn images(&self) -> KeptImages {
        KeptImages {
            folder: self.settings.folder.clone(),
            journal: Journal::new(&self.settings.folder),
            date: now(),
        }
    }

    fn on_sr8730<T>(
        &self,
        answers: RobotAnswers,
        job: impl FnOnce(&mut GpioLines, &Keeping) -> Result<T, JobError<gpiocdev::Error>>,
    ) -> Result<T, WiredError> {
        let lines = self.settings.icsp.as_ref().ok_or(WiredError::NoLines)?;
        let _loan = LineLoan::take(&self.socket.0, &self.settings.serial, answers)?;
        let mut lines = GpioLines::open(lines)?;
        Ok(job(&mut lines, &self.keeping())?)
    }

    fn on_relax<T>(
        &self,
        answers: RobotAnswers,
        job: impl FnOnce(&mut SerialLine, Entry) -> Result<T, LoaderJobError>,
    ) -> Result<T, WiredError> {
        let _loan = LineLoan::take(&self.socket.0, &self.settings.serial, answers)?;
        let mut line = SerialLine::open(&self.settings.serial, self.settings.power.as_ref())?;
        Ok(job(&mut line, entry_of(&self.settings))?)
    }

    /// Looks whether the file is an image for this chip, and whether the chip answers. Nothing is changed.
    ///
    /// # Errors
    /// Why it could not be written.
    pub fn check(&self, text: &str) -> Result<(), WiredError> {
        let pieces = hex::parse(text)?;
        match self.settings.robot {
            RobotName::Sr8730 => {
                sr8730::image_of(&pieces)?;
                self.on_sr8730(RobotAnswers::Expected, |lines, _| {
                    sr8730::probe(lines, &mut |_| {}).map(drop)
                })
            }
            // The loader would want the supply off and on; the chip's answer comes with the write, before anything is erased.
            RobotName::Relax => {
                relax::image_of(&pieces)?;
                LineLoan::take(&self.socket.0, &self.settings.serial, RobotAnswers::Expected)?;
                Ok(())
            }
        }
    }

    /// Hash of what was verified in the chip last.
    pub fn verified(&self) -> Option<String> {
        Journal::new(&self.settings.folder).last()?.last_verified
    }

    /// Keeps what is in the chip and gives its name; none for a chip that cannot be read and of which no image is known.
    ///
    /// # Errors
    /// When it cannot be read or kept.
    pub fn keep(&self) -> Result<Option<String>, WiredError> {
        match self.settings.robot {
            RobotName::Sr8730 => {
                let mut show = sr8730_progress();
                let name = self.on_sr8730(RobotAnswers::Expected, |lines, keeping| {
                    sr8730::backup(lines, keeping, &mut show)
                })?;
                Ok(Some(name))
            }
            RobotName::Relax => {
                let known = self.verified();
                Ok(known.filter(|sha256| self.images().load(sha256).is_some()))
            }
        }
    }

    /// Writes and verifies an image. A calibration in the chip stays.
    ///
    /// # Errors
    /// Why it is not there.
    pub fn write(&self, text: &str, answers: RobotAnswers) -> Result<(), WiredError> {
        let pieces = hex::parse(text)?;
        let safeguards = Safeguards {
            // Whoever writes has kept what was there, or has said that he can do without.
            no_way_back: true,
            erase_chip: false,
        };
        match self.settings.robot {
            RobotName::Sr8730 => {
                let image = sr8730::image_of(&pieces)?;
                let mut show = sr8730_progress();
                self.on_sr8730(answers, |lines, keeping| {
                    sr8730::write(lines, (&image, safeguards), keeping, &mut show)
                })
            }
            RobotName::Relax => self.write_relax(&relax::image_of(&pieces)?, answers),
        }
    }

    /// Writes and verifies what [`Self::keep`] named.
    ///
    /// # Errors
    /// Why it is not there.
    pub fn restore(&self, name: &str) -> Result<(), WiredError> {
        match self.settings.robot {
            RobotName::Sr8730 => {
                let backup = Backups::new(&self.settings.folder).load(Some(name))?;
                let mut show = sr8730_progress();
                self.on_sr8730(RobotAnswers::Silent, |lines, keeping| {
                    sr8730::bring_back(lines, &backup, keeping, &mut show)
                })
            }
            RobotName::Relax => {
                let image = self
                    .images()
                    .load(name)
                    .ok_or_else(|| WiredError::NotKept(name.to_owned()))?;
                self.write_relax(&image, RobotAnswers::Silent)
            }
        }
    }

    fn write_relax(&self, image: &[u8], answers: RobotAnswers) -> Result<(), WiredError> {
        let safeguards = Safeguards {
            no_way_back: true,
            erase_chip: false,
        };
        let images = self.images();
        let mut shown = shown_on_terminal();
        self.on_relax(answers, |line, entry| {
            relax::write(
                line,
                (image, safeguards, entry),
                &images,
                &mut |step, progress| {
                    if matches!(step, Step::Write { .. }) {
                        shown("write", progress);
                    }
                },
            )
            .map(drop)
        })
    }
}

fn sr8730_progress() -> impl FnMut(pic32_icsp::Progress) {
    let mut shown = shown_on_terminal();
    move |progress| {
        shown(
            sr8730::word(progress.task),
            (progress.done_bytes, progress.total_bytes),
        );
    }
}
