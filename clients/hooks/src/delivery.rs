//! Telling: over HTTP or by a program for mail, a few times when it does not go at once.

use std::process::Stdio;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context as _, bail, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use bridge::dial::{HttpPlace, post};
use serde_json::json;
use tokio::io::AsyncWriteExt as _;
use tokio::process::Command;
use tokio::sync::mpsc;
use tokio::time::{sleep, timeout};

use crate::configuration::{Route, Target};
use crate::watcher::Notice;

/// Notices that wait for a target; a newer one than these is not told.
const WAITING_MAX: usize = 16;
/// Attempts, and the pause after the first; it doubles.
const ATTEMPTS: u32 = 6;
const PAUSE: Duration = Duration::from_secs(2);
/// A target takes a notice within this time.
const PATIENCE: Duration = Duration::from_secs(20);

/// A notice with all that goes along.
#[derive(Clone, Debug)]
pub(crate) struct Letter {
    pub(crate) robot: String,
    pub(crate) notice: Notice,
    /// The map as PNG, if there is one.
    pub(crate) picture: Option<Arc<Vec<u8>>>,
}

/// A target with its queue.
#[derive(Debug)]
pub(crate) struct Recipient {
    target: Target,
    queue: mpsc::Sender<Letter>,
}

impl Recipient {
    /// Starts its task.
    pub(crate) fn new(target: Target) -> Self {
        let (queue, letters) = mpsc::channel(WAITING_MAX);
        tokio::spawn(deliver_all(target.route.clone(), letters));
        Self { target, queue }
    }

    /// Tells it, if it is to be told of that.
    pub(crate) fn tell(&self, letter: &Letter) {
        if !self.target.when.contains(&letter.notice.event) {
            return;
        }
        if self.queue.try_send(letter.clone()).is_err() {
            tracing::warn!(route = ?self.target.route, "too much waits for it: a notice is lost");
        }
    }
}

async fn deliver_all(route: Route, mut letters: mpsc::Receiver<Letter>) {
    while let Some(letter) = letters.recv().await {
        let mut pause = PAUSE;
        for attempt in 1..=ATTEMPTS {
            match timeout(PATIENCE, deliver(&route, &letter)).await {
                Ok(Ok(())) => break,
                Ok(Err(error)) => tracing::warn!(attempt, "a notice was not taken: {error:#}"),
                Err(_) => tracing::warn!(attempt, "a notice was not taken in time"),
            }
            sleep(pause).await;
            pause *= 2;
        }
    }
}

async fn deliver(route: &Route, letter: &Letter) -> anyhow::Result<()> {
    match route {
        Route::Ntfy { url, token } => ntfy(url, token.as_deref(), letter).await,
        Route::Webhook { url } => {
            let place = HttpPlace::read(url).context("the address")?;
            let picture = letter
                .picture
                .as_ref()
                .map(|file| STANDARD.encode(file.as_slice()));
            let body = json!({
                "robot": letter.robot,
                "event": letter.notice.event,
                "title": letter.notice.title,
                "text": letter.notice.text,
                "reason": letter.notice.reason,
                "picture_png": picture,
            });
            let headers = [("Content-Type", "application/json")];
            accepted(post(&place, &headers, body.to_string().as_bytes()).await?)
        }
        Route::Mail { to, sendmail } => mail(to, sendmail, letter).await,
    }
}

/// With a picture the message stands in a header and the picture in the body; see ntfy's documentation of attachments.
async fn ntfy(url: &str, token: Option<&str>, letter: &Letter) -> anyhow::Result<()> {
    let place = HttpPlace::read(url).context("the address")?;
    let title = encoded_word(&format!("{}: {}", letter.robot, letter.notice.title));
    let text = encoded_word(&letter.notice.text);
    let bearer = token.map(|token| format!("Bearer {token}"));
    let urgent = letter.notice.event.is_urgent();
    let mut headers = vec![
        ("Title", title.as_str()),
        ("Priority", if urgent { "high" } else { "default" }),
    ];
    headers.extend(bearer.as_deref().map(|bearer| ("Authorization", bearer)));
    match &letter.picture {
        Some(picture) => {
            headers.extend([("Message", text.as_str()), ("Filename", "map.png")]);
            accepted(post(&place, &headers, picture).await?)
        }
        None => accepted(post(&place, &headers, letter.notice.text.as_bytes()).await?),
    }
}

fn accepted(code: u16) -> anyhow::Result<()> {
    ensure!((200..300).contains(&code), "the server answers {code}");
    Ok(())
}

/// Letters beyond ASCII in a header (RFC 2047).
fn encoded_word(text: &str) -> String {
    if text.bytes().all(|byte| (0x20..0x7f).contains(&byte)) {
        return text.to_owned();
    }
    format!("=?UTF-8?B?{}?=", STANDARD.encode(text))
}

async fn mail(to: &str, sendmail: &std::path::Path, letter: &Letter) -> anyhow::Result<()> {
    let mut child = Command::new(sendmail)
        .args(["-i", "--", to])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .kill_on_drop(true)
        .spawn()
        .with_context(|| format!("cannot start {}", sendmail.display()))?;
    let mut input = child.stdin.take().context("it takes no input")?;
    input.write_all(message(to, letter).as_bytes()).await?;
    drop(input);
    let status = child.wait().await?;
    if !status.success() {
        bail!("{} ended with {status}", sendmail.display());
    }
    Ok(())
}

/// A mail with the picture beside its text (RFC 2045 and 2046).
fn message(to: &str, letter: &Letter) -> String {
    let subject = encoded_word(&format!("{}: {}", letter.robot, letter.notice.title));
    let part = |kind: &str, bytes: &[u8]| {
        let lines = STANDARD.encode(bytes);
        let lines: Vec<&str> = lines
            .as_bytes()
            .chunks(76)
            .filter_map(|line| std::str::from_utf8(line).ok())
            .collect();
        format!(
            "--librervac\nContent-Type: {kind}\nContent-Transfer-Encoding: base64\n\n{}\n",
            lines.join("\n")
        )
    };
    let text = part("text/plain; charset=utf-8", letter.notice.text.as_bytes());
    let picture = letter
        .picture
        .as_ref()
        .map_or_else(String::new, |file| part("image/png; name=\"map.png\"", file));
    format!(
        "To: {to}\nSubject: {subject}\nMIME-Version: 1.0\nContent-Type: multipart/mixed; boundary=librervac\n\n{text}{picture}--librervac--\n"
    )
}
