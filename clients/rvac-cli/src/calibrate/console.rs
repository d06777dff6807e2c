//! The steps of a calibration on the terminal.

use std::io::{self, Write as _};

use calibration::{CalibrationError, Danger, Question, Screen, Shown, Task};
use calibration_values::Item;

/// What answers a choice.
const CHOICE: &str = "[Enter = yes, a = again, s = skip, q = quit]";

/// The terminal. The robot's session lives on while somebody reads it.
#[derive(Debug)]
pub(super) struct TerminalScreen;

impl Screen for TerminalScreen {
    fn show(&mut self, shown: Shown<'_>) -> Result<(), CalibrationError> {
        let line = match shown {
            Shown::Value { number, of, item, .. } => format!(
                "\n{number} of {of}: {}, needed for {}\n  {}",
                item.name, item.needed_for, item.measure
            ),
            Shown::NotNeeded => "  not needed: cliff-emitter-line is 1".to_owned(),
            Shown::Ready(danger) => {
                if let Some(danger) = danger {
                    say(&format!("  {}", warning(danger)))?;
                }
                format!("  Ready? {CHOICE}")
            }
            Shown::Do(task) => wish(task),
            Shown::Ask(question) => question_words(question),
            Shown::Malformed(line) if line.chars().any(|one| one.is_ascii_digit()) => format!(
                "{line:?} is no whole number of at most nine digits. Type it again, without unit or point."
            ),
            Shown::Malformed(line) => format!("{line:?} is none of these."),
            Shown::Note(note) => format!("  {note}"),
            Shown::Keep { item, value } => {
                format!("  {} = {}. Keep it? {CHOICE}", item.name, item.shown(value))
            }
            Shown::Failed(error) => format!("  {error}. Once more? {CHOICE}"),
            Shown::Kept { item, value } => format!("  kept: {} = {}", item.name, item.shown(value)),
            // Who is beside the robot sees what it does, and a terminal that scrolls shows no figure that changes.
            Shown::HoldOn | Shown::Progress { .. } | Shown::Counts { .. } | Shown::Duty(_) => return Ok(()),
        };
        Ok(say(&line)?)
    }
}

/// Says a line.
pub(super) fn say(line: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "{line}").and_then(|()| out.flush())
}

/// What a person must know beforehand.
const fn warning(danger: Danger) -> &'static str {
    match danger {
        Danger::Moves => {
            "The robot will MOVE: put it on the floor with a metre free before it, and stay within reach."
        }
        Danger::Pulls => {
            "A wheel will PULL: keep fingers and hair out of it, and hold the robot so that it cannot get away."
        }
        Danger::Brush => {
            "The main brush will TURN: keep fingers and hair away from it, and the robot on the floor."
        }
    }
}

fn wish(task: Task) -> String {
    match task {
        Task::Push => {
            "Push it straight ahead along a measure, three metres if there is room, then press Enter."
        }
        Task::Spin => "Turn it ten times around on the spot, then press Enter.",
        Task::Roll(_) => "Turn the wheel forward by half a turn, then press Enter.",
        Task::LightFloor => "Put it on a light floor, then press Enter.",
        Task::DarkFloor => "Put it on the darkest floor you have, then press Enter.",
        Task::Drop => {
            "Hold all three sensors over the edge of a table, or lift it to your chest, then press Enter."
        }
        Task::FreeFront => "Leave a metre free around its front and step back, then press Enter.",
        Task::Paper { number, sensor, of } => {
            return format!(
                "Hold white paper flat against the {sensor} sensor ({number} of {of}, from the right), then press Enter."
            );
        }
        Task::HoldWheelRead => {
            "Hold the left wheel fast. After Enter it pulls; read the ammeter, type the mA, and Enter stops it."
        }
        Task::HoldWheel => "Hold the left wheel fast. After Enter it pulls for two seconds.",
    }
    .to_owned()
}

fn question_words(question: Question<'_>) -> String {
    match question {
        Question::DistanceMm => "How far did it go, in millimetres?",
        Question::AtRestMa => "What does the ammeter in the battery's line show at rest, in mA?",
        Question::PulledMa => "What did the ammeter show while it pulled, in mA?",
        Question::PackMv => "What does the multimeter show, in millivolts?",
        Question::RoomDc => "What does the room's thermometer show, in tenths of a degree?",
        Question::Value(item) => return value_words(item),
    }
    .to_owned()
}

/// A plain number has no unit.
fn value_words(item: &Item) -> String {
    match item.unit.as_str() {
        "1" => "The value, a whole number?".to_owned(),
        unit => format!("The value, in {unit}?"),
    }
}
