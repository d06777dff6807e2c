//! The tables of pins and calibration values for people, between two marks in the robot's README.

use super::calibration::Calibration;
use super::pinout::{Active, Confidence, Level, Pinout, Pull, Signal};
use anyhow::Context;
use std::fmt::Write;

const BEGIN: &str =
    "<!-- Between these marks: made by cargo xtask codegen from pinout.toml and robot.toml. -->";
const END: &str = "<!-- End of what cargo xtask codegen makes. -->";

/// The README with fresh tables.
pub(super) fn renewed(readme: &str, pinout: &Pinout, calibration: &Calibration) -> anyhow::Result<String> {
    let marks = || format!("the README needs the marks {BEGIN:?} and {END:?}");
    let (before, rest) = readme.split_once(BEGIN).with_context(marks)?;
    let (_, after) = rest.split_once(END).with_context(marks)?;
    let mut text = format!("{before}{BEGIN}\n\n");
    text.push_str(
        "| signal | port | pin | kind | active | pull | function | at start | how sure | notes |\n",
    );
    text.push_str("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for signal in &pinout.signals {
        writeln!(text, "{}", row(signal))?;
    }
    if !calibration.items.is_empty() {
        push_values(&mut text, calibration)?;
    }
    text.push('\n');
    text.push_str(END);
    text.push_str(after);
    Ok(text)
}

fn push_values(text: &mut String, calibration: &Calibration) -> std::fmt::Result {
    text.push_str(
        "\n| calibration value | unit | least | greatest | assumed until measured | how to measure |\n",
    );
    text.push_str("| --- | --- | --- | --- | --- | --- |\n");
    for item in &calibration.items {
        writeln!(text, "{}", item.row())?;
    }
    Ok(())
}

fn row(signal: &Signal) -> String {
    let Signal {
        name,
        port,
        pin,
        note,
        ..
    } = signal;
    let original = signal
        .original
        .as_ref()
        .map(|name| format!("{name}; "))
        .unwrap_or_default();
    let function = signal.function.as_deref().unwrap_or_default();
    let note = format!("{original}{note}");
    let note = note.trim_end_matches("; ").replace('|', "\\|");
    format!(
        "| `{name}` | {port} | {pin} | {} | {} | {} | {function} | {} | {} | {note} |",
        signal.kind.word(),
        active(signal.active),
        pull(signal.pull),
        signal.safe.map(level).unwrap_or_default(),
        confidence(signal.confidence),
    )
}

fn active(active: Active) -> &'static str {
    match active {
        Active::High => "high",
        Active::Low => "low",
        Active::Unknown => "?",
    }
}

fn level(level: Level) -> &'static str {
    match level {
        Level::High => "high",
        Level::Low => "low",
    }
}

fn pull(pull: Pull) -> &'static str {
    match pull {
        Pull::BoardUp => "up, board",
        Pull::ChipUp => "up, chip",
        Pull::None => "",
        Pull::Unknown => "?",
    }
}

fn confidence(confidence: Confidence) -> &'static str {
    match confidence {
        Confidence::Known => "known",
        Confidence::Estimated => "estimated",
        Confidence::Placeholder => "placeholder",
        Confidence::Unknown => "?",
    }
}
