//! What a message asks of the robot. Whatever is not exactly a command is none.

use bridge::FanSpeed;
use rvac_api::{JobOrder, JobPart, RequestBody};
use serde_json::{Map, Value};

use crate::topics::Hearing;

/// Longest command.
const COMMAND_BYTES_MAX: usize = 4 << 10;
/// Requests that may come over a broker, by their word in `c`: nothing that drives by hand, and nothing that changes the home.
const REQUESTS: [&str; 13] = [
    "start",
    "clean",
    "spot",
    "go-to",
    "pause",
    "resume",
    "stop",
    "dock",
    "locate",
    "clear",
    "run-schedule",
    "skip-next",
    "choose-floor",
];

/// What a message asks for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Order {
    /// To clean the whole home, or to go on with the job that waits.
    Go,
    /// To clean so from the next job on.
    Speed(FanSpeed),
    /// To clean this, as hard as the preset says where the order says nothing.
    Clean(JobOrder),
    /// To go to the floor of this name.
    Floor(String),
    /// Anything else.
    Ask(RequestBody),
}

/// Why a message is no command.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoCommand {
    #[error("it is longer than {COMMAND_BYTES_MAX} bytes")]
    TooLong,
    #[error("it is no text")]
    NoText,
    #[error("it is none of the words that are known here")]
    Unknown,
    #[error("it is not of the form that is expected here")]
    Form,
}

/// Reads a message.
pub(crate) fn read(hearing: Hearing, payload: &[u8]) -> Result<Order, NoCommand> {
    if payload.len() > COMMAND_BYTES_MAX {
        return Err(NoCommand::TooLong);
    }
    let text = std::str::from_utf8(payload).map_err(|_| NoCommand::NoText)?;
    match hearing {
        Hearing::Command => word(text),
        Hearing::FanSpeed => FanSpeed::from_name(text)
            .map(Order::Speed)
            .ok_or(NoCommand::Unknown),
        Hearing::Rooms => rooms(text).map(Order::Clean),
        Hearing::Request => request(text),
        Hearing::Floor => Ok(Order::Floor(text.to_owned())),
        Hearing::WearRenew => Ok(Order::Ask(RequestBody::RenewPart {
            component: text.to_owned(),
        })),
        Hearing::WearReset => Ok(Order::Ask(RequestBody::ResetHealth {
            component: text.to_owned(),
        })),
    }
}

/// A word of Home Assistant's vacuum.
fn word(text: &str) -> Result<Order, NoCommand> {
    Ok(Order::Ask(match text {
        "start" => return Ok(Order::Go),
        "stop" => RequestBody::Stop,
        "pause" => RequestBody::Pause,
        "return_to_base" => RequestBody::Dock,
        "clean_spot" => RequestBody::Spot,
        "locate" => RequestBody::Locate,
        _ => return Err(NoCommand::Unknown),
    }))
}

/// A list of identities of rooms: numbers, also written as texts.
fn rooms(text: &str) -> Result<JobOrder, NoCommand> {
    let list: Vec<Value> = serde_json::from_str(text).map_err(|_| NoCommand::Form)?;
    let room = |value: &Value| {
        let number = match value {
            Value::String(text) => text.parse().ok(),
            Value::Number(number) => number.as_u64().and_then(|number| u16::try_from(number).ok()),
            _ => None,
        };
        number.filter(|id| *id > 0).map(JobPart::Room)
    };
    let parts: Option<Vec<JobPart>> = list.iter().map(room).collect();
    let parts = parts.filter(|parts| !parts.is_empty()).ok_or(NoCommand::Form)?;
    Ok(JobOrder {
        parts,
        ..JobOrder::default()
    })
}

/// A request of the daemon's interface, whose word may also stand in `command`, as Home Assistant sends it; a word alone is one, too.
fn request(text: &str) -> Result<Order, NoCommand> {
    let mut object = match serde_json::from_str(text) {
        Ok(Value::Object(object)) => object,
        _ if REQUESTS.contains(&text) => Map::new(),
        _ => return Err(NoCommand::Form),
    };
    let named = object.remove("command").or_else(|| object.remove("c"));
    let named = named.unwrap_or_else(|| Value::String(text.to_owned()));
    if !REQUESTS.iter().any(|known| named == *known) {
        return Err(NoCommand::Unknown);
    }
    object.insert("c".to_owned(), named);
    let body = serde_json::from_value(Value::Object(object)).map_err(|_| NoCommand::Form)?;
    Ok(match body {
        RequestBody::Clean(order) => Order::Clean(order),
        body => Order::Ask(body),
    })
}

#[cfg(test)]
mod tests {
    use bridge::FanSpeed;
    use proptest::prelude::*;
    use rvac_api::{JobOrder, JobPart, RequestBody};

    use super::{COMMAND_BYTES_MAX, NoCommand, Order, read};
    use crate::topics::Hearing;

    #[test]
    fn commands_are_exactly_what_they_are() {
        let read = |hearing, text: &str| read(hearing, text.as_bytes());
        let rooms = |ids: &[u16]| JobOrder {
            parts: ids.iter().map(|id| JobPart::Room(*id)).collect(),
            ..JobOrder::default()
        };
        assert_eq!(read(Hearing::Command, "start"), Ok(Order::Go));
        assert_eq!(
            read(Hearing::Command, "return_to_base"),
            Ok(Order::Ask(RequestBody::Dock))
        );
        assert_eq!(read(Hearing::Command, "Start"), Err(NoCommand::Unknown));
        assert_eq!(
            read(Hearing::FanSpeed, "quiet"),
            Ok(Order::Speed(FanSpeed::Quiet))
        );
        assert_eq!(
            read(Hearing::Rooms, r#"["2",1]"#),
            Ok(Order::Clean(rooms(&[2, 1])))
        );
        for wrong in [
            "[]",
            "2",
            "[0]",
            "[-1]",
            "[1.5]",
            "[\"Kitchen\"]",
            "[99999]",
            "{}",
        ] {
            assert_eq!(read(Hearing::Rooms, wrong), Err(NoCommand::Form), "{wrong}");
        }
        let twice = JobOrder {
            passes: 2,
            ..rooms(&[3])
        };
        let sent = r#"{"command": "clean", "parts": [{"room": 3}], "passes": 2}"#;
        assert_eq!(read(Hearing::Request, sent), Ok(Order::Clean(twice)));
        assert_eq!(read(Hearing::Request, "spot"), Ok(Order::Ask(RequestBody::Spot)));
        let long = "x".repeat(COMMAND_BYTES_MAX + 1);
        assert_eq!(read(Hearing::Request, &long), Err(NoCommand::TooLong));
    }

    #[test]
    fn nothing_drives_by_hand_or_changes_the_home_over_a_broker() {
        for forbidden in [
            r#"{"c":"drive","v":0.3,"w":0,"ttl":400}"#,
            r#"{"c":"raw","packet":"{}"}"#,
            r#"{"command":"remove-floor","floor":1}"#,
            r#"{"command":"borrow-link"}"#,
            r#"{"command":["stop"]}"#,
        ] {
            assert_eq!(
                read(Hearing::Request, forbidden.as_bytes()),
                Err(NoCommand::Unknown),
                "{forbidden}"
            );
        }
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_fail(payload in prop::collection::vec(any::<u8>(), 0..200)) {
            for hearing in Hearing::ALL {
                // Whatever it is, it is judged.
                let _judged = read(hearing, &payload);
            }
        }
    }
}
