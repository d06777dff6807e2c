//! What the server knows, and the texts that it gives out.

use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bridge::{Change, FanSpeed, Knowledge, Limiter};
use dialect::Frame;
use rvac_api::{ComponentHealth, RequestBody, Statistics, Update};
use tokio::sync::watch;
use tokio::time::Instant;

use crate::access::Access;
use crate::answer::Refusal;
use crate::configuration::Configuration;
use crate::desk::{Asked, Desk};
use crate::driving::Driving;
use crate::streams::Streams;

/// Least pause between two maps.
pub(crate) const MAP_EVERY: Duration = Duration::from_secs(2);

/// A text that is made once and sent to many.
pub(crate) type Text = Arc<str>;

/// All that requests are answered from.
#[derive(Debug)]
pub(crate) struct Site {
    begun: Instant,
    pub(crate) id: String,
    pub(crate) access: Access,
    desk: Desk,
    pub(crate) streams: Streams,
    store: Mutex<Store>,
    driving: Mutex<Driving>,
    limiter: Mutex<Limiter>,
    /// The state's attributes and the map, as JSON.
    attributes: watch::Sender<Text>,
    map: watch::Sender<Text>,
}

/// The newest of what the daemon has said.
#[derive(Debug, Default)]
pub(crate) struct Store {
    pub(crate) known: Knowledge,
    pub(crate) speed: FanSpeed,
    pub(crate) wear: Vec<ComponentHealth>,
    /// What all runs come to, once it was said.
    pub(crate) totals: Option<Statistics>,
    /// Of the map that was said last: places in commands are in it.
    frame: Option<Frame>,
    map_is_new: bool,
    map_at: Option<Instant>,
}

/// Nobody holds such a lock over a wait, and nothing that is done under it can panic half way.
fn lock<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Site {
    pub(crate) fn new(configuration: &Configuration, desk: Desk) -> Self {
        let store = Store::default();
        let attributes = dialect::attributes(&store.known, store.speed).to_string();
        Self {
            begun: Instant::now(),
            id: configuration.id.clone(),
            access: Access::new(configuration),
            desk,
            streams: Streams::default(),
            store: Mutex::new(store),
            driving: Mutex::default(),
            limiter: Mutex::default(),
            attributes: watch::Sender::new(attributes.into()),
            map: watch::Sender::new(dialect::empty_map().to_string().into()),
        }
    }

    pub(crate) fn now(&self) -> Duration {
        self.begun.elapsed()
    }

    pub(crate) fn store(&self) -> MutexGuard<'_, Store> {
        lock(&self.store)
    }

    pub(crate) fn driving(&self) -> MutexGuard<'_, Driving> {
        lock(&self.driving)
    }

    /// Takes what the daemon says; gives what it is to be asked next.
    pub(crate) fn take(&self, update: &Update) -> Option<RequestBody> {
        let mut store = self.store();
        let next = match update {
            Update::Health { components, .. } => {
                store.wear.clone_from(components);
                None
            }
            Update::Statistics(sums) => {
                store.totals = Some(sums.as_ref().clone());
                None
            }
            Update::RunKept(_) => Some(RequestBody::Statistics),
            _ => None,
        };
        match store.known.take(update) {
            Change::Map | Change::Home | Change::Pose => store.map_is_new = true,
            Change::Status | Change::Device | Change::Robot => {
                drop(store);
                self.say_attributes();
            }
            Change::Floors | Change::Schedules | Change::Nothing => {}
        }
        next
    }

    /// The daemon is gone.
    pub(crate) fn daemon_went(&self) {
        self.store().known.forget_state();
        self.driving().refused();
        self.say_attributes();
    }

    pub(crate) fn set_speed(&self, speed: FanSpeed) {
        self.store().speed = speed;
        self.say_attributes();
    }

    fn say_attributes(&self) {
        let store = self.store();
        let text = dialect::attributes(&store.known, store.speed).to_string();
        drop(store);
        self.attributes.send_if_modified(|said| {
            let is_new = **said != *text;
            if is_new {
                *said = text.into();
            }
            is_new
        });
    }

    /// Makes the map anew if it has changed, but not too often.
    pub(crate) fn say_map(&self) {
        let mut store = self.store();
        let now = Instant::now();
        let is_due = store.map_at.is_none_or(|at| now.duration_since(at) >= MAP_EVERY);
        if !store.map_is_new || !is_due {
            return;
        }
        if let Some((frame, map)) = dialect::map(&store.known) {
            store.map_is_new = false;
            store.map_at = Some(now);
            store.frame = Some(frame);
            self.map.send_replace(map.to_string().into());
        }
    }

    /// Somebody waits for maps.
    pub(crate) fn map_is_followed(&self) -> bool {
        self.map.receiver_count() > 0
    }

    pub(crate) fn attributes(&self) -> watch::Receiver<Text> {
        self.attributes.subscribe()
    }

    pub(crate) fn map(&self) -> watch::Receiver<Text> {
        self.say_map();
        self.map.subscribe()
    }

    /// That of the last map: places in commands are in it.
    pub(crate) fn frame(&self) -> Option<Frame> {
        self.say_map();
        self.store().frame
    }

    /// Lets a command through, unless they come faster than people say them.
    pub(crate) fn count_command(&self) -> Result<(), Refusal> {
        let allowed = lock(&self.limiter).allows(self.now());
        allowed.then_some(()).ok_or(Refusal::TooFast)
    }

    /// Asks the daemon, and waits for its answer.
    pub(crate) async fn ask(&self, body: RequestBody) -> Result<Asked, Refusal> {
        self.desk.ask(body).await
    }

    /// The same for a drive: after a refusal the client begins from rest again.
    pub(crate) async fn drive(&self, stick: [f64; 2], by: IpAddr) -> Result<(), Refusal> {
        let robot = self.store().known.robot.clone().ok_or(Refusal::Away)?;
        let asked = self
            .driving()
            .hear(stick, (by, Instant::now(), self.now()), &robot)?;
        for body in asked {
            if let Err(refusal) = self.ask(body).await {
                self.driving().refused();
                return Err(refusal);
            }
        }
        Ok(())
    }
}
