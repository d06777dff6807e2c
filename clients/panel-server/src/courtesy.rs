//! What the server itself says and remembers on behalf of one browser: the little it must know about the messages it relays.

use std::time::Duration;

use crate::guarded::Newcomer;
use rvac_api::{Failure, Request, RequestBody, SEPARATOR, SoftwareUpdate, Status, Update};

/// What must be sent to vthal again after a reconnect, and whether the browser sits in the driver's seat.
#[derive(Debug, Default)]
pub(crate) struct Courtesy {
    hello: Option<String>,
    watch: Option<String>,
    driving: bool,
}

impl Courtesy {
    /// Notes what a request means for later.
    pub(crate) fn note(&mut self, text: &str) {
        let Ok(request) = serde_json::from_str::<Request>(text) else {
            return;
        };
        match request.body {
            RequestBody::Hello { .. } => self.hello = Some(text.to_owned()),
            RequestBody::Watch { .. } => self.watch = Some(text.to_owned()),
            RequestBody::Drive { .. } => self.driving = true,
            RequestBody::Release => self.driving = false,
            _ => {}
        }
    }

    /// What to say to vthal on a new connection. The driver's seat is lost with the old one.
    pub(crate) fn introduction(&mut self) -> Vec<String> {
        self.driving = false;
        self.hello.iter().chain(&self.watch).cloned().collect()
    }

    /// What to say to vthal when the browser goes away.
    pub(crate) fn farewell(&self) -> Option<String> {
        self.driving.then(|| {
            text_of(&Request {
                id: None,
                body: RequestBody::Release,
            })
        })
    }
}

/// Whether the text would be one message on the Unix socket.
pub(crate) fn is_one_message(text: &str) -> bool {
    !text.as_bytes().contains(&SEPARATOR)
}

/// Whether the text asks the robot to stop.
pub(crate) fn is_stop(text: &str) -> bool {
    serde_json::from_str::<Request>(text).is_ok_and(|request| request.body == RequestBody::Stop)
}

/// The introduction of a client.
pub(crate) fn introduction(id: Option<u32>, name: &str) -> String {
    text_of(&Request {
        id,
        body: RequestBody::Hello {
            name: name.to_owned(),
        },
    })
}

/// The message to all clients when a device was paired.
pub(crate) fn new_device(newcomer: Newcomer) -> String {
    text_of(&Update::NewDevice {
        name: newcomer.name,
        role: newcomer.role.name().to_owned(),
        from: newcomer.from,
    })
}

/// The message to administrators when an update of the software goes on or has ended.
pub(crate) fn software_update(told: SoftwareUpdate) -> String {
    text_of(&Update::SoftwareUpdate(Box::new(told)))
}

/// The sign of life to a page, with the time since the daemon was heard.
pub(crate) fn heartbeat(silent: Option<Duration>) -> String {
    let silent_ms = silent.map(|silent| u64::try_from(silent.as_millis()).unwrap_or(u64::MAX));
    text_of(&Update::Heartbeat { silent_ms })
}

/// The message to a browser while vthal is not connected.
pub(crate) fn disconnected() -> String {
    let status = Status {
        state: "disconnected".to_owned(),
        reason: "no-daemon".to_owned(),
        ..Status::default()
    };
    text_of(&Update::Status(status))
}

/// The answer to a request that cannot be passed on.
pub(crate) fn refused(request: &str, reason: &str, text: &str) -> String {
    let id = serde_json::from_str::<Request>(request)
        .ok()
        .and_then(|request| request.id);
    text_of(&Update::Failed(Failure {
        id,
        reason: reason.to_owned(),
        text: text.to_owned(),
    }))
}

fn text_of(message: &impl serde::Serialize) -> String {
    serde_json::to_string(message).expect("plain types without maps can be written")
}

#[cfg(test)]
mod tests {
    use super::{Courtesy, refused};

    #[test]
    fn only_a_driver_is_released() {
        let mut courtesy = Courtesy::default();
        assert_eq!(courtesy.farewell(), None);
        courtesy.note(r#"{"c":"drive","v":0.1,"w":0,"ttl":250}"#);
        assert_eq!(courtesy.farewell().as_deref(), Some(r#"{"c":"release"}"#));
        courtesy.note(r#"{"c":"release"}"#);
        assert_eq!(courtesy.farewell(), None);
    }

    #[test]
    fn hello_and_the_newest_watch_are_repeated() {
        let mut courtesy = Courtesy::default();
        courtesy.note(r#"{"c":"watch","topics":["pose"]}"#);
        courtesy.note(r#"{"c":"hello","name":"panel"}"#);
        courtesy.note(r#"{"c":"watch","topics":["map"]}"#);
        courtesy.note("not json");
        assert_eq!(
            courtesy.introduction(),
            [
                r#"{"c":"hello","name":"panel"}"#,
                r#"{"c":"watch","topics":["map"]}"#
            ]
        );
    }

    #[test]
    fn a_refusal_carries_the_number_of_the_request() {
        assert_eq!(
            refused(r#"{"id":7,"c":"start"}"#, "no-daemon", "x"),
            r#"{"e":"failed","id":7,"reason":"no-daemon","text":"x"}"#
        );
        assert_eq!(
            refused("not json", "no-daemon", "x"),
            r#"{"e":"failed","reason":"no-daemon","text":"x"}"#
        );
    }
}
