//! The code for Matter: told to administrators, while the program that has it runs.

use pairing::Role;
use tokio::io::AsyncWriteExt as _;
use tokio::net::UnixListener;

use crate::rig::Rig;

const PATH: &str = "/api/matter";
pub(crate) const OPEN: &str =
    r#"{"code":"MT:-24J0AFN00KA0648G00","digits":"3497-011-2332","open_s":840,"joined":false}"#;

/// Stands in for `rvac-matter`: tells each who connects this text.
pub(crate) fn tell(rig: &Rig, text: &'static str) -> tokio::task::JoinHandle<()> {
    let path = rig.folder.join("matter.sock");
    std::fs::remove_file(&path).ok();
    let listener = UnixListener::bind(path).unwrap();
    tokio::spawn(async move {
        while let Ok((mut stream, _)) = listener.accept().await {
            stream.write_all(text.as_bytes()).await.ok();
        }
    })
}

#[tokio::test]
async fn the_code_is_for_administrators_alone() {
    let rig = Rig::start().await;
    let told = tell(&rig, OPEN);
    for (cookie, status) in [
        (String::new(), 401),
        (rig.pair(Role::View).await, 403),
        (rig.pair(Role::Drive).await, 403),
    ] {
        let answer = rig.get(PATH, &cookie).await;
        assert_eq!(answer.status, status, "{answer:?}");
        assert!(
            !answer.body.contains("MT:") && !answer.body.contains("3497"),
            "{answer:?}"
        );
    }
    let admin = rig.pair(Role::Admin).await;
    let answer = rig.get(PATH, &admin).await;
    assert_eq!((answer.status, answer.body.as_str()), (200, OPEN));
    assert!(answer.head.contains("cache-control: no-store"), "{answer:?}");
    told.abort();
}

#[tokio::test]
async fn without_a_program_that_tells_it_there_is_none() {
    let rig = Rig::start().await;
    let admin = rig.pair(Role::Admin).await;
    assert_eq!(
        rig.get(PATH, &admin).await.status,
        204,
        "nobody has made the socket"
    );
    for strange in [
        "",
        "no code",
        r#"{"open_s":-1,"joined":false}"#,
        r#"{"open_s":1}"#,
    ] {
        let told = tell(&rig, strange);
        let answer = rig.get(PATH, &admin).await;
        assert_eq!((answer.status, answer.body.as_str()), (204, ""), "{strange}");
        told.abort();
    }
    // A program that has ended leaves its socket behind.
    drop(UnixListener::bind(rig.folder.join("left.sock")).unwrap());
    std::fs::rename(rig.folder.join("left.sock"), rig.folder.join("matter.sock")).unwrap();
    assert_eq!(rig.get(PATH, &admin).await.status, 204);
}

#[tokio::test]
async fn a_program_that_says_nothing_keeps_nobody_waiting() {
    let rig = Rig::start().await;
    let admin = rig.pair(Role::Admin).await;
    let silent = UnixListener::bind(rig.folder.join("matter.sock")).unwrap();
    assert_eq!(rig.get(PATH, &admin).await.status, 204);
    drop(silent);
}
