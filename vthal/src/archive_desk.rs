//! What clients ask of archives of floors: pieces of one that is written for them, and pieces of one that they hand over.

use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rvac_api::{ARCHIVE_BYTES_MAX, ARCHIVE_PIECE_BYTES, ARCHIVE_UPLOAD_BYTES, Update};
use vthal_core::{ArchiveOrder, ArchiveTask, ClientId, KeptFloor};

use crate::floor_archive::{self, ArchiveError};
use crate::floor_folder::{FloorError, FloorFolder};

/// An upload of which no piece came for so long is dropped when another client starts one.
const IDLE: Duration = Duration::from_secs(30);

/// What came of an order.
#[derive(Debug)]
pub(crate) struct ArchiveAnswer {
    /// Who asked.
    pub(crate) client: ClientId,
    /// Number of the request.
    pub(crate) id: Option<u32>,
    /// What came of it.
    pub(crate) outcome: Result<ArchiveOutcome, DeskError>,
}

/// See [`ArchiveAnswer`].
#[derive(Debug)]
pub(crate) enum ArchiveOutcome {
    /// A piece for the client.
    Piece(Box<Update>),
    /// The piece was taken, and more come.
    Waits,
    /// The archive is kept: all floors, and the numbers of the new ones.
    TakenIn(Vec<KeptFloor>, Vec<u16>),
}

/// Why an order is refused.
#[derive(Debug, thiserror::Error)]
pub(crate) enum DeskError {
    /// Something is wrong with the archive.
    #[error(transparent)]
    Archive(#[from] ArchiveError),
    /// The floors cannot be kept.
    #[error(transparent)]
    Floor(#[from] FloorError),
    /// There is nothing to write.
    #[error("There is no map to write into an archive: let the robot clean once.")]
    NoMap,
    /// A piece is none, or not the next one.
    #[error(
        "The next piece must begin at byte {expected} and have 1 to {ARCHIVE_UPLOAD_BYTES} bytes in base 64: send the archive from its beginning."
    )]
    Piece {
        /// First byte of the next one.
        expected: u64,
    },
    /// Another client is uploading an archive.
    #[error("Another archive is just being handed over: try again in half a minute.")]
    Busy,
}

impl DeskError {
    /// The reason's name for clients.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Archive(error) => error.name(),
            Self::Floor(error) => error.name(),
            Self::NoMap => "no-map",
            Self::Piece { .. } => "archive-piece",
            Self::Busy => "archive-busy",
        }
    }
}

/// An archive that comes in pieces. There is one at a time, so that clients cannot fill the memory.
#[derive(Debug)]
struct Upload {
    client: ClientId,
    size: u64,
    bytes: Vec<u8>,
    touched: Instant,
}

/// A piece as it came.
struct Piece {
    client: ClientId,
    from: u64,
    size: u64,
    data: String,
}

/// Where orders are carried out.
#[derive(Debug, Default)]
pub(crate) struct ArchiveDesk {
    upload: Option<Upload>,
}

impl ArchiveDesk {
    /// Handles a client's order at `now`.
    pub(crate) fn obey(&mut self, order: ArchiveOrder, floors: &FloorFolder, now: Instant) -> ArchiveAnswer {
        let ArchiveOrder { client, id, task } = order;
        let outcome = match task {
            ArchiveTask::Export { floor, from } => export(floors, floor, from),
            ArchiveTask::Import { from, size, data } => {
                let piece = Piece {
                    client,
                    from,
                    size,
                    data,
                };
                self.import(piece, floors, now)
            }
        };
        ArchiveAnswer { client, id, outcome }
    }

    fn import(
        &mut self,
        piece: Piece,
        floors: &FloorFolder,
        now: Instant,
    ) -> Result<ArchiveOutcome, DeskError> {
        // A failure ends the upload; only that of another client continues.
        let mut upload = self.upload_of(&piece, now)?;
        take(&mut upload, &piece)?;
        if (upload.bytes.len() as u64) < upload.size {
            self.upload = Some(upload);
            return Ok(ArchiveOutcome::Waits);
        }
        let taken = floors.take_in(&floor_archive::decode(&upload.bytes)?)?;
        Ok(ArchiveOutcome::TakenIn(floors.load().0, taken))
    }

    /// The upload to which the piece belongs; a first piece begins one.
    fn upload_of(&mut self, piece: &Piece, now: Instant) -> Result<Upload, DeskError> {
        let is_busy =
            |upload: &Upload| upload.client != piece.client && now.duration_since(upload.touched) < IDLE;
        if self.upload.as_ref().is_some_and(is_busy) {
            return Err(DeskError::Busy);
        }
        let present = self.upload.take().filter(|upload| upload.client == piece.client);
        if piece.from > 0 {
            let mut present = present.ok_or(DeskError::Piece { expected: 0 })?;
            present.touched = now;
            return Ok(present);
        }
        if piece.size > ARCHIVE_BYTES_MAX {
            return Err(ArchiveError::TooLarge(piece.size).into());
        }
        Ok(Upload {
            client: piece.client,
            size: piece.size,
            bytes: Vec::new(),
            touched: now,
        })
    }
}

/// Adds a piece that is the next one.
fn take(upload: &mut Upload, piece: &Piece) -> Result<(), DeskError> {
    let expected = upload.bytes.len() as u64;
    let bytes = STANDARD.decode(&piece.data).unwrap_or_default();
    let count = bytes.len() as u64;
    let fits = piece.from == expected
        && piece.size == upload.size
        && (1..=ARCHIVE_UPLOAD_BYTES).contains(&count)
        && count <= upload.size - expected;
    if !fits {
        return Err(DeskError::Piece { expected });
    }
    upload.bytes.extend(bytes);
    Ok(())
}

/// The archive is built again for each piece, so nothing is kept for clients that may never ask for the next; its checksum shows
/// them if a map changed in between.
fn export(floors: &FloorFolder, floor: Option<u16>, from: u64) -> Result<ArchiveOutcome, DeskError> {
    let archived = floors.archived(floor);
    if archived.is_empty() {
        return Err(DeskError::NoMap);
    }
    let archive = floor_archive::encode(&archived)?;
    let size = archive.len() as u64;
    let begin = from.min(size);
    let end = (begin + ARCHIVE_PIECE_BYTES).min(size);
    let piece = archive.get(begin as usize..end as usize).unwrap_or_default();
    Ok(ArchiveOutcome::Piece(Box::new(Update::FloorArchive {
        from: begin,
        size,
        check: floor_archive::check(&archive),
        data: STANDARD.encode(piece),
    })))
}

#[cfg(test)]
mod tests;
