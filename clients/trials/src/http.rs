//! A small client of HTTP/1.1: one request a connection.

use std::fmt::Write as _;
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use anyhow::{Context as _, bail, ensure};
use serde_json::Value;

/// Who is asked.
#[derive(Clone, Debug, Default)]
pub(crate) struct Site {
    pub(crate) port: u16,
    /// What the site has given out after a login.
    pub(crate) token: Option<String>,
}

/// An answer.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    pub(crate) code: u16,
    pub(crate) head: String,
    pub(crate) body: Vec<u8>,
}

impl Answer {
    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }
}

impl Answer {
    /// The JSON of an answer that went well.
    fn json(&self, path: &str) -> anyhow::Result<Value> {
        ensure!(
            (200..300).contains(&self.code),
            "{path}: {} {}",
            self.code,
            self.text()
        );
        serde_json::from_slice(&self.body).with_context(|| format!("{path}: {}", self.text()))
    }

    fn read(answer: &[u8]) -> anyhow::Result<Self> {
        let at = answer
            .windows(4)
            .position(|four| four == b"\r\n\r\n")
            .context("an answer without a head")?;
        let (head, body) = answer.split_at(at + 4);
        let head = String::from_utf8_lossy(head).into_owned();
        let code = head
            .split(' ')
            .nth(1)
            .and_then(|code| code.parse().ok())
            .context("no code")?;
        let body = if head.to_ascii_lowercase().contains("transfer-encoding: chunked") {
            joined(body)?
        } else {
            body.to_vec()
        };
        Ok(Self { code, head, body })
    }
}

impl Site {
    /// The JSON of an answer that went well.
    pub(crate) fn get_json(&self, path: &str) -> anyhow::Result<Value> {
        self.get(path)?.json(path)
    }

    pub(crate) fn get(&self, path: &str) -> anyhow::Result<Answer> {
        self.ask(&format!("GET {path}"), None)
    }

    pub(crate) fn post_json(&self, path: &str, value: &Value) -> anyhow::Result<Value> {
        let body = ("application/json", value.to_string());
        self.ask(&format!("POST {path}"), Some(&body))?.json(path)
    }

    pub(crate) fn post_form(&self, path: &str, form: &str) -> anyhow::Result<Value> {
        let body = ("application/x-www-form-urlencoded", form.to_owned());
        self.ask(&format!("POST {path}"), Some(&body))?.json(path)
    }

    /// `what` is a method and a path, `body` a kind of medium and its text.
    fn ask(&self, what: &str, body: Option<&(&str, String)>) -> anyhow::Result<Answer> {
        let mut request = format!("{what} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n");
        if let Some(token) = &self.token {
            write!(request, "Authorization: Bearer {token}\r\n")?;
        }
        match body {
            None => request.push_str("\r\n"),
            Some((medium, text)) => write!(
                request,
                "Content-Type: {medium}\r\nContent-Length: {}\r\n\r\n{text}",
                text.len()
            )?,
        }
        let mut stream = TcpStream::connect(("127.0.0.1", self.port))?;
        stream.set_read_timeout(Some(Duration::from_secs(30)))?;
        stream.write_all(request.as_bytes())?;
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer)?;
        Answer::read(&answer)
    }
}

fn joined(mut chunks: &[u8]) -> anyhow::Result<Vec<u8>> {
    let mut body = Vec::new();
    loop {
        let at = chunks
            .windows(2)
            .position(|two| two == b"\r\n")
            .context("a chunk without a length")?;
        let (length, rest) = chunks.split_at(at);
        let length = usize::from_str_radix(std::str::from_utf8(length)?.trim(), 16)?;
        let rest = rest.get(2..).unwrap_or_default();
        if length == 0 {
            return Ok(body);
        }
        let Some((chunk, after)) = rest.split_at_checked(length) else {
            bail!("a chunk is cut off");
        };
        body.extend_from_slice(chunk);
        chunks = after.get(2..).unwrap_or_default();
    }
}
