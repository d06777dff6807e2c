//! What is said to the person, and what the person answers.

use std::io::Write as _;

use anyhow::bail;

use crate::robot::Robot;

/// What a person chose.
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

    /// Asks for a whole number of at most nine digits, so that what is reckoned from it cannot overflow.
    pub(crate) fn number(robot: &mut Robot, question: &str) -> anyhow::Result<i64> {
        loop {
            Self::say(question)?;
            let line = Self::line(robot)?;
            match parse_number(&line) {
                Some(number) => return Ok(number),
                None => Self::say(&format!(
                    "{line:?} is no whole number of at most nine digits. Type it again, without unit or point."
                ))?,
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

fn parse_number(line: &str) -> Option<i64> {
    const BELOW: i64 = 1_000_000_000;
    line.trim()
        .parse()
        .ok()
        .filter(|number| (1 - BELOW..BELOW).contains(number))
}

/// The person ends it; no fault.
#[derive(Debug, thiserror::Error)]
#[error("ended; what was kept is in the file")]
pub(crate) struct Quit;

#[cfg(test)]
mod tests {
    use super::parse_number;

    #[test]
    fn a_number_has_at_most_nine_digits() {
        assert_eq!(parse_number(" 16876 "), Some(16_876));
        assert_eq!(parse_number("-999999999"), Some(-999_999_999));
        for line in [
            "1000000000",
            "16876373999983414",
            "99999999999999999999",
            "16.9",
            "",
            "16876 mV",
        ] {
            assert_eq!(parse_number(line), None, "{line}");
        }
    }
}
