//! An archive: floors with the newest versions of their maps as one file, which people take along.
//!
//! `RVACFLRS`, a version byte, the number of floors, then of each the length of its name (none has no bytes), the name, the
//! length of its map (four bytes, low one first) and the map's bytes as they are kept; in the end a CRC-32C over everything
//! before it, low byte first. Maps have versions of their own: those that the disk may hold an archive may hold, too.

use brain::RoomName;
use rvac_api::ARCHIVE_BYTES_MAX;
use rvac_protocol::crc::crc32c;
use vthal_core::stored_map;

const MAGIC: &[u8; 8] = b"RVACFLRS";
const VERSION: u8 = 1;
const SUM_BYTES: usize = 4;

/// A floor in an archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ArchivedFloor {
    /// What people call it.
    pub(crate) name: Option<RoomName>,
    /// Its map, as kept.
    pub(crate) map: Vec<u8>,
}

/// Why bytes are no archive, or floors cannot be one.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum ArchiveError {
    /// They do not begin like one.
    #[error(
        "The file is no archive of floors: take one that the panel or `rvac floor export` wrote. Nothing was changed."
    )]
    Foreign,
    /// It is of a later program.
    #[error(
        "The archive has version {0}, and this vthal reads version {VERSION}: install the newer one. Nothing was changed."
    )]
    TooNew(u8),
    /// It was damaged in transit.
    #[error(
        "The archive is cut or damaged: its checksum is {computed:08X} and should be {stored:08X}. Copy it again. Nothing was changed."
    )]
    Checksum {
        /// Of the bytes.
        computed: u32,
        /// At their end.
        stored: u32,
    },
    /// Its parts do not fit together.
    #[error("The archive is wrong at byte {0}: write it anew. Nothing was changed.")]
    Wrong(usize),
    /// More than is taken.
    #[error(
        "The archive has {0} bytes, and {ARCHIVE_BYTES_MAX} are the most: make one of a single floor (`rvac floor export FILE --floor NAME`). Nothing was changed."
    )]
    TooLarge(u64),
    /// A map in it is none.
    #[error(
        "The map of floor {place} of the archive{} cannot be used: {what}. Nothing was changed.",
        name.as_ref().map_or_else(String::new, |name| format!(" ({})", name.as_str()))
    )]
    Map {
        /// Which, from 1.
        place: usize,
        /// What people call it.
        name: Option<RoomName>,
        /// What is wrong.
        what: String,
    },
}

impl ArchiveError {
    /// The reason's name for clients.
    pub(crate) const fn name(&self) -> &'static str {
        match self {
            Self::Foreign => "no-archive",
            Self::TooNew(_) => "archive-too-new",
            Self::Checksum { .. } | Self::Wrong(_) => "archive-damaged",
            Self::TooLarge(_) => "archive-too-large",
            Self::Map { .. } => "archive-map-wrong",
        }
    }
}

/// The bytes of an archive.
///
/// # Errors
/// [`ArchiveError::TooLarge`] when no daemon would accept it.
pub(crate) fn encode(floors: &[ArchivedFloor]) -> Result<Vec<u8>, ArchiveError> {
    let mut bytes = MAGIC.to_vec();
    bytes.push(VERSION);
    bytes.push(u8::try_from(floors.len()).unwrap_or(u8::MAX));
    for floor in floors {
        let name = floor.name.as_ref().map_or("", RoomName::as_str).as_bytes();
        // Forty characters have at most 160 bytes.
        bytes.push(u8::try_from(name.len()).unwrap_or(0));
        bytes.extend(name);
        let length = u32::try_from(floor.map.len()).map_err(|_| too_large(floor.map.len()))?;
        bytes.extend(length.to_le_bytes());
        bytes.extend(&floor.map);
    }
    bytes.extend(sum(&bytes).to_le_bytes());
    if bytes.len() as u64 > ARCHIVE_BYTES_MAX {
        return Err(too_large(bytes.len()));
    }
    Ok(bytes)
}

/// The checksum at the end of an archive.
pub(crate) fn check(archive: &[u8]) -> u32 {
    archive
        .last_chunk()
        .map_or(0, |stored| u32::from_le_bytes(*stored))
}

/// The floors of an archive, every map of which can be read.
///
/// # Errors
/// What is wrong with it; nothing is taken from a broken one.
pub(crate) fn decode(bytes: &[u8]) -> Result<Vec<ArchivedFloor>, ArchiveError> {
    if bytes.len() as u64 > ARCHIVE_BYTES_MAX {
        return Err(too_large(bytes.len()));
    }
    let body = bytes.strip_prefix(MAGIC).ok_or(ArchiveError::Foreign)?;
    match body.first() {
        Some(&VERSION) => {}
        Some(&version) if version > VERSION => return Err(ArchiveError::TooNew(version)),
        _ => return Err(ArchiveError::Wrong(MAGIC.len())),
    }
    let (whole, stored) = bytes
        .split_last_chunk::<SUM_BYTES>()
        .ok_or(ArchiveError::Foreign)?;
    let (computed, stored) = (sum(whole), u32::from_le_bytes(*stored));
    if computed != stored {
        return Err(ArchiveError::Checksum { computed, stored });
    }
    let mut reader = Reader {
        whole,
        at: MAGIC.len() + 1,
    };
    let count = reader.byte()?;
    let floors = (1..=usize::from(count))
        .map(|place| floor(&mut reader, place))
        .collect::<Result<Vec<_>, _>>()?;
    if floors.is_empty() || reader.at != whole.len() {
        return Err(ArchiveError::Wrong(reader.at));
    }
    Ok(floors)
}

fn floor(reader: &mut Reader<'_>, place: usize) -> Result<ArchivedFloor, ArchiveError> {
    let length = usize::from(reader.byte()?);
    let at = reader.at;
    let name = name(reader.take(length)?).map_err(|_| ArchiveError::Wrong(at))?;
    let at = reader.at;
    let length = reader.take(size_of::<u32>())?;
    let length = length.first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
    let length = length.and_then(|length| usize::try_from(length).ok());
    let map = reader.take(length.ok_or(ArchiveError::Wrong(at))?)?.to_vec();
    match stored_map::decode(&map) {
        Ok(_) => Ok(ArchivedFloor { name, map }),
        Err(error) => Err(ArchiveError::Map {
            place,
            name,
            what: error.to_string(),
        }),
    }
}

/// A name has one spelling, without spaces around it, so that reading and writing give the same bytes.
struct NotAName;

fn name(bytes: &[u8]) -> Result<Option<RoomName>, NotAName> {
    if bytes.is_empty() {
        return Ok(None);
    }
    let text = core::str::from_utf8(bytes).map_err(|_| NotAName)?;
    match RoomName::new(text) {
        Ok(name) if name.as_str() == text => Ok(Some(name)),
        _ => Err(NotAName),
    }
}

fn too_large(bytes: usize) -> ArchiveError {
    ArchiveError::TooLarge(bytes as u64)
}

fn sum(bytes: &[u8]) -> u32 {
    !crc32c(u32::MAX, bytes)
}

/// What is left of an archive.
struct Reader<'bytes> {
    whole: &'bytes [u8],
    at: usize,
}

impl<'bytes> Reader<'bytes> {
    fn take(&mut self, count: usize) -> Result<&'bytes [u8], ArchiveError> {
        let end = self.at.checked_add(count);
        let taken = end.and_then(|end| self.whole.get(self.at..end));
        let taken = taken.ok_or(ArchiveError::Wrong(self.at))?;
        self.at += count;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, ArchiveError> {
        let at = self.at;
        self.take(1)?.first().copied().ok_or(ArchiveError::Wrong(at))
    }
}

#[cfg(test)]
mod tests;
