//! Requests and what answers them.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use anyhow::bail;
use rvac_api::{Request, RequestBody, Topic, Update};

use crate::arguments::Daemon;
use crate::socket::Connection;

/// The daemon answers at once; this covers a machine under load.
pub(crate) const ANSWER: Duration = Duration::from_secs(10);
/// Number of our only request.
const REQUEST_ID: u32 = 1;

pub(crate) fn start(strategy: Option<String>, daemon: &Daemon) -> anyhow::Result<ExitCode> {
    send(RequestBody::Start { strategy }, daemon)
}

/// Sends a request and waits until vthal says how it went.
pub(crate) fn send(body: RequestBody, daemon: &Daemon) -> anyhow::Result<ExitCode> {
    ask(&mut Connection::open(daemon)?, body)
}

/// As [`send`], over an open connection.
pub(crate) fn ask(connection: &mut Connection, body: RequestBody) -> anyhow::Result<ExitCode> {
    answer(connection, body, ANSWER, |update, _| match update {
        Update::Done { id: REQUEST_ID } => Some(ExitCode::SUCCESS),
        _ => None,
    })
}

/// Sends a request and waits for the update that answers it, which `found` recognizes; it is also given the daemon's own text.
pub(crate) fn answer<Found>(
    connection: &mut Connection,
    body: RequestBody,
    patience: Duration,
    found: impl Fn(Update, String) -> Option<Found>,
) -> anyhow::Result<Found> {
    connection.send(&Request {
        id: Some(REQUEST_ID),
        body,
    })?;
    awaited(connection, patience, found)
}

/// Follows topics and waits for the view that `found` recognizes. The request has no number: its `done` would come after the view, and be
/// taken for the answer to the next request.
pub(crate) fn followed<Found>(
    connection: &mut Connection,
    topics: Vec<Topic>,
    found: impl Fn(Update, String) -> Option<Found>,
) -> anyhow::Result<Found> {
    connection.watch(topics)?;
    awaited(connection, ANSWER, found)
}

fn awaited<Found>(
    connection: &mut Connection,
    patience: Duration,
    found: impl Fn(Update, String) -> Option<Found>,
) -> anyhow::Result<Found> {
    let deadline = Instant::now() + patience;
    while let Some(message) = connection.receive_until(deadline)? {
        match message.update {
            Some(Update::Failed(failure)) if failure.id.is_none_or(|id| id == REQUEST_ID) => {
                bail!("refused ({}): {}", failure.reason, failure.text);
            }
            Some(update) => {
                if let Some(found) = found(update, message.text) {
                    return Ok(found);
                }
            }
            None => {}
        }
    }
    bail!("vthal did not answer within {} s", patience.as_secs())
}
