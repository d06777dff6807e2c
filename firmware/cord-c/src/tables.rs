//! Tables: of the CRC, of names, of ranges.

use crate::wire::{COUNT, SPANS};
use rvac_protocol::crc::crc32c;
use rvac_protocol::message::{ArmingState, CommandName, Inhibit, Motor, Parameter, Refusal};
use rvac_protocol::span::Span;
use std::fmt::Write;

const HEAD: &str = "/* Tables of the C cord, included once, by tables.c. Made by cargo xtask codegen from \
                    protocol/rvac-protocol. Do not edit.\n *\n * SPDX-License-Identifier: GPL-3.0-or-later\n */\n";

/// The header.
pub(crate) fn source() -> anyhow::Result<String> {
    let mut text = HEAD.to_owned();
    for byte in 0..4 {
        crc_table(&mut text, byte)?;
    }
    names(&mut text, "command", &CommandName::ALL.map(CommandName::name))?;
    names(&mut text, "motor", &Motor::ALL.map(Motor::name))?;
    names(&mut text, "inhibit", &Inhibit::ALL.map(Inhibit::name))?;
    names(&mut text, "parameter", &Parameter::ALL.map(Parameter::name))?;
    names(&mut text, "refusal", &Refusal::ALL.map(Refusal::name))?;
    names(&mut text, "arming", &ArmingState::ALL.map(ArmingState::name))?;
    let spans: Vec<Span> = SPANS.iter().chain([&COUNT]).map(|(_, span)| *span).collect();
    let decimals: Vec<i64> = spans.iter().map(|span| i64::from(span.decimals)).collect();
    numbers(&mut text, "uint8_t cord_span_decimals", &decimals)?;
    let below: Vec<i64> = spans.iter().map(|span| (-span.min).max(0)).collect();
    numbers(&mut text, "uint32_t cord_span_below", &below)?;
    let least: Vec<i64> = spans.iter().map(|span| span.min.max(0)).collect();
    numbers(&mut text, "uint32_t cord_span_least", &least)?;
    let most: Vec<i64> = spans.iter().map(|span| span.max).collect();
    numbers(&mut text, "uint32_t cord_span_most", &most)?;
    let ranges = Parameter::ALL.map(Parameter::range);
    numbers(
        &mut text,
        "uint32_t cord_parameter_least",
        &ranges.map(|(least, _)| i64::from(least)),
    )?;
    numbers(
        &mut text,
        "uint32_t cord_parameter_most",
        &ranges.map(|(_, most)| i64::from(most)),
    )?;
    Ok(text)
}

/// One byte of each entry of the usual table.
fn crc_table(text: &mut String, byte: u32) -> std::fmt::Result {
    write!(text, "\nconst uint8_t cord_crc_table_{byte}[256] = {{")?;
    for index in 0..=u8::MAX {
        let comma = if index == 0 { "" } else { "," };
        let space = if index % 16 == 0 { "\n    " } else { " " };
        write!(
            text,
            "{comma}{space}0x{:02X}",
            crc32c(0, &[index]) >> (8 * byte) & 0xFF
        )?;
    }
    writeln!(text, "\n}};")
}

fn names(text: &mut String, family: &str, names: &[&str]) -> std::fmt::Result {
    write!(text, "\nconst uint8_t cord_names_{family}[] =")?;
    for name in names {
        write!(text, "\n    \"\\{:03o}{name}\"", name.len())?;
    }
    writeln!(text, ";")
}

fn numbers(text: &mut String, declaration: &str, values: &[i64]) -> std::fmt::Result {
    let listed: Vec<String> = values.iter().map(|value| format!("{value}UL")).collect();
    writeln!(
        text,
        "\nconst {declaration}[] = {{\n    {}\n}};",
        listed.join(",\n    ")
    )
}

#[cfg(test)]
mod tests {
    use super::source;
    use rvac_protocol::crc::crc32c;

    /// The bytes of a table as they stand in the header.
    fn table(text: &str, byte: u32) -> Vec<u32> {
        let head = format!("cord_crc_table_{byte}[256] = {{");
        let rest = text.split_once(&head).expect("the table").1;
        let rest = rest.split_once('}').expect("its end").0;
        let digits = rest.split(',').map(|word| word.trim().trim_start_matches("0x"));
        digits
            .map(|word| u32::from_str_radix(word, 16).expect("a byte"))
            .collect()
    }

    #[test]
    fn the_tables_make_the_crc_of_the_protocol() {
        let text = source().expect("the header");
        let tables: Vec<Vec<u32>> = (0..4).map(|byte| table(&text, byte)).collect();
        let mut register = u32::MAX;
        for byte in b"123456789" {
            let index = ((register ^ u32::from(*byte)) & 0xFF) as usize;
            let entry = (0..4).fold(0, |sum, byte| sum | tables[byte][index] << (8 * byte));
            register = register >> 8 ^ entry;
        }
        assert_eq!(!register, 0xE306_9283);
        assert_eq!(register, crc32c(u32::MAX, b"123456789"));
    }
}
