//! Homes inside of something: gzip, zlib, a picture that carries a Valetudo map, a byte order mark before the text.

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

use flate2::read::{GzDecoder, ZlibDecoder};

use super::{HomeError, TEXT_BYTES_MAX};

/// Chunk of a PNG in which Valetudo's own pictures carry the map: its type, its keyword, and the mark of zlib.
const VALETUDO_CHUNK: &[u8] = b"zTXtValetudoMap\0\0";

/// The bytes of the home itself.
pub(super) fn unpacked<'a>(path: &Path, bytes: &'a [u8]) -> Result<Cow<'a, [u8]>, HomeError> {
    let inner = if bytes.starts_with(&[0x1f, 0x8b]) {
        inflated(path, "gzip", GzDecoder::new(bytes))?
    } else if is_zlib(bytes) {
        inflated(path, "zlib", ZlibDecoder::new(bytes))?
    } else if let Some(chunk) = valetudo_chunk(bytes) {
        inflated(path, "the Valetudo map in the picture", ZlibDecoder::new(chunk))?
    } else {
        return Ok(Cow::Borrowed(without_mark(bytes)));
    };
    Ok(Cow::Owned(without_mark(&inner).to_vec()))
}

/// The two bytes of a zlib head with the usual window, whose sum of check is right.
fn is_zlib(bytes: &[u8]) -> bool {
    matches!(bytes, [0x78, flags, ..] if (0x7800 + u32::from(*flags)) % 31 == 0)
}

fn valetudo_chunk(bytes: &[u8]) -> Option<&[u8]> {
    if !bytes.starts_with(b"\x89PNG") {
        return None;
    }
    let at = bytes
        .windows(VALETUDO_CHUNK.len())
        .position(|window| window == VALETUDO_CHUNK)?;
    bytes.get(at + VALETUDO_CHUNK.len()..)
}

fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

fn inflated(path: &Path, what: &str, packed: impl Read) -> Result<Vec<u8>, HomeError> {
    let mut inner = Vec::new();
    match packed.take(TEXT_BYTES_MAX + 1).read_to_end(&mut inner) {
        Ok(length) if length as u64 > TEXT_BYTES_MAX => Err(HomeError::TooLong {
            path: path.to_owned(),
            bytes: length as u64,
            limit: TEXT_BYTES_MAX,
        }),
        Ok(_) => Ok(inner),
        Err(cause) if cause.kind() == std::io::ErrorKind::UnexpectedEof => Err(HomeError::Truncated {
            path: path.to_owned(),
            place: format!("{what} ends too early"),
        }),
        Err(cause) => Err(HomeError::Invalid {
            path: path.to_owned(),
            place: what.to_owned(),
            problem: format!("it cannot be unpacked: {cause}; save it again, or unpack it yourself"),
        }),
    }
}
