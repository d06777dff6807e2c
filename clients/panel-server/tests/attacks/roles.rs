//! A1, A2: who has no token, and who has one of a role that is too low.

use pairing::{Method, Need, PRESENCE, ROUTES, Role};
use rvac_api::{VERBS, example_of};

use crate::report::Report;
use crate::rig::{Answer, Rig};

pub(crate) async fn try_all(report: &mut Report) {
    let rig = Rig::start().await;
    nobody(&rig, report).await;
    for role in Role::ALL {
        let cookie = rig.pair(role).await;
        // The robot beeped at the opening and at the success.
        for _ in 0..2 {
            rig.daemon().await;
        }
        addresses(&rig, role, &cookie, report).await;
        verbs(&rig, role, &cookie, report).await;
    }
}

fn method(method: Method) -> &'static str {
    match method {
        Method::Get => "GET",
        Method::Post => "POST",
    }
}

async fn nobody(rig: &Rig, report: &mut Report) {
    let false_token = format!("__Host-rvac={}.{}", "0".repeat(16), "0".repeat(64));
    let unknown = [(Method::Get, "/api/unknown"), (Method::Post, "/api/pairing/x")];
    let known = ROUTES.iter().filter(|route| route.need != Need::Nobody);
    let all = known.map(|route| (route.method, route.path)).chain(unknown);
    for (how, path) in all {
        for (who, cookie) in [("no token", ""), ("a false token", false_token.as_str())] {
            let seen = call(rig, method(how), path, cookie).await.status;
            report.row(
                ("A1", format!("{who}: {} {path}", method(how))),
                "401",
                seen.to_string(),
            );
        }
    }
    for path in ["/", "/robot.crt", "/api/pairing"] {
        let seen = call(rig, "GET", path, "").await.status;
        report.row(
            ("A1", format!("what is for everybody: GET {path}")),
            "200",
            seen.to_string(),
        );
    }
}

async fn call(rig: &Rig, method: &str, path: &str, cookie: &str) -> Answer {
    if path == "/api/ws" {
        let (host, origin) = (rig.host(), rig.origin());
        return rig
            .raw(&format!(
                "GET /api/ws HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nConnection: close, Upgrade\r\nUpgrade: websocket\r\n\
                 Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nCookie: {cookie}\r\n\r\n"
            ))
            .await;
    }
    if (method, path) == ("POST", "/api/update") {
        return rig.upload(cookie, b"{}", 2).await;
    }
    let cookie = if cookie.is_empty() {
        String::new()
    } else {
        format!("Cookie: {cookie}\r\n")
    };
    let body = if method == "POST" { "{}" } else { "" };
    rig.ask((method, path), &cookie, body).await
}

/// What asks the daemon, which does not answer here: every role may do so, and each of its requests is tried below.
const ASK_THE_DAEMON: [&str; 2] = ["/api/ws", "/api/floors/archive"];

/// Every other address, with a body that means nothing: whoever may gets as far as that.
async fn addresses(rig: &Rig, role: Role, cookie: &str, report: &mut Report) {
    for route in ROUTES
        .iter()
        .filter(|route| !ASK_THE_DAEMON.contains(&route.path))
    {
        let answer = call(rig, method(route.method), route.path, cookie).await;
        let seen = if answer.body.contains("not-allowed") {
            "403"
        } else {
            "heard"
        };
        let expected = if route.need.is_met_by(Some(role)) {
            "heard"
        } else {
            "403"
        };
        report.row(
            ("A2", format!("{role}: {} {}", method(route.method), route.path)),
            expected,
            seen,
        );
    }
}

/// Every request, each followed by one that everybody may make: either the daemon receives it or it does not.
async fn verbs(rig: &Rig, role: Role, cookie: &str, report: &mut Report) {
    let mut socket = rig.socket(cookie).await;
    let mut daemon = rig.daemon().await;
    for (verb, needed) in VERBS {
        let example = example_of(verb).expect("each request has one");
        socket.say(&example.replacen('{', r#"{"id":1,"#, 1)).await;
        socket.say(r#"{"id":2,"c":"maps"}"#).await;
        let first = daemon.hear().await.unwrap_or_default();
        let heard = first.contains(&format!(r#""c":"{verb}""#)) && first.contains(r#""id":1"#);
        if heard {
            daemon.hear().await;
        }
        let expected = if role >= needed && !PRESENCE.contains(&verb) {
            "the daemon hears it"
        } else {
            "nobody hears it"
        };
        let seen = if heard {
            "the daemon hears it"
        } else {
            "nobody hears it"
        };
        report.row(("A2", format!("{role}: {verb}")), expected, seen);
    }
}
