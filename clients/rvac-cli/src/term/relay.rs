//! Through the raw pass-through of vthal, which numbers the packets and adds the CRC.

use std::process::ExitCode;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use anyhow::bail;
use rvac_api::{Failure, Request, RequestBody, Topic, Update};
use rvac_protocol::message::Refusal;

use super::{print_packet, print_remark};
use crate::arguments::TermOptions;
use crate::lines;
use crate::show::{Shown, Verdict};
use crate::socket::Connection;

enum RelayEvent {
    Typed(String),
    InputEnded,
    Update(Box<Update>),
    Lost(anyhow::Error),
}

pub(super) fn run(mut connection: Connection, options: &TermOptions) -> anyhow::Result<ExitCode> {
    let mut sender = connection.sender()?;
    let (events, inbox) = channel();
    connection.watch(vec![Topic::Packets])?;
    follow(connection, events.clone());
    lines::read_input(events, RelayEvent::Typed, || RelayEvent::InputEnded);
    let start = Instant::now();
    let mut ends_at: Option<Instant> = None;
    let mut refused = false;
    loop {
        let pause = ends_at.map_or(Duration::from_secs(3600), |end| {
            end.saturating_duration_since(Instant::now())
        });
        match inbox.recv_timeout(pause) {
            Ok(RelayEvent::Typed(packet)) if packet.is_empty() => {}
            Ok(RelayEvent::Typed(packet)) => sender.send(&Request {
                id: Some(1),
                body: RequestBody::Raw { packet },
            })?,
            Ok(RelayEvent::InputEnded) => {
                ends_at = Some(Instant::now() + Duration::from_millis(options.linger))
            }
            Ok(RelayEvent::Update(update)) => match *update {
                Update::Packet { t, direction, text } => print_packet(t, direction, &relayed(text), options)?,
                Update::Failed(failure) => {
                    refused = true;
                    print_remark(start.elapsed().as_secs_f64(), &refusal(&failure))?;
                }
                _ => {}
            },
            Ok(RelayEvent::Lost(error)) => return Err(error),
            Err(RecvTimeoutError::Disconnected) => bail!("both input and connection have ended"),
            Err(RecvTimeoutError::Timeout) if ends_at.is_some() => break,
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
    Ok(if refused {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

fn follow(mut connection: Connection, events: Sender<RelayEvent>) {
    std::thread::spawn(move || {
        loop {
            let event = match connection.receive() {
                Ok(message) => message.update.map(|update| RelayEvent::Update(Box::new(update))),
                Err(error) => Some(RelayEvent::Lost(error)),
            };
            let over = matches!(event, Some(RelayEvent::Lost(_)));
            if event.is_some_and(|event| events.send(event).is_err()) || over {
                return;
            }
        }
    });
}

/// The daemon has checked the CRC and gives the text twin of what was binary.
fn relayed(text: String) -> Shown {
    let meaning = if text.is_empty() {
        Err(Refusal::Syntax)
    } else {
        Ok(String::new())
    };
    Shown {
        verdict: Verdict::Checked,
        text,
        binary: false,
        meaning,
    }
}

fn refusal(failure: &Failure) -> String {
    format!("vthal refuses ({}): {}", failure.reason, failure.text)
}
