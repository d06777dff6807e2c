//! What a procedure works with, and how it speaks to the person.

use rvac_protocol::message::{EncoderProbe, ProbeTarget, ProbedContent};

use calibration_values::{Catalog, Measurements};

use crate::arithmetic::{Wheels, travelled};
use crate::error::CalibrationError;
use crate::robot::Robot;
use crate::screen::{Question, Screen, Shown, Task};

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

/// See the module.
pub(crate) struct Bench<'a> {
    /// The robot.
    pub(crate) robot: &'a mut Robot,
    /// What can be measured.
    pub(crate) catalog: &'a Catalog,
    /// What was measured so far.
    pub(crate) measured: &'a Measurements,
    /// What the person sees.
    pub(crate) screen: &'a mut dyn Screen,
}

impl Bench<'_> {
    /// Waits until the person has done it.
    pub(crate) fn enter(&mut self, task: Task) -> Result<(), CalibrationError> {
        self.screen.show(Shown::Do(task))?;
        self.answer().map(drop)
    }

    /// The same while both wheels are counted; what they did from before to after.
    pub(crate) fn moved_by_hand(&mut self, task: Task) -> Result<Wheels<i64>, CalibrationError> {
        let before = self.totals()?;
        self.screen.show(Shown::Do(task))?;
        while !self.robot.has_line() {
            self.robot.pass(COUNTS_SHOWN)?;
            let Wheels { left, right } = travelled(before, self.totals()?);
            self.screen.show(Shown::Counts { left, right })?;
        }
        self.answer()?;
        Ok(travelled(before, self.totals()?))
    }

    fn totals(&mut self) -> Result<Wheels<i32>, CalibrationError> {
        match self.robot.probe(ProbeTarget::Encoders)? {
            ProbedContent::Encoders(EncoderProbe { left, right, .. }) => Ok(Wheels { left, right }),
            _ => Err(CalibrationError::OtherReading),
        }
    }

    /// Shows what waits for a choice, and waits for it.
    pub(crate) fn choose(&mut self, shown: Shown<'_>) -> Result<Wish, CalibrationError> {
        loop {
            self.screen.show(shown)?;
            match self.answer()?.as_str() {
                "" | "y" | "yes" => return Ok(Wish::Yes),
                "a" | "again" | "n" => return Ok(Wish::Again),
                "s" | "skip" => return Ok(Wish::Skip),
                other => self.screen.show(Shown::Malformed(other))?,
            }
        }
    }

    /// Asks for a whole number of at most nine digits, so that what is reckoned from it cannot overflow.
    pub(crate) fn number(&mut self, question: Question<'_>) -> Result<i64, CalibrationError> {
        loop {
            self.screen.show(Shown::Ask(question))?;
            let line = self.answer()?;
            match parse_number(&line) {
                Some(number) => return Ok(number),
                None => self.screen.show(Shown::Malformed(&line))?,
            }
        }
    }

    /// Waits until the person holds the motors on, where that is asked for.
    pub(crate) fn hold_on(&mut self) -> Result<(), CalibrationError> {
        if self.robot.is_held() {
            return Ok(());
        }
        self.screen.show(Shown::HoldOn)?;
        self.robot.await_hold()
    }

    /// What the person types; `q` and the end of the input end everything, with all that was kept in the file.
    fn answer(&mut self) -> Result<String, CalibrationError> {
        match self.robot.next_line()? {
            Some(line) if line == "q" || line == "quit" => Err(CalibrationError::Quit),
            Some(line) => Ok(line),
            None => Err(CalibrationError::Quit),
        }
    }
}

/// Pause between two counts that are shown.
const COUNTS_SHOWN: std::time::Duration = std::time::Duration::from_millis(200);

fn parse_number(line: &str) -> Option<i64> {
    const BELOW: i64 = 1_000_000_000;
    line.trim()
        .parse()
        .ok()
        .filter(|number| (1 - BELOW..BELOW).contains(number))
}

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
