//! A20: texts of a robot and names of devices that would be orders elsewhere. In a browser a test of pairing checks them, in a
//! terminal tests of `rvac`.

use pairing::{DeviceName, Role};

use crate::report::Report;
use crate::rig::Rig;

/// HTML, a terminal's order, the separator of messages, and a line of one's own.
const HOSTILE: &str = "<img src=x onerror=alert(1)>\\u001b[2J\\u001f\\u0007\\nok";

pub(crate) async fn try_all(report: &mut Report) {
    let rig = Rig::start().await;
    let cookie = rig.pair(Role::Admin).await;
    for _ in 0..2 {
        rig.daemon().await;
    }
    let line =
        format!(r#"{{"e":"log","number":1,"t":0.5,"level":"warn","part":"robot","text":"{HOSTILE}"}}"#);
    let mut socket = rig.socket(&cookie).await;
    let mut daemon = rig.daemon().await;
    daemon.say(&line).await;
    let heard = loop {
        let text = socket.hear().await.unwrap_or_default();
        if text.is_empty() || text.contains(r#""e":"log""#) {
            break text;
        }
    };
    let is_one = heard == line && !heard.contains(char::is_control);
    report.row(
        (
            "A20",
            "a line of the log with HTML, ANSI and 0x1F: one message, as text",
        ),
        "true",
        is_one.to_string(),
    );
    for name in ["a\u{1b}[2J", "a\u{1f}b", "a\nb", "", "\u{9b}31m"] {
        let seen = DeviceName::new(name).map_or("refused", |_| "taken");
        report.row(
            ("A20", format!("a device named {}", name.escape_default())),
            "refused",
            seen,
        );
    }
    let page = rig.get("/", &cookie).await;
    let is_strict = page.head.contains("script-src 'self' 'wasm-unsafe-eval'")
        && !page.head.contains("unsafe-inline")
        && page.head.contains("nosniff");
    report.row(
        (
            "A20",
            "a script in a text would not run: the page takes none but its own",
        ),
        "true",
        is_strict.to_string(),
    );
}
