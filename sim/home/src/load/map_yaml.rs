//! The YAML of a `map_server` map: which keys it has, and what each says.
//!
//! A library reads the YAML; what the values mean follows Nav2's own loader: the same keys are required, `mode` alone
//! may be missing, `negate` is a whole number or a truth value. Three things are stricter: a key given twice, an anchor
//! and a number out of any sense are refused, each by its name.

use std::path::Path;

use saphyr_parser::{Event, Parser, ScalarStyle};

use super::HomeError;

/// What a key holds.
enum Held {
    /// One value, and whether it stands in quotes.
    Scalar(String, bool),
    /// A list of values.
    List(Vec<String>),
    /// Keys of its own, lists of lists: no key of ours holds such.
    Deep,
}

/// One key with the line that its value begins in.
struct Entry {
    key: String,
    line: usize,
    held: Held,
}

/// The keys of the file, in its order.
pub(super) struct MapYaml<'a> {
    path: &'a Path,
    entries: Vec<Entry>,
}

/// Longest YAML of a map: savers write some hundred bytes.
const YAML_BYTES_MAX: usize = 64 << 10;

impl<'a> MapYaml<'a> {
    pub(super) fn parse(path: &'a Path, text: &str) -> Result<Self, HomeError> {
        if text.len() > YAML_BYTES_MAX {
            return Err(HomeError::TooLong {
                path: path.to_owned(),
                bytes: text.len() as u64,
                limit: YAML_BYTES_MAX as u64,
            });
        }
        let mut reader = EntryReader::default();
        for event in Parser::new_from_str(text) {
            let (event, span) = event.map_err(|error| {
                let line = error.marker().line();
                HomeError::Invalid {
                    path: path.to_owned(),
                    place: format!("line {line} or the one before"),
                    problem: format!("{}; {}", error.info(), remedy_near(text, line)),
                }
            })?;
            if event == Event::DocumentEnd {
                break;
            }
            reader.take(event, span.start.line()).map_err(|refusal| {
                let line = span.start.line();
                let (place, problem) = match refusal {
                    Refusal::Alias => (
                        format!("line {line}"),
                        "it refers to an anchor (`*name`); write the value itself".to_owned(),
                    ),
                    Refusal::Twice(key) => (
                        format!("`{key}` in line {line}"),
                        "the key is given twice; leave one".to_owned(),
                    ),
                    Refusal::NoKeys => (
                        format!("line {line}"),
                        "it holds no keys; write `image: NAME` and the others, each on a line".to_owned(),
                    ),
                };
                HomeError::Invalid {
                    path: path.to_owned(),
                    place,
                    problem,
                }
            })?;
        }
        Ok(Self {
            path,
            entries: reader.entries,
        })
    }

    /// A key that is missing, or that stands there in other letters.
    fn missing(&self, key: &str, example: &str) -> HomeError {
        let alike = self
            .entries
            .iter()
            .find(|entry| entry.key.eq_ignore_ascii_case(key));
        let problem = match alike {
            Some(entry) => format!(
                "it is missing, and `{}` is in line {}; write it in small letters, as `{key}: {example}`",
                entry.key, entry.line
            ),
            None => format!("it is missing; add a line such as `{key}: {example}`"),
        };
        self.invalid(key, problem)
    }

    /// A refusal of what this key says.
    pub(super) fn invalid(&self, key: &str, problem: String) -> HomeError {
        let place = match self.entry(key) {
            Some(entry) => format!("`{key}` in line {}", entry.line),
            None => format!("`{key}`"),
        };
        HomeError::Invalid {
            path: self.path.to_owned(),
            place,
            problem,
        }
    }

    fn entry(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// The value of a key that may be missing.
    pub(super) fn optional(&self, key: &str, example: &str) -> Result<Option<&str>, HomeError> {
        let Some(entry) = self.entry(key) else {
            return Ok(None);
        };
        match &entry.held {
            Held::Scalar(text, quoted) if *quoted || !is_null(text) => Ok(Some(text)),
            Held::Scalar(..) => Err(self.invalid(key, format!("it has no value; write `{key}: {example}`"))),
            Held::List(items) => Err(self.invalid(
                key,
                format!(
                    "a list of {} is there; write one value, as `{key}: {example}`",
                    items.len()
                ),
            )),
            Held::Deep => Err(self.invalid(
                key,
                format!("lists or keys lie within it; write one value, as `{key}: {example}`"),
            )),
        }
    }

    /// The value of a key that Nav2's loader requires.
    pub(super) fn text(&self, key: &str, example: &str) -> Result<&str, HomeError> {
        self.optional(key, example)?
            .ok_or_else(|| self.missing(key, example))
    }

    pub(super) fn number(&self, key: &str, example: &str) -> Result<f64, HomeError> {
        self.numeral(key, self.text(key, example)?)
    }

    /// A whole number other than 0, or a truth value in any spelling of YAML.
    pub(super) fn truth(&self, key: &str) -> Result<bool, HomeError> {
        let text = self.text(key, "0")?;
        match text.to_ascii_lowercase().as_str() {
            "true" | "yes" | "on" | "y" => Ok(true),
            "false" | "no" | "off" | "n" => Ok(false),
            other => match other.parse::<i64>() {
                Ok(number) => Ok(number != 0),
                Err(_) => Err(self.invalid(
                    key,
                    format!("`{text}` is neither a whole number nor true or false; write `{key}: 0`"),
                )),
            },
        }
    }

    /// A list of numbers, in brackets or one to a line.
    pub(super) fn numbers(&self, key: &str, example: &str) -> Result<Vec<f64>, HomeError> {
        match self.entry(key).map(|entry| &entry.held) {
            Some(Held::List(items)) => items.iter().map(|item| self.numeral(key, item)).collect(),
            Some(Held::Scalar(text, quoted)) if *quoted || !is_null(text) => Err(self.invalid(
                key,
                format!("`{}` is no list; write `{key}: {example}`", shortened(text)),
            )),
            Some(_) => Err(self.invalid(key, format!("it holds no numbers; write `{key}: {example}`"))),
            None => Err(self.missing(key, example)),
        }
    }

    fn numeral(&self, key: &str, text: &str) -> Result<f64, HomeError> {
        match text.trim().parse::<f64>() {
            Ok(number) if number.is_finite() && number.abs() <= 1e6 => Ok(number),
            _ => Err(self.invalid(
                key,
                format!(
                    "`{}` is not a number of a sensible size; write it with digits and a point",
                    shortened(text)
                ),
            )),
        }
    }
}

/// What helps against a mistake of writing in this line or the one before.
fn remedy_near(text: &str, line: usize) -> &'static str {
    let mut near = text.lines().skip(line.saturating_sub(2)).take(2);
    if near.any(|line| line.contains('\t')) {
        "write spaces instead of the tab"
    } else {
        "write one `key: value` to a line"
    }
}

/// What a value is that YAML takes for nothing.
fn is_null(text: &str) -> bool {
    matches!(text, "" | "~" | "null" | "Null" | "NULL")
}

/// A text as a sentence can hold it: one line of at most 60 characters.
pub(super) fn shortened(text: &str) -> String {
    text.chars()
        .map(|letter| if letter.is_control() { ' ' } else { letter })
        .take(60)
        .collect()
}

/// Why the events of the parser are no map.
enum Refusal {
    Alias,
    NoKeys,
    Twice(String),
}

/// Gathers the entries of the outermost mapping. It holds no stack, so depth costs nothing.
#[derive(Default)]
struct EntryReader {
    entries: Vec<Entry>,
    depth: usize,
    key: Option<String>,
    /// The value that is being read.
    open: Option<Entry>,
}

impl EntryReader {
    fn take(&mut self, event: Event<'_>, line: usize) -> Result<(), Refusal> {
        match event {
            Event::Alias(_) => Err(Refusal::Alias),
            Event::MappingStart(..) | Event::SequenceStart(..) => {
                let list = matches!(event, Event::SequenceStart(..));
                self.start(list, line)
            }
            Event::MappingEnd | Event::SequenceEnd => {
                self.depth = self.depth.saturating_sub(1);
                if self.depth == 1
                    && let Some(entry) = self.open.take()
                {
                    self.entries.push(entry);
                }
                Ok(())
            }
            Event::Scalar(text, style, ..) => self.scalar(&text, style != ScalarStyle::Plain, line),
            _ => Ok(()),
        }
    }

    fn start(&mut self, list: bool, line: usize) -> Result<(), Refusal> {
        match self.depth {
            0 if list => return Err(Refusal::NoKeys),
            1 => {
                // A list or a mapping as a key: it has no name that a refusal could use.
                let key = self.key.take().ok_or(Refusal::NoKeys)?;
                let held = if list { Held::List(Vec::new()) } else { Held::Deep };
                self.open = Some(Entry { key, line, held });
            }
            2 => {
                if let Some(entry) = &mut self.open {
                    entry.held = Held::Deep;
                }
            }
            _ => {}
        }
        self.depth += 1;
        Ok(())
    }

    fn scalar(&mut self, text: &str, quoted: bool, line: usize) -> Result<(), Refusal> {
        match self.depth {
            0 => return Err(Refusal::NoKeys),
            1 => match self.key.take() {
                None if self.entries.iter().any(|entry| entry.key == text) => {
                    return Err(Refusal::Twice(shortened(text)));
                }
                None => self.key = Some(text.to_owned()),
                Some(key) => self.entries.push(Entry {
                    key,
                    line,
                    held: Held::Scalar(text.to_owned(), quoted),
                }),
            },
            2 => {
                if let Some(Entry {
                    held: Held::List(items),
                    ..
                }) = &mut self.open
                {
                    items.push(text.to_owned());
                }
            }
            _ => {}
        }
        Ok(())
    }
}
