//! A robot on a network: only paired devices get in, each as far as its role goes.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

#[path = "../folder/mod.rs"]
mod folder;
mod matter;
mod openapi;
mod rig;
mod schema;
mod software;

use pairing::console::{Order, Reply};
use pairing::wire::Finished;
use pairing::{DeviceName, Role};
use rig::Rig;

#[tokio::test]
async fn a_device_is_paired_drives_and_is_shut_out() {
    let rig = Rig::start().await;
    assert_eq!(rig.get("/", "").await.status, 200, "the page is for everybody");
    assert_eq!(rig.get("/api/session", "").await.status, 401);

    let code = rig.open(Role::Drive).await.unwrap();
    assert_eq!(
        rig.daemon().await.hear().await.unwrap(),
        r#"{"c":"locate"}"#,
        "the robot beeps"
    );
    let finish = rig.begin(&code, "Mari's phone", 7).await.unwrap();
    let answer = rig.finish(&finish).await;
    let finished: Finished = serde_json::from_str(&answer.body).unwrap();
    assert_eq!(finished.role, Role::Drive);
    let cookie = answer.cookie().unwrap();
    assert_eq!(
        rig.daemon().await.hear().await.unwrap(),
        r#"{"c":"locate"}"#,
        "and again"
    );

    let mut socket = rig.socket(&cookie).await;
    let mut daemon = rig.daemon().await;
    socket.say(r#"{"id":1,"c":"start"}"#).await;
    assert_eq!(daemon.hear().await.unwrap(), r#"{"c":"start","id":1}"#);
    socket.say(r#"{"c":"hello","name":"an administrator"}"#).await;
    assert_eq!(
        daemon.hear().await.unwrap(),
        r#"{"c":"hello","name":"Mari's phone"}"#,
        "who drives is told by the name that was paired"
    );
    socket.say(r#"{"id":2,"c":"set-quiet"}"#).await;
    let refused = socket.hear().await.unwrap();
    assert!(
        refused.contains(r#""reason":"not-allowed""#) && refused.contains("role admin"),
        "{refused}"
    );

    let clients = match rig.console(&Order::Clients).await {
        Reply::Clients { clients } => clients,
        other => panic!("{other:?}"),
    };
    assert_eq!(clients[0].name.as_str(), "Mari's phone");
    let id = clients[0].id;
    rig.console(&Order::SetRole { id, role: Role::View }).await;
    socket.say(r#"{"id":3,"c":"start"}"#).await;
    assert!(
        socket.hear().await.unwrap().contains("not-allowed"),
        "at once, on the open connection"
    );
    rig.console(&Order::Revoke { id }).await;
    socket.until_ended().await;
    assert_eq!(daemon.hear().await, None, "nothing else came to the daemon");
    assert_eq!(rig.get("/api/session", &cookie).await.status, 401);
}

/// WebSockets that one device opens; a page has one.
const GREEDY: usize = 40;
/// As many connections may it have.
const OF_DEVICE_MAX: usize = 16;

#[tokio::test]
async fn one_device_has_its_share_of_connections_and_stop_of_another_comes_through() {
    let rig = Rig::start().await;
    let (greedy, phone) = (rig.pair(Role::View).await, rig.pair(Role::Drive).await);
    for _ in 0..4 {
        rig.daemon().await; // Beeps.
    }
    let (mut sockets, mut daemons) = (Vec::new(), Vec::new());
    for _ in 0..GREEDY {
        sockets.push(rig.socket(&greedy).await);
        daemons.push(rig.daemon().await);
    }
    for socket in &mut sockets[..GREEDY - OF_DEVICE_MAX] {
        socket.until_ended().await;
    }
    // Each had asked for its session on a connection of its own, which may end a moment later.
    let newest = GREEDY - OF_DEVICE_MAX + 2;
    for (socket, daemon) in sockets.iter_mut().zip(&mut daemons).skip(newest) {
        socket.say(r#"{"id":1,"c":"watch","topics":["status"]}"#).await;
        assert!(daemon.hear().await.is_some(), "its newest stay");
    }
    let mut socket = rig.socket(&phone).await;
    let mut daemon = rig.daemon().await;
    socket.say(r#"{"id":1,"c":"stop"}"#).await;
    assert_eq!(daemon.hear().await.unwrap(), r#"{"c":"stop","id":1}"#);
}

#[tokio::test]
async fn devices_are_remembered_and_everybody_hears_of_a_new_one() {
    let mut rig = Rig::start().await;
    let cookie = rig.pair(Role::Admin).await;
    let robot = rig.trust.clone();
    rig.restart().await;
    assert_eq!(rig.session(&cookie).await.role, Role::Admin);
    let mut socket = rig.socket(&cookie).await;
    let name = DeviceName::new("script").unwrap();
    let Reply::Added { token } = rig
        .console(&Order::Add {
            name,
            role: Role::View,
        })
        .await
    else {
        panic!("not added");
    };
    let notice = socket.hear().await.unwrap();
    let notice = if notice.contains("new-device") {
        notice
    } else {
        socket.hear().await.unwrap()
    };
    assert_eq!(
        notice,
        r#"{"e":"new-device","name":"script","role":"view","from":"console"}"#
    );
    let bearer = format!("Authorization: Bearer {token}\r\n");
    let answer = rig.ask(("GET", "/api/session"), &bearer, "").await;
    assert!(answer.body.contains(r#""role":"view""#), "{answer:?}");
    assert_eq!(rig.ask(("GET", "/api/clients"), &bearer, "").await.status, 403);
    let Reply::Trust(again) = rig.console(&Order::Trust).await else {
        panic!("no answer");
    };
    assert_eq!((robot.robot, robot.fingerprint), (again.robot, again.fingerprint));
}

#[tokio::test]
async fn an_administrator_does_from_the_panel_what_the_console_does() {
    let rig = Rig::start().await;
    let admin = rig.pair(Role::Admin).await;
    let answer = rig
        .post(
            "/api/pairing/open",
            &admin,
            &pairing::wire::OpenWindow { role: Role::View },
        )
        .await;
    let invitation: pairing::wire::OpenedHere = serde_json::from_str(&answer.body).unwrap();
    assert!(
        invitation
            .addresses
            .iter()
            .all(|address| address.starts_with("https://")),
        "{invitation:?}"
    );
    let code = pairing::Code::parse(&invitation.opened.code).unwrap();
    let finish = rig.begin(&code, "tablet", 3).await.unwrap();
    let view = rig.finish(&finish).await.cookie().unwrap();
    let id = rig.session(&view).await.client.unwrap();
    let promote = pairing::wire::SetRole {
        id,
        role: Role::Drive,
    };
    assert_eq!(rig.post("/api/clients/role", &admin, &promote).await.status, 204);
    assert_eq!(rig.session(&view).await.role, Role::Drive);
    assert_eq!(
        rig.post("/api/clients/revoke", &admin, &pairing::wire::Revoke { id })
            .await
            .status,
        204
    );
    assert_eq!(
        rig.post("/api/clients/revoke", &admin, &pairing::wire::Revoke { id })
            .await
            .status,
        404
    );
    assert_eq!(rig.get("/api/session", &view).await.status, 401);
    let listed = rig.get("/api/clients", &admin).await.body;
    assert!(
        listed.contains("\"admin\"") && !listed.contains("digest"),
        "{listed}"
    );
}

#[tokio::test]
async fn whoever_holds_start_and_presses_what_a_device_shows_lets_it_in() {
    let mut rig = Rig::start().await;
    let closed = rig.join("phone").await.unwrap_err();
    assert!(closed.body.contains("window-shut"), "{closed:?}");
    let invitation = rig.hold_start().await;
    assert!(invitation.presses, "no code in this one");
    assert_eq!(
        rig.daemon().await.hear().await.unwrap(),
        r#"{"c":"locate"}"#,
        "the robot beeps"
    );
    let joined = rig.join("Mari's phone").await.unwrap();
    assert_eq!(
        rig.buttons.hear().await.unwrap(),
        r#"{"c":"claim-buttons","ms":2000}"#,
        "the presses shall start nothing"
    );
    rig.press(joined.presses).await;
    let answer = rig.matched(&joined).await;
    assert!(answer.body.contains(r#""role":"drive""#), "{answer:?}");
    let cookie = answer.cookie().unwrap();
    assert_eq!(rig.session(&cookie).await.role, Role::Drive);
    while rig.buttons.hear().await.unwrap() != r#"{"c":"claim-buttons","ms":0}"# {}
    let again = rig.matched(&joined).await;
    assert!(again.body.contains("no-attempt"), "{again:?}");
}

#[tokio::test]
async fn other_presses_let_nobody_in_and_end_the_window() {
    let mut rig = Rig::start().await;
    rig.hold_start().await;
    let joined = rig.join("phone").await.unwrap();
    for _ in 0..7 {
        rig.gesture("press").await;
    }
    let answer = rig.matched(&joined).await;
    assert!(
        answer.status == 403 && answer.body.contains("not-matched"),
        "{answer:?}"
    );
    assert!(rig.join("phone").await.is_err());
    let clients = rig.console(&Order::Clients).await;
    assert!(matches!(clients, Reply::Clients { clients } if clients.is_empty()));
}

#[tokio::test]
async fn what_devices_may_trust_is_to_be_had() {
    let rig = Rig::start().await;
    let file = rig.get("/robot.crt", "").await;
    assert!(
        file.status == 200 && file.head.contains("application/x-x509-ca-cert"),
        "{}",
        file.head
    );
    let profile = rig.get("/robot.mobileconfig", "").await;
    assert!(profile.body.contains(&rig.trust.host_name));
}

#[tokio::test]
async fn a_disk_that_takes_nothing_lets_nobody_in() {
    let rig = Rig::start().await;
    let code = rig.open(Role::View).await.unwrap();
    // A folder in the place of the file that is written first makes each write fail.
    std::fs::create_dir_all(rig.folder.join("state/clients.json.new/x")).unwrap();
    let answer = rig.begin(&code, "phone", 1).await.unwrap_err();
    assert_eq!(answer.status, 500, "{answer:?}");
    assert!(
        answer.body.contains("cannot write its list of devices"),
        "{answer:?}"
    );
    std::fs::remove_dir_all(rig.folder.join("state/clients.json.new")).unwrap();
    assert_eq!(
        rig.begin(&code, "phone", 1).await.unwrap_err().status,
        403,
        "the window is shut"
    );
}
