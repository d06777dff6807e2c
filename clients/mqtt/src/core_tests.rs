//! Tests of the core.

use std::time::Duration;

use bridge::COMMANDS_MAX;
use rvac_api::{DeviceTable, Failure, RequestBody, RoomHere, Status, Update};

use super::Core;
use crate::voice::{Output, Voice as _};
use crate::wire::Incoming;

fn core() -> Core {
    core_of(r#"{"broker": "mqtt://b", "id": "robo", "user": "robo", "password": "word"}"#)
}

fn core_of(text: &str) -> Core {
    let mut core = Core::new(serde_json::from_str(text).expect("a configuration"));
    core.daemon_came(&mut Vec::new());
    core.broker_came(Duration::ZERO, &mut Vec::new());
    core
}

fn message(topic: &str, payload: &str) -> Incoming {
    Incoming {
        topic: topic.to_owned(),
        payload: payload.as_bytes().to_vec(),
        retained: false,
    }
}

fn status(state: &str, room: Option<u16>) -> Update {
    Update::Status(Status {
        state: state.to_owned(),
        room: room.map(|id| RoomHere { id, name: None }),
        ..Status::default()
    })
}

fn said(core: &mut Core, update: &Update, at_s: u64) -> Vec<Output> {
    let mut out = Vec::new();
    core.update(update, Duration::from_secs(at_s), &mut out);
    out.retain(|output| *output != Output::Hello);
    out
}

fn asked(core: &mut Core, message: &Incoming) -> Vec<RequestBody> {
    let mut out = Vec::new();
    core.message(message, Duration::from_secs(100), &mut out);
    let asked = out.into_iter().filter_map(|output| match output {
        Output::Ask(body) => Some(body),
        _ => None,
    });
    asked.collect()
}

#[test]
fn states_are_kept_by_the_broker_and_events_never() {
    let mut core = core();
    let mut all = said(&mut core, &status("cleaning", Some(1)), 1);
    all.extend(said(&mut core, &status("cleaning", Some(2)), 2));
    let failure = Failure {
        id: Some(4),
        reason: "no-job".to_owned(),
        text: "There is none.".to_owned(),
    };
    all.extend(said(&mut core, &Update::Failed(failure), 3));
    let mut events = 0;
    for output in all {
        match output {
            Output::State(message) => assert!(message.retain && message.acknowledged, "{message:?}"),
            Output::Event(message) => {
                assert!(!message.retain && message.acknowledged, "{message:?}");
                events += 1;
            }
            Output::Hello => {}
            Output::Ask(body) => panic!("{body:?}"),
        }
    }
    assert_eq!(events, 2, "a room was entered, and something was refused");
}

#[test]
fn commands_reach_the_daemon_and_kept_ones_do_not() {
    let mut core = core();
    said(&mut core, &status("idle", None), 1);
    let start = message("librervac/robo/command", "start");
    assert_eq!(asked(&mut core, &start), [RequestBody::Start { strategy: None }]);
    let kept = Incoming {
        retained: true,
        ..start.clone()
    };
    assert_eq!(asked(&mut core, &kept), []);
    for foreign in ["librervac/robot/command", "librervac/robo/command/x", "x"] {
        assert_eq!(asked(&mut core, &message(foreign, "start")), [], "{foreign}");
    }
    said(&mut core, &status("paused", None), 2);
    assert_eq!(asked(&mut core, &start), [RequestBody::Resume]);
    said(&mut core, &status("idle", None), 3);
    assert_eq!(
        asked(&mut core, &message("librervac/robo/fan-speed/set", "quiet")),
        []
    );
    let with_power = asked(&mut core, &start);
    assert!(
        matches!(with_power.as_slice(), [RequestBody::Clean(order)] if order.power.is_some()),
        "{with_power:?}"
    );
}

#[test]
fn on_a_broker_that_lets_everybody_in_nobody_commands_unless_the_owner_says_so() {
    let start = message("librervac/robo/command", "start");
    let mut open = core_of(r#"{"broker": "mqtt://b", "id": "robo"}"#);
    assert_eq!(asked(&mut open, &start), []);
    assert_eq!(open.heard_topics(), ["homeassistant/status"]);
    let mut allowed = core_of(r#"{"broker": "mqtt://b", "id": "robo", "commands": true}"#);
    assert_eq!(
        asked(&mut allowed, &start),
        [RequestBody::Start { strategy: None }]
    );
    let refused = r#"{"broker": "mqtt://b", "id": "robo", "user": "a", "password": "b", "commands": false}"#;
    assert_eq!(asked(&mut core_of(refused), &start), []);
}

#[test]
fn a_flood_of_commands_moves_nothing_more_than_a_person_could() {
    let mut core = core();
    let stop = message("librervac/robo/command", "stop");
    let passed: usize = (0..10_000).map(|_| asked(&mut core, &stop).len()).sum();
    assert_eq!(passed, COMMANDS_MAX as usize);
}

#[test]
fn what_changes_by_and_by_is_said_every_ten_seconds_and_what_happens_at_once() {
    let mut core = core();
    let swept = |swept_m2, state: &str| {
        Update::Status(Status {
            state: state.to_owned(),
            swept_m2,
            ..Status::default()
        })
    };
    assert!(!said(&mut core, &swept(0.0, "cleaning"), 0).is_empty());
    let of_a_minute: usize = (1..60_u32)
        .map(|second| {
            said(
                &mut core,
                &swept(f64::from(second), "cleaning"),
                u64::from(second),
            )
            .len()
        })
        .sum();
    assert_eq!(of_a_minute, 5);
    assert_eq!(
        said(&mut core, &swept(59.0, "paused"), 59).len(),
        2,
        "the vacuum's state and the readings"
    );
}

#[test]
fn after_a_break_everything_is_said_again() {
    let mut core = core();
    said(&mut core, &status("idle", None), 1);
    said(&mut core, &Update::Device(DeviceTable::default()), 1);
    core.broker_went();
    assert!(said(&mut core, &status("cleaning", None), 2).is_empty());
    let mut out = Vec::new();
    core.broker_came(Duration::from_secs(3), &mut out);
    let text = format!("{out:?}");
    let born = message("homeassistant/status", "online");
    let mut again = Vec::new();
    core.message(&born, Duration::from_secs(4), &mut again);
    assert_eq!(format!("{again:?}"), text, "Home Assistant has started");
    let mut lost = Vec::new();
    core.daemon_went(Duration::from_secs(5), &mut lost);
    assert!(
        matches!(lost.as_slice(), [Output::State(gone)] if gone.payload == b"offline"),
        "{lost:?}"
    );
}
