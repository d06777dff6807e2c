//! What was tried, what should have come of it, and what did.

use serde::Serialize;

/// One try.
#[derive(Debug, Serialize)]
struct Row {
    id: &'static str,
    attack: String,
    expected: String,
    seen: String,
}

/// All tries.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    rows: Vec<Row>,
    elsewhere: Vec<&'static str>,
    not_tried: Vec<String>,
    attacks: usize,
    unexpected: usize,
}

impl Report {
    /// Notes one try.
    pub(crate) fn row(
        &mut self,
        (id, attack): (&'static str, impl Into<String>),
        expected: impl Into<String>,
        seen: impl Into<String>,
    ) {
        let (expected, seen) = (expected.into(), seen.into());
        self.attacks += 1;
        self.unexpected += usize::from(expected != seen);
        self.rows.push(Row {
            id,
            attack: attack.into(),
            expected,
            seen,
        });
    }

    /// A line that other tests try.
    pub(crate) fn elsewhere(&mut self, line: &'static str) {
        self.elsewhere.push(line);
    }

    /// A try for which this machine is not fit.
    pub(crate) fn not_tried(&mut self, line: String) {
        self.not_tried.push(line);
    }

    /// Whether everything came as it should.
    pub(crate) const fn is_good(&self) -> bool {
        self.unexpected == 0
    }

    pub(crate) fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap()
    }

    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        for row in &self.rows {
            let mark = if row.expected == row.seen { "ok " } else { "BAD" };
            text.push_str(&format!(
                "{mark} {:3} {}: expected {}, seen {}\n",
                row.id, row.attack, row.expected, row.seen
            ));
        }
        for line in &self.elsewhere {
            text.push_str(&format!("elsewhere {line}\n"));
        }
        for line in &self.not_tried {
            text.push_str(&format!("not tried {line}\n"));
        }
        text.push_str(&format!(
            "{} attacks, {} unexpected\n",
            self.attacks, self.unexpected
        ));
        text
    }
}
