//! Why the robot does not do what it was asked, in the words of Matter.

use rvac_api::{Failure, Trouble, explain};

use crate::text::{DETAILS_BYTES_MAX, cut};

/// `GenericFailure` of a change of mode.
const MODE_GENERIC: u8 = 0x02;
/// `InvalidInMode` of a change of mode.
const MODE_INVALID: u8 = 0x03;
/// `Stuck` and `BatteryLow`: the errors of a robot that a change of its run mode may end with.
const MODE_TROUBLES: [u8; 2] = [0x41, 0x48];
/// `UnableToStartOrResume` of a command.
const COMMAND_UNABLE: u8 = 0x01;
/// `CommandInvalidInState` of a command.
const COMMAND_INVALID: u8 = 0x03;

/// What was asked does not fit to what the robot does now; nothing is the matter with it.
const OF_THE_MOMENT: [&str; 12] = [
    "already-running",
    "job-runs",
    "no-job",
    "busy",
    "driver-busy",
    "being-calibrated",
    "docked",
    "charged",
    "planning",
    "ending",
    "no-error",
    "recharging",
];

/// A refusal of the daemon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Refusal {
    reason: String,
    text: String,
}

impl From<Failure> for Refusal {
    fn from(failure: Failure) -> Self {
        Self {
            reason: failure.reason,
            text: failure.text,
        }
    }
}

impl Refusal {
    /// One that the daemon has not said: it is away, or silent.
    pub(crate) fn without_daemon() -> Self {
        Self::because("no-daemon")
    }

    /// One for a reason of the catalogue.
    pub(crate) fn because(reason: &str) -> Self {
        Self {
            reason: reason.to_owned(),
            text: String::new(),
        }
    }

    /// What to do about it; what is the matter, where nothing helps or nothing is known to. One that is too long for a text of Matter is cut.
    pub(crate) fn text(&self) -> String {
        let told = explain(&self.reason);
        let remedy = told.map(|told| told.remedy).filter(|remedy| !remedy.is_empty());
        let cause = told.map(|told| told.cause);
        let said = (!self.text.is_empty()).then_some(self.text.as_str());
        let text = remedy.or(said).or(cause).unwrap_or(&self.reason);
        cut(text, DETAILS_BYTES_MAX)
    }

    /// `Status` of the answer to a change of the run mode.
    pub(crate) fn mode_status(&self) -> u8 {
        let error = self.trouble_error();
        match error.filter(|error| MODE_TROUBLES.contains(error)) {
            Some(error) => error,
            None if self.is_of_the_moment() => MODE_INVALID,
            None => MODE_GENERIC,
        }
    }

    /// `ErrorStateID` of the answer to a command.
    pub(crate) fn command_error(&self) -> u8 {
        match self.trouble_error() {
            Some(error) => error,
            None if self.is_of_the_moment() => COMMAND_INVALID,
            None => COMMAND_UNABLE,
        }
    }

    fn trouble_error(&self) -> Option<u8> {
        Trouble::of(&self.reason).map(|trouble| trouble.words().matter_error)
    }

    fn is_of_the_moment(&self) -> bool {
        OF_THE_MOMENT.contains(&self.reason.as_str())
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{Failure, explain, explanations};

    use super::{OF_THE_MOMENT, Refusal};

    #[test]
    fn every_code_of_the_catalogue_has_a_status_and_a_text_that_fit() {
        for (code, _) in explanations() {
            let refusal = Refusal::because(code);
            let mode = refusal.mode_status();
            assert!(matches!(mode, 0x02 | 0x03 | 0x41 | 0x48), "{code}: {mode}");
            let command = refusal.command_error();
            assert!(matches!(command, 0x01..=0x03 | 0x40..=0x4e), "{code}: {command}");
            let text = refusal.text();
            assert!(!text.is_empty() && text.len() <= 64, "{code}: {text}");
        }
        for code in OF_THE_MOMENT {
            assert!(explain(code).is_some(), "{code} stands in no catalogue");
        }
    }

    #[test]
    fn a_refusal_says_what_to_do() {
        let hangs = Refusal::because("wheel-drop");
        assert_eq!((hangs.mode_status(), hangs.command_error()), (0x41, 0x41));
        assert_eq!(hangs.text(), "Put the robot flat on the floor.");
        let low = Refusal::because("battery-low");
        assert_eq!((low.mode_status(), low.command_error()), (0x48, 0x48));
        let idle = Refusal::because("no-job");
        assert_eq!((idle.mode_status(), idle.command_error()), (0x03, 0x03));
        let no_dock = Refusal::because("dock-unknown");
        assert_eq!((no_dock.mode_status(), no_dock.command_error()), (0x02, 0x40));
        let of_tomorrow = Refusal::from(Failure {
            id: None,
            reason: "of-tomorrow".to_owned(),
            text: "The moon is in the way.".to_owned(),
        });
        assert_eq!(of_tomorrow.text(), "The moon is in the way.");
        assert_eq!(
            (of_tomorrow.mode_status(), of_tomorrow.command_error()),
            (0x02, 0x01)
        );
    }
}
