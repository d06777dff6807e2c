//! A7, A13 to A15, A25: false robots, stolen files, revoked and replayed words, other users of the computer.

use std::os::unix::fs::PermissionsExt as _;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use pairing::console::Order;
use pairing::{DeviceName, Role};
use rustix::process::{Gid, Uid};
use rustls::pki_types::CertificateDer;
use rustls::pki_types::pem::PemObject as _;

use crate::report::Report;
use crate::rig::Rig;

pub(crate) async fn try_all(report: &mut Report) {
    false_robot(report).await;
    stolen_file(report).await;
    revoked(report).await;
    replayed(report).await;
    other_users(report).await;
}

async fn false_robot(report: &mut Report) {
    let (rig, other) = (Rig::start().await, Rig::start().await);
    let authority = CertificateDer::from_pem_slice(other.trust.pem.as_bytes()).unwrap();
    let reached = rig.tls_trusting(authority).await.is_ok();
    let seen = if reached { "connected" } else { "no connection" };
    report.row(
        (
            "A7",
            "a robot with another certificate, for a client that trusts its own",
        ),
        "no connection",
        seen,
    );
}

async fn stolen_file(report: &mut Report) {
    let rig = Rig::start().await;
    rig.pair(Role::Admin).await;
    let text = std::fs::read_to_string(rig.folder.join("state/clients.json")).unwrap();
    let words: Vec<&str> = text
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| matches!(word.len(), 16 | 64))
        .collect();
    for id in words.iter().filter(|word| word.len() == 16) {
        for secret in words.iter().filter(|word| word.len() == 64) {
            let answer = rig
                .get("/api/session", &format!("__Host-rvac={id}.{secret}"))
                .await;
            report.row(
                ("A13", "a field of the stolen list as a token"),
                "401",
                answer.status.to_string(),
            );
        }
    }
}

async fn revoked(report: &mut Report) {
    let rig = Rig::start().await;
    let cookie = rig.pair(Role::Drive).await;
    let id = rig.session(&cookie).await.client.unwrap();
    let mut socket = rig.socket(&cookie).await;
    socket.say(r#"{"id":1,"c":"maps"}"#).await;
    rig.console(&Order::Revoke { id }).await;
    let begun = Instant::now();
    socket.until_ended().await;
    let in_time = begun.elapsed() < Duration::from_secs(1);
    report.row(
        ("A14", "a WebSocket that was open ends within a second"),
        "true",
        in_time.to_string(),
    );
    let later = rig.get("/api/session", &cookie).await.status;
    report.row(("A14", "a revoked token later"), "401", later.to_string());
}

async fn replayed(report: &mut Report) {
    let rig = Rig::start().await;
    let cookie = rig.pair(Role::Drive).await;
    for _ in 0..2 {
        rig.daemon().await;
    }
    let nonce = rig.session(&cookie).await.nonce.unwrap();
    let recorded = [
        format!(r#"{{"nonce":"{nonce}"}}"#),
        r#"{"c":"drive","v":0.2,"w":0.0,"ttl":250}"#.to_owned(),
    ];
    for (what, expected) in [("said the first time", true), ("replayed", false)] {
        let mut socket = rig.mute_socket(&cookie).await;
        let mut daemon = rig.daemon().await;
        for text in &recorded {
            socket.say(text).await;
        }
        let heard = daemon.hear().await.is_some_and(|text| text.contains("drive"));
        report.row(
            ("A15", format!("drive messages {what} reach the daemon")),
            expected.to_string(),
            heard.to_string(),
        );
    }
    let mut socket = rig.mute_socket(&cookie).await;
    let mut daemon = rig.daemon().await;
    socket.say(r#"{"c":"drive","v":0.2,"w":0.0,"ttl":250}"#).await;
    let heard = daemon.hear().await.is_some();
    report.row(
        ("A15", "drive messages without the word reach the daemon"),
        "false",
        heard.to_string(),
    );
}

async fn other_users(report: &mut Report) {
    let rig = Rig::start().await;
    let name = DeviceName::new("x").unwrap();
    rig.console(&Order::Add {
        name,
        role: Role::View,
    })
    .await;
    for (what, expected) in [
        ("state", "700"),
        ("state/console.sock", "600"),
        ("state/clients.json", "600"),
        ("state/identity.json", "600"),
    ] {
        let mode = std::fs::metadata(rig.folder.join(what))
            .unwrap()
            .permissions()
            .mode()
            & 0o777;
        report.row(
            ("A25", format!("who may use {what}")),
            expected,
            format!("{mode:o}"),
        );
    }
    as_somebody_else(report, rig.folder.join("state"));
}

/// The user `nobody` of Linux.
const NOBODY: u32 = 65_534;

/// Tries it as another user of the computer, which only root can become.
fn as_somebody_else(report: &mut Report, state: PathBuf) {
    let tries = move || {
        let before = reached(&state);
        rustix::thread::set_thread_groups(&[])?;
        rustix::thread::set_thread_res_gid(
            Gid::from_raw(NOBODY),
            Gid::from_raw(NOBODY),
            Gid::from_raw(NOBODY),
        )?;
        rustix::thread::set_thread_res_uid(
            Uid::from_raw(NOBODY),
            Uid::from_raw(NOBODY),
            Uid::from_raw(NOBODY),
        )?;
        Ok::<_, rustix::io::Errno>((before, reached(&state)))
    };
    // The kernel keeps users by threads: only this one changes its user, and it ends.
    match std::thread::spawn(tries).join().unwrap() {
        Ok((owner, other)) => {
            report.row(
                ("A25", "the owner, at the console and the files"),
                "3 of 3",
                owner,
            );
            report.row(("A25", "nobody, at the console and the files"), "0 of 3", other);
        }
        Err(error) => report.not_tried(format!("A25 as another user, which needs root: {error}")),
    }
}

/// How much of what is kept can be used by the thread that asks.
fn reached(state: &Path) -> String {
    let console = UnixStream::connect(state.join("console.sock")).is_ok();
    let files = ["clients.json", "identity.json"].map(|file| std::fs::read(state.join(file)).is_ok());
    let count = usize::from(console) + files.into_iter().filter(|read| *read).count();
    format!("{count} of 3")
}
