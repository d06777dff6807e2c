//! Readings from another program: a line for each change, `pad-0-axis-1 -0.5`, and `pad-0 gone` when a device is lost. Empty
//! lines and those that begin with `#` say nothing. The end of the input is the loss of everything.

use std::sync::mpsc::Sender;

use mixer::{Device, Source, SourceError};

use super::DriveEvent;
use crate::lines;

/// Why a line cannot be used.
#[derive(Debug, PartialEq, thiserror::Error)]
pub(super) enum LineError {
    /// It has not two words.
    #[error("`{0}`: write an input and what it reads, `pad-0-axis-1 -0.5`, or a device and `gone`")]
    Words(String),
    /// The input is none.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The input is made here.
    #[error("`{0}` cannot be moved: name an input of a device")]
    Unmovable(Source),
    /// There is no such device.
    #[error("`{0}` is no device: write pad-0 to pad-3, keyboard, touch or tilt")]
    Device(String),
    /// The reading is none.
    #[error("`{0}` is no reading: write a number")]
    Number(String),
}

/// Reads the input on a thread of its own.
pub(super) fn listen(events: Sender<DriveEvent>) {
    lines::read_input(
        events,
        |line| match parse(&line) {
            Ok(Some(event)) => event,
            Ok(None) => DriveEvent::Remark(String::new()),
            Err(error) => DriveEvent::Wrong(error),
        },
        || DriveEvent::Ended,
    );
}

/// What a line says; none for one that says nothing.
fn parse(line: &str) -> Result<Option<DriveEvent>, LineError> {
    let mut words = line.split_whitespace();
    let (first, second) = match (words.next(), words.next(), words.next()) {
        (None, _, _) => return Ok(None),
        (Some(first), _, _) if first.starts_with('#') => return Ok(None),
        (Some(first), Some(second), None) => (first, second),
        _ => return Err(LineError::Words(line.to_owned())),
    };
    if second == "gone" {
        return Ok(Some(DriveEvent::Gone(device(first)?)));
    }
    let source: Source = first.parse()?;
    // Inputs of other clients come from the robot, with their leases.
    if source.device().is_none() || matches!(source, Source::Client(_)) {
        return Err(LineError::Unmovable(source));
    }
    let value = second.parse::<f64>().ok().filter(|value| value.is_finite());
    let value = value.ok_or_else(|| LineError::Number(second.to_owned()))?;
    Ok(Some(DriveEvent::Moved(source, value)))
}

fn device(word: &str) -> Result<Device, LineError> {
    let all = (0..4)
        .map(Device::Pad)
        .chain([Device::Keyboard, Device::Touch, Device::Tilt]);
    all.into_iter()
        .find(|device| device.to_string() == word)
        .ok_or_else(|| LineError::Device(word.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::{DriveEvent, parse};

    #[test]
    fn lines_are_readings_losses_or_told_to_be_wrong() {
        let said = |line: &str| match parse(line) {
            Ok(Some(DriveEvent::Moved(source, value))) => format!("{source}={value}"),
            Ok(Some(DriveEvent::Gone(device))) => format!("{device} gone"),
            Ok(other) => format!("{other:?}"),
            Err(error) => error.to_string(),
        };
        assert_eq!(said("pad-0-axis-1  -0.5"), "pad-0-axis-1=-0.5");
        assert_eq!(said("keyboard gone"), "keyboard gone");
        assert_eq!(said(""), "None");
        assert_eq!(said("# a remark of three words"), "None");
        for (line, error) in [
            ("pad-0-axis-1", "`pad-0-axis-1`: write an input and what it reads"),
            ("pad-0-axis-1 NaN", "`NaN` is no reading"),
            ("always 1", "`always` cannot be moved"),
            ("client-steer 1", "`client-steer` cannot be moved"),
            ("pad-9 gone", "`pad-9` is no device"),
            ("stick 1", "`stick` is no input"),
        ] {
            assert!(said(line).starts_with(error), "{}", said(line));
        }
    }
}
