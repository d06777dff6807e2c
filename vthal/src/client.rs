//! One client of the socket: splitting what it sends, and what waits for it.

use std::io;
use std::rc::Rc;
use std::sync::Arc;

use rvac_api::{Failure, Request, SEPARATOR, Update};
use tokio::sync::Semaphore;
use tokio::sync::mpsc::Sender;
use tokio::task::AbortHandle;
use vthal_core::ClientId;

use crate::client_stream::ClientStream;
use crate::event::Event;
use crate::outbox::{Class, Outbox, Overflow};

/// Longest request in bytes. Whoever sends more is disconnected.
const REQUEST_MAX: usize = 16 << 10;
/// Bytes read at once.
const READ_SIZE: usize = 4096;

/// A connected client.
#[derive(Debug)]
pub(crate) struct Client {
    stream: Rc<ClientStream>,
    incoming: Vec<u8>,
    outbox: Outbox,
    /// Something waits until the socket takes bytes again.
    blocked: bool,
    /// The reason why it is disconnected as soon as its last word is out, or cannot get out.
    leaving: Option<&'static str>,
    /// The tasks that hold its stream open.
    tasks: Vec<AbortHandle>,
}

impl Drop for Client {
    fn drop(&mut self) {
        for task in &self.tasks {
            task.abort();
        }
    }
}

/// What a client's bytes hold.
#[derive(Debug, PartialEq)]
pub(crate) enum Incoming {
    /// A request.
    Request(Box<Request>),
    /// Something that is none; the answer says why.
    Broken(Failure),
    /// More than a request may have; the client must go.
    TooLong(Failure),
}

/// What became of a client's outbox.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flushed {
    /// All is out.
    Done,
    /// The rest waits until the socket takes bytes again; [`watch_writable`] must be started.
    Blocks,
    /// It waits already.
    Waits,
    /// The client is gone or must go, for the named reason.
    Gone(&'static str),
}

impl Client {
    /// A client that has just connected.
    #[must_use]
    pub(crate) fn new(stream: Rc<ClientStream>) -> Self {
        Self {
            stream,
            incoming: Vec::new(),
            outbox: Outbox::default(),
            blocked: false,
            leaving: None,
            tasks: Vec::new(),
        }
    }

    /// Its stream.
    #[must_use]
    pub(crate) fn stream(&self) -> &Rc<ClientStream> {
        &self.stream
    }

    /// Whether anything waits for it.
    #[must_use]
    pub(crate) fn has_mail(&self) -> bool {
        !self.outbox.is_empty()
    }

    /// Takes bytes and gives what they complete.
    pub(crate) fn receive(&mut self, bytes: &[u8]) -> Vec<Incoming> {
        if self.leaving.is_some() {
            return Vec::new();
        }
        let mut all = Vec::new();
        for piece in bytes.split_inclusive(|byte| *byte == SEPARATOR) {
            let (body, whole) = match piece.split_last() {
                Some((&SEPARATOR, body)) => (body, true),
                _ => (piece, false),
            };
            if self.incoming.len() + body.len() > REQUEST_MAX {
                all.push(Incoming::TooLong(failure(
                    "too-long",
                    "A request may have at most 16 KiB.",
                )));
                return all;
            }
            self.incoming.extend_from_slice(body);
            if whole {
                let packet = std::mem::take(&mut self.incoming);
                if !packet.trim_ascii().is_empty() {
                    all.push(parse(&packet));
                }
            }
        }
        all
    }

    /// Adds a message to what waits. A client that lets too much wait is disconnected; it receives the reason, if it ever reads again.
    pub(crate) fn push(&mut self, class: Class, message: Rc<[u8]>) {
        if self.leaving.is_none() && self.outbox.push(class, message) == Err(Overflow) {
            self.dismiss(
                failure(
                    "too-slow",
                    "Too much waited for this client: read faster, or follow less.",
                ),
                "too-slow",
            );
        }
    }

    /// The last word to a client that must go.
    pub(crate) fn dismiss(&mut self, last_word: Failure, reason: &'static str) {
        self.outbox.replace_all(encode(&Update::Failed(last_word)));
        self.leaving = Some(reason);
    }

    /// Sends what the socket takes.
    pub(crate) fn flush(&mut self) -> Flushed {
        if self.blocked {
            // A client that must go and does not even read its last word goes without.
            return self.leaving.map_or(Flushed::Waits, Flushed::Gone);
        }
        let stream = &self.stream;
        match self.outbox.flush(|slices| stream.try_write(slices)) {
            Ok(()) => self.leaving.map_or(Flushed::Done, Flushed::Gone),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                self.blocked = true;
                self.leaving.map_or(Flushed::Blocks, Flushed::Gone)
            }
            Err(_) => Flushed::Gone("hung-up"),
        }
    }

    /// Ends `task` together with the client.
    pub(crate) fn own(&mut self, task: AbortHandle) {
        self.tasks.retain(|task| !task.is_finished());
        self.tasks.push(task);
    }

    /// The socket takes bytes again.
    pub(crate) fn unblock(&mut self) {
        self.blocked = false;
    }
}

/// A message for the socket, separator included.
#[must_use]
pub(crate) fn encode(update: &Update) -> Rc<[u8]> {
    let mut bytes = serde_json::to_vec(update).unwrap_or_else(|error| {
        // Updates are plain data; only a number that JSON does not have could bring us here.
        tracing::error!("an update cannot be spelled: {error}");
        Vec::new()
    });
    bytes.push(SEPARATOR);
    bytes.into()
}

fn failure(reason: &str, text: &str) -> Failure {
    Failure {
        id: None,
        reason: reason.to_owned(),
        text: text.to_owned(),
    }
}

/// A request, or a failure that says what is wrong with it and carries its number if that can be read.
fn parse(packet: &[u8]) -> Incoming {
    let error = match serde_json::from_slice::<Request>(packet) {
        Ok(request) => return Incoming::Request(Box::new(request)),
        Err(error) => error,
    };
    let Ok(value) = serde_json::from_slice::<serde_json::Value>(packet) else {
        return Incoming::Broken(failure("syntax", &format!("This is not JSON: {error}.")));
    };
    let id = value
        .get("id")
        .and_then(serde_json::Value::as_u64)
        .and_then(|id| u32::try_from(id).ok());
    let text = format!("This is not a request: {error}.");
    let reason = match value.get("c") {
        Some(_) if text.contains("unknown variant") => "unknown",
        Some(_) => "arguments",
        None => "syntax",
    };
    Incoming::Broken(Failure {
        id,
        ..failure(reason, &text)
    })
}

/// Reads for a client until it hangs up. One that has ended only its own side may wait for answers still, as a script does that
/// pipes its requests in. Each request is an event of its own, and the next one waits until it was carried out: whoever sends without
/// end is one of all who wait for the daemon, however much is in its socket.
pub(crate) async fn read_for(client: ClientId, stream: Rc<ClientStream>, events: Sender<Event>) {
    let turns = Arc::new(Semaphore::new(1));
    let mut buffer = [0; READ_SIZE];
    while let Ok(count @ 1..) = stream.read(&mut buffer).await {
        let bytes = buffer.get(..count).unwrap_or_default();
        for piece in bytes.split_inclusive(|byte| *byte == SEPARATOR) {
            let Ok(turn) = Arc::clone(&turns).acquire_owned().await else {
                return;
            };
            let event = Event::ClientBytes(client, piece.to_vec(), turn);
            if events.send(event).await.is_err() {
                return;
            }
        }
    }
    if events.send(Event::ClientSilent(client)).await.is_ok() {
        stream.closed().await;
        // A closed queue means that the daemon ends.
        events.send(Event::ClientClosed(client)).await.ok();
    }
}

/// Tells once when the client's socket takes bytes again.
pub(crate) async fn watch_writable(client: ClientId, stream: Rc<ClientStream>, events: Sender<Event>) {
    let event = match stream.writable().await {
        Ok(()) => Event::ClientWritable(client),
        Err(_) => Event::ClientClosed(client),
    };
    // A closed queue means that the daemon ends.
    events.send(event).await.ok();
}

#[cfg(test)]
mod tests {
    use super::{Incoming, parse};

    fn check(packet: &str, reason: &str, id: Option<u32>) {
        match parse(packet.as_bytes()) {
            Incoming::Broken(failure) => {
                assert_eq!((failure.reason.as_str(), failure.id), (reason, id), "{packet}")
            }
            other => panic!("{packet} was taken for {other:?}"),
        }
    }

    #[test]
    fn broken_requests_get_a_named_reason_and_their_number() {
        check("nonsense", "syntax", None);
        check("[]", "syntax", None);
        check(r#"{"id":7}"#, "syntax", Some(7));
        check(r#"{"id":7,"c":"fly"}"#, "unknown", Some(7));
        check(
            r#"{"id":7,"c":"drive","v":"fast","w":0,"ttl":1}"#,
            "arguments",
            Some(7),
        );
        check(r#"{"c":"drive","v":1e999,"w":0,"ttl":1}"#, "syntax", None);
        check(&"[".repeat(5000), "syntax", None);
    }

    #[test]
    fn unknown_keys_are_ignored() {
        let Incoming::Request(request) = parse(br#"{"c":"stop","why":"because"}"#) else {
            panic!("refused")
        };
        assert_eq!(request.id, None);
    }
}
