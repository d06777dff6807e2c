//! `cargo xtask book-pictures`: makes the pictures of the book's measurements with today's code.
//!
//! The runs are fixed and deterministic, so that the same code gives the same bytes. They take a minute or two; that is why
//! no test makes them again.

use crate::process;
use crate::workspace::{self, Profile};
use anyhow::Context;
use std::path::Path;
use std::process::Command;

/// The home of all runs.
const HOME: &str = "generated:7";

/// Runs in the order in which their files are numbered, which is that of their names.
const RUNS: [&[&str]; 3] = [
    &["--strategy", "bounce", "--minutes", "60"],
    &[
        "--strategy",
        "systematic",
        "--minutes",
        "60",
        "--until-done",
        "--known-map",
    ],
    &["--strategy", "systematic", "--minutes", "60", "--until-done"],
];

/// The simulator's pictures that the book shows, and their names there.
const SHOWN: [(&str, &str); 5] = [
    ("coverage.svg", "coverage.svg"),
    ("place.svg", "place.svg"),
    ("3-way.svg", "first-run-way.svg"),
    ("3-map.svg", "first-run-map.svg"),
    ("2-way.svg", "known-map-way.svg"),
];

/// Makes them.
pub(crate) fn run() -> anyhow::Result<()> {
    workspace::build(&["rvac-sim"], Profile::Dev)?;
    let folder = workspace::target().join("book-pictures");
    if folder.exists() {
        std::fs::remove_dir_all(&folder).with_context(|| format!("cannot empty {}", folder.display()))?;
    }
    for run in RUNS {
        let mut command = simulator();
        command
            .args(["run", "--home", HOME])
            .args(run)
            .arg("--keep")
            .arg(&folder);
        process::run(&format!("run {}", run.join(" ")), &mut command)?;
    }
    let mut command = simulator();
    command.arg("report").arg(&folder).arg("--pictures");
    process::run("draw", &mut command)?;
    let book = workspace::root().join("docs/book/src/images");
    for (drawn, shown) in SHOWN {
        copy(&folder.join(drawn), &book.join(shown))?;
    }
    process::say(&format!("the pictures are in {}", book.display()));
    Ok(())
}

fn simulator() -> Command {
    let mut command = Command::new(workspace::program("rvac-sim", Profile::Dev));
    command.current_dir(workspace::root());
    command
}

fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    std::fs::copy(from, to).with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::SHOWN;
    use crate::codegen::drawings::DRAWINGS;
    use crate::workspace;

    #[test]
    fn the_book_shows_what_is_made_and_nothing_else() {
        let book = workspace::root().join("docs/book/src");
        let page = std::fs::read_to_string(book.join("measurements/systematic-known.md")).expect("readable");
        for (_, shown) in SHOWN {
            assert!(
                page.contains(&format!("(../images/{shown})")),
                "{shown} is not shown"
            );
            assert!(book.join("images").join(shown).exists(), "{shown} was not made");
        }
        let of_this_command = |name: &str| SHOWN.iter().any(|(_, shown)| *shown == name);
        let is_made = |name: &str| of_this_command(name) || DRAWINGS.contains(&name);
        let names = std::fs::read_dir(book.join("images"))
            .expect("readable")
            .map(|entry| entry.expect("readable").file_name());
        let strange: Vec<_> = names.filter(|name| !name.to_str().is_some_and(is_made)).collect();
        assert_eq!(strange, [""; 0], "files that no command makes");
    }
}
