//! `rvac flash`: reads, keeps, writes and restores the firmware of robots from their Linux board.
//!
//! The sequences are those of `pic32-icsp` and `stc-isp`. Here is what stands around them: the lines of the board, backups with
//! hashes, the journal that remembers a write which was cut off, refusals, progress, and the daemon, which lends its line meanwhile.
//! [`sr8730`] and [`relax`] are whole jobs over any lines, so that they run on simulated chips, too.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod arguments;
mod backups;
mod gpio_lines;
mod hex;
mod journal;
mod line_loan;
mod progress_line;
pub mod relax;
mod run;
mod serial_line;
mod settings;
pub mod sr8730;
mod wired_robot;

pub use arguments::{FlashJob, FlashVerb, Safeguards};
pub use backups::{Backup, BackupError, Backups};
pub use hex::{HexError, Piece, parse as parse_hex};
pub use journal::{Journal, JournalEntry, WriteState};
pub use line_loan::{LoanError, RobotAnswers};
pub use progress_line::progress_line;
pub use run::{DaemonSocket, run};
pub use serial_line::{SerialLine, SerialLineError};
pub use settings::{FlashSettings, RobotName, SettingsError};
pub use wired_robot::{WiredError, WiredRobot};
