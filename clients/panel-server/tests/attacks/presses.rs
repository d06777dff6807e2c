//! A2 to A5 for what the robot's buttons allow: windows, patterns of presses, and requests that need a person beside the robot.

use pairing::Role;
use pairing::console::Order;

use crate::report::Report;
use crate::rig::{Answer, Rig};

pub(crate) async fn try_all(report: &mut Report) {
    windows(report).await;
    patterns(report).await;
    stuck(report).await;
    presence(report).await;
}

fn reason(answer: &Answer) -> String {
    let refused: Option<pairing::wire::Refused> = serde_json::from_str(&answer.body).ok();
    refused.map_or_else(|| answer.status.to_string(), |refused| refused.reason)
}

async fn windows(report: &mut Report) {
    let mut rig = Rig::start().await;
    let shut = rig.join("thief").await.unwrap_err();
    report.row(
        ("A3", "asking for presses while no window is open"),
        "window-shut",
        reason(&shut),
    );
    rig.open(Role::Admin).await.unwrap();
    let shut = rig.join("thief").await.unwrap_err();
    report.row(
        ("A3", "asking for presses in a window for codes"),
        "window-shut",
        reason(&shut),
    );
    rig.restart().await;
    rig.hold_start().await;
    let code = pairing::Code::parse("12345678").unwrap();
    let shut = rig.begin(&code, "thief", 1).await.unwrap_err();
    report.row(
        ("A3", "a code in a window for presses"),
        "window-shut",
        reason(&shut),
    );
}

async fn patterns(report: &mut Report) {
    let mut rig = Rig::start().await;
    rig.hold_start().await;
    let phone = rig.join("phone").await.unwrap();
    let mut guess = phone.clone();
    guess.session = [7; 16];
    report.row(
        ("A4", "a guessed name of the device that waits"),
        "no-attempt",
        reason(&rig.matched(&guess).await),
    );
    rig.press(phone.presses).await;
    let answer = rig.matched(&phone).await;
    report.row(
        ("A5", "the device whose pattern is pressed"),
        "200, drive true",
        format!("{}, drive {}", answer.status, answer.body.contains("drive")),
    );
    report.row(
        ("A5", "the same name again"),
        "no-attempt",
        reason(&rig.matched(&phone).await),
    );
    rig.hold_start().await;
    let phone = rig.join("phone").await.unwrap();
    let [first, second] = phone.presses;
    let miscounted = [first, if second == 2 { 3 } else { second - 1 }];
    rig.press(miscounted).await;
    report.row(
        ("A4", "a pattern that is miscounted by one"),
        "not-matched",
        reason(&rig.matched(&phone).await),
    );
    let shut = rig.join("phone").await.unwrap_err();
    report.row(
        ("A4", "and another try in that window"),
        "window-shut",
        reason(&shut),
    );
}

/// A button that is stuck and let go again and again.
async fn stuck(report: &mut Report) {
    let mut rig = Rig::start().await;
    let mut windows = 0;
    for _ in 0..20 {
        rig.gesture("pairing-hold").await;
        let Ok(phone) = joined_soon(&rig).await else {
            continue;
        };
        windows += 1;
        for _ in 0..7 {
            rig.gesture("press").await;
        }
        rig.matched(&phone).await;
    }
    report.row(
        ("A4", "START held 20 times in a row: windows"),
        "3",
        windows.to_string(),
    );
    let reopened = rig.open(Role::Admin).await;
    report.row(
        ("A4", "the console after that"),
        "opens a window",
        reopened.map_or_else(|reason| reason, |_| "opens a window".to_owned()),
    );
}

/// The server receives the hold on another connection than the question.
async fn joined_soon(rig: &Rig) -> Result<pairing::wire::Joined, Answer> {
    for _ in 0..3 {
        if let Ok(joined) = rig.join("phone").await {
            return Ok(joined);
        }
        tokio::time::sleep(std::time::Duration::from_millis(30)).await;
    }
    rig.join("phone").await
}

async fn presence(report: &mut Report) {
    let mut rig = Rig::start().await;
    let cookie = rig.pair(Role::Admin).await;
    let id = rig.session(&cookie).await.client.unwrap();
    for _ in 0..2 {
        rig.daemon().await;
    }
    let mut socket = rig.socket(&cookie).await;
    let mut daemon = rig.daemon().await;
    let raw = r#"{"id":1,"c":"raw","packet":"{}"}"#;
    rig.gesture("press").await;
    socket.say(raw).await;
    let answer = socket.hear().await.unwrap_or_default();
    report.row(
        (
            "A2",
            "a raw packet of an administrator, after a press that was for nothing",
        ),
        "not-present",
        word(&answer),
    );
    rig.gesture("press").await;
    // The press and the request take different connections.
    loop {
        socket.say(raw).await;
        socket.say(r#"{"id":2,"c":"maps"}"#).await;
        if daemon.hear().await.is_some_and(|text| text.contains("raw")) {
            break;
        }
    }
    report.row(
        ("A2", "the same after a press that was asked for"),
        "heard",
        "heard",
    );
    let other = rig.pair(Role::Admin).await;
    for _ in 0..2 {
        rig.daemon().await;
    }
    let mut second = rig.socket(&other).await;
    let mut its_daemon = rig.daemon().await;
    second.say(raw).await;
    report.row(
        ("A2", "another administrator, for whom nobody pressed"),
        "not-present",
        word(&second.hear().await.unwrap_or_default()),
    );
    let its_id = rig.session(&other).await.client.unwrap();
    rig.console(&Order::Vouch { id: its_id }).await;
    second.say(raw).await;
    let heard = its_daemon.hear().await.is_some_and(|text| text.contains("raw"));
    report.row(
        ("A2", "when the console vouches for it"),
        "true",
        heard.to_string(),
    );
    let refused = rig
        .console(&Order::Vouch {
            id: "00000000000000ff".parse().unwrap(),
        })
        .await;
    let seen = match refused {
        pairing::console::Reply::Refused(refused) => refused.reason,
        other => format!("{other:?}"),
    };
    report.row(("A2", "vouching for nobody"), "no-client", seen);
    assert_ne!(id, its_id);
}

fn word(answer: &str) -> &'static str {
    if answer.contains("not-present") {
        "not-present"
    } else {
        "something else"
    }
}
