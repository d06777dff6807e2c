//! What the person beside the robot does with its buttons, as the daemon reports it.

use std::time::Duration;

use pairing::wire::Forgotten;
use rvac_api::{Gesture, Request, RequestBody, Topic, Update};
use tokio::time::{Interval, MissedTickBehavior, interval};
use tracing::{debug, info, warn};

use crate::gate::Gate;
use crate::upstream::{Event, Upstream};

/// While presses are waited for, they are judged this often.
const JUDGE_EVERY: Duration = Duration::from_millis(100);

/// The button that a device asks to press.
const START: u8 = 0;

/// For how long the daemon leaves presses to this server: renewed while they are waited for, so that it ends soon after a crash.
const CLAIM_MS: u32 = 2_000;

/// Ticks after which the claim is renewed.
const CLAIM_EVERY: u8 = 10;

/// Receives what the daemon reports of the buttons, for ever.
pub(crate) async fn watch_buttons(gate: &Gate) {
    let mut ears = Ears {
        gate,
        daemon: gate.daemon(),
        waits: false,
        ticks: 0,
    };
    let mut pulse = interval(JUDGE_EVERY);
    pulse.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        ears.turn(&mut pulse).await;
    }
}

struct Ears<'g> {
    gate: &'g Gate,
    daemon: Upstream,
    /// Presses are waited for.
    waits: bool,
    /// Since the claim was renewed.
    ticks: u8,
}

impl Ears<'_> {
    async fn turn(&mut self, pulse: &mut Interval) {
        tokio::select! {
            event = self.daemon.next() => self.on_event(event).await,
            () = self.gate.guarded.presses_wanted() => self.begin_to_wait().await,
            _ = pulse.tick(), if self.waits => self.judge().await,
        }
    }

    async fn on_event(&mut self, event: Event) {
        match event {
            Event::Connected => {
                let name = "panel-server".to_owned();
                self.say(RequestBody::Hello { name }).await;
                let topics = vec![Topic::Buttons];
                self.say(RequestBody::Watch { topics }).await;
            }
            Event::Lost => {}
            Event::Message(text) => {
                if let Ok(Update::Button { gesture, button, .. }) = serde_json::from_str(&text) {
                    self.on_gesture(gesture, button).await;
                }
            }
        }
    }

    async fn on_gesture(&mut self, gesture: Gesture, button: u8) {
        match gesture {
            Gesture::Press => self.gate.guarded.press(button == START).await,
            Gesture::RecoveryHold => self.recover().await,
            Gesture::PairingHold => match self.gate.guarded.open_by_button().await {
                Ok(()) => self.gate.beep(),
                Err(error) => info!(%error, "START is held, and no window is opened"),
            },
        }
    }

    /// Forgets all devices, and lets the next one in.
    async fn recover(&self) {
        let outcome = async {
            self.gate.guarded.forget_all(Forgotten::Buttons).await?;
            self.gate.guarded.open_by_button().await
        };
        match outcome.await {
            Ok(()) => self.gate.beep(),
            Err(error) => warn!(%error, "START and DOCK are held, and not all devices could be forgotten"),
        }
    }

    async fn begin_to_wait(&mut self) {
        self.waits = true;
        self.claim(CLAIM_MS).await;
    }

    async fn judge(&mut self) {
        self.waits = self.gate.guarded.judge_presses().await;
        self.ticks += 1;
        if !self.waits {
            self.claim(0).await;
        } else if self.ticks >= CLAIM_EVERY {
            self.claim(CLAIM_MS).await;
        }
    }

    async fn claim(&mut self, ms: u32) {
        self.ticks = 0;
        self.say(RequestBody::ClaimButtons { ms }).await;
    }

    /// A daemon that is away has no buttons either.
    async fn say(&mut self, body: RequestBody) {
        let text = serde_json::to_string(&Request { id: None, body }).unwrap_or_default();
        if self.daemon.send(&text).await.is_err() {
            debug!("the daemon is away");
        }
    }
}
