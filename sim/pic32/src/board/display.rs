//! The display that sisters of the robot have, from the data of one of them. The SR8730's board has its lines, too.

use serde::Deserialize;

use super::BoardError;
use super::pinout::Pinout;
use super::wiring::DigitalLine;

const FILE: &str = "variants/sr8750.toml";

/// Lines of a display of four digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DisplayWiring {
    /// Commons of the digits, from the left.
    pub digits: [DigitalLine; 4],
    /// Segments a to g.
    pub segments: [DigitalLine; 7],
    /// Those of the segments' lines that light nothing else.
    pub own_segments: [DigitalLine; 2],
    /// The colon.
    pub colon: DigitalLine,
}

/// What of the file is wiring.
#[derive(Deserialize)]
struct Variant {
    display: Names,
}

#[derive(Deserialize)]
struct Names {
    digits: [String; 4],
    segments: [String; 7],
    colon: String,
}

impl DisplayWiring {
    /// The display of the SR8750 on a board.
    ///
    /// # Errors
    /// [`BoardError::Format`] when the project's own file is wrong, [`BoardError::NoLevel`], [`BoardError::NoSignal`].
    pub(super) fn of(pinout: &Pinout) -> Result<Self, BoardError> {
        let text = include_str!("../../../../robots/samsung-sr8730/variants/sr8750.toml");
        let wrong = |message: String| BoardError::Format {
            origin: FILE,
            message,
        };
        let Variant { display } =
            toml::from_str(text).map_err(|error| wrong(error.to_string().trim().replace('\n', " ")))?;
        let line = |name: &String| {
            let signal = pinout.signals().find(|signal| signal.name == *name);
            let line = signal.and_then(DigitalLine::of_signal);
            line.ok_or_else(|| wrong(format!("`{name}` is no line with an active level")))
        };
        Ok(Self {
            digits: all(&display.digits, line)?,
            segments: all(&display.segments, line)?,
            own_segments: [
                DigitalLine::of(pinout, "display-segment-a")?,
                DigitalLine::of(pinout, "display-segment-b")?,
            ],
            colon: line(&display.colon)?,
        })
    }
}

/// The lines of all names.
fn all<const N: usize>(
    names: &[String; N],
    line: impl Fn(&String) -> Result<DigitalLine, BoardError>,
) -> Result<[DigitalLine; N], BoardError> {
    let lines = names.iter().map(line).collect::<Result<Vec<_>, _>>()?;
    // As many lines as names went in.
    lines.try_into().map_err(|_| BoardError::NoSignal("display"))
}
