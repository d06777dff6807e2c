//! Finds and records the gyro module: which serial port, at what rate, and what it says at rest and in turns.

use std::path::Path;
use std::time::Duration;

use anyhow::{Context as _, bail};
use rvac_protocol::message::{ProbeTarget, Probed, ProbedContent};

use super::frames::{Frames, Recording};
use super::say;
use calibration::{Robot, Watch};

/// Ports of the chip.
const PORTS: [u8; 2] = [1, 2];
/// Rates that modules use.
const RATES: [u32; 8] = [9_600, 19_200, 38_400, 57_600, 115_200, 230_400, 4_800, 2_400];
/// How long each is listened to.
const TRY: Duration = Duration::from_millis(600);
/// Length of each part of the recording.
const PART: Duration = Duration::from_secs(8);
/// Bytes in a try below which no module sends.
const BYTES_MIN: usize = 10;

/// What a port gave in a while.
#[derive(Debug, Default)]
struct CapturedBytes {
    bytes: Vec<u8>,
    lost: u32,
    /// From the first piece to the last by the robot's clock, ms.
    span_ms: u32,
}

impl CapturedBytes {
    /// What the pieces hold, in their order; a gap on our own line is left out.
    fn join(pieces: Vec<Probed>) -> Self {
        let ends = pieces.first().zip(pieces.last());
        let mut heard = Self {
            span_ms: ends.map_or(0, |(first, last)| last.tick.since(first.tick)),
            ..Self::default()
        };
        for piece in pieces {
            if let ProbedContent::Serial(serial) = piece.content {
                heard.bytes.extend_from_slice(&serial.bytes);
                heard.lost = heard.lost.max(serial.lost);
            }
        }
        heard
    }
}

pub(super) fn run(robot: &mut Robot, file: &Path) -> anyhow::Result<()> {
    let (port, baud) = find(robot)?;
    say(&format!(
        "UART {port} at {baud} baud: bytes without a wrong stop bit."
    ))?;
    let target = ProbeTarget::Serial { port, baud };
    let mut part = |wish: &str| -> anyhow::Result<CapturedBytes> {
        say(&format!(
            "{wish}, within {} s; press Enter to begin.",
            PART.as_secs()
        ))?;
        if robot.next_line()?.is_none() {
            bail!("the input ended before the recording did; nothing was written");
        }
        Ok(CapturedBytes::join(robot.watch(target, &[], Watch::For(PART))?))
    };
    let rest = part("Leave the robot alone")?;
    let left = part("Turn it once around to the left (counter-clockwise), slowly")?;
    let right = part("Turn it once around to the right, slowly")?;
    let recording = Recording {
        part_s: f64::from(left.span_ms + right.span_ms) / 2_000.0,
        rest: rest.bytes,
        left: left.bytes,
        right: right.bytes,
    };
    save(&recording, file)?;
    match Frames::find(&recording) {
        Some(frames) => say(&frames.to_string()),
        None => say("No frames were recognized. The recording is worth more than nothing: send it in."),
    }?;
    say(&format!(
        "gyro-uart = {port}\ngyro-rate = {baud}\ngyro-frame: compare with robots/samsung-sr8730/gyro.md"
    ))
}

/// The port and rate at which most bytes come without errors: a wrong rate may give a few that only seem right.
fn find(robot: &mut Robot) -> anyhow::Result<(u8, u32)> {
    let mut any = 0;
    for port in PORTS {
        let mut best: Option<(u32, usize)> = None;
        for baud in RATES {
            let heard =
                CapturedBytes::join(robot.watch(ProbeTarget::Serial { port, baud }, &[], Watch::For(TRY))?);
            let count = heard.bytes.len();
            say(&format!(
                "UART {port}, {baud:6} baud: {count} bytes, {} wrong",
                heard.lost
            ))?;
            if count >= BYTES_MIN && heard.lost == 0 && best.is_none_or(|(_, most)| count > most) {
                best = Some((baud, count));
            }
            any += count;
        }
        if let Some((baud, _)) = best {
            return Ok((port, baud));
        }
    }
    match any {
        0 => bail!("neither UART hears anything: is the module fitted and its plug in?"),
        _ => bail!("something is heard, but no rate fits: at each of them bytes come with errors"),
    }
}

/// The three parts one after the other, each headed by its name and length.
fn save(recording: &Recording, file: &Path) -> anyhow::Result<()> {
    let mut bytes = Vec::new();
    for (name, part) in [
        ("rest", &recording.rest),
        ("left", &recording.left),
        ("right", &recording.right),
    ] {
        bytes.extend(format!("{name} {}\n", part.len()).as_bytes());
        bytes.extend(part);
        bytes.push(b'\n');
    }
    std::fs::write(file, bytes).with_context(|| format!("cannot write {}", file.display()))?;
    say(&format!("Recorded to {}.", file.display()))
}
