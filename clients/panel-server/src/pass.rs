//! What a paired client may do on its WebSocket, as long as it is paired.

use std::sync::Arc;

use pairing::wire::Greeting;
use pairing::{Asker, Denied, Register, Role, checked_request};
use rvac_api::{Request, RequestBody, SoftwareUpdate};
use tokio::sync::{broadcast, watch};

use crate::api::may;
use crate::courtesy::{introduction, refused};
use crate::gate::Gate;
use crate::guarded::{Known, Newcomer};

/// The pass of one client on one connection.
#[derive(Debug)]
pub(crate) struct Pass {
    gate: Arc<Gate>,
    known: Known,
    register: watch::Receiver<Register>,
    notices: broadcast::Receiver<Newcomer>,
    software: watch::Receiver<Option<SoftwareUpdate>>,
    greeted: bool,
}

/// What happens to a pass from outside.
#[derive(Debug)]
pub(crate) enum Change {
    /// The client was shut out.
    Revoked,
    /// Somebody else was let in.
    Newcomer(Newcomer),
    /// An update of the software goes on or has ended.
    Software(SoftwareUpdate),
}

/// What to do with a message of the browser.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Judged {
    /// It was the word that opens the connection.
    Greeted,
    /// To be sent to the daemon.
    PassOn(String),
    /// To be sent to the browser.
    Answer(String),
    /// The connection was never opened rightly.
    Stranger,
}

impl Pass {
    pub(crate) fn new(gate: Arc<Gate>, known: Known) -> Self {
        let mut software = gate.software.watch();
        // Whoever comes hears how it stands.
        software.mark_changed();
        Self {
            register: gate.guarded.watch(),
            notices: gate.guarded.notices(),
            software,
            gate,
            known,
            greeted: false,
        }
    }

    /// Waits for the next change that concerns this client.
    pub(crate) async fn changed(&mut self) -> Change {
        loop {
            if !self.renew() {
                return Change::Revoked;
            }
            let hears_of_software = self.greeted && self.known.role == Role::Admin;
            tokio::select! {
                gone = self.register.changed() => if gone.is_err() { return Change::Revoked },
                Ok(newcomer) = self.notices.recv() => return Change::Newcomer(newcomer),
                Ok(()) = self.software.changed(), if hears_of_software => {
                    if let Some(told) = self.software.borrow_and_update().clone() {
                        return Change::Software(told);
                    }
                }
            }
        }
    }

    /// Whether the client is still paired; takes over its present role.
    fn renew(&mut self) -> bool {
        let role = self
            .register
            .borrow_and_update()
            .get(self.known.id)
            .map(|client| client.role);
        role.map(|role| self.known.role = role).is_some()
    }

    /// Judges a message of the browser by the role of this moment.
    pub(crate) fn judge(&mut self, text: &str) -> Judged {
        if !self.renew() {
            return Judged::Stranger;
        }
        if !self.greeted {
            return self.greet(text);
        }
        let asker = Asker {
            role: self.known.role,
            is_present: self.gate.guarded.is_present(self.known.id),
        };
        match checked_request(text, asker) {
            Ok(request) => Judged::PassOn(self.under_own_name(request)),
            Err(Denied::Unreadable) => Judged::Answer(refused(
                text,
                "syntax",
                "The request could not be read: reload the page, or update the software.",
            )),
            Err(Denied::Absent) => {
                self.gate.guarded.ask_presence(self.known.id);
                Judged::Answer(refused(
                    text,
                    "not-present",
                    "Somebody must be beside the robot for that: press a button on it within a minute, then ask again. At its console, \
                     rvac clients vouch does the same.",
                ))
            }
            Err(Denied::NotAllowed { needed, .. }) => Judged::Answer(refused(
                text,
                "not-allowed",
                &not_allowed(self.known.role, needed),
            )),
        }
    }

    /// The same, with the name under which the client was paired where it sends one: the daemon and everybody who reads its log
    /// shall know which phone drives, and none may call itself another.
    fn under_own_name(&self, request: String) -> String {
        let register = self.register.borrow();
        let Some(client) = register.get(self.known.id) else {
            return request;
        };
        match serde_json::from_str::<Request>(&request) {
            Ok(Request {
                id,
                body: RequestBody::Hello { .. },
            }) => introduction(id, client.name.as_str()),
            _ => request,
        }
    }

    fn greet(&mut self, text: &str) -> Judged {
        let greeting: Option<Greeting> = serde_json::from_str(text).ok();
        self.greeted =
            greeting.is_some_and(|greeting| self.gate.guarded.take_nonce(self.known.id, &greeting.nonce));
        if self.greeted {
            Judged::Greeted
        } else {
            Judged::Stranger
        }
    }
}

fn not_allowed(role: Role, needed: Role) -> String {
    format!(
        "This device may only {}; that needs the role {needed}, which an administrator can give it.",
        may(role)
    )
}
