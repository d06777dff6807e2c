//! `pinout.toml`, as far as the emulated board needs it; `cargo xtask codegen` checks all of it.

use super::BoardError;
use super::wiring::DigitalLine;
use crate::pins::{Level, Pin};
use serde::Deserialize;

/// Level at which a signal means what its name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Active {
    High,
    Low,
    Unknown,
}

#[derive(Deserialize)]
struct RawPinout {
    chip: String,
    signal: Vec<RawSignal>,
}

#[derive(Deserialize)]
struct RawSignal {
    name: String,
    port: String,
    active: Active,
}

#[derive(Clone, Debug)]
struct Signal {
    name: String,
    pin: Pin,
    active: Active,
}

/// All signals of the board.
#[derive(Clone, Debug)]
pub(super) struct Pinout(Vec<Signal>);

const CHIP: &str = "stc90c58rd";

impl Pinout {
    /// Reads the text of a `pinout.toml`.
    pub(super) fn parse(text: &str) -> Result<Self, BoardError> {
        let format = |text: String| BoardError::Format(text.trim().replace('\n', " "));
        let raw: RawPinout = toml::from_str(text).map_err(|error| format(error.to_string()))?;
        if raw.chip != CHIP {
            let text = format!("it is for a {}, and only the {CHIP} is emulated here", raw.chip);
            return Err(BoardError::Format(text));
        }
        let signals = raw.signal.into_iter().map(signal).collect::<Result<_, _>>()?;
        Ok(Self(signals))
    }

    /// That of the Relax, which comes with the project.
    pub(super) fn relax() -> Result<Self, BoardError> {
        Self::parse(include_str!("../../../../robots/vileda-relax/pinout.toml"))
    }

    fn signal(&self, name: &'static str) -> Result<&Signal, BoardError> {
        let found = self.0.iter().find(|signal| signal.name == name);
        found.ok_or(BoardError::NoSignal(name))
    }

    /// The pin of a signal.
    pub(super) fn pin(&self, name: &'static str) -> Result<Pin, BoardError> {
        Ok(self.signal(name)?.pin)
    }

    /// A signal with the level that means "on".
    pub(super) fn line(&self, name: &'static str) -> Result<DigitalLine, BoardError> {
        let signal = self.signal(name)?;
        let active = match signal.active {
            Active::High => Level::High,
            Active::Low => Level::Low,
            Active::Unknown => return Err(BoardError::NoLevel(name)),
        };
        Ok(DigitalLine {
            pin: signal.pin,
            active,
        })
    }
}

fn signal(raw: RawSignal) -> Result<Signal, BoardError> {
    match raw.port.parse() {
        Ok(pin) => Ok(Signal {
            name: raw.name,
            pin,
            active: raw.active,
        }),
        Err(cause) => Err(BoardError::Port {
            signal: raw.name,
            cause,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::Pinout;
    use crate::board::{BoardError, Wiring};

    const FILE: &str = "chip = 'stc90c58rd'\n[[signal]]\nname = 'a'\nport = 'P1.3'\nactive = 'unknown'\n";

    #[test]
    fn what_is_wrong_is_named() {
        let pinout = Pinout::parse(FILE).unwrap();
        assert_eq!(pinout.pin("a").unwrap().to_string(), "P1.3");
        assert_eq!(pinout.line("a"), Err(BoardError::NoLevel("a")));
        assert_eq!(pinout.pin("b"), Err(BoardError::NoSignal("b")));
        for (from, to) in [
            ("stc90c58rd", "pic32"),
            ("P1.3", "P7.3"),
            ("unknown", "sometimes"),
            ("name", "nome"),
        ] {
            let message = Pinout::parse(&FILE.replace(from, to)).unwrap_err().to_string();
            assert!(message.contains(to) || message.contains(from), "{message}");
        }
    }

    #[test]
    fn the_project_s_own_pinout_is_sound() {
        assert!(Wiring::relax().is_ok());
    }
}
