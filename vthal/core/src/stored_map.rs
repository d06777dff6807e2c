//! Bytes of a stored map, for the disk and for the beginning of a recording.
//!
//! `RVACMAP`, a version byte, the body, and a CRC-32 (IEEE 802.3) over everything before it, low byte first. Since version
//! 10 the body is a [`Body`] in the postcard format, since version 11 a [`Past`] follows it, and since version 12 the [`Beacons`] follow
//! that. Versions 1 to 9 are read by [`legacy`].

mod annotations;
mod body;
mod legacy;

use body::{Beacons, Body, Past};
use brain::{StoredMap, StoredMapError};
use serde::de::DeserializeOwned;

const MAGIC: &[u8; 7] = b"RVACMAP";
/// Version that is written.
const VERSION: u8 = 12;
/// Oldest version that is read.
const VERSION_MIN: u8 = 1;

/// Why bytes are no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// They do not begin like a map.
    #[error("it does not begin like a map")]
    NotAMap,
    /// A version that is not known here.
    #[error("it has version {0} and this program reads {VERSION_MIN} to {VERSION}")]
    Version(u8),
    /// The checksum is another one.
    #[error("its checksum is {computed:08X} and should be {stored:08X}")]
    Checksum {
        /// Of the bytes.
        computed: u32,
        /// At their end.
        stored: u32,
    },
    /// They end too early.
    #[error("it ends too early")]
    Cut,
    /// A number is longer than any that is written.
    #[error("it has a number that is too long")]
    Number,
    /// A kind of something that is not known here.
    #[error("it has a kind of something that is not known")]
    Kind,
    /// Something follows the end.
    #[error("something follows its end")]
    Trailing,
    /// What they hold makes no map.
    #[error(transparent)]
    Content(#[from] StoredMapError),
}

/// The bytes of a map.
#[must_use]
pub fn encode(map: &StoredMap) -> Vec<u8> {
    let mut header = MAGIC.to_vec();
    header.push(VERSION);
    // Every length is known and memory takes all bytes, so it cannot fail.
    let mut bytes = postcard::to_extend(&Body::of(map), header).unwrap_or_default();
    let sum = crc32fast::hash(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// The map of `bytes`.
///
/// # Errors
/// What is wrong with them; nothing is taken from broken bytes.
pub fn decode(bytes: &[u8]) -> Result<StoredMap, DecodeError> {
    let rest = bytes.strip_prefix(MAGIC).ok_or(DecodeError::NotAMap)?;
    let version = *rest.first().ok_or(DecodeError::Cut)?;
    if !(VERSION_MIN..=VERSION).contains(&version) {
        return Err(DecodeError::Version(version));
    }
    let (whole, sum) = bytes.split_last_chunk::<4>().ok_or(DecodeError::Cut)?;
    let (computed, stored) = (crc32fast::hash(whole), u32::from_le_bytes(*sum));
    if computed != stored {
        return Err(DecodeError::Checksum { computed, stored });
    }
    let mut reader = Reader {
        rest: whole.get(MAGIC.len() + 1..).ok_or(DecodeError::Cut)?,
    };
    let body = match version {
        10.. => reader.take(DecodeError::Kind)?,
        _ => legacy::body(&mut reader, version)?,
    };
    let past: Past = match version {
        11.. => reader.take(DecodeError::Number)?,
        _ => Past::new(),
    };
    let beacons: Beacons = match version {
        12.. => reader.take(DecodeError::Number)?,
        _ => Beacons::new(),
    };
    if !reader.rest.is_empty() {
        return Err(DecodeError::Trailing);
    }
    Ok(body.into_map(past, beacons)?)
}

/// What is left to read.
struct Reader<'bytes> {
    rest: &'bytes [u8],
}

impl Reader<'_> {
    /// The next value; `unknown` when it is of a kind that is not known here.
    fn take<T: DeserializeOwned>(&mut self, unknown: impl Into<DecodeError>) -> Result<T, DecodeError> {
        let (value, rest) = postcard::take_from_bytes(self.rest).map_err(|error| match error {
            postcard::Error::DeserializeUnexpectedEnd => DecodeError::Cut,
            postcard::Error::DeserializeBadUtf8 => StoredMapError::Name.into(),
            postcard::Error::SerdeDeCustom | postcard::Error::DeserializeBadEnum => unknown.into(),
            _ => DecodeError::Number,
        })?;
        self.rest = rest;
        Ok(value)
    }
}
