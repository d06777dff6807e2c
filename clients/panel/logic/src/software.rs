//! An update of the robot's software, as its page shows it: named steps, how far they are, and how it ended.

use rvac_api::{Activity, SoftwareUpdate, Status, UPDATE_BYTES_MAX, UpdateEnd, UpdateStage};

use crate::codes::refusal_text;
use crate::words::{SoftwareWords, Words};

/// How a step stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepState {
    /// It is over, and well.
    Done,
    /// It goes on.
    Now,
    /// The update ended with it.
    Failed,
    /// It has not begun.
    ToCome,
}

/// One step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UpdateRow {
    /// What is true after it.
    pub text: &'static str,
    /// How it stands.
    pub state: StepState,
}

/// All that is shown of an update.
#[derive(Clone, Debug, PartialEq)]
pub struct UpdateSight {
    /// The steps, in their order.
    pub rows: Vec<UpdateRow>,
    /// What goes on, or how it ended.
    pub headline: String,
    /// Why it ended so.
    pub why: Option<String>,
    /// Share of the whole, in percent; none when it has ended.
    pub percent: Option<u8>,
    /// It is in use.
    pub is_installed: bool,
}

/// The steps on the way there, in their order.
const STAGES: [UpdateStage; 7] = [
    UpdateStage::Receive,
    UpdateStage::Verify,
    UpdateStage::Unpack,
    UpdateStage::TryPrograms,
    UpdateStage::KeepFirmware,
    UpdateStage::WriteFirmware,
    UpdateStage::TryFirmware,
];

/// What is shown of an update.
#[must_use]
pub fn update_sight(words: &Words, told: &SoftwareUpdate) -> UpdateSight {
    let rows = rows(&words.software, told);
    let done = rows.iter().filter(|row| row.state == StepState::Done).count();
    // A step that goes on counts for nothing but its part that is known.
    let part = match told.stage {
        UpdateStage::Receive => received_share(told),
        _ => 0.0,
    };
    let share = (done as f64 + part) / rows.len().max(1) as f64;
    let why = told.end.filter(|end| *end != UpdateEnd::Installed).and_then(|_| {
        let reason = told.reason.as_deref()?;
        Some(refusal_text(
            words,
            reason,
            told.text.as_deref().unwrap_or(reason),
        ))
    });
    UpdateSight {
        rows,
        headline: headline(words, told),
        why,
        percent: told.end.is_none().then_some((100.0 * share).round() as u8),
        is_installed: told.end == Some(UpdateEnd::Installed),
    }
}

fn received_share(told: &SoftwareUpdate) -> f64 {
    match (told.bytes, told.total) {
        (Some(bytes), Some(total)) if total > 0 => (bytes as f64 / total as f64).min(1.0),
        _ => 0.0,
    }
}

fn rows(texts: &SoftwareWords, told: &SoftwareUpdate) -> Vec<UpdateRow> {
    let goes_back = told.stage == UpdateStage::GoBack;
    // Where it came to before it went back.
    let reached = match goes_back {
        true => told.failed.unwrap_or(UpdateStage::Verify),
        false => told.stage,
    };
    // Waiting for whoever installs it is part of the check for people.
    let reached = match reached {
        UpdateStage::HandOver => UpdateStage::Verify,
        other => other,
    };
    let has_failed = told.failed.is_some() || told.end.is_some_and(|end| end != UpdateEnd::Installed);
    let state_of = |stage: UpdateStage| match stage.cmp(&reached) {
        _ if told.end == Some(UpdateEnd::Installed) => StepState::Done,
        core::cmp::Ordering::Less => StepState::Done,
        core::cmp::Ordering::Equal if has_failed => StepState::Failed,
        core::cmp::Ordering::Equal => StepState::Now,
        core::cmp::Ordering::Greater => StepState::ToCome,
    };
    let writes = told.flashes != Some(false);
    let mut rows: Vec<UpdateRow> = STAGES
        .into_iter()
        .filter(|stage| writes || *stage < UpdateStage::KeepFirmware)
        .map(|stage| UpdateRow {
            text: text_of(texts, stage),
            state: state_of(stage),
        })
        .collect();
    let way_back = match told.end {
        None if goes_back => Some(StepState::Now),
        Some(UpdateEnd::WentBack | UpdateEnd::GivenUp) => Some(StepState::Done),
        Some(UpdateEnd::NotSettled) => Some(StepState::Failed),
        _ => None,
    };
    rows.extend(way_back.map(|state| UpdateRow {
        text: texts.go_back,
        state,
    }));
    rows
}

const fn text_of(texts: &SoftwareWords, stage: UpdateStage) -> &'static str {
    match stage {
        UpdateStage::Receive => texts.receive,
        UpdateStage::HandOver | UpdateStage::Verify => texts.verify,
        UpdateStage::Unpack => texts.unpack,
        UpdateStage::TryPrograms => texts.try_programs,
        UpdateStage::KeepFirmware => texts.keep_firmware,
        UpdateStage::WriteFirmware => texts.write_firmware,
        UpdateStage::TryFirmware => texts.try_firmware,
        UpdateStage::GoBack => texts.go_back,
    }
}

fn headline(words: &Words, told: &SoftwareUpdate) -> String {
    let texts = &words.software;
    let ended = match told.end {
        None => return goes_on(words, told),
        Some(UpdateEnd::Installed) => {
            let epoch = told.epoch.unwrap_or_default();
            let version = told.version.as_deref().unwrap_or_default();
            return texts.installed.fill([&epoch, &version]);
        }
        Some(UpdateEnd::Refused) => texts.refused,
        Some(UpdateEnd::WentBack) => texts.went_back,
        Some(UpdateEnd::WentOn) => texts.went_on,
        Some(UpdateEnd::NotSettled) => texts.not_settled,
        Some(UpdateEnd::CutOff) => texts.cut_off,
        Some(UpdateEnd::GivenUp) => texts.given_up,
    };
    ended.to_owned()
}

fn goes_on(words: &Words, told: &SoftwareUpdate) -> String {
    let texts = &words.software;
    let said = match told.stage {
        UpdateStage::Receive => {
            return texts
                .receiving
                .fill([&words.number(100.0 * received_share(told), 0)]);
        }
        UpdateStage::HandOver => texts.handing_over,
        UpdateStage::Verify => texts.verifying,
        UpdateStage::Unpack => texts.unpacking,
        UpdateStage::TryPrograms => texts.trying_programs,
        UpdateStage::KeepFirmware => texts.keeping_firmware,
        UpdateStage::WriteFirmware => texts.writing_firmware,
        UpdateStage::TryFirmware => texts.trying_firmware,
        UpdateStage::GoBack => texts.going_back,
    };
    said.to_owned()
}

/// How a step stands, for those who do not see its sign.
#[must_use]
pub const fn step_text(words: &Words, state: StepState) -> &'static str {
    match state {
        StepState::Done => words.software.done,
        StepState::Now => words.software.now,
        StepState::Failed => words.software.failed,
        StepState::ToCome => words.software.to_come,
    }
}

/// What is wrong with a file of this size, before it is sent.
#[must_use]
pub fn update_file_problem(words: &Words, bytes: u64) -> Option<String> {
    let most_mib = words.number((UPDATE_BYTES_MAX >> 20) as f64, 0);
    let is_one = (1..=UPDATE_BYTES_MAX).contains(&bytes);
    (!is_one).then(|| words.software.size.fill([&most_mib]))
}

/// Why no update can be sent now: the robot moves.
#[must_use]
pub fn update_obstacle(words: &Words, status: Option<&Status>) -> Option<&'static str> {
    let activity = status.and_then(|status| Activity::from_name(&status.state));
    let is_at_work = activity.is_some_and(Activity::moves);
    is_at_work.then_some(words.software.works)
}

#[cfg(test)]
mod tests {
    use rvac_api::{SoftwareUpdate, Status, UPDATE_BYTES_MAX, UpdateEnd, UpdateStage};

    use super::{StepState, UpdateSight, update_file_problem, update_obstacle, update_sight};
    use crate::words::Language;

    fn sight(told: &SoftwareUpdate) -> UpdateSight {
        update_sight(Language::English.words(), told)
    }

    /// A letter for each step.
    fn states(told: &SoftwareUpdate) -> String {
        let letter = |state| match state {
            StepState::Done => 'd',
            StepState::Now => 'n',
            StepState::Failed => 'f',
            StepState::ToCome => '.',
        };
        sight(told).rows.iter().map(|row| letter(row.state)).collect()
    }

    #[test]
    fn steps_go_from_one_to_the_next() {
        let at = SoftwareUpdate::at;
        for (stage, expected) in [
            (UpdateStage::Receive, "n......"),
            (UpdateStage::HandOver, "dn....."),
            (UpdateStage::Verify, "dn....."),
            (UpdateStage::TryPrograms, "dddn..."),
            (UpdateStage::WriteFirmware, "dddddn."),
        ] {
            assert_eq!(states(&at(stage)), expected, "{stage:?}");
        }
        let programs_alone = SoftwareUpdate {
            flashes: Some(false),
            ..at(UpdateStage::TryPrograms)
        };
        assert_eq!(states(&programs_alone), "dddn");
    }

    #[test]
    fn the_step_that_failed_and_the_way_back_are_shown() {
        let going_back = SoftwareUpdate {
            failed: Some(UpdateStage::TryFirmware),
            ..SoftwareUpdate::at(UpdateStage::GoBack)
        };
        assert_eq!(states(&going_back), "ddddddfn");
        assert!(sight(&going_back).percent.is_some());
        let back = going_back.ended(UpdateEnd::WentBack, "update-silent", "the robot does not answer");
        assert_eq!(states(&back), "ddddddfd");
        assert_eq!(sight(&back).percent, None);
        assert_eq!(sight(&back).why.as_deref(), Some("the robot does not answer"));
        let estonian = update_sight(Language::Estonian.words(), &back);
        assert!(estonian.why.is_some_and(|why| !why.contains("answer")));
        let refused = SoftwareUpdate::at(UpdateStage::Verify).ended(UpdateEnd::Refused, "update-old", "old");
        assert_eq!(states(&refused), "df.....");
    }

    #[test]
    fn one_that_is_in_use_has_all_its_steps_behind_it() {
        let told = SoftwareUpdate {
            epoch: Some(7),
            version: Some("0.7.0".to_owned()),
            flashes: Some(true),
            end: Some(UpdateEnd::Installed),
            ..SoftwareUpdate::at(UpdateStage::TryFirmware)
        };
        let seen = sight(&told);
        assert_eq!(states(&told), "ddddddd");
        assert!(seen.is_installed && seen.why.is_none());
        assert_eq!(seen.headline, "Update 7 is in use, version 0.7.0.");
    }

    #[test]
    fn a_file_that_comes_counts_in_percent() {
        let told = SoftwareUpdate {
            bytes: Some(50),
            total: Some(100),
            ..SoftwareUpdate::at(UpdateStage::Receive)
        };
        let seen = sight(&told);
        assert_eq!(seen.headline, "Receives the file: 50\u{a0}%");
        assert_eq!(seen.percent, Some(7), "half of one step of seven");
    }

    #[test]
    fn what_cannot_be_sent_is_said_before() {
        let words = Language::English.words();
        for (bytes, is_wrong) in [
            (0, true),
            (1, false),
            (UPDATE_BYTES_MAX, false),
            (UPDATE_BYTES_MAX + 1, true),
        ] {
            assert_eq!(update_file_problem(words, bytes).is_some(), is_wrong, "{bytes}");
        }
        let status = |state: &str| Status {
            state: state.to_owned(),
            ..Status::default()
        };
        assert!(update_obstacle(words, Some(&status("cleaning"))).is_some());
        assert!(update_obstacle(words, Some(&status("docked"))).is_none());
        assert!(update_obstacle(words, None).is_none());
    }
}
