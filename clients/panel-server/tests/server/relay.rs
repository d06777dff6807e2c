//! What passes between browsers and vthal, over real sockets.

use crate::folder::Folder;
use crate::rig::{Daemon, Rig, assets, settings};
use panel_server::{Guard, Server, StartError};
use tokio::net::UnixListener;

#[tokio::test]
async fn messages_pass_both_ways() {
    let rig = Rig::start().await;
    let mut browser = rig.browser().await;
    let mut vthal = rig.accept().await;
    browser.say(r#"{"id":1,"c":"start"}"#).await;
    assert_eq!(vthal.hear().await.as_deref(), Some(r#"{"id":1,"c":"start"}"#));
    vthal.say(r#"{"e":"done","id":1}"#).await;
    assert_eq!(browser.hear().await, r#"{"e":"done","id":1}"#);
}

#[tokio::test]
async fn each_browser_is_a_client_of_its_own() {
    let rig = Rig::start().await;
    let mut first = rig.browser().await;
    let mut first_vthal = rig.accept().await;
    let mut second = rig.browser().await;
    let mut second_vthal = rig.accept().await;
    first_vthal.say(r#"{"e":"done","id":1}"#).await;
    second_vthal.say(r#"{"e":"done","id":2}"#).await;
    assert_eq!(second.hear().await, r#"{"e":"done","id":2}"#);
    assert_eq!(first.hear().await, r#"{"e":"done","id":1}"#);
}

#[tokio::test]
async fn a_driver_who_vanishes_is_released_at_once() {
    let rig = Rig::start().await;
    let mut browser = rig.browser().await;
    let mut vthal = rig.accept().await;
    browser.say(r#"{"c":"drive","v":0.2,"w":0,"ttl":250}"#).await;
    assert!(vthal.hear().await.unwrap().contains("drive"));
    drop(browser);
    assert_eq!(vthal.hear().await.as_deref(), Some(r#"{"c":"release"}"#));
    assert_eq!(vthal.hear().await, None);
}

#[tokio::test]
async fn a_lost_daemon_is_shown_and_found_again() {
    let rig = Rig::start().await;
    let mut browser = rig.browser().await;
    let mut vthal = rig.accept().await;
    for text in [
        r#"{"c":"hello","name":"panel"}"#,
        r#"{"c":"watch","topics":["status"]}"#,
    ] {
        browser.say(text).await;
        vthal.hear().await.unwrap();
    }
    drop(vthal);
    assert!(browser.hear().await.contains(r#""state":"disconnected""#));
    browser.say(r#"{"id":9,"c":"start"}"#).await;
    let refusal = browser.hear().await;
    assert!(
        refusal.contains(r#""id":9"#) && refusal.contains("no-daemon"),
        "{refusal}"
    );
    let mut vthal = rig.accept().await;
    assert_eq!(
        vthal.hear().await.as_deref(),
        Some(r#"{"c":"hello","name":"panel"}"#)
    );
    assert_eq!(
        vthal.hear().await.as_deref(),
        Some(r#"{"c":"watch","topics":["status"]}"#)
    );
}

#[tokio::test]
async fn the_simulator_is_heard_but_never_spoken_to() {
    let folder = assets();
    let vthal = UnixListener::bind(folder.join("vthal.sock")).unwrap();
    let simulator = UnixListener::bind(folder.join("simulator.sock")).unwrap();
    let mut wanted = settings(&folder);
    wanted.simulator = Some(folder.join("simulator.sock"));
    let server = Server::bind(wanted).await.unwrap();
    let address = server.address();
    tokio::spawn(server.run());
    let rig = Rig {
        address,
        vthal,
        folder,
    };
    let mut browser = rig.browser().await;
    let mut simulator = Daemon::accept(&simulator).await;
    let mut vthal = rig.accept().await;
    simulator.say(r#"{"e":"simulated-truth","n":1}"#).await;
    assert_eq!(browser.hear().await, r#"{"e":"simulated-truth","n":1}"#);
    browser.say(r#"{"c":"stop"}"#).await;
    assert_eq!(vthal.hear().await.as_deref(), Some(r#"{"c":"stop"}"#));
    drop(browser);
    assert_eq!(simulator.hear().await, None);
}

#[tokio::test]
async fn a_stalled_browser_is_dropped_and_hurts_nobody() {
    let rig = Rig::start().await;
    let _stalled = rig.browser().await;
    let mut stalled_vthal = rig.accept().await;
    let mut lively = rig.browser().await;
    let mut lively_vthal = rig.accept().await;
    let line = format!(r#"{{"e":"log","text":"{}"}}"#, "x".repeat(60_000));
    let flood = tokio::spawn(async move {
        for _ in 0..2000 {
            if stalled_vthal.try_say(&line).await.is_err() {
                return true;
            }
        }
        false
    });
    lively_vthal.say(r#"{"e":"done","id":5}"#).await;
    assert_eq!(lively.hear().await, r#"{"e":"done","id":5}"#);
    assert!(
        flood.await.unwrap(),
        "the server took everything for a browser that reads nothing"
    );
}

#[tokio::test]
async fn refusals_to_start_name_the_remedy() {
    let folder = assets();
    let mut open = settings(&folder);
    open.address.set_ip([0, 0, 0, 0].into());
    let error = Server::bind(open.clone()).await.unwrap_err();
    assert!(
        matches!(error, StartError::BeyondLoopback(_)) && error.to_string().contains("--state"),
        "{error}"
    );
    open.guard = Some(Guard {
        state: folder.join("state"),
        console: None,
        card: None,
        page_port: None,
        announce: false,
        updates: folder.join("updates"),
        free_bytes: panel_server::free_bytes,
        clock: panel_server::unix_s,
    });
    let server = Server::bind(open).await.unwrap();
    assert!(server.url().starts_with("https://"), "{}", server.url());

    let first = Server::bind(settings(&folder)).await.unwrap();
    let mut same = settings(&folder);
    same.address = first.address();
    let error = Server::bind(same).await.unwrap_err();
    assert!(
        matches!(error, StartError::PortInUse(_)) && error.to_string().contains("--port"),
        "{error}"
    );

    let mut missing = settings(&folder);
    missing.assets = folder.join("nothing");
    let error = Server::bind(missing).await.unwrap_err();
    assert!(
        error.to_string().contains("nothing") && error.to_string().contains("--assets"),
        "{error}"
    );
    let empty = Folder::new();
    let error = Server::bind(settings(&empty)).await.unwrap_err();
    assert!(error.to_string().contains("index.html"), "{error}");
}
