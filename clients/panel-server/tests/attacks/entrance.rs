//! A3 to A6: pairing without a window, guessing, racing, and messages that are none.

use pairing::wire::{Begin, Begun};
use pairing::{ATTEMPTS_MAX, Code, DeviceName, Ends, Guest, Role};

use crate::report::Report;
use crate::rig::Rig;

/// Races over TLS; many more are run on a virtual clock by the tests of `pairing`.
const RACES: u32 = 50;

pub(crate) async fn try_all(report: &mut Report) {
    no_window(report).await;
    guessing(report).await;
    racing(report).await;
    malformed(report).await;
}

fn code(digits: &str) -> Code {
    Code::parse(digits).unwrap()
}

/// The reason of a refusal, or the answer instead.
fn reason(body: &str, status: u16) -> String {
    let refused: Option<pairing::wire::Refused> = serde_json::from_str(body).ok();
    refused.map_or_else(|| status.to_string(), |refused| refused.reason)
}

async fn no_window(report: &mut Report) {
    let rig = Rig::start().await;
    let answer = rig.begin(&code("12345678"), "thief", 1).await.unwrap_err();
    report.row(
        ("A3", "pairing while no window is open"),
        "window-shut",
        reason(&answer.body, answer.status),
    );
    let written = rig.folder.join("state/clients.json").exists();
    report.row(("A3", "and nothing is kept of it"), "false", written.to_string());
}

async fn guessing(report: &mut Report) {
    let mut rig = Rig::start().await;
    for window in 1..=3 {
        let right = rig.open(Role::Admin).await.unwrap();
        let mut wrong = 0;
        // The server is ended after each guess of the second window, and the window opened again by its owner.
        for guess in 0..20_u32 {
            let tried = code(&format!("{guess:08}"));
            if tried == right {
                continue;
            }
            match rig.begin(&tried, "thief", 1).await {
                Ok(finish) => wrong += u32::from(rig.finish(&finish).await.status == 403),
                Err(_) => break,
            }
            if window == 2 {
                rig.restart().await;
                if wrong < u32::from(ATTEMPTS_MAX) {
                    rig.open(Role::Admin).await.unwrap();
                }
            }
        }
        let how = if window == 2 {
            ", the server ended after each"
        } else {
            ""
        };
        report.row(
            ("A4", format!("guesses in window {window}{how}")),
            ATTEMPTS_MAX.to_string(),
            wrong.to_string(),
        );
        if window == 2 {
            // What the owner opens next is a new window: its first guess tells.
            continue;
        }
    }
    let reopened = rig.open(Role::Admin).await;
    report.row(
        ("A4", "opening again after three such windows"),
        "waiting",
        reopened.err().unwrap_or_default(),
    );
    rig.restart().await;
    let reopened = rig.open(Role::Admin).await;
    report.row(
        ("A4", "and after ending the server"),
        "waiting",
        reopened.err().unwrap_or_default(),
    );
}

async fn racing(report: &mut Report) {
    let rig = Rig::start().await;
    let mut outcomes = Vec::new();
    for round in 0..RACES {
        let right = rig.open(Role::View).await.unwrap();
        let [first, second] = [1, 2].map(|number| (format!("device {round} {number}"), number));
        let first = rig.begin(&right, &first.0, first.1).await.unwrap();
        let second = rig.begin(&right, &second.0, second.1).await.unwrap();
        let (one, other) = tokio::join!(rig.finish(&first), rig.finish(&second));
        let mut words = [one, other].map(|answer| reason(&answer.body, answer.status));
        words.sort();
        outcomes.push(words.join(" and "));
        for _ in 0..2 {
            rig.daemon().await;
        }
    }
    outcomes.dedup();
    report.row(
        ("A5", format!("two devices race, {RACES} times")),
        "200 and window-shut",
        outcomes.join(", "),
    );
}

async fn malformed(report: &mut Report) {
    let rig = Rig::start().await;
    rig.open(Role::View).await.unwrap();
    let point = |first: &str, rest: &str| format!("41{first}{}", rest.repeat(31));
    let bodies = [
        ("no JSON", "x".to_owned(), "syntax"),
        (
            "a short point",
            r#"{"name":"a","message":"41"}"#.to_owned(),
            "syntax",
        ),
        ("the identity", message(&point("01", "00")), "malformed"),
        ("a point of order four", message(&point("00", "00")), "malformed"),
        ("a point that is none", message(&point("02", "00")), "malformed"),
        (
            "a name with an escape",
            message(&point("01", "00")).replace("\"a\"", "\"a\\u001b[2J\""),
            "syntax",
        ),
    ];
    for (what, body, expected) in bodies {
        let answer = rig.ask(("POST", "/api/pairing/begin"), "", &body).await;
        report.row(("A6", what), expected, reason(&answer.body, answer.status));
    }
    let right = rig.open(Role::View).await.unwrap();
    let reflected = reflected(&rig, &right).await;
    report.row(
        (
            "A6",
            "a message comes back to the robot, and to the guest, who sent it",
        ),
        "malformed, refused",
        reflected,
    );
    let right = rig.open(Role::View).await.unwrap();
    let mut finish = rig.begin(&right, "thief", 1).await.unwrap();
    finish.proof = [0; 32];
    let answer = rig.finish(&finish).await;
    report.row(
        ("A6", "a proof of nothing"),
        "wrong-code",
        reason(&answer.body, answer.status),
    );
    let answer = rig.finish(&finish).await;
    report.row(
        ("A6", "the same attempt again"),
        "no-attempt",
        reason(&answer.body, answer.status),
    );
}

fn message(point: &str) -> String {
    format!(r#"{{"name":"a","message":"{point}"}}"#)
}

/// What the robot says to a message of its own, and what a guest says to one.
async fn reflected(rig: &Rig, right: &Code) -> String {
    let name = DeviceName::new("mirror").unwrap();
    let ends = Ends {
        guest: &name,
        robot: &rig.trust.robot,
    };
    let (guest, own) = Guest::begin(right, ends, [9; 64]);
    let begin = |message| Begin {
        name: name.clone(),
        message,
    };
    let answer = rig.post("/api/pairing/begin", "", &begin(own)).await;
    let begun: Begun = serde_json::from_str(&answer.body).unwrap();
    let answer = rig.post("/api/pairing/begin", "", &begin(begun.message)).await;
    let at_robot = reason(&answer.body, answer.status);
    let at_guest = guest.hear(&own).map_or("refused", |_| "taken");
    format!("{at_robot}, {at_guest}")
}
