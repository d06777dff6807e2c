//! A22: plain HTTP and old TLS.

use pairing::Role;
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;

use crate::report::Report;
use crate::rig::{Rig, read_all};

pub(crate) async fn try_all(report: &mut Report) {
    let rig = Rig::start().await;
    let cookie = rig.pair(Role::Admin).await;
    let request = format!(
        "GET /api/session HTTP/1.1\r\nHost: {}\r\nCookie: {cookie}\r\nConnection: close\r\n\r\n",
        rig.trust.host_name
    );
    let answer = send(rig.address, request.as_bytes()).await;
    report.row(
        ("A22", "plain HTTP at the TLS port"),
        "no HTTP",
        word(&answer, "HTTP/"),
    );
    let answer = send(rig.page, request.as_bytes()).await;
    let has_interface = answer.contains("\"role\"") || answer.to_ascii_lowercase().contains("set-cookie");
    report.row(
        ("A22", "the interface at the plain port"),
        "false",
        has_interface.to_string(),
    );
    let tells = answer.contains("https://") && answer.contains("default-src 'none'");
    report.row(("A22", "the plain port tells the way"), "true", tells.to_string());
    let answer = send(rig.address, &old_hello()).await;
    // An alert, of protocol_version.
    let refused = answer.as_bytes().first() == Some(&0x15) && answer.as_bytes().last() == Some(&70);
    report.row(("A22", "TLS 1.2 is refused"), "true", refused.to_string());
}

fn word(answer: &str, sign: &str) -> &'static str {
    if answer.contains(sign) { "HTTP" } else { "no HTTP" }
}

async fn send(address: std::net::SocketAddr, bytes: &[u8]) -> String {
    let mut stream = TcpStream::connect(address).await.unwrap();
    stream.write_all(bytes).await.unwrap();
    read_all(&mut stream).await
}

/// The first message of a client that supports nothing newer than TLS 1.2.
fn old_hello() -> Vec<u8> {
    let mut body = vec![3, 3];
    body.extend([7; 32]); // random
    body.push(0); // no session
    body.extend([0, 2, 0xc0, 0x2b]); // ECDHE-ECDSA-AES128-GCM-SHA256
    body.extend([1, 0]); // no compression
    let mut extensions = Vec::new();
    extensions.extend([0, 10, 0, 4, 0, 2, 0, 23]); // the curve P-256
    extensions.extend([0, 13, 0, 4, 0, 2, 4, 3]); // ECDSA with SHA-256
    body.extend(u16::try_from(extensions.len()).unwrap().to_be_bytes());
    body.extend(extensions);
    let length = u16::try_from(body.len()).unwrap();
    let mut message = vec![0x16, 3, 1];
    message.extend((length + 4).to_be_bytes());
    message.extend([1, 0]);
    message.extend(length.to_be_bytes());
    message.extend(body);
    message
}
