//! `cargo xtask tidy`: the rules of the repository as checks. Each rule is a module with one function that lists
//! what breaks it; a rule that cannot be checked here says so instead of passing.

mod directions;
mod documents;
mod files;
mod folders;
mod foreign;
mod kinds;
mod layers;
mod length;
mod licences;
mod rust_text;
mod specification;
mod vocabulary;
mod words;

use crate::process;
use anyhow::bail;
use files::Files;

/// What a rule found.
#[derive(Debug, PartialEq, Eq)]
enum Finding {
    /// The rule was checked; each entry breaks it and names the place and the remedy.
    Checked(Vec<String>),
    /// It could not be checked here, and why.
    Skipped(String),
}

/// A rule: what it wants, and how that is checked.
struct Rule {
    wants: &'static str,
    check: fn(&Files) -> anyhow::Result<Finding>,
}

const RULES: [Rule; 14] = [
    Rule {
        wants: "crates depend only on crates they may know",
        check: directions::check,
    },
    Rule {
        wants: "crates are no_std and free of unsafe code where the architecture says so",
        check: kinds::check,
    },
    Rule {
        wants: layers::WANTS,
        check: layers::check,
    },
    Rule {
        wants: "every Rust file begins with what it is",
        check: length::heads,
    },
    Rule {
        wants: "files stay below 500 lines without tests",
        check: length::files,
    },
    Rule {
        wants: "functions stay below 70 lines",
        check: length::functions,
    },
    Rule {
        wants: "no unfinished business",
        check: words::check,
    },
    Rule {
        wants: "no retired word of the glossary is used",
        check: vocabulary::retired,
    },
    Rule {
        wants: "within a crate one name means one type",
        check: vocabulary::homonyms,
    },
    Rule {
        wants: "the specification names every word of the wire",
        check: specification::check,
    },
    Rule {
        wants: "dependencies have licences that fit",
        check: licences::check,
    },
    Rule {
        wants: "the README has one sentence for every folder",
        check: folders::check,
    },
    Rule {
        wants: "links and names in the documents lead somewhere",
        check: documents::check,
    },
    Rule {
        wants: "no map or log of somebody else is committed",
        check: foreign::check,
    },
];

/// What of the rules to show.
#[derive(Debug, clap::Args)]
pub(crate) struct TidyArguments {
    /// Prints the layers of the brain with their modules and circles, and checks nothing else.
    #[arg(long)]
    layers: bool,
}

/// Checks all rules and fails when one is broken.
pub(crate) fn run() -> anyhow::Result<()> {
    judge(&Files::list()?, RULES.iter())
}

/// Checks what is asked for.
pub(crate) fn run_with(arguments: &TidyArguments) -> anyhow::Result<()> {
    if !arguments.layers {
        return run();
    }
    let files = Files::list()?;
    layers::print(&files);
    judge(&files, RULES.iter().filter(|rule| rule.wants == layers::WANTS))
}

fn judge<'rules>(files: &Files, rules: impl Iterator<Item = &'rules Rule>) -> anyhow::Result<()> {
    let mut broken = 0_usize;
    for rule in rules {
        match (rule.check)(files)? {
            Finding::Skipped(why) => process::say(&format!("tidy: skipped: {}: {why}", rule.wants)),
            Finding::Checked(places) if places.is_empty() => {
                process::say(&format!("tidy: ok: {}", rule.wants))
            }
            Finding::Checked(places) => {
                process::complain(&format!("tidy: {}:", rule.wants));
                places
                    .iter()
                    .for_each(|place| process::print(&format!("  {place}")));
                broken += places.len();
            }
        }
    }
    if broken > 0 {
        bail!("tidy found {broken} places that break a rule of CONTRIBUTING.md");
    }
    Ok(())
}
