//! The description of the interface, `openapi.json`, against the table of routes and against real answers.

use pairing::wire::{AskMatched, Join, Joined, OpenWindow, Revoke, SetRole};
use pairing::{DeviceName, Method, Need, ROUTES, Role};
use serde_json::{Value, json};

use crate::rig::{Answer, Rig};
use crate::schema::misfit;

fn described() -> Value {
    serde_json::from_str(include_str!("../../openapi.json")).unwrap()
}

/// Method, path and role of every operation.
fn operations(spec: &Value) -> Vec<(String, String, String)> {
    let paths = spec["paths"].as_object().unwrap();
    let operations = paths.iter().flat_map(|(path, methods)| {
        let methods = methods.as_object().unwrap();
        methods.iter().map(move |(method, operation)| {
            let role = operation["x-role"].as_str().unwrap();
            (method.clone(), path.clone(), role.to_owned())
        })
    });
    operations.collect()
}

#[test]
fn the_description_has_exactly_the_routes_and_their_roles() {
    let spec = described();
    assert_eq!(spec["openapi"], "3.1.0");
    let mut left = operations(&spec);
    for route in ROUTES {
        let method = match route.method {
            Method::Get => "get",
            Method::Post => "post",
        };
        let role = match route.need {
            Need::Nobody => "nobody",
            Need::Role(role) => role.name(),
        };
        let is_it = |(found, path, needs): &(String, String, String)| {
            let fits = path == route.path || route.path.ends_with('/') && path.starts_with(route.path);
            found == method && fits && needs == role
        };
        let all = left.len();
        left.retain(|operation| !is_it(operation));
        assert_ne!(
            left.len(),
            all,
            "{method} {} for {role} is not described",
            route.path
        );
    }
    assert!(left.is_empty(), "described and not served: {left:?}");
}

/// The answer is one of the description, in status and content.
#[track_caller]
fn expect_described(spec: &Value, (method, path): (&str, &str), answer: &Answer) {
    let responses = &spec["paths"][path][method]["responses"];
    let mut response = &responses[answer.status.to_string()];
    if let Some(reference) = response["$ref"].as_str() {
        response = spec.pointer(reference.trim_start_matches('#')).unwrap();
    }
    assert!(response.is_object(), "{method} {path} answers {answer:?}");
    let Some(kinds) = response["content"].as_object() else {
        assert!(answer.body.is_empty(), "{method} {path} answers {answer:?}");
        return;
    };
    let is_told = |kind: &&String| answer.head.contains(&format!("content-type: {kind}"));
    let kind = kinds.keys().find(is_told);
    let kind = kind.unwrap_or_else(|| panic!("{method} {path} answers {answer:?}"));
    if kind != "application/json" {
        return;
    }
    let schema = &kinds[kind]["schema"];
    let body: Value = serde_json::from_str(&answer.body).unwrap();
    assert_eq!(misfit(spec, schema, &body), None, "{method} {path}");
}

#[tokio::test]
async fn real_answers_are_as_described() {
    let (rig, spec) = (Rig::start().await, described());
    let admin = rig.pair(Role::Admin).await;
    let viewer = rig.pair(Role::View).await;
    for path in ["/api/pairing", "/api/session", "/api/system", "/api/clients"] {
        for cookie in ["", &viewer, &admin] {
            expect_described(&spec, ("get", path), &rig.get(path, cookie).await);
        }
    }
    let wanted = OpenWindow { role: Role::Drive };
    for cookie in ["", &viewer, &admin] {
        let opened = rig.post("/api/pairing/open", cookie, &wanted).await;
        expect_described(&spec, ("post", "/api/pairing/open"), &opened);
    }
    for path in ["begin", "finish", "open", "match", "matched"] {
        let path = format!("/api/pairing/{path}");
        let odd = rig.post(&path, &admin, &json!({"odd": 1})).await;
        assert_eq!(odd.status, 400);
        expect_described(&spec, ("post", &path), &odd);
    }
    let id = rig.session(&viewer).await.client.unwrap();
    let role = Role::Drive;
    for cookie in ["", &viewer, &admin] {
        let changed = rig.post("/api/clients/role", cookie, &SetRole { id, role }).await;
        expect_described(&spec, ("post", "/api/clients/role"), &changed);
    }
    for cookie in ["", &viewer, &admin] {
        for path in ["/api/update", "/api/matter"] {
            expect_described(&spec, ("get", path), &rig.get(path, cookie).await);
        }
    }
    let told = crate::matter::tell(&rig, crate::matter::OPEN);
    expect_described(
        &spec,
        ("get", "/api/matter"),
        &rig.get("/api/matter", &admin).await,
    );
    told.abort();
    for announced in [0, 7, 7] {
        let taken = rig.upload(&admin, b"7 bytes", announced).await;
        expect_described(&spec, ("post", "/api/update"), &taken);
    }
    expect_described(
        &spec,
        ("get", "/api/update"),
        &rig.get("/api/update", &admin).await,
    );
    for expected in [204, 404] {
        let gone = rig.post("/api/clients/revoke", &admin, &Revoke { id }).await;
        assert_eq!(gone.status, expected);
        expect_described(&spec, ("post", "/api/clients/revoke"), &gone);
    }
}

#[tokio::test]
async fn the_description_is_for_everybody_and_so_are_the_files_that_it_names() {
    let (rig, spec) = (Rig::start().await, described());
    for path in ["/api/openapi.json", "/robot.crt", "/robot.mobileconfig"] {
        let answer = rig.get(path, "").await;
        assert_eq!(answer.status, 200, "{path}");
        expect_described(&spec, ("get", path), &answer);
    }
    let told: Value = serde_json::from_str(&rig.get("/api/openapi.json", "").await.body).unwrap();
    assert_eq!(told, spec);
}

/// Every operation, with each violation of the server's rules.
#[tokio::test]
async fn what_breaks_the_rules_is_refused_as_described() {
    let (rig, spec) = (Rig::start().await, described());
    let (host, origin) = (rig.host(), rig.origin());
    let strange = "Host: strange.example".to_owned();
    let ours = format!("Host: {host}\r\nOrigin: {origin}");
    for (method, path, _) in operations(&spec) {
        let mut tries = vec![
            (strange.clone(), 421),
            (format!("Host: {host}\r\nHost: {host}"), 400),
            (format!("Host: {host}\r\nSec-Fetch-Site: cross-site"), 403),
        ];
        if method == "post" {
            tries.push((format!("Host: {host}"), 403));
            tries.push((ours.clone(), 415));
        }
        for (lines, status) in tries {
            let head = format!("{} {path} HTTP/1.1\r\n{lines}\r\n", method.to_uppercase());
            let request = format!("{head}Content-Length: 0\r\nConnection: close\r\n\r\n");
            let answer = rig.raw(&request).await;
            assert_eq!(answer.status, status, "{request}");
            expect_described(&spec, (&method, &path), &answer);
        }
    }
}

#[tokio::test]
async fn a_program_shows_its_token_as_described() {
    let (rig, spec) = (Rig::start().await, described());
    assert_eq!(
        spec["components"]["securitySchemes"]["bearer"]["scheme"],
        "bearer"
    );
    let cookie = rig.pair(Role::View).await;
    let token = cookie.trim_start_matches("__Host-rvac=");
    let shown = format!("Authorization: Bearer {token}\r\n");
    let answer = rig.ask(("GET", "/api/session"), &shown, "").await;
    assert_eq!(answer.status, 200, "{answer:?}");
    expect_described(&spec, ("get", "/api/session"), &answer);
}

#[tokio::test]
async fn a_device_is_matched_as_described() {
    let (mut rig, spec) = (Rig::start().await, described());
    let closed = rig.join("phone").await.unwrap_err();
    expect_described(&spec, ("post", "/api/pairing/match"), &closed);
    rig.hold_start().await;
    expect_described(&spec, ("get", "/api/pairing"), &rig.get("/api/pairing", "").await);
    let name = DeviceName::new("phone").unwrap();
    let answer = rig.post("/api/pairing/match", "", &Join { name }).await;
    assert_eq!(answer.status, 200);
    expect_described(&spec, ("post", "/api/pairing/match"), &answer);
    let joined: Joined = serde_json::from_str(&answer.body).unwrap();
    let session = joined.session;
    let waits = rig
        .post("/api/pairing/matched", "", &AskMatched { session })
        .await;
    expect_described(&spec, ("post", "/api/pairing/matched"), &waits);
    rig.press(joined.presses).await;
    for _ in 0..2 {
        expect_described(
            &spec,
            ("post", "/api/pairing/matched"),
            &rig.matched(&joined).await,
        );
    }
}

#[tokio::test]
async fn a_device_is_paired_as_described() {
    let (rig, spec) = (Rig::start().await, described());
    let code = rig.open(Role::Drive).await.unwrap();
    let finish = rig.begin(&code, "Mari's phone", 7).await.unwrap();
    let answer = rig.finish(&finish).await;
    assert_eq!(answer.status, 200);
    expect_described(&spec, ("post", "/api/pairing/finish"), &answer);
    let late = rig.finish(&finish).await;
    assert_ne!(late.status, 200);
    expect_described(&spec, ("post", "/api/pairing/finish"), &late);
    let uninvited = rig.begin(&code, "Mari's phone", 7).await.unwrap_err();
    expect_described(&spec, ("post", "/api/pairing/begin"), &uninvited);
}
