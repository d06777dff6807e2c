//! `rvac packet`: one packet at a time, without a robot.

use std::io::{Read as _, Write as _, stdin, stdout};
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use rvac_protocol::crc::{Direction, packet_crc, to_hex};
use rvac_protocol::frame::{PACKET_BYTES_MAX, SEPARATOR, SEPARATOR_2016};

use crate::arguments::{DirectionName, PacketJob, PacketOptions, PacketVerb};
use crate::show::{Shown, Verdict, Viewer};

/// Bytes of a CRC in text: `*` and eight digits.
const CRC_BYTES: usize = 9;

pub(crate) fn run(job: &PacketJob) -> anyhow::Result<ExitCode> {
    match &job.verb {
        PacketVerb::Crc(options) => append_crc(options),
        PacketVerb::Check(options) => for_each_packet(options, |shown| {
            let good = matches!(shown.verdict, Verdict::Checked | Verdict::CheckedBeforeSession);
            (good, shown.verdict.in_words())
        }),
        PacketVerb::Decode(options) => for_each_packet(options, |shown| (shown.is_good(), explain(shown))),
    }
}

fn append_crc(options: &PacketOptions) -> anyhow::Result<ExitCode> {
    for packet in packets(options)? {
        if packet.len() + CRC_BYTES > PACKET_BYTES_MAX {
            bail!(
                "a packet has at most {PACKET_BYTES_MAX} bytes with its CRC, this one has {}",
                packet.len() + CRC_BYTES
            );
        }
        let digits = to_hex(packet_crc(direction(options), options.session, &packet));
        let mut line = packet;
        line.push(b'*');
        line.extend_from_slice(&digits);
        line.push(b'\n');
        stdout().write_all(&line)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn for_each_packet(
    options: &PacketOptions,
    judge: impl Fn(&Shown) -> (bool, String),
) -> anyhow::Result<ExitCode> {
    let mut all_good = true;
    for packet in packets(options)? {
        for shown in Viewer::new(direction(options), options.session).packets(&packet) {
            let (good, line) = judge(&shown);
            all_good &= good;
            writeln!(stdout(), "{line}")?;
        }
    }
    Ok(if all_good {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

fn explain(shown: &Shown) -> String {
    let mut lines = vec![format!("CRC:     {}", shown.verdict.in_words())];
    if !shown.text.is_empty() {
        let name = if shown.binary { "twin:   " } else { "text:   " };
        lines.push(format!("{name} {}", shown.text));
    }
    lines.push(match &shown.meaning {
        Ok(meaning) => format!("meaning: {meaning}"),
        Err(refusal) => format!("refused: {}", refusal.name()),
    });
    lines.join("\n")
}

/// The packets that are asked about, without separators.
fn packets(options: &PacketOptions) -> anyhow::Result<Vec<Vec<u8>>> {
    let mut input = Vec::new();
    match &options.packet {
        Some(packet) => input.extend_from_slice(packet.as_bytes()),
        None => drop(stdin().read_to_end(&mut input).context("cannot read the input")?),
    }
    let parts = input.split(|byte| matches!(*byte, b'\n' | SEPARATOR | SEPARATOR_2016));
    let parts = parts
        .map(|part| part.strip_suffix(b"\r").unwrap_or(part))
        .filter(|part| !part.is_empty());
    if options.hex {
        parts.map(unhex).collect()
    } else {
        Ok(parts.map(<[u8]>::to_vec).collect())
    }
}

fn unhex(text: &[u8]) -> anyhow::Result<Vec<u8>> {
    let digits: Vec<u8> = text
        .iter()
        .copied()
        .filter(|byte| !byte.is_ascii_whitespace())
        .collect();
    let byte = |pair: &[u8]| {
        let pair = std::str::from_utf8(pair).ok()?;
        if pair.len() == 2 {
            u8::from_str_radix(pair, 16).ok()
        } else {
            None
        }
    };
    let bytes: Option<Vec<u8>> = digits.chunks(2).map(byte).collect();
    bytes.with_context(|| {
        format!(
            "{:?} is not a row of hexadecimal digits",
            String::from_utf8_lossy(text)
        )
    })
}

fn direction(options: &PacketOptions) -> Direction {
    match options.direction {
        DirectionName::ToRobot => Direction::HostToRobot,
        DirectionName::FromRobot => Direction::RobotToHost,
    }
}
