//! `rvac history`: the runs that are over, one of them in full, and its recordings as a file.

mod words;

pub(crate) use words::when;

use std::fs::File;
use std::io::{Write as _, stdout};
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rvac_api::{RequestBody, Update};

use crate::arguments::{HistoryJob, HistoryVerb};
use crate::control::{self, ANSWER};
use crate::socket::Connection;

pub(crate) fn run(job: &HistoryJob) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&job.daemon)?;
    match &job.verb {
        None => list(job, &mut connection),
        Some(HistoryVerb::Show { number }) => show(job, *number, &mut connection),
        Some(HistoryVerb::Save {
            number,
            file,
            recording,
        }) => save(*number, recording.map(|place| place - 1), file, &mut connection),
    }
}

fn list(job: &HistoryJob, connection: &mut Connection) -> anyhow::Result<ExitCode> {
    let body = RequestBody::Runs {
        before: job.before,
        count: Some(job.count),
    };
    let (runs, more, text) = control::answer(connection, body, ANSWER, |update, text| match update {
        Update::Runs { runs, more } => Some((runs, more, text)),
        _ => None,
    })?;
    if job.json {
        writeln!(stdout(), "{text}")?;
    } else {
        write!(stdout(), "{}", words::list(&runs, more))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn show(job: &HistoryJob, number: u64, connection: &mut Connection) -> anyhow::Result<ExitCode> {
    let body = RequestBody::Run { number };
    let (record, text) = control::answer(connection, body, ANSWER, |update, text| match update {
        Update::Run(record) => Some((record, text)),
        _ => None,
    })?;
    if job.json {
        writeln!(stdout(), "{text}")?;
    } else {
        write!(stdout(), "{}", words::record(&record))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Saves a recording, or all of them as one file, piece by piece, never over something that is there.
fn save(
    number: u64,
    recording: Option<u32>,
    path: &Path,
    connection: &mut Connection,
) -> anyhow::Result<ExitCode> {
    let mut piece = |from| {
        let body = RequestBody::RunFile {
            number,
            recording,
            from,
        };
        control::answer(connection, body, ANSWER, |update, _| match update {
            Update::RunFile { data, size, name, .. } => Some((data, size, name)),
            _ => None,
        })
    };
    // The first piece comes before the file: what cannot be had leaves no empty one behind.
    let (mut data, _, name) = piece(0)?;
    let mut file = File::create_new(path)
        .with_context(|| format!("cannot create {}: is it there already?", path.display()))?;
    let mut written = 0;
    loop {
        let bytes = STANDARD
            .decode(&data)
            .context("vthal sent a piece that is no base 64")?;
        if bytes.is_empty() {
            break;
        }
        file.write_all(&bytes)
            .with_context(|| format!("cannot write {}", path.display()))?;
        written += bytes.len() as u64;
        let (next, size, _) = piece(written)?;
        if size.is_some_and(|size| written > size) {
            bail!("the recording became shorter while it was read: try again");
        }
        data = next;
    }
    writeln!(stdout(), "{name}: {written} bytes in {}", path.display())?;
    Ok(ExitCode::SUCCESS)
}
