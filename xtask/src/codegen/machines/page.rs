//! The page of a machine in the book, in the form that all have.

use super::data::{
    BoardLikeness, DisplayLines, FactConfidence, FactsOrigin, MachineFacts, MachineKind, PageSection,
    SEGMENTS, Sister,
};
use crate::codegen::board::{Confidence, Pinout};
use std::fmt::Write;

/// From a page to the root of the repository.
const TO_ROOT: &str = "../../../../";

/// The machine that a page needs beside its own: the pinout of ours, the title of a sister's base.
pub(super) struct Background<'a> {
    pub(super) pinout: Option<&'a Pinout>,
    pub(super) base: Option<&'a MachineFacts>,
}

/// The whole page.
pub(super) fn text(machine: &MachineFacts, background: &Background) -> Result<String, std::fmt::Error> {
    let file = machine.file.display();
    let mut text = format!(
        "<!-- Made by cargo xtask codegen from {file}. Do not edit. -->\n# {}\n\n",
        machine.title
    );
    let (kind, runs) = (kind(machine.kind), cell(&machine.runs));
    writeln!(
        text,
        "| | |\n| --- | --- |\n| kind | {kind} |\n| what runs | {runs} |"
    )?;
    if !machine.also_sold_as.is_empty() {
        writeln!(text, "| also | {} |", cell(&machine.also_sold_as.join(", ")))?;
    }
    if let (FactsOrigin::Sister(sister), Some(base)) = (&machine.origin, background.base) {
        writeln!(text, "| board | {} |", board(sister, base))?;
    }
    if let Some(way) = &machine.find_out {
        writeln!(text, "\n## Which one it is\n\n{}", way.trim())?;
    }
    for (section, title) in [
        (PageSection::Parts, "Parts"),
        (PageSection::Chip, "Chip"),
        (PageSection::Pins, "Pins"),
        (PageSection::Connectors, "Connectors"),
        (PageSection::Protocol, "Protocol"),
    ] {
        write_section(&mut text, machine, (section, title), background)?;
    }
    text.push_str("\n## What nobody knows\n\n");
    if machine.unknown.is_empty() {
        text.push_str("Nothing is listed.\n");
    }
    for gap in &machine.unknown {
        writeln!(text, "- {gap}")?;
    }
    writeln!(
        text,
        "\n[All machines](index.md), and what the words under \"how sure\" mean."
    )?;
    Ok(text)
}

fn write_section(
    text: &mut String,
    machine: &MachineFacts,
    (section, title): (PageSection, &str),
    background: &Background,
) -> std::fmt::Result {
    writeln!(text, "\n## {title}")?;
    let before = text.len();
    if let Some(pinout) = background.pinout
        && let (FactsOrigin::Ours(_), PageSection::Chip) = (&machine.origin, section)
    {
        let chip = &pinout.chip;
        let pins = chip.port_pins().len();
        writeln!(text, "\n{}, with {pins} pins that a board can use.", chip.title)?;
    }
    if let (FactsOrigin::Sister(sister), Some(base)) = (&machine.origin, background.base)
        && sister.board == BoardLikeness::Same
        && section != PageSection::Parts
    {
        let part = title.to_lowercase();
        writeln!(text, "\nAs the [{}]({}.md#{part}).", base.title, base.name)?;
    }
    if section == PageSection::Pins {
        write_pins(text, machine, background)?;
    }
    let mut facts = machine
        .facts
        .iter()
        .filter(|fact| fact.section == section)
        .peekable();
    if facts.peek().is_some() {
        text.push_str("\n| what | what is known | how sure | source |\n| --- | --- | --- | --- |\n");
    }
    for fact in facts {
        let (about, says, source) = (cell(&fact.about), cell(&fact.says), cell(&fact.source));
        writeln!(
            text,
            "| {about} | {says} | {} | {source} |",
            confidence(fact.confidence)
        )?;
    }
    for table in machine.tables.iter().filter(|table| table.section == section) {
        writeln!(
            text,
            "\n**{}** ({}; {})\n",
            table.title,
            confidence(table.confidence),
            table.source
        )?;
        write_row(text, &table.columns)?;
        write_row(text, &vec!["---".to_owned(); table.columns.len()])?;
        for row in &table.rows {
            write_row(text, row)?;
        }
    }
    if text.len() == before {
        text.push_str("\nNothing is known.\n");
    }
    Ok(())
}

fn write_row(text: &mut String, cells: &[String]) -> std::fmt::Result {
    let cells: Vec<String> = cells.iter().map(|text| cell(text)).collect();
    writeln!(text, "| {} |", cells.join(" | "))
}

/// What the data says of pins: of ours a count by confidence and where the table is, of a sister its display.
fn write_pins(text: &mut String, machine: &MachineFacts, background: &Background) -> std::fmt::Result {
    match (&machine.origin, background.pinout) {
        (FactsOrigin::Ours(folder), Some(pinout)) => {
            let of = |confidence| {
                pinout
                    .signals
                    .iter()
                    .filter(|signal| signal.confidence == confidence)
                    .count()
            };
            writeln!(
                text,
                "\nOf {} port pins {} are known, {} estimated, and {} nobody knows. [The table of all pins]({TO_ROOT}{folder}/README.md) \
                 is made from `{folder}/pinout.toml`, as are the firmware's constants and the emulator's wiring.",
                pinout.signals.len(),
                of(Confidence::Known),
                of(Confidence::Estimated),
                of(Confidence::Unknown),
            )
        }
        (FactsOrigin::Sister(sister), Some(pinout)) => match &sister.display {
            Some(display) => write_display(text, display, pinout),
            None => Ok(()),
        },
        _ => Ok(()),
    }
}

fn write_display(text: &mut String, display: &DisplayLines, pinout: &Pinout) -> std::fmt::Result {
    text.push_str("\nThe display's lines:\n\n| line | signal | port | pin | how sure |\n| --- | --- | --- | --- | --- |\n");
    let digits = display.digits.iter().enumerate();
    let digits = digits.map(|(number, name)| (format!("digit {}", number + 1), name));
    let segments = SEGMENTS.iter().zip(&display.segments);
    let segments = segments.map(|(letter, name)| (format!("segment {letter}"), name));
    for (what, name) in digits
        .chain(segments)
        .chain([("colon".to_owned(), &display.colon)])
    {
        let signal = pinout.signals.iter().find(|signal| &signal.name == name);
        let (port, pin) = signal.map_or((String::new(), 0), |signal| (signal.port.to_string(), signal.pin));
        let guessed = display
            .unverified
            .iter()
            .any(|letter| what == format!("segment {letter}"));
        let sure = confidence(if guessed {
            FactConfidence::Unverified
        } else {
            FactConfidence::OneSource
        });
        writeln!(text, "| {what} | `{name}` | {port} | {pin} | {sure} |")?;
    }
    Ok(())
}

fn board(sister: &Sister, base: &MachineFacts) -> String {
    let link = format!("[{}]({}.md)", base.title, base.name);
    let is = match sister.board {
        BoardLikeness::Same => format!("taken for that of the {link}"),
        BoardLikeness::Similar => format!("alike that of the {link}; nobody has compared them"),
        BoardLikeness::Unknown => format!("unknown; perhaps that of the {link}"),
    };
    format!(
        "{is} ({}: {})",
        confidence(sister.confidence),
        cell(&sister.source)
    )
}

pub(super) const fn kind(kind: MachineKind) -> &'static str {
    match kind {
        MachineKind::Vacuum => "vacuum cleaner",
        MachineKind::Mower => "lawn mower",
        MachineKind::Base => "base without tools",
        MachineKind::Sensor => "sensor",
    }
}

pub(super) const fn confidence(confidence: FactConfidence) -> &'static str {
    match confidence {
        FactConfidence::Known => "known",
        FactConfidence::OneSource => "one source",
        FactConfidence::Unverified => "unverified",
    }
}

/// A text that stays in its cell.
pub(super) fn cell(text: &str) -> String {
    text.trim().replace('\n', " ").replace('|', "\\|")
}
