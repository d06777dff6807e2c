//! An update whose daemon fails again and again after it was found to work: the programs before it run again.
//!
//! systemd says when the daemon starts and how it ended. A *failure* is an end with an error within a minute of the start, or a start
//! that never came to an end of its own. Power that is cut off is none.

use serde::{Deserialize, Serialize};

use crate::disk::Disk;
use crate::error::UpdateError;
use crate::journal::{Installed, read, write};
use crate::slots::{Programs, Slots};

/// So many failures, one after the other, end the use of an update.
pub const FAILURES_MAX: u32 = 3;
/// Whoever has run so long had started well.
const STARTED_S: f64 = 60.0;
/// With this the daemon says that its configuration must be changed, which other programs would say, too.
const CONFIGURATION_STATUS: &str = "2";

/// A moment on the clock of this start of the board.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Which start of the board.
    pub boot: String,
    /// Seconds since then.
    pub s: f64,
}

/// How the daemon ended, in the words of systemd.
#[derive(Clone, Copy, Debug)]
pub struct DaemonEnd<'a> {
    /// `$SERVICE_RESULT`.
    pub result: &'a str,
    /// `$EXIT_STATUS`.
    pub status: &'a str,
}

impl DaemonEnd<'_> {
    fn is_failure(self) -> bool {
        self.result != "success" && (self.result, self.status) != ("exit-code", CONFIGURATION_STATUS)
    }
}

/// Starts of the daemon of the update in use.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Starts {
    /// Failures, one after the other.
    failures: u32,
    /// The last start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    began: Option<Moment>,
}

/// Counts the starts of the update in use.
#[derive(Debug)]
pub struct Fallback<'a, D> {
    /// The folder of updates.
    pub slots: &'a Slots,
    /// Files.
    pub disk: &'a mut D,
}

impl<D: Disk> Fallback<'_, D> {
    /// The update in use and what could run in its place; none when there is no choice, or while an update is being tried.
    fn choice(&self) -> Result<Option<(Installed, Programs)>, UpdateError> {
        let installed = self.slots.installed()?;
        let Some(before) = installed.before else {
            return Ok(None);
        };
        let can_start = match before {
            Programs::Package => true,
            Programs::Update(slot) => self.slots.folder(slot).join("bin/vthal").exists(),
        };
        let is_free = self.slots.pending()?.is_none() && self.slots.current() != Programs::Package;
        let has_choice = is_free && can_start && before != self.slots.current();
        Ok(has_choice.then_some((installed, before)))
    }

    fn starts(&self) -> Starts {
        // A count that cannot be read begins anew.
        read(self.slots.starts_path()).ok().flatten().unwrap_or_default()
    }

    /// The daemon is about to start.
    ///
    /// # Errors
    /// When a file cannot be read or written.
    pub fn daemon_starts(&mut self, now: Moment) -> Result<(), UpdateError> {
        if self.choice()?.is_none() {
            return Ok(());
        }
        let starts = Starts {
            began: Some(now),
            ..self.starts()
        };
        write(self.disk, self.slots.starts_path(), &starts)
    }

    /// The daemon has ended. Gives the update that is not in use any more because of it.
    ///
    /// # Errors
    /// When a file cannot be read or written.
    pub fn daemon_ended(
        &mut self,
        end: DaemonEnd<'_>,
        now: &Moment,
    ) -> Result<Option<Installed>, UpdateError> {
        let Some((installed, before)) = self.choice()? else {
            return Ok(None);
        };
        let starts = self.starts();
        let has_lived = starts
            .began
            .as_ref()
            .is_some_and(|began| began.boot == now.boot && now.s - began.s >= STARTED_S);
        let failures = match end.is_failure() {
            true if has_lived => 1,
            true => starts.failures + 1,
            false => 0,
        };
        if failures < FAILURES_MAX {
            let starts = Starts { failures, ..starts };
            write(self.disk, self.slots.starts_path(), &starts)?;
            return Ok(None);
        }
        self.slots
            .choose(self.disk, before)
            .map_err(|error| UpdateError::File {
                path: self.slots.root().to_owned(),
                error,
            })?;
        let given_up = Installed {
            before: None,
            given_up: true,
            ..installed
        };
        self.slots.note_installed(self.disk, &given_up)?;
        write(self.disk, self.slots.starts_path(), &Starts::default())?;
        Ok(Some(given_up))
    }
}
