//! What a robot's board is, from its `robot.toml`: control figures, and the rows of `describe` as they go over the wire.

use anyhow::Context;
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    Capabilities, CommandName, CommandNames, DescribeRow, Limits, MotorGaps, Parameter, Report, RowContent,
};
use rvac_protocol::text::write_report;
use rvac_units::{AngularSpeed, Length, Speed};
use std::fmt::Write;
use std::path::Path;

/// Where the facts are.
const ROBOT: &str = "robots/vileda-relax/robot.toml";
/// What the C cord does not carry out, by name; it refuses them as `absent`.
const LEFT_OUT: [CommandName; 5] = [
    CommandName::Move,
    CommandName::Beep,
    CommandName::Led,
    CommandName::Charge,
    CommandName::Probe,
];
/// Rows of parameters and motors behind those of limits, parts and commands.
const FIRST_ROWS: u8 = 3;

/// Figures of `robot.toml`.
struct Facts(toml::Table);

impl Facts {
    fn load(root: &Path) -> anyhow::Result<Self> {
        let path = root.join(ROBOT);
        let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {ROBOT}"))?;
        Ok(Self(text.parse().with_context(|| ROBOT.to_owned())?))
    }

    fn value(&self, part: &str, name: &str) -> anyhow::Result<f64> {
        let value = self.0.get(part).and_then(|part| part.get(name)?.get("value"));
        value
            .and_then(|value| {
                value
                    .as_float()
                    .or_else(|| value.as_integer().map(|whole| whole as f64))
            })
            .with_context(|| format!("{ROBOT}: no {name} in [{part}]"))
    }
}

/// The header.
pub(crate) fn source(root: &Path) -> anyhow::Result<String> {
    let facts = Facts::load(root)?;
    let mut text = format!(
        "/* The robot behind the C cord. Made by cargo xtask codegen from {ROBOT}. Do not edit.\n *\n \
         * SPDX-License-Identifier: GPL-3.0-or-later\n */\n#ifndef CORD_MACHINE_H\n#define CORD_MACHINE_H\n\n"
    );
    let whole = |part: &str, name: &str, factor: f64| -> anyhow::Result<i64> {
        Ok((facts.value(part, name)? * factor).round() as i64)
    };
    let figures = [
        ("SPEED_MOST_UM_PER_S", whole("drive", "speed-max", 1e6)?),
        ("TURN_MOST_URAD_PER_S", whole("drive", "turn-max", 1e6)?),
        ("HALF_TRACK_UM", whole("drive", "track", 5e5)?),
        ("COUNT_UM", whole("drive", "distance-per-count", 1e3)?),
        ("FULL_SPEED_UM_PER_S", whole("wheel-motor", "free-speed", 1e6)?),
    ];
    for (name, value) in figures {
        writeln!(text, "#define CORD_{name} {value}L")?;
    }
    writeln!(
        text,
        "#define CORD_DEVICE \"relax\"\n#define CORD_FIRMWARE \"{}\"",
        env!("CARGO_PKG_VERSION")
    )?;
    let rows = rows(&facts)?;
    writeln!(
        text,
        "#define CORD_ROWS {}\n\n/* Rows of `describe`. */",
        rows.len()
    )?;
    for (index, row) in rows.iter().enumerate() {
        writeln!(text, "#define CORD_ROW_{index} {}", quoted(row))?;
    }
    text.push_str("\n#endif\n");
    Ok(text)
}

fn quoted(row: &str) -> String {
    format!("\"{}\"", row.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The rows as text.
fn rows(facts: &Facts) -> anyhow::Result<Vec<String>> {
    let limits = Limits {
        speed_max: Speed::from_m_per_s(facts.value("drive", "speed-max")?),
        turn_max: AngularSpeed::from_rad_per_s(facts.value("drive", "turn-max")?),
        track: Length::from_m(facts.value("drive", "track")?),
        count_nm: (facts.value("drive", "distance-per-count")? * 1e6).round() as u32,
        radius: Length::from_m(facts.value("body", "radius")?),
        swath: Length::from_m(facts.value("body", "swath")?),
    };
    let mut commands = CommandNames::NONE;
    for name in CommandName::ALL
        .into_iter()
        .filter(|name| !LEFT_OUT.contains(name))
    {
        commands.insert(name);
    }
    let mut contents = vec![
        RowContent::Limits(limits),
        RowContent::Capabilities(parts()),
        RowContent::Commands(commands),
    ];
    for parameter in Parameter::ALL {
        let (min, max) = parameter.range();
        contents.push(RowContent::Parameter { parameter, min, max });
    }
    contents.push(RowContent::Motors(MotorGaps::default()));
    debug_assert_eq!(contents.len(), usize::from(FIRST_ROWS) + Parameter::ALL.len() + 1);
    let rows = contents.len() as u8;
    let mut texts = Vec::new();
    for (row, content) in contents.into_iter().enumerate() {
        let mut buffer = PacketBuffer::new();
        let report = Report::Describe(DescribeRow {
            row: row as u8,
            rows,
            content,
        });
        write_report(&report, &mut buffer).map_err(|error| anyhow::anyhow!("row {row}: {error:?}"))?;
        texts.push(String::from_utf8(buffer.as_bytes().to_vec())?);
    }
    Ok(texts)
}

/// What this board has. Over-current lines guard all motors.
fn parts() -> Capabilities {
    Capabilities {
        encoders: true,
        bumpers: 2,
        cliffs: 3,
        wheel_drops: 1,
        proximity: 1,
        brush_main: true,
        brush_sides: true,
        vacuum: true,
        ..Capabilities::default()
    }
}

#[cfg(test)]
mod tests {
    use super::{Facts, rows};
    use rvac_protocol::text::read_report;
    use std::path::Path;

    #[test]
    fn rows_are_reports_that_a_host_understands() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let rows = rows(&Facts::load(&root).expect("facts")).expect("rows");
        assert_eq!(rows.len(), 6);
        for row in rows {
            read_report(row.trim_end_matches('\u{1f}').as_bytes()).expect("a report");
        }
    }
}
