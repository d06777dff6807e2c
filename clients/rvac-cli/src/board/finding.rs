//! What a check found: one line for people, with the remedy where there is something to do.

use serde::Serialize;

/// How it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Grade {
    /// As it should be.
    Good,
    /// The robot works, but something will surprise its owner.
    Warning,
    /// The robot will not work.
    Fault,
}

/// The outcome of one check.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Finding {
    /// What was checked, one word.
    pub(crate) check: &'static str,
    pub(crate) grade: Grade,
    /// What was found, or the cause of what is wrong.
    pub(crate) cause: String,
    /// What to do; empty when nothing is to be done.
    pub(crate) remedy: String,
}

impl Finding {
    pub(crate) fn good(check: &'static str, cause: impl Into<String>) -> Self {
        Self {
            check,
            grade: Grade::Good,
            cause: cause.into(),
            remedy: String::new(),
        }
    }

    pub(crate) fn warning(check: &'static str, cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            check,
            grade: Grade::Warning,
            cause: cause.into(),
            remedy: remedy.into(),
        }
    }

    pub(crate) fn fault(check: &'static str, cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            check,
            grade: Grade::Fault,
            cause: cause.into(),
            remedy: remedy.into(),
        }
    }

    /// One line for people.
    pub(crate) fn line(&self) -> String {
        let mark = match self.grade {
            Grade::Good => "ok",
            Grade::Warning => "note",
            Grade::Fault => "FAULT",
        };
        let remedy = if self.remedy.is_empty() {
            String::new()
        } else {
            format!(": {}", self.remedy)
        };
        let cause = self.cause.trim_end_matches('.');
        format!("{mark:5}  {:13}  {cause}{remedy}", self.check)
    }
}
