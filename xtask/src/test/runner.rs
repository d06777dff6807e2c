//! Running the commands of a stage: what they print goes on to the terminal and is counted on the way.

use super::count::Count;
use crate::process;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

/// A stage that failed, with what it had counted until then.
#[derive(Debug)]
pub(super) struct Failed {
    /// Tests until then.
    pub(super) count: Count,
    /// Why.
    pub(super) error: anyhow::Error,
}

impl From<anyhow::Error> for Failed {
    fn from(error: anyhow::Error) -> Self {
        Self {
            count: Count::default(),
            error,
        }
    }
}

/// What a stage gives.
pub(super) type Result = std::result::Result<Count, Failed>;

/// Runs a command that is one check: it passes or fails as a whole.
pub(super) fn check(command: &mut Command) -> Result {
    process::run(&process::name(command), command)?;
    Ok(Count::ONE)
}

/// Runs several checks and goes on after a failure, so that one run shows them all.
pub(super) fn checks(commands: &mut [Command]) -> Result {
    all(commands.iter_mut().map(check))
}

/// Joins results: the first error is kept, all counts are added.
pub(super) fn all(results: impl Iterator<Item = Result>) -> Result {
    let mut count = Count::default();
    let mut first = None;
    for result in results {
        match result {
            Ok(more) => count.add(more),
            Err(failed) => {
                count.add(failed.count.with_a_failure());
                first = first.or(Some(failed.error));
            }
        }
    }
    match first {
        Some(error) => Err(Failed { count, error }),
        None => Ok(count),
    }
}

/// Runs a test runner and counts the tests it reports; a runner that reports none fails.
pub(super) fn tests(command: &mut Command) -> Result {
    let name = process::name(command);
    process::say(&name);
    command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command
        .spawn()
        .map_err(|error| anyhow::anyhow!("cannot start {name}: {error}"))?;
    let errors = child
        .stderr
        .take()
        .map(|stream| std::thread::spawn(move || pass_on(stream)));
    let mut count = child.stdout.take().map(pass_on).unwrap_or_default();
    if let Some(Ok(more)) = errors.map(std::thread::JoinHandle::join) {
        count.add(more);
    }
    let status = child.wait().map_err(|error| anyhow::anyhow!("{name}: {error}"))?;
    if !status.success() {
        return Err(Failed {
            count,
            error: anyhow::anyhow!("{name} ended with {status}"),
        });
    }
    if count.passed == 0 {
        return Err(Failed {
            count,
            error: anyhow::anyhow!("{name} ran no test"),
        });
    }
    Ok(count)
}

fn pass_on(stream: impl Read) -> Count {
    let mut count = Count::default();
    for line in BufReader::new(stream)
        .split(b'\n')
        .map_while(std::result::Result::ok)
    {
        let line = String::from_utf8_lossy(&line).into_owned();
        count.read(&line);
        eprintln!("{line}");
    }
    count
}
