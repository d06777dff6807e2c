//! `pinout.toml`: every signal of the board with its pin.

use serde::Deserialize;

use super::BoardError;
use crate::pins::{Level, Pin};

/// What a pin is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SignalKind {
    /// Digital input.
    Input,
    /// Digital output.
    Output,
    /// Analog input.
    Analog,
    /// Output of an output compare module.
    Pwm,
    /// Input of an input capture module.
    Capture,
    /// Unused, kept an input.
    Spare,
}

/// Level at which a signal means what its name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SignalLevel {
    /// The supply.
    High,
    /// Ground.
    Low,
    /// Nobody knows.
    Unknown,
}

impl SignalLevel {
    const fn inverted(self) -> Self {
        match self {
            Self::High => Self::Low,
            Self::Low => Self::High,
            Self::Unknown => Self::Unknown,
        }
    }
}

/// Pull of a line that is not driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pull {
    /// A resistor on the board, to the supply.
    BoardUp,
    /// The chip's weak pull-up of the change notice.
    ChipUp,
    /// Nothing.
    None,
    /// Nobody knows.
    Unknown,
}

/// Level of an output from the first instruction on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Safe {
    /// The supply.
    High,
    /// Ground.
    Low,
}

impl From<Safe> for Level {
    fn from(safe: Safe) -> Self {
        Self::of(safe == Safe::High)
    }
}

/// How far a row can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RowConfidence {
    /// Documented or measured.
    Known,
    /// Derived from something known.
    Estimated,
    /// Chosen so that there is something to work with.
    Placeholder,
    /// Nobody knows.
    Unknown,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawPinout {
    chip: String,
    #[serde(rename = "firmware")]
    _firmware: Option<String>,
    signal: Vec<RawSignal>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSignal {
    name: String,
    #[serde(rename = "original")]
    _original: Option<String>,
    port: String,
    #[serde(rename = "pin")]
    package_pin: u8,
    kind: SignalKind,
    active: SignalLevel,
    pull: Pull,
    function: Option<String>,
    safe: Option<Safe>,
    confidence: RowConfidence,
    #[serde(rename = "source")]
    _source: String,
    #[serde(rename = "note")]
    _note: Option<String>,
}

/// One signal of the board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PinoutSignal {
    /// What our software calls it.
    pub name: String,
    /// Where it is.
    pub pin: Pin,
    /// Pin of the 100-pin package.
    pub package_pin: u8,
    /// What it is for.
    pub kind: SignalKind,
    /// Level that means what the name says.
    pub active: SignalLevel,
    /// What holds it.
    pub pull: Pull,
    /// Function of the pin that is used, in the words of the chip's pin list.
    pub function: Option<String>,
    /// Level from the first instruction on, for outputs.
    pub safe: Option<Level>,
    /// How sure all this is.
    pub confidence: RowConfidence,
}

/// All signals of the board, in the order of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pinout {
    signals: Vec<PinoutSignal>,
}

const FILE: &str = "pinout.toml";
const CHIP: &str = "pic32mx360f256l";

impl Pinout {
    /// Reads the text of a `pinout.toml`.
    ///
    /// # Errors
    /// [`BoardError::Format`], [`BoardError::Port`] or [`BoardError::Twice`].
    pub fn parse(text: &str) -> Result<Self, BoardError> {
        let raw: RawPinout = toml::from_str(text).map_err(|error| BoardError::Format {
            origin: FILE,
            message: error.to_string().trim().replace('\n', " "),
        })?;
        if raw.chip != CHIP {
            return Err(BoardError::Format {
                origin: FILE,
                message: format!("it is for a {}, and only the {CHIP} is emulated", raw.chip),
            });
        }
        let mut pinout = Self { signals: Vec::new() };
        for row in raw.signal {
            pinout.add(signal(row)?)?;
        }
        Ok(pinout)
    }

    /// The pinout of the SR8730 that comes with the project.
    ///
    /// # Errors
    /// As [`Self::parse`], when the project's own file is wrong.
    pub fn sr8730() -> Result<Self, BoardError> {
        Self::parse(include_str!("../../../../robots/samsung-sr8730/pinout.toml"))
    }

    fn add(&mut self, signal: PinoutSignal) -> Result<(), BoardError> {
        let clash = |other: &&PinoutSignal| other.name == signal.name || other.pin == signal.pin;
        if let Some(first) = self.signals.iter().find(clash) {
            return Err(BoardError::Twice {
                first: first.name.clone(),
                second: signal.name,
            });
        }
        self.signals.push(signal);
        Ok(())
    }

    /// The signal of this name.
    ///
    /// # Errors
    /// [`BoardError::NoSignal`].
    pub fn signal(&self, name: &'static str) -> Result<&PinoutSignal, BoardError> {
        self.signals
            .iter()
            .find(|signal| signal.name == name)
            .ok_or(BoardError::NoSignal(name))
    }

    /// The board after a mistake in its wiring. What the mistake does not fit, it leaves alone.
    #[must_use]
    pub fn miswired(&self, mistake: &Miswiring) -> Self {
        let mut signals = self.signals.clone();
        match mistake {
            Miswiring::Swapped(one, other) => swap_pins(&mut signals, one, other),
            Miswiring::Inverted(name) => {
                for signal in signals.iter_mut().filter(|signal| signal.name == *name) {
                    signal.active = signal.active.inverted();
                }
            }
        }
        Self { signals }
    }

    /// All of them.
    pub fn signals(&self) -> impl Iterator<Item = &PinoutSignal> {
        self.signals.iter()
    }
}

/// A mistake in the wiring of a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Miswiring {
    /// The wires of these two signals are exchanged. With a spare pin as the other one, the wire is cut.
    Swapped(&'static str, &'static str),
    /// The signal means the opposite.
    Inverted(&'static str),
}

fn swap_pins(signals: &mut [PinoutSignal], one: &str, other: &str) {
    let place = |name: &str| signals.iter().position(|signal| signal.name == name);
    if let (Some(first), Some(second)) = (place(one), place(other)) {
        // A resistor stays at the chip's pin.
        let (pin, pull) = (signals[first].pin, signals[first].pull);
        (signals[first].pin, signals[first].pull) = (signals[second].pin, signals[second].pull);
        (signals[second].pin, signals[second].pull) = (pin, pull);
    }
}

fn signal(row: RawSignal) -> Result<PinoutSignal, BoardError> {
    let pin = row.port.parse().map_err(|cause| BoardError::Port {
        signal: row.name.clone(),
        cause,
    })?;
    Ok(PinoutSignal {
        name: row.name,
        pin,
        package_pin: row.package_pin,
        kind: row.kind,
        active: row.active,
        pull: row.pull,
        function: row.function,
        safe: row.safe.map(Level::from),
        confidence: row.confidence,
    })
}

#[cfg(test)]
mod tests {
    use super::{Miswiring, Pinout, PinoutSignal, SignalKind, SignalLevel};
    use crate::board::BoardError;
    use crate::pins::Level;

    const ROW: &str = "name = 'a'\nport = 'RG9'\npin = 14\nkind = 'output'\nactive = 'high'\npull = 'none'\nsafe = 'low'\nconfidence = 'known'\nsource = 's'\n";

    fn file(rows: &[&str]) -> String {
        let mut text = "chip = 'pic32mx360f256l'\n".to_owned();
        for row in rows {
            text += &format!("[[signal]]\n{row}");
        }
        text
    }

    #[test]
    fn a_row_becomes_a_signal() {
        let pinout = Pinout::parse(&file(&[ROW])).unwrap();
        let signal = pinout.signal("a").unwrap();
        assert_eq!(
            (signal.pin.to_string(), signal.package_pin),
            ("RG9".to_owned(), 14)
        );
        assert_eq!(
            (signal.kind, signal.active, signal.safe),
            (SignalKind::Output, SignalLevel::High, Some(Level::Low))
        );
        assert_eq!(pinout.signal("b"), Err(BoardError::NoSignal("b")));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let cases = [
            (
                file(&[ROW]).replace("pic32mx360f256l", "pic32mx795"),
                "pic32mx795",
            ),
            (file(&[&ROW.replace("RG9", "RH9")]), "RH9"),
            (file(&[&ROW.replace("RG9", "RG4")]), "RG4"),
            (file(&[&ROW.replace("'high'", "'sometimes'")]), "sometimes"),
            (file(&[ROW, ROW]), "`a` and `a`"),
            (file(&[ROW, &ROW.replace("'a'", "'b'")]), "`b` and `a`"),
            (file(&[&ROW.replace("pull = 'none'\n", "")]), "pull"),
            (file(&[&ROW.replace("safe", "save")]), "save"),
        ];
        for (text, named) in cases {
            let message = Pinout::parse(&text).unwrap_err().to_string();
            assert!(message.contains(named), "{message} does not name {named}");
        }
    }

    #[test]
    fn the_project_s_own_pinout_is_sound() {
        let pinout = Pinout::sr8730().unwrap();
        for signal in pinout.signals() {
            let drives = matches!(signal.kind, SignalKind::Output | SignalKind::Pwm);
            assert_eq!(signal.safe.is_some(), drives, "{}", signal.name);
        }
    }

    #[test]
    fn a_mistake_changes_only_what_it_names() {
        let pinout = Pinout::sr8730().unwrap();
        let swapped = pinout.miswired(&Miswiring::Swapped("bumper-left", "vacuum"));
        let [bumper, vacuum] = ["bumper-left", "vacuum"].map(|name| pinout.signal(name).unwrap().pin);
        assert_eq!(swapped.signal("bumper-left").unwrap().pin, vacuum);
        assert_eq!(swapped.signal("vacuum").unwrap().pin, bumper);
        let inverted = pinout.miswired(&Miswiring::Inverted("vacuum"));
        assert_ne!(
            inverted.signal("vacuum").unwrap().active,
            pinout.signal("vacuum").unwrap().active
        );
        let others = |name: &str| !["bumper-left", "vacuum"].contains(&name);
        for board in [swapped, inverted] {
            let same = |(one, other): (&PinoutSignal, &PinoutSignal)| one == other || !others(&one.name);
            assert!(board.signals().zip(pinout.signals()).all(same));
        }
    }
}
