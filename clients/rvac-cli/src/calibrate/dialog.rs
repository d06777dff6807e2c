//! What is said to the person, and what the person answers.

use std::io::Write as _;

use anyhow::bail;

use crate::robot::Robot;

/// What a person wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wish {
    /// Go on, or keep what was measured.
    Yes,
    /// Once more.
    Again,
    /// Leave this one out.
    Skip,
}

/// Questions and answers over the terminal; the robot's session lives on meanwhile.
pub(crate) struct Dialog;

impl Dialog {
    /// Says a line.
    pub(crate) fn say(line: &str) -> std::io::Result<()> {
        let mut out = std::io::stdout().lock();
        writeln!(out, "{line}").and_then(|()| out.flush())
    }

    /// Waits for Enter.
    pub(crate) fn enter(robot: &mut Robot, wish: &str) -> anyhow::Result<()> {
        Self::say(wish)?;
        Self::line(robot).map(drop)
    }

    /// Asks what to do; Enter means yes.
    pub(crate) fn choose(robot: &mut Robot, question: &str) -> anyhow::Result<Wish> {
        loop {
            Self::say(&format!(
                "{question} [Enter = yes, a = again, s = skip, q = quit]"
            ))?;
            match Self::line(robot)?.as_str() {
                "" | "y" | "yes" => return Ok(Wish::Yes),
                "a" | "again" | "n" => return Ok(Wish::Again),
                "s" | "skip" => return Ok(Wish::Skip),
                other => Self::say(&format!("{other:?} is none of these."))?,
            }
        }
    }

    /// Asks for a whole number.
    pub(crate) fn number(robot: &mut Robot, question: &str) -> anyhow::Result<i64> {
        loop {
            Self::say(question)?;
            let line = Self::line(robot)?;
            match line.parse() {
                Ok(number) => return Ok(number),
                Err(_) => Self::say(&format!("{line:?} is no whole number."))?,
            }
        }
    }

    /// What the person types; `q` and the end of the input end everything, with all that was kept in the file.
    fn line(robot: &mut Robot) -> anyhow::Result<String> {
        match robot.next_line()? {
            Some(line) if line == "q" || line == "quit" => bail!(Quit),
            Some(line) => Ok(line),
            None => bail!(Quit),
        }
    }
}

/// The person wants to end; no fault.
#[derive(Debug, thiserror::Error)]
#[error("ended; what was kept is in the file")]
pub(crate) struct Quit;
