//! What is known of a machine, as its file tells: of a robot of ours, of a sister of one, or of a robot of another maker.

use crate::codegen::board::Pinout;
use anyhow::{Context, bail};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// What a machine is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MachineKind {
    /// A vacuum cleaner.
    Vacuum,
    /// A lawn mower.
    Mower,
    /// A robot without tools.
    Base,
    /// A part of a robot that is of use without it.
    Sensor,
}

/// How far something can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum FactConfidence {
    /// The maker's document, a measurement, or two sources that do not copy each other.
    Known,
    /// One source.
    OneSource,
    /// A guess, or what is said of such machines in general.
    Unverified,
}

/// Parts of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum PageSection {
    Chip,
    Pins,
    Connectors,
    Protocol,
    Parts,
}

/// One thing that is known.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Fact {
    pub(crate) section: PageSection,
    pub(crate) about: String,
    pub(crate) says: String,
    pub(crate) confidence: FactConfidence,
    pub(crate) source: String,
}

/// Things of one kind that are known, such as contacts or commands.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct FactTable {
    pub(crate) section: PageSection,
    pub(crate) title: String,
    pub(crate) columns: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
    pub(crate) confidence: FactConfidence,
    pub(crate) source: String,
}

/// How much of the board a sister shares with its base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum BoardLikeness {
    /// Taken for the same.
    Same,
    /// Alike; which chip it has and where its pins lead nobody has looked at.
    Similar,
    /// Unknown.
    Unknown,
}

/// Lines of a display, by names of the base's pins.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct DisplayLines {
    /// Commons, from the left.
    pub(crate) digits: [String; 4],
    /// Segments a to g.
    pub(crate) segments: [String; 7],
    pub(crate) colon: String,
    /// Segments whose line is a guess.
    #[serde(default)]
    pub(crate) unverified: Vec<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawFacts {
    title: String,
    kind: MachineKind,
    #[serde(default)]
    also_sold_as: Vec<String>,
    runs: String,
    find_out: Option<String>,
    #[serde(default)]
    unknown: Vec<String>,
    #[serde(default)]
    fact: Vec<Fact>,
    #[serde(default)]
    table: Vec<FactTable>,
    board: Option<BoardLikeness>,
    confidence: Option<FactConfidence>,
    source: Option<String>,
    display: Option<DisplayLines>,
    flash_allowance_bytes: Option<u32>,
}

/// That a machine is a sister of a robot of ours.
#[derive(Debug)]
pub(crate) struct Sister {
    /// The folder of the base's facts, from the root of the repository.
    pub(crate) base: String,
    pub(crate) board: BoardLikeness,
    pub(crate) confidence: FactConfidence,
    pub(crate) source: String,
    pub(crate) display: Option<DisplayLines>,
    /// How much more of the flash its firmware may take than that of its base.
    pub(crate) flash_allowance_bytes: u32,
}

/// Where a machine's facts come from beside its file.
#[derive(Debug)]
pub(crate) enum FactsOrigin {
    /// It has a pinout of its own in this folder, from the root of the repository.
    Ours(String),
    /// It is a variant.
    Sister(Box<Sister>),
    /// It keeps the firmware of its maker, as far as we are concerned.
    Others,
}

/// A machine.
#[derive(Debug)]
pub(crate) struct MachineFacts {
    /// Name of its page; that of a variant names its firmware, too.
    pub(crate) name: String,
    /// Its file, from the root of the repository.
    pub(crate) file: PathBuf,
    pub(crate) title: String,
    pub(crate) kind: MachineKind,
    pub(crate) also_sold_as: Vec<String>,
    /// What runs on it today.
    pub(crate) runs: String,
    /// How a person or a program finds out that it is this one.
    pub(crate) find_out: Option<String>,
    pub(crate) unknown: Vec<String>,
    pub(crate) facts: Vec<Fact>,
    pub(crate) tables: Vec<FactTable>,
    pub(crate) origin: FactsOrigin,
}

/// All of them: the robots of `described` folders, their variants, then others, each in the order of names.
pub(crate) fn all(root: &Path, described: &[String]) -> anyhow::Result<Vec<MachineFacts>> {
    let mut machines = Vec::new();
    for folder in described {
        let file = Path::new(folder).join("machine.toml");
        // A robot that somebody has just begun has none yet.
        if root.join(&file).is_file() {
            let name = Path::new(folder).file_name().unwrap_or_default();
            let name = name.to_string_lossy().into_owned();
            machines.push(MachineFacts::read(root, &file, &name)?);
        }
        machines.extend(variants(root, folder)?);
    }
    machines.extend(below(root, "robots/machines")?);
    Ok(machines)
}

/// The sisters of the robot in a folder of facts.
pub(crate) fn variants(root: &Path, facts: &str) -> anyhow::Result<Vec<MachineFacts>> {
    below(root, &format!("{facts}/variants"))
}

fn below(root: &Path, folder: &str) -> anyhow::Result<Vec<MachineFacts>> {
    let Ok(entries) = std::fs::read_dir(root.join(folder)) else {
        return Ok(Vec::new());
    };
    let mut names = Vec::new();
    for entry in entries {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    let read =
        |name: &String| MachineFacts::read(root, &Path::new(folder).join(format!("{name}.toml")), name);
    names.iter().map(read).collect()
}

impl MachineFacts {
    fn read(root: &Path, file: &Path, name: &str) -> anyhow::Result<Self> {
        let path = root.join(file);
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        Self::parse(&text, file, name).with_context(|| file.display().to_string())
    }

    /// Reads the text of such a file; its place says whose facts it has.
    pub(super) fn parse(text: &str, file: &Path, name: &str) -> anyhow::Result<Self> {
        let raw: RawFacts = toml::from_str(text)?;
        check_texts(&raw)?;
        let folder = file.parent().unwrap_or(Path::new(""));
        let origin = if folder.ends_with("variants") {
            FactsOrigin::Sister(Box::new(Sister {
                base: folder.parent().unwrap_or(folder).to_string_lossy().into_owned(),
                board: raw
                    .board
                    .context("a variant says how much of the board it shares: board")?,
                confidence: raw
                    .confidence
                    .context("a variant says how sure its board is: confidence")?,
                source: raw
                    .source
                    .context("a variant says where that comes from: source")?,
                display: raw.display,
                flash_allowance_bytes: raw.flash_allowance_bytes.unwrap_or_default(),
            }))
        } else if raw.board.is_some()
            || raw.confidence.is_some()
            || raw.source.is_some()
            || raw.display.is_some()
        {
            bail!("board, confidence, source, display and flash-allowance-bytes at the top are for variants");
        } else if file.file_name().is_some_and(|name| name == "machine.toml") {
            FactsOrigin::Ours(folder.to_string_lossy().into_owned())
        } else {
            FactsOrigin::Others
        };
        Ok(Self {
            name: name.to_owned(),
            file: file.to_owned(),
            title: raw.title,
            kind: raw.kind,
            also_sold_as: raw.also_sold_as,
            runs: raw.runs,
            find_out: raw.find_out,
            unknown: raw.unknown,
            facts: raw.fact,
            tables: raw.table,
            origin,
        })
    }

    /// How much of its base's board it has, if it is a variant.
    pub(crate) fn likeness(&self) -> Option<BoardLikeness> {
        match &self.origin {
            FactsOrigin::Sister(sister) => Some(sister.board),
            FactsOrigin::Ours(_) | FactsOrigin::Others => None,
        }
    }

    /// The display, if it is a variant with one whose lines are known or guessed.
    pub(crate) fn display(&self) -> Option<&DisplayLines> {
        match &self.origin {
            FactsOrigin::Sister(sister) => sister.display.as_ref(),
            FactsOrigin::Ours(_) | FactsOrigin::Others => None,
        }
    }

    /// How much more of the flash its firmware may take than that of its base.
    pub(crate) fn flash_allowance_bytes(&self) -> u32 {
        match &self.origin {
            FactsOrigin::Sister(sister) => sister.flash_allowance_bytes,
            FactsOrigin::Ours(_) | FactsOrigin::Others => 0,
        }
    }

    /// Checks what it says of its base's pins.
    pub(crate) fn check(&self, pinout: &Pinout) -> anyhow::Result<()> {
        let Some(display) = self.display() else {
            return Ok(());
        };
        let lines: Vec<&String> = display
            .digits
            .iter()
            .chain(&display.segments)
            .chain([&display.colon])
            .collect();
        for (place, line) in lines.iter().enumerate() {
            if !pinout.signals.iter().any(|signal| &signal.name == *line) {
                bail!(
                    "{}: the display has the line {line:?}, which pinout.toml does not know",
                    self.file.display()
                );
            }
            if lines.iter().take(place).any(|other| other == line) {
                bail!("{}: the display has the line {line:?} twice", self.file.display());
            }
        }
        if let Some(segment) = display
            .unverified
            .iter()
            .find(|name| !SEGMENTS.contains(&name.as_str()))
        {
            bail!("{}: there is no segment {segment:?}", self.file.display());
        }
        Ok(())
    }
}

/// Segments of a digit: a is the top one, b to f follow clockwise, g is in the middle.
pub(super) const SEGMENTS: [&str; 7] = ["a", "b", "c", "d", "e", "f", "g"];

/// Every row fits its table, and nothing is said without words and a source.
fn check_texts(raw: &RawFacts) -> anyhow::Result<()> {
    for table in &raw.table {
        if table.source.trim().is_empty() {
            bail!("the table {:?} has no source", table.title);
        }
        if let Some(row) = table.rows.iter().find(|row| row.len() != table.columns.len()) {
            bail!(
                "the table {:?} has {} columns, the row {row:?} has {}",
                table.title,
                table.columns.len(),
                row.len()
            );
        }
    }
    match raw
        .fact
        .iter()
        .find(|fact| fact.says.trim().is_empty() || fact.source.trim().is_empty())
    {
        Some(fact) => bail!("the fact {:?} says nothing or has no source", fact.about),
        None => Ok(()),
    }
}
