//! `rvac floor export` and `import`: floors as one file, sent piece by piece.

use std::fs::{self, File};
use std::io::{Write as _, stdout};
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rvac_api::{ARCHIVE_BYTES_MAX, ARCHIVE_UPLOAD_BYTES, FloorsView, RequestBody, Update};

use super::{ask, called};
use crate::control::{self, ANSWER};
use crate::socket::Connection;

/// Writes the archive when all of it is here, never over something that is there.
pub(super) fn export(
    connection: &mut Connection,
    floor: Option<u16>,
    path: &Path,
) -> anyhow::Result<ExitCode> {
    let archive = fetch(connection, floor)?;
    let mut file = File::create_new(path)
        .with_context(|| format!("cannot create {}: is it there already?", path.display()))?;
    file.write_all(&archive)
        .and_then(|()| file.sync_all())
        .with_context(|| format!("cannot write {}", path.display()))?;
    writeln!(stdout(), "{} bytes in {}", archive.len(), path.display())?;
    Ok(ExitCode::SUCCESS)
}

fn fetch(connection: &mut Connection, floor: Option<u16>) -> anyhow::Result<Vec<u8>> {
    let mut archive = Vec::new();
    let mut begun = None;
    loop {
        let from = archive.len() as u64;
        let request = RequestBody::ExportFloors { floor, from };
        let (size, check, data) = control::answer(connection, request, ANSWER, |update, _| match update {
            Update::FloorArchive {
                size, check, data, ..
            } => Some((size, check, data)),
            _ => None,
        })?;
        if *begun.get_or_insert((size, check)) != (size, check) || size > ARCHIVE_BYTES_MAX {
            bail!("a map changed while the floors were read: try again");
        }
        let bytes = STANDARD
            .decode(&data)
            .context("vthal sent a piece that is no base 64")?;
        if bytes.is_empty() {
            bail!("vthal sent less than it promised: try again");
        }
        archive.extend(bytes);
        if archive.len() as u64 >= size {
            return Ok(archive);
        }
    }
}

/// Hands the file over and prints under which numbers and names its floors are stored.
pub(super) fn import(
    connection: &mut Connection,
    before: &FloorsView,
    path: &Path,
) -> anyhow::Result<ExitCode> {
    let unread = || format!("cannot read {}", path.display());
    let size = fs::metadata(path).with_context(unread)?.len();
    if size == 0 || size > ARCHIVE_BYTES_MAX {
        bail!(
            "{} is no archive of floors: it has {size} bytes, and those have up to {ARCHIVE_BYTES_MAX}. Take a file that \
             `rvac floor export` wrote",
            path.display()
        );
    }
    let archive = kept_file::read(path).with_context(unread)?;
    let mut from = 0;
    for piece in archive.chunks(ARCHIVE_UPLOAD_BYTES as usize) {
        let body = RequestBody::ImportFloors {
            from,
            size: archive.len() as u64,
            data: STANDARD.encode(piece),
        };
        control::ask(connection, body)?;
        from += piece.len() as u64;
    }
    // A client that follows the floors already does not get them again.
    connection.watch(Vec::new())?;
    let (after, _) = ask(connection)?;
    for floor in &after.floors {
        if before.floors.iter().all(|known| known.number != floor.number) {
            writeln!(stdout(), "taken in: floor {}", called(floor))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
