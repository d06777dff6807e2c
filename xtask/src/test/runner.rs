//! Running the commands of a stage: what they print goes on to the terminal and is counted on the way.

use super::count::Count;
use super::verdicts::Verdicts;
use crate::{process, workspace};
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

/// A stage that failed, with what it had counted until then.
#[derive(Debug)]
pub(super) struct Failed {
    /// Tests until then.
    pub(super) count: Count,
    /// Why, one for each command that failed.
    pub(super) errors: Vec<anyhow::Error>,
}

impl From<anyhow::Error> for Failed {
    fn from(error: anyhow::Error) -> Self {
        Self {
            count: Count::default(),
            errors: vec![error],
        }
    }
}

/// What a stage gives.
pub(super) type Result = std::result::Result<Count, Failed>;

/// A cargo with these words.
pub(super) fn cargo(words: &[&str]) -> Command {
    let mut command = workspace::cargo();
    command.args(words);
    command
}

/// Runs a command that is one check: it passes or fails as a whole.
pub(super) fn check(command: &mut Command) -> Result {
    process::run(&process::name(command), command)?;
    Ok(Count::ONE)
}

/// Runs several checks and goes on after a failure, so that one run shows them all.
pub(super) fn checks(commands: &mut [Command]) -> Result {
    all(commands.iter_mut().map(check))
}

/// Runs checks two at a time: for those that take one core each. All run, whatever fails.
pub(super) fn checks_side_by_side(commands: Vec<Command>) -> Result {
    let waiting = Mutex::new(commands.into_iter());
    let results = Mutex::new(Vec::new());
    let work = || {
        while let Some(mut command) = { unpoisoned(&waiting).next() } {
            let result = check(&mut command);
            unpoisoned(&results).push(result);
        }
    };
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(work);
        }
    });
    all(results
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner)
        .into_iter())
}

/// A list is whole even when a thread ended that held it.
fn unpoisoned<T>(list: &Mutex<T>) -> MutexGuard<'_, T> {
    list.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Joins results: all errors are kept, all counts are added.
pub(super) fn all(results: impl Iterator<Item = Result>) -> Result {
    let mut count = Count::default();
    let mut errors = Vec::new();
    for result in results {
        match result {
            Ok(more) => count.add(more),
            Err(failed) => {
                count.add(failed.count.with_a_failure());
                errors.extend(failed.errors);
            }
        }
    }
    if errors.is_empty() {
        Ok(count)
    } else {
        Err(Failed { count, errors })
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
    let beside = child
        .stderr
        .take()
        .map(|stream| std::thread::spawn(move || pass_on(stream)));
    let mut verdicts = child.stdout.take().map(pass_on).unwrap_or_default();
    if let Some(Ok(more)) = beside.map(std::thread::JoinHandle::join) {
        verdicts.add(more);
    }
    let status = child.wait().map_err(|error| anyhow::anyhow!("{name}: {error}"))?;
    let count = verdicts.count;
    let failed = |error| {
        Err(Failed {
            count,
            errors: vec![error],
        })
    };
    if !status.success() {
        return failed(anyhow::anyhow!("{name} ended with {status}{verdicts}"));
    }
    if count.passed == 0 {
        return failed(anyhow::anyhow!("{name} ran no test"));
    }
    Ok(count)
}

fn pass_on(stream: impl Read) -> Verdicts {
    let mut verdicts = Verdicts::default();
    for line in BufReader::new(stream)
        .split(b'\n')
        .map_while(std::result::Result::ok)
    {
        let line = String::from_utf8_lossy(&line).into_owned();
        verdicts.read(&line);
        eprintln!("{line}");
    }
    verdicts
}
