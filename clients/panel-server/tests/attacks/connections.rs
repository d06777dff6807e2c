//! A18: too many connections, too much in one, and too slow ones, while another client is served.

use std::net::Ipv4Addr;
use std::time::Duration;

use futures_util::SinkExt as _;
use pairing::Role;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::time::timeout;
use tokio_tungstenite::tungstenite::Message;

use crate::report::Report;
use crate::rig::{Rig, read_all};

/// What the crowd and the flood may take.
const GROWTH_KIB_MAX: u64 = 48 << 10;

/// A hundred thousand pings of the longest kind are 13 MB, and so are their answers, which are not read.
const PINGS: usize = 100_000;
const PINGS_KIB_MAX: u64 = 8 << 10;
const PING_TIME_MAX: Duration = Duration::from_secs(2);

/// Twice as many as all connections that are served at one time.
const CROWD: usize = 256;

pub(crate) async fn try_all(report: &mut Report) {
    let rig = Rig::start().await;
    let cookie = rig.pair(Role::Drive).await;
    for _ in 0..2 {
        rig.daemon().await;
    }
    let before = resident_kib();
    too_much(&rig, &cookie, report).await;
    endless_body(&rig, report).await;
    flood(&rig, &cookie, report).await;
    pings(&rig, &cookie, report).await;
    packed(&rig, &cookie, report).await;
    strangers(&rig, &cookie, report).await;
    crowd(&rig, &cookie, report).await;
    let grown = resident_kib().saturating_sub(before);
    let seen = if grown < GROWTH_KIB_MAX {
        "below 48 MiB".to_owned()
    } else {
        format!("{grown} KiB")
    };
    report.row(
        ("A18", "memory that all of it took, attackers and server together"),
        "below 48 MiB",
        seen,
    );
}

/// What is resident of this process, which is server and attackers at once.
fn resident_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))
        .unwrap();
    line.split_whitespace().next().unwrap().parse().unwrap()
}

/// A body of 1 GiB is announced, and sent for as long as anybody takes it.
async fn endless_body(rig: &Rig, report: &mut Report) {
    let mut stream = rig.tls().await;
    let (host, origin) = (rig.host(), rig.origin());
    let head = format!(
        "POST /api/pairing/begin HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nContent-Type: application/json\r\n\
         X-Rvac: 1\r\nContent-Length: {}\r\n\r\n",
        1_u64 << 30
    );
    stream.write_all(head.as_bytes()).await.unwrap();
    let (chunk, mut sent) = (vec![b'x'; 64 << 10], 0_u64);
    while sent < 64 << 20 && stream.write_all(&chunk).await.is_ok() {
        sent += chunk.len() as u64;
    }
    let seen = if sent < 16 << 20 { "cut off" } else { "taken" };
    report.row(("A18", "a body of 1 GiB"), "cut off", seen);
}

async fn too_much(rig: &Rig, cookie: &str, report: &mut Report) {
    let host = rig.host();
    let head = format!(
        "GET / HTTP/1.1\r\nHost: {host}\r\nX-Padding: {}\r\n\r\n",
        "x".repeat(64 << 10)
    );
    let status = rig.raw(&head).await.status;
    let seen = if matches!(status, 0 | 431) {
        "refused"
    } else {
        "taken"
    };
    report.row(("A18", "a head of 64 KiB"), "refused", seen);
    let body = format!(r#"{{"name":"{}"}}"#, "x".repeat(1 << 20));
    let answer = rig.ask(("POST", "/api/pairing/begin"), "", &body).await;
    let seen = if matches!(answer.status, 0 | 400 | 413) {
        "refused"
    } else {
        "taken"
    };
    report.row(("A18", "a body of 1 MiB"), "refused", seen);
    let mut socket = rig.socket(cookie).await;
    let mut daemon = rig.daemon().await;
    socket
        .say(&format!(r#"{{"c":"hello","name":"{}"}}"#, "x".repeat(1 << 20)))
        .await;
    let heard = daemon.hear().await.is_some();
    report.row(
        ("A18", "a message of 1 MiB reaches the daemon"),
        "false",
        heard.to_string(),
    );
}

async fn flood(rig: &Rig, cookie: &str, report: &mut Report) {
    let mut socket = rig.socket(cookie).await;
    let mut daemon = rig.daemon().await;
    for _ in 0..190 {
        socket.say(r#"{"c":"maps"}"#).await;
    }
    for _ in 0..30 {
        socket.say(r#"{"c":"stop"}"#).await;
    }
    let mut stops = 0;
    for _ in 0..220 {
        stops += u32::from(daemon.hear().await.is_some_and(|text| text.contains("stop")));
    }
    report.row(("A18", "Stop behind a flood, 30 times"), "30", stops.to_string());
    let mut said = 0;
    while said < 10_000 && socket.0.send(Message::text(r#"{"c":"maps"}"#)).await.is_ok() {
        said += 1;
    }
    let seen = if said < 10_000 { "ended" } else { "goes on" };
    report.row(("A18", "a flood of requests"), "ended", seen);
}

/// Pings that nobody reads the answers of, as many as the server takes.
async fn pings(rig: &Rig, cookie: &str, report: &mut Report) {
    let before = resident_kib();
    let mut socket = rig.socket(cookie).await;
    rig.daemon().await;
    let mut sent = 0;
    let ping = || Message::Ping(vec![b'x'; 125].into());
    while sent < PINGS {
        let send = timeout(PING_TIME_MAX, socket.0.feed(ping()));
        if !matches!(send.await, Ok(Ok(()))) {
            break;
        }
        sent += 1;
    }
    let is_bounded = resident_kib().saturating_sub(before) < PINGS_KIB_MAX;
    let owner = rig.get("/api/session", cookie).await.status;
    report.row(
        ("A18", "a flood of pings: memory stays, and the owner is answered"),
        "true, 200",
        format!("{is_bounded}, {owner}"),
    );
}

/// A compression bomb needs a receiver that decompresses.
async fn packed(rig: &Rig, cookie: &str, report: &mut Report) {
    let lines = format!("Cookie: {cookie}\r\nContent-Encoding: gzip\r\n");
    let body = r#"{"name":"a","message":""}"#;
    let status = rig.ask(("POST", "/api/pairing/begin"), &lines, body).await.status;
    report.row(("A18", "a packed body"), "415", status.to_string());
    let (host, origin) = (rig.host(), rig.origin());
    let request = format!(
        "GET /api/ws HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\
         Sec-WebSocket-Extensions: permessage-deflate\r\nCookie: {cookie}\r\n\r\n"
    );
    let mut stream = rig.tls().await;
    stream.write_all(request.as_bytes()).await.unwrap();
    let mut head = vec![0; 4096];
    let count = stream.read(&mut head).await.unwrap();
    let head = String::from_utf8_lossy(&head[..count]).to_ascii_lowercase();
    let seen = format!(
        "{}, {}",
        head.get(9..12).unwrap_or_default(),
        head.contains("permessage-deflate")
    );
    report.row(
        ("A18", "packed WebSocket messages are agreed on"),
        "101, false",
        seen,
    );
}

/// All connections that are served at one time, from four addresses, each of which stays for as long as it is let.
async fn strangers(rig: &Rig, cookie: &str, report: &mut Report) {
    let mut held = Vec::new();
    for last in 2..6 {
        for _ in 0..32 {
            let socket = TcpSocket::new_v4().unwrap();
            socket.bind((Ipv4Addr::new(127, 0, 0, last), 0).into()).unwrap();
            held.push(socket.connect(rig.address).await.unwrap());
        }
    }
    let owner = timeout(Duration::from_secs(5), rig.get("/api/session", cookie)).await;
    let seen = owner.map_or_else(|_| "waits".to_owned(), |answer| answer.status.to_string());
    report.row(("A18", "the owner while strangers hold all seats"), "200", seen);
}

async fn crowd(rig: &Rig, cookie: &str, report: &mut Report) {
    let mut slow = Vec::new();
    for _ in 0..CROWD {
        let mut stream = TcpStream::connect(rig.address).await.unwrap();
        stream.write_all(b"\x16\x03\x01").await.ok(); // It may be closed already.
        slow.push(stream);
    }
    // The ones for whom there is no room are closed at once, the others when they have been too slow.
    let mut closed = 0;
    for mut stream in slow {
        read_all(&mut stream).await;
        closed += 1;
    }
    report.row(
        ("A18", "connections that say nothing"),
        format!("{CROWD} closed"),
        format!("{closed} closed"),
    );
    let status = rig.get("/api/session", cookie).await.status;
    report.row(("A18", "the owner afterwards"), "200", status.to_string());
}
