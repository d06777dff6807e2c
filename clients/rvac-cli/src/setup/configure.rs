//! Writes the daemon's configuration, from the one that the package brings for a model.

use std::fs;
use std::io::Write as _;

use anyhow::{Context as _, bail};

use super::Chosen;
use super::find::USUAL_BAUD;
use crate::board::Board;

/// Where the daemon looks for it.
pub(super) const FILE: &str = "etc/vthal.toml";
/// The one that was there before.
const OLD: &str = "etc/vthal.toml.old";
/// What the package brings.
const SAMPLES: &str = "usr/share/librervac/configurations";
/// The line of a sample that names the serial device.
const SERIAL_LINE: &str = "serial = ";
/// The line of a sample that names a rate other than the usual one.
const BAUD_LINE: &str = "baud = ";

/// Writes it; one that was there is kept beside it.
pub(super) fn write(board: &Board, robot: &Chosen) -> anyhow::Result<()> {
    let sample = sample(board, &robot.model)?;
    let text = with_serial(&sample, &robot.serial.to_string_lossy(), robot.baud)?;
    let place = board.path(FILE);
    if place.exists() {
        fs::copy(&place, board.path(OLD))
            .context("cannot keep the old configuration as /etc/vthal.toml.old")?;
    }
    // Whole or not at all: a power cut in between must not leave half a file.
    let fresh = board.path("etc/vthal.toml.new");
    let mut file = fs::File::create(&fresh)
        .with_context(|| format!("cannot write {}: start it with sudo", fresh.display()))?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    fs::rename(&fresh, &place).with_context(|| format!("cannot write {}", place.display()))
}

/// The sample of a model: that whose description has its name.
fn sample(board: &Board, model: &str) -> anyhow::Result<String> {
    let mut known = Vec::new();
    for name in board.names(SAMPLES) {
        let Some(text) = board.text(&format!("{SAMPLES}/{name}")) else {
            continue;
        };
        let described = described_model(board, &text);
        if described.as_deref() == Some(model) {
            return Ok(text + "\n");
        }
        known.extend(described);
    }
    if known.is_empty() {
        bail!("/{SAMPLES} has no configurations: install the package librervac");
    }
    bail!(
        "there is no configuration for a {model}; there are some for {}",
        known.join(", ")
    )
}

/// The name in the description that a configuration points to.
fn described_model(board: &Board, configuration: &str) -> Option<String> {
    let table: toml::Table = configuration.parse().ok()?;
    let path = table.get("robot")?.get("description")?.as_str()?.to_owned();
    let description: toml::Table = board.text(&path)?.parse().ok()?;
    Some(description.get("name")?.as_str()?.to_owned())
}

/// The sample with this serial device, and with the rate at which the robot answered there.
fn with_serial(sample: &str, device: &str, baud: Option<u32>) -> anyhow::Result<String> {
    let mut replaced = 0;
    let names_rate = sample.lines().any(|line| line.starts_with(BAUD_LINE));
    let mut lines = Vec::new();
    for line in sample.lines() {
        if line.starts_with(SERIAL_LINE) {
            replaced += 1;
            lines.push(format!("{SERIAL_LINE}{}", toml::Value::from(device)));
            if let Some(baud) = baud.filter(|baud| !names_rate && *baud != USUAL_BAUD) {
                lines.push(format!("{BAUD_LINE}{baud}"));
            }
        } else if let Some(baud) = baud.filter(|_| line.starts_with(BAUD_LINE)) {
            lines.push(format!("{BAUD_LINE}{baud}"));
        } else {
            lines.push(line.to_owned());
        }
    }
    if replaced != 1 {
        bail!("the sample has {replaced} lines that name the serial device, and needs one");
    }
    Ok(lines.join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::with_serial;

    #[test]
    fn the_device_is_written_as_toml() {
        let sample = "[link]\nserial = \"/dev/serial0\"\nbaud = 1\n";
        assert_eq!(
            with_serial(sample, "/dev/a\"b", None).expect("one line"),
            "[link]\nserial = '/dev/a\"b'\nbaud = 1\n"
        );
        assert!(with_serial("[link]\n", "/dev/a", None).is_err());
    }

    #[test]
    fn the_rate_at_which_a_robot_answered_is_written() {
        let written = |sample, baud| with_serial(sample, "/dev/a", Some(baud)).expect("one line");
        let sr8730 = "[link]\nserial = \"/dev/serial0\"\n\n[socket]\n";
        assert_eq!(
            written(sr8730, 57_600),
            "[link]\nserial = \"/dev/a\"\nbaud = 57600\n\n[socket]\n"
        );
        assert_eq!(
            written(sr8730, 230_400),
            "[link]\nserial = \"/dev/a\"\n\n[socket]\n"
        );
        let relax = "[link]\nserial = \"/dev/serial0\"\nbaud = 38400\n";
        assert_eq!(
            written(relax, 38_400),
            "[link]\nserial = \"/dev/a\"\nbaud = 38400\n"
        );
        assert_eq!(
            written(relax, 230_400),
            "[link]\nserial = \"/dev/a\"\nbaud = 230400\n"
        );
    }
}
