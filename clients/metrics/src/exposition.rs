//! The text format of Prometheus, version 0.0.4.

use std::fmt::Write as _;

/// What a figure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// It goes up and down.
    Gauge,
    /// It only grows, until the program starts anew.
    Counter,
}

/// A page of figures.
#[derive(Debug, Default)]
pub(crate) struct Page {
    text: String,
}

impl Page {
    /// A figure without labels; nothing when it is not known.
    pub(crate) fn figure(&mut self, (name, kind): (&str, Kind), help: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.head((name, kind), help);
            // A text takes all that is written to it.
            let _never_fails = writeln!(self.text, "{name} {value}");
        }
    }

    /// A figure for each value of a label.
    pub(crate) fn figures<'a>(
        &mut self,
        (name, kind): (&str, Kind),
        help: &str,
        (label, rows): (&str, impl Iterator<Item = (&'a str, f64)>),
    ) {
        let mut rows = rows.peekable();
        if rows.peek().is_some() {
            self.head((name, kind), help);
        }
        for (of, value) in rows {
            let of = escaped(of);
            let _never_fails = writeln!(self.text, "{name}{{{label}=\"{of}\"}} {value}");
        }
    }

    fn head(&mut self, (name, kind): (&str, Kind), help: &str) {
        let kind = match kind {
            Kind::Gauge => "gauge",
            Kind::Counter => "counter",
        };
        let _never_fails = write!(self.text, "# HELP {name} {help}\n# TYPE {name} {kind}\n");
    }

    pub(crate) fn into_text(self) -> String {
        self.text
    }
}

fn escaped(label: &str) -> String {
    label
        .replace('\\', "\\\\")
        .replace('"', "\\\"")
        .replace('\n', "\\n")
}

#[cfg(test)]
mod tests {
    use super::{Kind, Page};

    #[test]
    fn a_page_is_as_the_format_wants_it() {
        let mut page = Page::default();
        page.figure(("a_volts", Kind::Gauge), "The voltage.", Some(1.5));
        page.figure(("b", Kind::Gauge), "Not known.", None);
        page.figures(
            ("c_total", Kind::Counter),
            "Stops.",
            ("reason", [("x\"\\\n", 2.0)].into_iter()),
        );
        page.figures(("d", Kind::Gauge), "None.", ("of", [].into_iter()));
        assert_eq!(
            page.into_text(),
            "# HELP a_volts The voltage.\n# TYPE a_volts gauge\na_volts 1.5\n\
             # HELP c_total Stops.\n# TYPE c_total counter\nc_total{reason=\"x\\\"\\\\\\n\"} 2\n"
        );
    }
}
