//! The recording of a run, or all floors, as a file for the browser, asked of vthal piece by piece as the browser takes it.

use std::io;
use std::path::PathBuf;
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::http::{HeaderValue, Response, StatusCode, header};
use axum::response::IntoResponse;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use futures_util::stream::try_unfold;
use rvac_api::{Failure, Request, RequestBody, Update};
use tokio::time::timeout;

use crate::upstream::{Event, Upstream};

/// A disk that takes longer for a piece is as good as gone.
const PIECE_TIME_MAX: Duration = Duration::from_secs(20);
/// Number of our requests.
const REQUEST_ID: u32 = 1;

/// Name of the file with all floors.
const FLOORS_NAME: &str = "home.rvacfloors";

/// Which file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// The recording of a run.
    Recording {
        /// Number of the run.
        number: u64,
        /// Which of its recordings, from 0; all of them as one without that.
        recording: Option<u32>,
    },
    /// All floors.
    Floors,
}

impl Wanted {
    fn request(self, from: u64) -> RequestBody {
        match self {
            Self::Recording { number, recording } => RequestBody::RunFile {
                number,
                recording,
                from,
            },
            Self::Floors => RequestBody::ExportFloors { floor: None, from },
        }
    }
}

/// Why there is no piece.
enum NoPiece {
    /// vthal says so.
    Refused(Failure),
    /// vthal does not answer.
    Silent,
}

struct Piece {
    bytes: Vec<u8>,
    name: String,
    whole: Whole,
}

/// What pieces of one file have in common.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Whole {
    /// Unknown of a file that is made while it is read.
    size: Option<u64>,
    /// Of a file that is built again for each piece; recordings only grow.
    check: Option<u32>,
}

/// Answers with the file, or with a sentence that says why not.
pub(crate) async fn answer(vthal: PathBuf, wanted: Wanted) -> Response<Body> {
    let mut upstream = Upstream::new(vthal);
    let first = piece(&mut upstream, wanted, 0).await;
    let Piece { bytes, name, whole } = match first {
        Ok(first) => first,
        Err(NoPiece::Refused(failure)) => {
            return (StatusCode::NOT_FOUND, format!("{}\n", failure.text)).into_response();
        }
        Err(NoPiece::Silent) => {
            let text = "The robot's software does not answer.\n";
            return (StatusCode::BAD_GATEWAY, text).into_response();
        }
    };
    // Without a size the last piece is an empty one.
    let size = whole.size.unwrap_or(u64::MAX);
    let length = whole
        .size
        .map(|size| (header::CONTENT_LENGTH, HeaderValue::from(size)));
    let headers = [
        (header::CONTENT_TYPE, "application/octet-stream".to_owned()),
        (header::CACHE_CONTROL, "no-store".to_owned()),
        (
            header::CONTENT_DISPOSITION,
            format!("attachment; filename=\"{}\"", plain(&name)),
        ),
    ];
    let begun = (upstream, 0_u64, Some(bytes));
    let rest = try_unfold(begun, move |(mut upstream, sent, ready)| async move {
        if sent >= size {
            return Ok::<_, io::Error>(None);
        }
        let mut bytes = match ready {
            Some(bytes) => bytes,
            None => match piece(&mut upstream, wanted, sent).await {
                Ok(piece) if piece.whole.check == whole.check => piece.bytes,
                _ => return Err(io::ErrorKind::UnexpectedEof.into()),
            },
        };
        // A recording that grows meanwhile is as long as was promised.
        bytes.truncate(usize::try_from(size - sent).unwrap_or(usize::MAX));
        if bytes.is_empty() {
            return match whole.size {
                Some(_) => Err(io::ErrorKind::UnexpectedEof.into()),
                None => Ok(None),
            };
        }
        let sent = sent + bytes.len() as u64;
        Ok(Some((Bytes::from(bytes), (upstream, sent, None))))
    });
    let mut response = (headers, Body::from_stream(rest)).into_response();
    response.headers_mut().extend(length);
    response
}

async fn piece(upstream: &mut Upstream, wanted: Wanted, from: u64) -> Result<Piece, NoPiece> {
    timeout(PIECE_TIME_MAX, ask(upstream, wanted, from))
        .await
        .unwrap_or(Err(NoPiece::Silent))
}

async fn ask(upstream: &mut Upstream, wanted: Wanted, from: u64) -> Result<Piece, NoPiece> {
    let request = Request {
        id: Some(REQUEST_ID),
        body: wanted.request(from),
    };
    let text = serde_json::to_string(&request).map_err(|_| NoPiece::Silent)?;
    if from == 0 && upstream.next().await != Event::Connected {
        return Err(NoPiece::Silent);
    }
    upstream.send(&text).await.map_err(|_| NoPiece::Silent)?;
    loop {
        let Event::Message(text) = upstream.next().await else {
            return Err(NoPiece::Silent);
        };
        match serde_json::from_str(&text) {
            Ok(Update::Failed(failure)) => return Err(NoPiece::Refused(failure)),
            Ok(update) => {
                if let Some((name, whole, data)) = parts(update, from) {
                    let bytes = STANDARD.decode(data).map_err(|_| NoPiece::Silent)?;
                    return Ok(Piece { bytes, name, whole });
                }
            }
            Err(_) => {}
        }
    }
}

/// Name, whole and data of the piece that begins at `from`, if the update is that.
fn parts(update: Update, from: u64) -> Option<(String, Whole, String)> {
    match update {
        Update::RunFile {
            from: begins,
            name,
            size,
            data,
            ..
        } if begins == from => Some((name, Whole { size, check: None }, data)),
        Update::FloorArchive {
            from: begins,
            size,
            check,
            data,
        } if begins == from => {
            let whole = Whole {
                size: Some(size),
                check: Some(check),
            };
            Some((FLOORS_NAME.to_owned(), whole, data))
        }
        _ => None,
    }
}

/// A name that needs no quoting in a header.
fn plain(name: &str) -> String {
    let is_plain = |letter: &char| letter.is_ascii_alphanumeric() || "._-".contains(*letter);
    name.chars().filter(is_plain).take(100).collect()
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn names_cannot_break_out_of_their_header() {
        assert_eq!(plain("run-20261123-080000.mcap"), "run-20261123-080000.mcap");
        assert_eq!(plain("a\"\r\nSet-Cookie: b"), "aSet-Cookieb");
    }
}
