//! One browser: relays its messages until it goes away.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::extract::ws::{Message, WebSocket};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use tokio::sync::Notify;
use tokio::time::{Instant, Interval, interval, timeout};
use tracing::{debug, info, warn};

use crate::courtesy::{Courtesy, disconnected, is_one_message, is_stop, new_device, refused};
use crate::outbox::{Outbox, Stalled};
use crate::pass::{Change, Judged, Pass};
use crate::upstream::{Event, Upstream};

/// A browser that takes longer for one message is dropped.
const SEND_LIMIT: Duration = Duration::from_secs(10);

/// A browser is asked for a sign of life this often and dropped after three of them in silence.
const PING_EVERY: Duration = Duration::from_secs(10);

/// Ten drive commands a second and some clicks need a tenth of this.
const MESSAGES_PER_S_MAX: u32 = 200;

/// Relays between one browser and its upstreams until the browser goes away or misbehaves.
pub(crate) async fn relay(
    socket: WebSocket,
    vthal: Upstream,
    simulator: Option<Upstream>,
    pass: Option<Pass>,
) {
    let (sink, stream) = socket.split();
    let shared = Arc::new(Shared::default());
    let writer = tokio::spawn(write_all(sink, Arc::clone(&shared)));
    let mut browser = Browser {
        shared,
        vthal,
        simulator,
        pass,
        courtesy: Courtesy::default(),
        budget: Budget::default(),
        heard: Instant::now(),
    };
    let parting = browser.run(stream).await;
    info!(?parting, "browser gone");
    if let Some(farewell) = browser.courtesy.farewell()
        && browser.vthal.send(&farewell).await.is_err()
    {
        debug!("vthal went away before the driver's seat could be released; the lease ends by itself");
    }
    writer.abort();
}

/// Why the relay ended.
#[derive(Clone, Copy, Debug)]
enum Parting {
    Closed,
    Silent,
    Stalled,
    Flooding,
    NotText,
    Stranger,
    Revoked,
}

impl From<Stalled> for Parting {
    fn from(_: Stalled) -> Self {
        Self::Stalled
    }
}

#[derive(Debug, Default)]
struct Shared {
    outbox: Mutex<Outbox>,
    filled: Notify,
    ping_due: Notify,
    failed: Notify,
}

impl Shared {
    fn push(&self, text: String) -> Result<(), Stalled> {
        self.outbox
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(text)?;
        self.filled.notify_one();
        Ok(())
    }

    fn pop(&self) -> Option<String> {
        self.outbox.lock().unwrap_or_else(PoisonError::into_inner).pop()
    }
}

struct Browser {
    shared: Arc<Shared>,
    vthal: Upstream,
    simulator: Option<Upstream>,
    /// None on the robot's own computer, where everything is allowed.
    pass: Option<Pass>,
    courtesy: Courtesy,
    budget: Budget,
    heard: Instant,
}

impl Browser {
    async fn run(&mut self, mut stream: SplitStream<WebSocket>) -> Parting {
        let mut pulse = interval(PING_EVERY);
        // The first request must not find the connection half made.
        let first = self.vthal.next().await;
        let mut turn = self.on_vthal(first).await;
        loop {
            if let Err(parting) = turn {
                return parting;
            }
            turn = self.turn(&mut stream, &mut pulse).await;
        }
    }

    async fn turn(
        &mut self,
        stream: &mut SplitStream<WebSocket>,
        pulse: &mut Interval,
    ) -> Result<(), Parting> {
        let shared = Arc::clone(&self.shared);
        tokio::select! {
            message = stream.next() => self.on_browser(message).await,
            event = self.vthal.next() => self.on_vthal(event).await,
            event = next_of(&mut self.simulator) => self.on_simulator(event),
            change = change_of(&mut self.pass) => self.on_change(change),
            () = shared.failed.notified() => Err(Parting::Stalled),
            _ = pulse.tick() => self.on_pulse(),
        }
    }

    async fn on_browser(&mut self, message: Option<Result<Message, axum::Error>>) -> Result<(), Parting> {
        let Some(Ok(message)) = message else {
            return Err(Parting::Closed);
        };
        self.heard = Instant::now();
        // Stop is passed on however often it is said.
        let says_stop = || matches!(&message, Message::Text(text) if is_stop(text.as_str()));
        if !self.budget.spend(self.heard) && !says_stop() {
            return Err(Parting::Flooding);
        }
        match message {
            Message::Text(text) => self.on_text(text.as_str()).await,
            Message::Ping(_) | Message::Pong(_) => Ok(()),
            Message::Close(_) => Err(Parting::Closed),
            Message::Binary(_) => Err(Parting::NotText),
        }
    }

    async fn on_text(&mut self, text: &str) -> Result<(), Parting> {
        let Some(pass) = &mut self.pass else {
            return self.on_request(text).await;
        };
        match pass.judge(text) {
            Judged::Greeted => Ok(()),
            Judged::PassOn(request) => self.on_request(&request).await,
            Judged::Answer(answer) => Ok(self.shared.push(answer)?),
            Judged::Stranger => Err(Parting::Stranger),
        }
    }

    async fn on_request(&mut self, text: &str) -> Result<(), Parting> {
        if !is_one_message(text) {
            let answer = refused("", "syntax", "A message must not contain the separator 0x1F.");
            return Ok(self.shared.push(answer)?);
        }
        self.courtesy.note(text);
        if self.vthal.send(text).await.is_err() {
            let answer = refused(
                text,
                "no-daemon",
                "The daemon vthal does not run: start it, the panel connects by itself.",
            );
            self.shared.push(answer)?;
        }
        Ok(())
    }

    async fn on_vthal(&mut self, event: Event) -> Result<(), Parting> {
        match event {
            Event::Connected => {
                for text in self.courtesy.introduction() {
                    if self.vthal.send(&text).await.is_err() {
                        warn!("vthal took the connection but not the first message");
                        break;
                    }
                }
                Ok(())
            }
            Event::Lost => Ok(self.shared.push(disconnected())?),
            Event::Message(text) => Ok(self.shared.push(text)?),
        }
    }

    fn on_simulator(&mut self, event: Event) -> Result<(), Parting> {
        match event {
            Event::Message(text) => Ok(self.shared.push(text)?),
            Event::Connected | Event::Lost => Ok(()),
        }
    }

    fn on_change(&mut self, change: Change) -> Result<(), Parting> {
        match change {
            Change::Revoked => Err(Parting::Revoked),
            Change::Newcomer(newcomer) => Ok(self.shared.push(new_device(newcomer))?),
        }
    }

    fn on_pulse(&mut self) -> Result<(), Parting> {
        if self.heard.elapsed() > 3 * PING_EVERY {
            return Err(Parting::Silent);
        }
        self.shared.ping_due.notify_one();
        Ok(())
    }
}

async fn next_of(upstream: &mut Option<Upstream>) -> Event {
    match upstream {
        Some(upstream) => upstream.next().await,
        None => std::future::pending().await,
    }
}

async fn change_of(pass: &mut Option<Pass>) -> Change {
    match pass {
        Some(pass) => pass.changed().await,
        None => std::future::pending().await,
    }
}

/// Sends what the outbox holds, and a ping when one is due, until the browser takes no more.
async fn write_all(mut sink: SplitSink<WebSocket, Message>, shared: Arc<Shared>) {
    loop {
        tokio::select! {
            () = shared.filled.notified() => {}
            () = shared.ping_due.notified() => {
                if !send(&mut sink, Message::Ping(Vec::new().into())).await {
                    break;
                }
            }
        }
        while let Some(text) = shared.pop() {
            if !send(&mut sink, Message::Text(text.into())).await {
                shared.failed.notify_one();
                return;
            }
        }
    }
    shared.failed.notify_one();
}

/// Whether the browser took the message in time.
async fn send(sink: &mut SplitSink<WebSocket, Message>, message: Message) -> bool {
    matches!(timeout(SEND_LIMIT, sink.send(message)).await, Ok(Ok(())))
}

/// Limits the messages per second.
#[derive(Debug, Default)]
struct Budget {
    second_began: Option<Instant>,
    spent: u32,
}

impl Budget {
    /// Whether one more message at `now` is within the limit.
    fn spend(&mut self, now: Instant) -> bool {
        match self.second_began {
            Some(began) if now.duration_since(began) < Duration::from_secs(1) => self.spent += 1,
            _ => {
                self.second_began = Some(now);
                self.spent = 1;
            }
        }
        self.spent <= MESSAGES_PER_S_MAX
    }
}

#[cfg(test)]
mod tests {
    use super::{Budget, MESSAGES_PER_S_MAX};
    use std::time::Duration;
    use tokio::time::Instant;

    #[test]
    fn budget_is_per_second() {
        let mut budget = Budget::default();
        let start = Instant::now();
        assert!((0..MESSAGES_PER_S_MAX).all(|_| budget.spend(start)));
        assert!(!budget.spend(start + Duration::from_millis(999)));
        assert!(budget.spend(start + Duration::from_millis(1000)));
    }
}
