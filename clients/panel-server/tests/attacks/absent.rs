//! A26, A27: nothing but the one address of signed updates takes a program, and nothing speaks MQTT.

use pairing::Role;
use rvac_api::Request;
use rvac_api::VERBS;
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;

use crate::report::Report;
use crate::rig::{Rig, read_all};

/// How others call what writes a program into a device.
const ADDRESSES: [&str; 4] = [
    "/api/firmware",
    "/api/flash",
    "/update",
    "/api/v2/robot/capabilities",
];
const WORDS: [&str; 6] = ["update", "flash", "firmware", "install", "reboot", "mqtt"];

/// The beginning of a conversation with a broker: CONNECT, version 5, without a name.
const CONNECT: &[u8] = b"\x10\x10\x00\x04MQTT\x05\x02\x00\x3c\x00\x00\x03abc";

pub(crate) async fn try_all(report: &mut Report) {
    let rig = Rig::start().await;
    let cookie = rig.pair(Role::Admin).await;
    let line = format!("Cookie: {cookie}\r\n");
    for path in ADDRESSES {
        let status = rig.ask(("POST", path), &line, "{}").await.status;
        let seen = if matches!(status, 404 | 405) {
            "nothing there".to_owned()
        } else {
            status.to_string()
        };
        report.row(
            ("A26", format!("an administrator: POST {path}")),
            "nothing there",
            seen,
        );
    }
    for word in WORDS {
        let is_known = VERBS.iter().any(|(verb, _)| *verb == word)
            || serde_json::from_str::<Request>(&format!(r#"{{"c":"{word}"}}"#)).is_ok();
        let id = if word == "mqtt" { "A27" } else { "A26" };
        report.row(
            (id, format!("the request {word} over the socket")),
            "unknown",
            if is_known { "known" } else { "unknown" },
        );
    }
    for (what, address) in [("HTTPS", rig.address), ("the plain page", rig.page)] {
        let mut stream = TcpStream::connect(address).await.unwrap();
        stream.write_all(CONNECT).await.unwrap();
        stream.shutdown().await.ok(); // It may have hung up already.
        let answer = read_all(&mut stream).await;
        // A broker would acknowledge: 0x20.
        let seen = if answer.starts_with('\u{20}') {
            "a broker"
        } else {
            "no broker"
        };
        report.row(("A27", format!("MQTT at the port of {what}")), "no broker", seen);
    }
}
