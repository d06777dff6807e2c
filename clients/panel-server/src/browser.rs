//! One browser: relays its messages until it goes away.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::extract::ws::{Message, WebSocket};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use tokio::sync::Notify;
use tokio::task::yield_now;
use tokio::time::{Instant, Interval, interval, timeout};
use tracing::{debug, info, warn};

use crate::courtesy::{
    Courtesy, disconnected, heartbeat, is_one_message, is_stop, new_device, refused, software_update,
};
use crate::outbox::{Outbox, Stalled};
use crate::pass::{Change, Judged, Pass};
use crate::seats::Seat;
use crate::upstream::{Event, Upstream};

/// A browser that takes longer for one message is dropped.
const SEND_LIMIT: Duration = Duration::from_secs(10);

/// A browser is asked for a sign of life this often and dropped after three of them in silence.
const PING_EVERY: Duration = Duration::from_secs(10);

/// A page that asked for it hears this often that the server is there.
const HEARTBEAT_EVERY: Duration = Duration::from_secs(1);

/// Bytes that may be on the way to such a page without a sign that they came: the answer to a press waits behind no more than these.
const ON_THE_WAY_MAX: u64 = 24 << 10;

/// Bytes after which it is asked for such a sign.
const ASK_EVERY: u64 = 4 << 10;

/// Ten drive commands a second and some clicks need a tenth of this.
const MESSAGES_PER_S_MAX: u32 = 200;

/// Relays between one browser and its upstreams until the browser goes away or misbehaves.
pub(crate) async fn relay(
    socket: WebSocket,
    (vthal, simulator): (Upstream, Option<Upstream>),
    guest: Guest,
    delivery: Delivery,
) {
    let (sink, stream) = socket.split();
    let shared = Arc::new(Shared::new(delivery));
    let writer = tokio::spawn(write_all(sink, Arc::clone(&shared)));
    let mut browser = Browser {
        shared,
        vthal,
        simulator,
        pass: guest.pass,
        seat: guest.seat,
        courtesy: Courtesy::default(),
        budget: Budget::default(),
        heard: Instant::now(),
        heard_daemon: None,
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

/// Whose browser it is.
pub(crate) struct Guest {
    /// None on the robot's own computer, where everything is allowed.
    pub(crate) pass: Option<Pass>,
    pub(crate) seat: Arc<Seat>,
}

/// How a client wants its updates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Delivery {
    /// Each as a message of its own.
    Whole,
    /// In pieces, with few bytes on the way and a heartbeat.
    Live,
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
    /// Somebody else needs the seat more.
    NoSeat,
}

impl From<Stalled> for Parting {
    fn from(_: Stalled) -> Self {
        Self::Stalled
    }
}

#[derive(Debug)]
struct Shared {
    delivery: Delivery,
    outbox: Mutex<Outbox>,
    /// Bytes that were sent, and those of them that have come.
    sent: AtomicU64,
    came: AtomicU64,
    filled: Notify,
    ping_due: Notify,
    failed: Notify,
}

impl Shared {
    fn new(delivery: Delivery) -> Self {
        let outbox = match delivery {
            Delivery::Whole => Outbox::default(),
            Delivery::Live => Outbox::in_pieces(),
        };
        Self {
            delivery,
            outbox: Mutex::new(outbox),
            sent: AtomicU64::new(0),
            came: AtomicU64::new(0),
            filled: Notify::new(),
            ping_due: Notify::new(),
            failed: Notify::new(),
        }
    }

    fn push(&self, text: String) -> Result<(), Stalled> {
        self.outbox
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(text)?;
        self.filled.notify_one();
        Ok(())
    }

    /// The next message, unless enough is on the way.
    fn pop(&self) -> Option<String> {
        let on_the_way = self.sent.load(Ordering::Relaxed) - self.came.load(Ordering::Relaxed);
        if self.delivery == Delivery::Live && on_the_way > ON_THE_WAY_MAX {
            return None;
        }
        self.outbox.lock().unwrap_or_else(PoisonError::into_inner).pop()
    }

    /// The browser answers that everything up to so many bytes has come; whether that is news.
    fn on_came(&self, payload: &[u8]) -> bool {
        let Ok(bytes) = payload.try_into().map(u64::from_be_bytes) else {
            return false;
        };
        // A number that was never sent counts for nothing.
        let is_news = bytes <= self.sent.load(Ordering::Relaxed)
            && bytes > self.came.fetch_max(bytes, Ordering::Relaxed);
        if is_news {
            self.filled.notify_one();
        }
        is_news
    }
}

struct Browser {
    shared: Arc<Shared>,
    vthal: Upstream,
    simulator: Option<Upstream>,
    /// None on the robot's own computer, where everything is allowed.
    pass: Option<Pass>,
    seat: Arc<Seat>,
    courtesy: Courtesy,
    budget: Budget,
    heard: Instant,
    /// When the daemon was heard last; none while there is no connection to it.
    heard_daemon: Option<Instant>,
}

impl Browser {
    async fn run(&mut self, mut stream: SplitStream<WebSocket>) -> Parting {
        let mut pulse = interval(PING_EVERY);
        let mut heartbeat = interval(HEARTBEAT_EVERY);
        // The first request must not find the connection half made.
        let first = self.vthal.next().await;
        let mut turn = self.on_vthal(first).await;
        loop {
            if let Err(parting) = turn {
                return parting;
            }
            turn = self.turn(&mut stream, [&mut pulse, &mut heartbeat]).await;
        }
    }

    async fn turn(
        &mut self,
        stream: &mut SplitStream<WebSocket>,
        [pulse, heartbeat]: [&mut Interval; 2],
    ) -> Result<(), Parting> {
        let shared = Arc::clone(&self.shared);
        tokio::select! {
            message = stream.next() => {
                self.on_browser(message).await?;
                // Many messages come in one read: others have their turn after each.
                yield_now().await;
                Ok(())
            }
            event = self.vthal.next() => self.on_vthal(event).await,
            event = next_of(&mut self.simulator) => self.on_simulator(event),
            change = change_of(&mut self.pass) => self.on_change(change),
            () = shared.failed.notified() => Err(Parting::Stalled),
            () = self.seat.parting() => Err(Parting::NoSeat),
            _ = pulse.tick() => self.on_pulse(),
            _ = heartbeat.tick() => self.on_heartbeat(),
        }
    }

    async fn on_browser(&mut self, message: Option<Result<Message, axum::Error>>) -> Result<(), Parting> {
        let Some(Ok(message)) = message else {
            return Err(Parting::Closed);
        };
        self.heard = Instant::now();
        // A page on a fast network is asked often.
        if matches!(&message, Message::Pong(payload) if self.shared.on_came(payload)) {
            return Ok(());
        }
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
        self.heard_daemon = (event != Event::Lost).then(Instant::now);
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
            Change::Software(told) => Ok(self.shared.push(software_update(told))?),
        }
    }

    fn on_heartbeat(&self) -> Result<(), Parting> {
        if self.shared.delivery == Delivery::Live {
            self.shared
                .push(heartbeat(self.heard_daemon.map(|heard| heard.elapsed())))?;
        }
        Ok(())
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
    let mut asked = 0;
    loop {
        tokio::select! {
            () = shared.filled.notified() => {}
            () = shared.ping_due.notified() => {
                if !send(&mut sink, Message::Ping(Vec::new().into())).await {
                    break;
                }
            }
        }
        if !send_waiting(&mut sink, &shared, &mut asked).await {
            break;
        }
    }
    shared.failed.notify_one();
}

/// Sends what waits as far as it may be on the way; `asked` = the bytes after which the browser was asked last whether they came.
async fn send_waiting(sink: &mut SplitSink<WebSocket, Message>, shared: &Shared, asked: &mut u64) -> bool {
    while let Some(text) = shared.pop() {
        let bytes = text.len() as u64;
        if !send(sink, Message::Text(text.into())).await {
            return false;
        }
        let sent = shared.sent.fetch_add(bytes, Ordering::Relaxed) + bytes;
        if shared.delivery == Delivery::Live && sent - *asked >= ASK_EVERY {
            *asked = sent;
            if !send(sink, Message::Ping(sent.to_be_bytes().to_vec().into())).await {
                return false;
            }
        }
    }
    true
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
