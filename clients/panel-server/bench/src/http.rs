//! As much of HTTP/1.1 as a measurement needs: one request after the other on a connection that stays.

use std::io::{Read, Write};

use anyhow::{Context, bail};

/// Lines of an answer's head.
const LINES_MAX: usize = 32;

/// Sends a GET with further header lines and gives the body.
///
/// # Errors
/// The server hangs up, is silent for too long, or answers anything but 200.
pub fn get(stream: &mut (impl Read + Write), path: &str, headers: &str) -> anyhow::Result<Vec<u8>> {
    stream.write_all(format!("GET {path} HTTP/1.1\r\n{headers}\r\n").as_bytes())?;
    stream.flush()?;
    let mut received = Vec::new();
    loop {
        let mut bytes = [0; 16 << 10];
        let count = stream.read(&mut bytes)?;
        if count == 0 {
            bail!("the server hung up in the middle of an answer");
        }
        received.extend_from_slice(bytes.get(..count).unwrap_or_default());
        if let Some(body) = body_of(&received)? {
            return Ok(body.to_vec());
        }
    }
}

/// The body, when all of it is there.
fn body_of(received: &[u8]) -> anyhow::Result<Option<&[u8]>> {
    let mut lines = [httparse::EMPTY_HEADER; LINES_MAX];
    let mut head = httparse::Response::new(&mut lines);
    let httparse::Status::Complete(at) = head.parse(received).context("no answer of HTTP")? else {
        return Ok(None);
    };
    if head.code != Some(200) {
        bail!("the answer was {:?}", head.code);
    }
    let length = head
        .headers
        .iter()
        .find(|line| line.name.eq_ignore_ascii_case("content-length"))
        .and_then(|line| std::str::from_utf8(line.value).ok()?.parse::<usize>().ok())
        .context("an answer without its length")?;
    let body = received.get(at..).unwrap_or_default();
    Ok((body.len() >= length).then_some(body))
}
