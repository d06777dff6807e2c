//! Updates of the robot's software: who may send one, what is refused, and what is told of one that goes on.

use std::path::PathBuf;
use std::time::Duration;

use pairing::Role;
use rvac_api::{SoftwareUpdate, UPDATE_BYTES_MAX, Update, UpdateEnd, UpdateStage};

use crate::rig::{Answer, Rig, Socket};

fn offer(rig: &Rig) -> PathBuf {
    rig.folder.join("state/update/offer.update")
}

/// The file is refused for this reason, and nothing of it stays.
#[track_caller]
fn expect_refused(rig: &Rig, answer: &Answer, (status, reason): (u16, &str)) {
    assert_eq!(answer.status, status, "{answer:?}");
    assert!(
        answer.body.contains(&format!("\"reason\":\"{reason}\"")),
        "{answer:?}"
    );
    assert!(!offer(rig).exists(), "{reason}");
    assert!(!rig.folder.join("state/update/incoming").exists(), "{reason}");
}

/// What the server says next of an update.
async fn told(socket: &mut Socket) -> SoftwareUpdate {
    loop {
        let text = socket.hear().await.expect("the connection stays");
        if let Ok(Update::SoftwareUpdate(told)) = serde_json::from_str(&text) {
            return *told;
        }
    }
}

/// Writes the progress of an update as `rvac update` does.
fn note(rig: &Rig, told: &SoftwareUpdate) {
    let folder = rig.folder.join("updates");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("new"), serde_json::to_vec(told).unwrap()).unwrap();
    std::fs::rename(folder.join("new"), folder.join("progress.json")).unwrap();
}

#[tokio::test]
async fn only_an_administrator_sends_an_update() {
    let rig = Rig::start().await;
    let file = vec![7; 300_000];
    for (cookie, status, reason) in [
        (String::new(), 401, "not-paired"),
        (rig.pair(Role::View).await, 403, "not-allowed"),
        (rig.pair(Role::Drive).await, 403, "not-allowed"),
    ] {
        let answer = rig.upload(&cookie, &file, file.len() as u64).await;
        expect_refused(&rig, &answer, (status, reason));
        assert_ne!(rig.get("/api/update", &cookie).await.status, 200);
    }
    let admin = rig.pair(Role::Admin).await;
    assert_eq!(rig.get("/api/update", &admin).await.status, 204);
    let answer = rig.upload(&admin, &file, file.len() as u64).await;
    assert_eq!(answer.status, 202, "{answer:?}");
    assert_eq!(std::fs::read(offer(&rig)).unwrap(), file);
    let waits = rig.get("/api/update", &admin).await.body;
    assert_eq!(waits, r#"{"stage":"hand-over"}"#);
    let another = rig.upload(&admin, &file, file.len() as u64).await;
    assert_eq!(another.status, 409, "{another:?}");
    assert!(another.body.contains("update-busy"), "{another:?}");
}

#[tokio::test]
async fn a_file_that_cannot_be_taken_is_refused_by_name_and_nothing_of_it_stays() {
    let rig = Rig::start().await;
    let admin = rig.pair(Role::Admin).await;
    let too_long = rig.upload(&admin, b"x", UPDATE_BYTES_MAX + 1).await;
    expect_refused(&rig, &too_long, (413, "update-too-long"));
    let empty = rig.upload(&admin, b"", 0).await;
    expect_refused(&rig, &empty, (413, "update-too-long"));
    // Nobody is there to hear that the rest did not come.
    rig.upload(&admin, &[7; 100_000], 200_000).await;
    let free_again = async {
        while rig.folder.join("state/update/incoming").exists() {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    };
    tokio::time::timeout(Duration::from_secs(10), free_again)
        .await
        .expect("half a file does not stay");
    assert!(!offer(&rig).exists());
    std::fs::write(rig.folder.join("state/update/free-bytes"), "1000000").unwrap();
    let full = rig.upload(&admin, b"update", 6).await;
    expect_refused(&rig, &full, (507, "update-disk-full"));
    std::fs::remove_file(rig.folder.join("state/update/free-bytes")).unwrap();
    assert_eq!(rig.upload(&admin, b"update", 6).await.status, 202);
}

#[tokio::test]
async fn no_form_of_another_page_sends_an_update() {
    let rig = Rig::start().await;
    let cookie = format!("Cookie: {}\r\n", rig.pair(Role::Admin).await);
    let as_json = rig.ask(("POST", "/api/update"), &cookie, "{}").await;
    assert_eq!(as_json.status, 415, "{as_json:?}");
    assert!(!offer(&rig).exists());
}

#[tokio::test]
async fn administrators_hear_how_far_an_update_is_across_a_restart_of_the_server() {
    let mut rig = Rig::start().await;
    let (admin, viewer) = (rig.pair(Role::Admin).await, rig.pair(Role::View).await);
    let mut socket = rig.socket(&admin).await;
    let answer = rig.upload(&admin, b"update", 6).await;
    assert_eq!(answer.status, 202);
    while told(&mut socket).await.stage != UpdateStage::HandOver {}
    // What `rvac update --take` does.
    let lock = rig.folder.join("updates/lock");
    std::fs::create_dir_all(rig.folder.join("updates")).unwrap();
    let lock = std::fs::File::create(lock).unwrap();
    lock.lock().unwrap();
    std::fs::remove_file(offer(&rig)).unwrap();
    let mut goes_on = SoftwareUpdate::at(UpdateStage::TryPrograms);
    goes_on.epoch = Some(7);
    note(&rig, &goes_on);
    while told(&mut socket).await != goes_on {}
    drop(socket);
    rig.restart().await;
    let mut socket = rig.socket(&admin).await;
    assert_eq!(
        told(&mut socket).await,
        goes_on,
        "a page that comes hears it at once"
    );
    let failed = goes_on.ended(UpdateEnd::WentBack, "update-silent", "the daemon does not answer");
    note(&rig, &failed);
    drop(lock);
    assert_eq!(told(&mut socket).await, failed);
    let mut others = rig.socket(&viewer).await;
    for _ in 0..4 {
        others.say(r#"{"id":2,"c":"start"}"#).await;
        let heard = others.hear().await.expect("the connection stays");
        assert!(heard.contains("not-allowed"), "{heard}");
    }
}
