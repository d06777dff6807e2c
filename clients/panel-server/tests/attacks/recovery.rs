//! A28: forgetting all devices, which only a person beside the robot, at its console or with its card in hand can do.

use pairing::Role;
use pairing::console::{Order, Reply};
use pairing::wire::Invitation;
use rustls::pki_types::CertificateDer;
use rustls::pki_types::pem::PemObject as _;

use crate::report::Report;
use crate::rig::Rig;

pub(crate) async fn try_all(report: &mut Report) {
    by_buttons(report).await;
    by_file(report).await;
    by_console(report).await;
}

async fn invitation(rig: &Rig) -> Invitation {
    serde_json::from_str(&rig.get("/api/pairing", "").await.body).unwrap()
}

async fn fingerprint(rig: &Rig) -> String {
    match rig.console(&Order::Trust).await {
        Reply::Trust(trust) => trust.fingerprint,
        other => panic!("{other:?}"),
    }
}

async fn known(rig: &Rig) -> usize {
    match rig.console(&Order::Clients).await {
        Reply::Clients { clients } => clients.len(),
        other => panic!("{other:?}"),
    }
}

async fn by_buttons(report: &mut Report) {
    let mut rig = Rig::start().await;
    let cookie = rig.pair(Role::Admin).await;
    let body = r#"{"identity":false}"#;
    for path in ["/api/clients/forget-all", "/api/forget-all"] {
        let line = format!("Cookie: {cookie}\r\n");
        rig.ask(("POST", path), &line, body).await;
    }
    report.row(
        (
            "A28",
            "an administrator asks for it over the network: devices left",
        ),
        "1",
        known(&rig).await.to_string(),
    );
    let mut socket = rig.socket(&cookie).await;
    rig.gesture("recovery-hold").await;
    socket.until_ended().await;
    report.row(("A28", "START and DOCK held: an open WebSocket"), "ends", "ends");
    let status = rig.get("/api/session", &cookie).await.status;
    report.row(("A28", "a token from before"), "401", status.to_string());
    report.row(("A28", "devices left"), "0", known(&rig).await.to_string());
    let stays = fingerprint(&rig).await == rig.trust.fingerprint;
    report.row(("A28", "the robot is who it was"), "true", stays.to_string());
    let mut invited = invitation(&rig).await;
    while !invited.open {
        invited = invitation(&rig).await;
    }
    let old = std::fs::read_to_string(rig.folder.join("state/clients.json.old")).unwrap();
    report.row(
        ("A28", "the predecessor of the list holds a token"),
        "false",
        old.contains("digest").to_string(),
    );
    report.row(
        ("A28", "the window after it is one of presses"),
        "true",
        invited.presses.to_string(),
    );
    report.row(
        ("A28", "strangers are told by what"),
        "Some(Buttons)",
        format!("{:?}", invited.forgotten),
    );
    rig.restart().await;
    let status = rig.get("/api/session", &cookie).await.status;
    report.row(("A28", "and after ending the server"), "401", status.to_string());
}

async fn by_file(report: &mut Report) {
    let mut rig = Rig::start().await;
    let card = rig.folder.join("card");
    std::fs::create_dir_all(&card).unwrap();
    for (text, same_robot) in [("", true), ("everything\n", false)] {
        let cookie = rig.pair(Role::View).await;
        std::fs::write(card.join("librvac-reset"), text).unwrap();
        rig.restart().await;
        report.row(
            (
                "A28",
                format!("the file on the card, with {text:?}: devices left"),
            ),
            "0",
            known(&rig).await.to_string(),
        );
        let stays = fingerprint(&rig).await == rig.trust.fingerprint;
        report.row(
            ("A28", format!("the robot is who it was, with {text:?}")),
            same_robot.to_string(),
            stays.to_string(),
        );
        if same_robot {
            let status = rig.get("/api/session", &cookie).await.status;
            report.row(("A28", "a token from before the file"), "401", status.to_string());
            rig.pair(Role::View).await;
            rig.restart().await;
            report.row(
                ("A28", "the file asks once: devices left after the next start"),
                "1",
                known(&rig).await.to_string(),
            );
        }
    }
}

async fn by_console(report: &mut Report) {
    let rig = Rig::start().await;
    rig.pair(Role::Admin).await;
    let order = Order::ForgetAll { identity: true };
    let Reply::Trust(new) = rig.console(&order).await else {
        panic!("no new identity");
    };
    let authority = |pem: &str| CertificateDer::from_pem_slice(pem.as_bytes()).unwrap();
    // The new certificate is made a moment later.
    let mut trusting = rig.tls_as(&new.host_name, authority(&new.pem)).await;
    while trusting.is_err() {
        trusting = rig.tls_as(&new.host_name, authority(&new.pem)).await;
    }
    report.row(
        (
            "A28",
            "everything forgotten at the console: who trusts the new identity",
        ),
        "connected",
        "connected",
    );
    let old = rig.tls_trusting(authority(&rig.trust.pem)).await.is_ok();
    report.row(
        ("A28", "who trusts the one before"),
        "no connection",
        if old { "connected" } else { "no connection" },
    );
    report.row(("A28", "devices left"), "0", known(&rig).await.to_string());
}
