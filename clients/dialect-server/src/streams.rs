//! States that are pushed: at most five clients a stream, of which the oldest leaves for a sixth; one that does not read misses states, and
//! nothing waits for it.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::future::pending;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::response::Sse;
use axum::response::sse::{Event, KeepAlive};
use futures_util::Stream;
use futures_util::stream::unfold;
use tokio::sync::{oneshot, watch};

use crate::reads::state_text;
use crate::site::{Site, Text};

/// Clients of one stream.
const CLIENTS_MAX: usize = 5;
/// Pause between signs of life, and what they say.
const LIFE_EVERY: Duration = Duration::from_secs(5);
const LIFE: &str = "sse-keep-alive";

/// What is pushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pushed {
    State,
    Attributes,
    Map,
}

impl Pushed {
    const fn event(self) -> &'static str {
        match self {
            Self::State => "StateUpdated",
            Self::Attributes => "StateAttributesUpdated",
            Self::Map => "MapUpdated",
        }
    }
}

/// The clients of each stream.
#[derive(Debug, Default)]
pub(crate) struct Streams {
    state: Mutex<Row>,
    attributes: Mutex<Row>,
    map: Mutex<Row>,
}

/// Clients in the order in which they came. One that has gone is known by its closed channel.
type Row = VecDeque<oneshot::Sender<()>>;

impl Streams {
    /// A place in the row; what is given ends when it is lost.
    fn join(&self, pushed: Pushed) -> oneshot::Receiver<()> {
        let row = match pushed {
            Pushed::State => &self.state,
            Pushed::Attributes => &self.attributes,
            Pushed::Map => &self.map,
        };
        let mut row = row.lock().unwrap_or_else(PoisonError::into_inner);
        row.retain(|client| !client.is_closed());
        while row.len() >= CLIENTS_MAX {
            row.pop_front();
        }
        let (client, leaving) = oneshot::channel();
        row.push_back(client);
        leaving
    }
}

/// A text that a client follows; nothing for one that it does not: maps are made only while somebody follows them.
type Followed = Option<watch::Receiver<Text>>;

async fn changed(followed: &mut Followed) -> Option<()> {
    match followed {
        Some(text) => text.changed().await.ok(),
        None => pending().await,
    }
}

fn newest(followed: &mut Followed) -> Text {
    followed
        .as_mut()
        .map_or_else(|| "".into(), |text| Arc::clone(&text.borrow_and_update()))
}

/// A client of a stream.
struct Follower {
    pushed: Pushed,
    leaving: oneshot::Receiver<()>,
    attributes: Followed,
    map: Followed,
    is_new: bool,
}

impl Follower {
    /// The next event: at once what is now, then what changes.
    async fn next(&mut self) -> Option<Event> {
        if !std::mem::take(&mut self.is_new) {
            tokio::select! {
                _ = &mut self.leaving => return None,
                said = changed(&mut self.attributes) => said?,
                said = changed(&mut self.map) => said?,
            }
        }
        let (attributes, map) = (newest(&mut self.attributes), newest(&mut self.map));
        let event = Event::default().event(self.pushed.event());
        Some(match self.pushed {
            Pushed::State => event.data(state_text(&attributes, &map)),
            Pushed::Attributes => event.data(attributes),
            Pushed::Map => event.data(map),
        })
    }
}

/// The stream for a client.
pub(crate) fn follow(
    site: &Site,
    pushed: Pushed,
) -> Sse<impl Stream<Item = Result<Event, Infallible>> + use<>> {
    let follower = Follower {
        pushed,
        leaving: site.streams.join(pushed),
        attributes: (pushed != Pushed::Map).then(|| site.attributes()),
        map: (pushed != Pushed::Attributes).then(|| site.map()),
        // A map on which nothing is is told to whoever asks, and pushed to nobody.
        is_new: pushed != Pushed::Map || site.frame().is_some(),
    };
    let events = unfold(follower, async |mut follower| {
        let event = follower.next().await?;
        Some((Ok(event), follower))
    });
    Sse::new(events).keep_alive(KeepAlive::new().interval(LIFE_EVERY).text(LIFE))
}

#[cfg(test)]
mod tests {
    use super::{CLIENTS_MAX, Pushed, Streams};

    #[test]
    fn the_oldest_leaves_for_a_sixth_and_who_has_gone_holds_no_place() {
        let streams = Streams::default();
        let mut clients: Vec<_> = (0..CLIENTS_MAX).map(|_| streams.join(Pushed::Map)).collect();
        drop(clients.remove(2));
        clients.push(streams.join(Pushed::Map));
        let leaves = |client: &mut tokio::sync::oneshot::Receiver<()>| {
            client.try_recv() == Err(tokio::sync::oneshot::error::TryRecvError::Closed)
        };
        assert!(!clients.iter_mut().any(leaves));
        let _other = streams.join(Pushed::State);
        assert!(!clients.iter_mut().any(leaves), "streams have rows of their own");
        let _sixth = streams.join(Pushed::Map);
        let left: Vec<bool> = clients.iter_mut().map(leaves).collect();
        assert_eq!(left, [true, false, false, false, false]);
    }
}
