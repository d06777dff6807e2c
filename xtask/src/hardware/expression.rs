//! S-expressions, as KiCad writes them.

use anyhow::bail;

/// One expression: a word (with or without quotation marks) or a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Node {
    /// A word.
    Word(String),
    /// A list, whose first word says what it is.
    List(Vec<Node>),
}

/// Deeper files are not KiCad's.
const DEPTH_MAX: usize = 64;

impl Node {
    /// Reads a file of one expression.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        let mut open: Vec<Vec<Self>> = vec![Vec::new()];
        let mut letters = text.chars().peekable();
        while let Some(letter) = letters.next() {
            let done = match letter {
                _ if letter.is_whitespace() => continue,
                '(' if open.len() > DEPTH_MAX => bail!("more than {DEPTH_MAX} lists in each other"),
                '(' => {
                    open.push(Vec::new());
                    continue;
                }
                ')' => match (open.pop(), open.is_empty()) {
                    (Some(list), false) => Self::List(list),
                    _ => bail!("a list is closed that was never opened"),
                },
                '"' => Self::Word(quoted(&mut letters)?),
                _ => {
                    let mut word = String::from(letter);
                    while let Some(next) =
                        letters.next_if(|next| !next.is_whitespace() && !"()\"".contains(*next))
                    {
                        word.push(next);
                    }
                    Self::Word(word)
                }
            };
            if let Some(list) = open.last_mut() {
                list.push(done);
            }
        }
        match (open.len(), open.pop().unwrap_or_default().as_slice()) {
            (1, [one @ Self::List(_)]) => Ok(one.clone()),
            (1, _) => bail!("not one list"),
            (lists, _) => bail!("{} lists are never closed", lists - 1),
        }
    }

    fn items(&self) -> &[Self] {
        match self {
            Self::List(items) => items,
            Self::Word(_) => &[],
        }
    }

    /// The word at this place of the list; 0 is its head.
    pub(super) fn word(&self, place: usize) -> Option<&str> {
        match self.items().get(place) {
            Some(Self::Word(word)) => Some(word),
            _ => None,
        }
    }

    /// All lists in this list that begin with `head`.
    pub(super) fn all<'node>(&'node self, head: &'node str) -> impl Iterator<Item = &'node Self> {
        self.items().iter().filter(move |item| item.word(0) == Some(head))
    }

    /// The first of them.
    pub(super) fn one<'node>(&'node self, head: &'node str) -> Option<&'node Self> {
        self.all(head).next()
    }

    /// The word behind the head of the first list of this head: `(lib_id "R")` has `R`.
    pub(super) fn value(&self, head: &str) -> Option<&str> {
        self.items()
            .iter()
            .find(|item| item.word(0) == Some(head))
            .and_then(|item| item.word(1))
    }

    /// The value of `(property "KEY" "VALUE" ...)`.
    pub(super) fn property(&self, key: &str) -> Option<&str> {
        self.all("property")
            .find(|entry| entry.word(1) == Some(key))
            .and_then(|entry| entry.word(2))
    }

    /// A length in mm, as whole 0.0001 mm.
    pub(super) fn length(&self, place: usize) -> anyhow::Result<i64> {
        let number = self.word(place).and_then(|word| word.parse::<f64>().ok());
        match number {
            Some(number) if number.abs() < 10_000.0 => Ok((number * 10_000.0).round() as i64),
            _ => bail!(
                "({} ...) has no length at place {place}",
                self.word(0).unwrap_or("?")
            ),
        }
    }
}

fn quoted(letters: &mut impl Iterator<Item = char>) -> anyhow::Result<String> {
    let mut word = String::new();
    while let Some(letter) = letters.next() {
        match letter {
            '"' => return Ok(word),
            '\\' => word.extend(letters.next()),
            _ => word.push(letter),
        }
    }
    bail!("a text in quotation marks has no end")
}

#[cfg(test)]
mod tests {
    use super::Node;

    #[test]
    fn words_texts_and_lists() {
        let node = Node::parse("(a \"b (\\\"c\" (at 1.27 -2))\n").expect("valid");
        assert_eq!(node.word(1), Some("b (\"c"));
        let at = node.one("at").expect("a list");
        assert_eq!(at.length(1).expect("a length"), 12_700);
        assert_eq!(at.length(2).expect("a length"), -20_000);
        assert!(at.length(3).is_err() && node.length(1).is_err());
    }

    #[test]
    fn broken_files_are_refused() {
        for text in ["", "a", "(a", "(a))", "(a \"b", "(a) (b)"] {
            assert!(Node::parse(text).is_err(), "{text}");
        }
        assert!(Node::parse(&"(".repeat(1000)).is_err());
    }
}
