//! Names as numbers, sizes and ranges of the wire.

use crate::constant;
use rvac_protocol::binary;
use rvac_protocol::frame;
use rvac_protocol::message::{
    ArmingState, CommandName, Inhibit, Motor, PROBE_LEASE_MS_MAX, Parameter, ProtocolVersion, Refusal,
};
use rvac_protocol::session;
use rvac_protocol::span::{self, Span};
use std::fmt::Write;

/// Ranges by name.
pub(crate) const SPANS: [(&str, Span); 15] = [
    ("speed", span::SPEED),
    ("turn", span::TURN),
    ("lease", span::LEASE),
    ("probe-lease", span::PROBE_LEASE),
    ("baud", span::BAUD),
    ("throttle", span::THROTTLE),
    ("move-length", span::MOVE_LENGTH),
    ("move-radius", span::MOVE_RADIUS),
    ("pitch", span::PITCH),
    ("duration", span::DURATION),
    ("ratio", span::RATIO),
    ("led", span::LED),
    ("byte", span::BYTE),
    ("word", span::WORD),
    ("total", span::TOTAL),
];
/// The one range that fills an `i32`.
pub(crate) const COUNT: (&str, Span) = ("count", span::COUNT);

const HEAD: &str = "/* What the C cord and the Rust protocol must agree on. Made by cargo xtask codegen from \
                    protocol/rvac-protocol. Do not edit.\n *\n * SPDX-License-Identifier: GPL-3.0-or-later\n */\n\
                    #ifndef CORD_WIRE_H\n#define CORD_WIRE_H\n\n#include <stdint.h>\n";

const DECLARATIONS: &str = "\n/* Names, each with its length before it and 0 at the end. */\n\
    extern const uint8_t cord_names_command[];\nextern const uint8_t cord_names_motor[];\n\
    extern const uint8_t cord_names_inhibit[];\nextern const uint8_t cord_names_parameter[];\n\
    extern const uint8_t cord_names_refusal[];\nextern const uint8_t cord_names_arming[];\n\n\
    /* Ranges: decimals, greatest magnitude below zero, least and most from zero on. */\n\
    extern const uint8_t cord_span_decimals[];\nextern const uint32_t cord_span_below[];\n\
    extern const uint32_t cord_span_least[];\nextern const uint32_t cord_span_most[];\n\n\
    /* Ranges of parameters besides 0. */\n\
    extern const uint32_t cord_parameter_least[];\nextern const uint32_t cord_parameter_most[];\n\n#endif\n";

/// The header.
pub(crate) fn source() -> anyhow::Result<String> {
    let mut text = HEAD.to_owned();
    sizes(&mut text)?;
    numbers(&mut text, "COMMAND", 0, CommandName::ALL.map(CommandName::name))?;
    numbers(&mut text, "MOTOR", 0, Motor::ALL.map(Motor::name))?;
    numbers(&mut text, "INHIBIT", 0, Inhibit::ALL.map(Inhibit::name))?;
    numbers(&mut text, "PARAMETER", 0, Parameter::ALL.map(Parameter::name))?;
    // 0 says that nothing is refused.
    numbers(&mut text, "REFUSAL", 1, Refusal::ALL.map(Refusal::name))?;
    numbers(&mut text, "ARMING", 0, ArmingState::ALL.map(ArmingState::name))?;
    numbers(
        &mut text,
        "SPAN",
        0,
        SPANS.iter().chain([&COUNT]).map(|(name, _)| *name),
    )?;
    text.push_str(DECLARATIONS);
    Ok(text)
}

fn numbers<'a>(
    text: &mut String,
    family: &str,
    first: usize,
    names: impl IntoIterator<Item = &'a str>,
) -> std::fmt::Result {
    text.push('\n');
    for (index, name) in names.into_iter().enumerate() {
        writeln!(text, "#define CORD_{family}_{} {}", constant(name), index + first)?;
    }
    Ok(())
}

fn sizes(text: &mut String) -> std::fmt::Result {
    let figures: [(&str, i64); 19] = [
        ("PACKET_BYTES_MAX", frame::PACKET_BYTES_MAX as i64),
        ("SEPARATOR", i64::from(frame::SEPARATOR)),
        ("SEPARATOR_2016", i64::from(frame::SEPARATOR_2016)),
        ("STUFFING", i64::from(frame::STUFFING)),
        ("STUFFED_BIT", i64::from(frame::STUFFED_BIT)),
        ("BINARY_KIND_MIN", i64::from(frame::BINARY_KIND_MIN)),
        ("KIND_DRIVE", i64::from(binary::DRIVE)),
        ("KIND_STATE", i64::from(binary::STATE)),
        ("DRIVE_BYTES", binary::DRIVE_BYTES as i64),
        ("STATE_BYTES", binary::STATE_BYTES as i64),
        ("VERSION_LEAST", i64::from(ProtocolVersion::MIN.0)),
        ("VERSION_MOST", i64::from(ProtocolVersion::CURRENT.0)),
        ("FRESHNESS_MS", i64::from(session::FRESHNESS_MS)),
        ("SESSION_SILENCE_MS", i64::from(session::SESSION_SILENCE_MS)),
        ("HAND_LEASE_MS_MAX", i64::from(session::HAND_LEASE_MS_MAX)),
        ("HAND_SPEED_MAX", i64::from(session::HAND_SPEED_MAX.0)),
        ("HAND_TURN_MAX", i64::from(session::HAND_TURN_MAX.0)),
        ("PROBE_LEASE_MS_MAX", i64::from(PROBE_LEASE_MS_MAX)),
        ("BAUD_RATE_PATTERN", i64::from(b'U')),
    ];
    text.push('\n');
    for (name, value) in figures {
        writeln!(text, "#define CORD_{name} {value}")?;
    }
    writeln!(text, "#define CORD_SPEED_MOST {}L", span::SPEED.max)?;
    writeln!(text, "#define CORD_TURN_MOST {}L", span::TURN.max)?;
    writeln!(text, "#define CORD_LEASE_LEAST {}", span::LEASE.min)?;
    writeln!(text, "#define CORD_LEASE_MOST {}", span::LEASE.max)?;
    let pitch = (1..=span::PITCH.max).find(|pitch| span::is_pitch(*pitch));
    writeln!(text, "#define CORD_PITCH_LEAST_HZ {}", pitch.unwrap_or(1))
}
