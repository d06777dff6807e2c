//! What can be moved or pressed.

use core::fmt;
use core::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::{Name, NameError};

/// Pads are numbered 0..=3, in the order in which they were found.
const PADS: u8 = 4;
/// Axes of one pad.
pub(crate) const AXES: u8 = 16;
/// Buttons of one pad.
pub(crate) const BUTTONS: u8 = 32;
/// Longest name of a key.
const KEY_LENGTH_MAX: usize = 24;

/// Something that holds inputs and can be lost as a whole.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Device {
    /// A gamepad, by its number.
    Pad(u8),
    /// The keyboard.
    Keyboard,
    /// The stick on the screen.
    Touch,
    /// The device that is held in the hand and tilted.
    Tilt,
    /// An input that another client sends to the robot. It expires by itself.
    Client(Name),
}

/// A key by its place on the keyboard, as browsers name it in `KeyboardEvent.code`: `KeyW`, `ArrowUp`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct KeyCode(String);

impl KeyCode {
    /// The key with this code; none for what no browser says.
    #[must_use]
    pub fn new(code: &str) -> Option<Self> {
        let fits = (1..=KEY_LENGTH_MAX).contains(&code.len())
            && code.bytes().all(|byte| byte.is_ascii_alphanumeric());
        fits.then(|| Self(code.to_owned()))
    }

    /// A key of ours, which fits: a test reads every one.
    pub(crate) fn ours(code: &'static str) -> Self {
        Self(code.to_owned())
    }
}

/// One input. Spelled `always`, `pad-0-axis-1`, `pad-0-button-9`, `key-KeyW`, `touch-right`, `touch-up`, `tilt-forward`,
/// `tilt-left`, `client-NAME`, `switch-NAME`. Axes and buttons have the numbers of the "standard" mapping of the W3C.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Source {
    /// Fully on, always.
    Always,
    /// An axis of a pad; down and right are positive.
    PadAxis {
        /// Which pad.
        pad: u8,
        /// Which axis.
        axis: u8,
    },
    /// A button of a pad, 0..=1.
    PadButton {
        /// Which pad.
        pad: u8,
        /// Which button.
        button: u8,
    },
    /// A key.
    Key(KeyCode),
    /// The stick on the screen, right of its middle.
    TouchRight,
    /// The stick on the screen, above its middle.
    TouchUp,
    /// Top edge of the device tilted away from the person; a quarter turn is 1.
    TiltForward,
    /// Left edge of the device tilted down; a quarter turn is 1.
    TiltLeft,
    /// The value that another client sends under this name, -1..=1.
    Client(Name),
    /// A switch of the profile, 0 or 1.
    Switch(Name),
}

/// Why a text names no input.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SourceError {
    /// It has no form that is known.
    #[error(
        "`{0}` is no input: write always, pad-0-axis-1, pad-0-button-9, key-KeyW, touch-right, touch-up, tilt-forward, \
         tilt-left, client-NAME or switch-NAME"
    )]
    Unknown(String),
    /// A number is beyond what there is.
    #[error("`{text}` has the number {found}: take one below {below}")]
    Number {
        /// The whole text.
        text: String,
        /// The number in it.
        found: u32,
        /// The first number that is too large.
        below: u8,
    },
    /// The name of a switch or of a client's input is none.
    #[error(transparent)]
    Name(#[from] NameError),
}

impl fmt::Display for Device {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pad(pad) => write!(formatter, "pad-{pad}"),
            Self::Keyboard => formatter.write_str("keyboard"),
            Self::Touch => formatter.write_str("touch"),
            Self::Tilt => formatter.write_str("tilt"),
            Self::Client(name) => write!(formatter, "client-{name}"),
        }
    }
}

impl Source {
    /// The device that it belongs to; none for what cannot be lost.
    #[must_use]
    pub fn device(&self) -> Option<Device> {
        match self {
            Self::Always | Self::Switch(_) => None,
            Self::PadAxis { pad, .. } | Self::PadButton { pad, .. } => Some(Device::Pad(*pad)),
            Self::Key(_) => Some(Device::Keyboard),
            Self::TouchRight | Self::TouchUp => Some(Device::Touch),
            Self::TiltForward | Self::TiltLeft => Some(Device::Tilt),
            Self::Client(name) => Some(Device::Client(name.clone())),
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Always => formatter.write_str("always"),
            Self::PadAxis { pad, axis } => write!(formatter, "pad-{pad}-axis-{axis}"),
            Self::PadButton { pad, button } => write!(formatter, "pad-{pad}-button-{button}"),
            Self::Key(KeyCode(code)) => write!(formatter, "key-{code}"),
            Self::TouchRight => formatter.write_str("touch-right"),
            Self::TouchUp => formatter.write_str("touch-up"),
            Self::TiltForward => formatter.write_str("tilt-forward"),
            Self::TiltLeft => formatter.write_str("tilt-left"),
            Self::Client(name) => write!(formatter, "client-{name}"),
            Self::Switch(name) => write!(formatter, "switch-{name}"),
        }
    }
}

impl FromStr for Source {
    type Err = SourceError;

    fn from_str(text: &str) -> Result<Self, SourceError> {
        match text {
            "always" => return Ok(Self::Always),
            "touch-right" => return Ok(Self::TouchRight),
            "touch-up" => return Ok(Self::TouchUp),
            "tilt-forward" => return Ok(Self::TiltForward),
            "tilt-left" => return Ok(Self::TiltLeft),
            _ => {}
        }
        let unknown = || SourceError::Unknown(text.to_owned());
        if let Some(name) = text.strip_prefix("switch-") {
            return Ok(Self::Switch(Name::new(name)?));
        }
        if let Some(name) = text.strip_prefix("client-") {
            return Ok(Self::Client(Name::new(name)?));
        }
        if let Some(code) = text.strip_prefix("key-") {
            return KeyCode::new(code).map(Self::Key).ok_or_else(unknown);
        }
        let rest = text.strip_prefix("pad-").ok_or_else(unknown)?;
        let (pad, control) = rest.split_once('-').ok_or_else(unknown)?;
        let pad = number(text, pad, PADS)?;
        if let Some(axis) = control.strip_prefix("axis-") {
            let axis = number(text, axis, AXES)?;
            return Ok(Self::PadAxis { pad, axis });
        }
        let button = control.strip_prefix("button-").ok_or_else(unknown)?;
        let button = number(text, button, BUTTONS)?;
        Ok(Self::PadButton { pad, button })
    }
}

fn number(text: &str, digits: &str, below: u8) -> Result<u8, SourceError> {
    let is_plain =
        digits.bytes().all(|byte| byte.is_ascii_digit()) && (digits == "0" || !digits.starts_with('0'));
    let found = digits.parse::<u32>().ok().filter(|_| is_plain);
    let found = found.ok_or_else(|| SourceError::Unknown(text.to_owned()))?;
    u8::try_from(found)
        .ok()
        .filter(|number| *number < below)
        .ok_or_else(|| SourceError::Number {
            text: text.to_owned(),
            found,
            below,
        })
}

impl TryFrom<String> for Source {
    type Error = SourceError;

    fn try_from(text: String) -> Result<Self, SourceError> {
        text.parse()
    }
}

impl From<Source> for String {
    fn from(source: Source) -> Self {
        source.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::{Source, SourceError};

    #[test]
    fn every_spelling_comes_back() {
        for text in [
            "always",
            "pad-0-axis-1",
            "pad-3-button-31",
            "key-ArrowUp",
            "touch-right",
            "touch-up",
            "tilt-forward",
            "tilt-left",
            "client-front left",
            "switch-slow drive",
        ] {
            assert_eq!(
                text.parse::<Source>().map(|source| source.to_string()).as_deref(),
                Ok(text)
            );
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        for text in [
            "",
            "pad",
            "pad-0",
            "pad-0-hat-1",
            "pad-00-axis-1",
            "pad-+1-axis-1",
            "key-",
            "key-é",
            "switch-",
            "client-",
            "client-a/b",
        ] {
            let error = text.parse::<Source>().expect_err(text);
            assert!(!matches!(error, SourceError::Number { .. }), "{text}: {error}");
        }
        let error = "pad-4-axis-1".parse::<Source>().expect_err("there are four");
        assert_eq!(
            error.to_string(),
            "`pad-4-axis-1` has the number 4: take one below 4"
        );
    }
}
