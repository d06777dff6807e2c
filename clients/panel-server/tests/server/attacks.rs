//! What foreign pages and odd clients try, over real TCP.

use crate::rig::Rig;

#[tokio::test]
async fn only_our_own_page_opens_a_socket() {
    let rig = Rig::start().await;
    let good = "Host: 127.0.0.1:PORT\r\n";
    assert_eq!(
        rig.upgrade(&format!("{good}Origin: http://127.0.0.1:PORT\r\n"))
            .await,
        "101"
    );
    assert_eq!(
        rig.upgrade("Host: robot.local:PORT\r\nOrigin: http://robot.local:PORT\r\n")
            .await,
        "101"
    );
    for (lines, expected) in [
        (good.to_owned(), "403"),
        (format!("{good}Origin: null\r\n"), "403"),
        (format!("{good}Origin: http://evil.example\r\n"), "403"),
        (format!("{good}Origin: http://127.0.0.1:1\r\n"), "403"),
        (format!("{good}Origin: https://127.0.0.1:PORT\r\n"), "403"),
        (format!("{good}Origin: http://localhost:PORT\r\n"), "403"),
        (
            format!("{good}Origin: http://127.0.0.1:PORT\r\nSec-Fetch-Site: cross-site\r\n"),
            "403",
        ),
        (
            format!("{good}Origin: http://127.0.0.1:PORT\r\nSec-Fetch-Site: same-site\r\n"),
            "403",
        ),
        (
            "Host: evil.example:PORT\r\nOrigin: http://evil.example:PORT\r\n".to_owned(),
            "421",
        ),
        (
            format!("{good}Host: evil.example\r\nOrigin: http://127.0.0.1:PORT\r\n"),
            "400",
        ),
    ] {
        assert_eq!(rig.upgrade(&lines).await, expected, "{lines}");
    }
}

#[tokio::test]
async fn a_page_whose_name_was_rebound_gets_nothing() {
    let rig = Rig::start().await;
    let answer = rig
        .raw("GET / HTTP/1.1\r\nHost: evil.example:PORT\r\nConnection: close\r\n\r\n")
        .await;
    assert!(answer.starts_with("HTTP/1.1 421"), "{answer}");
    assert!(!answer.contains("doctype"), "{answer}");
    let answer = rig
        .raw("GET http://evil.example/ HTTP/1.1\r\nHost: 127.0.0.1:PORT\r\nConnection: close\r\n\r\n")
        .await;
    assert!(answer.starts_with("HTTP/1.1 400"), "{answer}");
}

#[tokio::test]
async fn other_sites_cannot_load_pages_or_post() {
    let rig = Rig::start().await;
    for (request, expected) in [
        ("GET / HTTP/1.1\r\nSec-Fetch-Site: cross-site\r\n", "403"),
        ("GET / HTTP/1.1\r\nSec-Fetch-Site: same-site\r\n", "403"),
        ("GET / HTTP/1.1\r\nSec-Fetch-Site: none\r\n", "200"),
        ("GET / HTTP/1.1\r\nSec-Fetch-Site: same-origin\r\n", "200"),
        ("POST / HTTP/1.1\r\nContent-Length: 0\r\n", "403"),
        ("POST / HTTP/1.1\r\nContent-Length: 0\r\nOrigin: null\r\n", "403"),
        (
            "POST / HTTP/1.1\r\nContent-Length: 0\r\nOrigin: http://127.0.0.1:PORT\r\n",
            "405",
        ),
        ("DELETE / HTTP/1.1\r\nOrigin: http://127.0.0.1:PORT\r\n", "405"),
    ] {
        let answer = rig
            .raw(&format!(
                "{request}Host: 127.0.0.1:PORT\r\nConnection: close\r\n\r\n"
            ))
            .await;
        assert_eq!(answer.get(9..12), Some(expected), "{request}");
    }
}

#[tokio::test]
async fn every_answer_carries_the_security_headers() {
    let rig = Rig::start().await;
    for path in ["/", "/nothing", "/boot-1.js"] {
        let answer = rig
            .raw(&format!(
                "GET {path} HTTP/1.1\r\nHost: localhost:PORT\r\nConnection: close\r\n\r\n"
            ))
            .await;
        for header in [
            "content-security-policy: default-src 'none';",
            "frame-ancestors 'none'",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
        ] {
            assert!(answer.contains(header), "{path}: {answer}");
        }
        assert!(!answer.contains("access-control-allow"), "{path}: {answer}");
    }
}

#[tokio::test]
async fn paths_lead_nowhere_else() {
    let rig = Rig::start().await;
    std::fs::write(
        rig.folder.parent().unwrap().join("panel-server-secret.html"),
        "secret",
    )
    .unwrap();
    for path in [
        "/../panel-server-secret.html",
        "/..%2fpanel-server-secret.html",
        "/%2e%2e/panel-server-secret.html",
        "/./../panel-server-secret.html",
        "//etc/passwd",
        "/boot-1.js/../index.html",
        "/vthal.sock",
        "/index.html.gz",
        "/\\..\\panel-server-secret.html",
    ] {
        let answer = rig
            .raw(&format!(
                "GET {path} HTTP/1.1\r\nHost: localhost:PORT\r\nConnection: close\r\n\r\n"
            ))
            .await;
        let status = answer.get(9..12).unwrap_or_default();
        assert!(matches!(status, "404" | "400"), "{path}: {answer}");
        assert!(
            !answer.contains("secret\r\n") && !answer.ends_with("secret"),
            "{path}: {answer}"
        );
    }
    std::fs::remove_file(rig.folder.parent().unwrap().join("panel-server-secret.html")).unwrap();
}

#[tokio::test]
async fn packed_files_are_sent_to_who_takes_them() {
    let rig = Rig::start().await;
    let get = "GET /boot-1.js HTTP/1.1\r\nHost: localhost:PORT\r\nConnection: close\r\n";
    let packed = rig.raw(&format!("{get}Accept-Encoding: br, gzip\r\n\r\n")).await;
    assert!(
        packed.contains("content-encoding: gzip") && packed.ends_with("packed"),
        "{packed}"
    );
    let plain = rig.raw(&format!("{get}\r\n")).await;
    assert!(
        !plain.contains("content-encoding") && plain.ends_with("export {}"),
        "{plain}"
    );
    assert!(
        plain.contains("immutable") && plain.contains("text/javascript"),
        "{plain}"
    );
}

#[tokio::test]
async fn a_huge_head_is_refused() {
    let rig = Rig::start().await;
    let padding = "x".repeat(64 << 10);
    let answer = rig
        .raw(&format!(
            "GET / HTTP/1.1\r\nHost: localhost:PORT\r\nX-Padding: {padding}\r\n\r\n"
        ))
        .await;
    assert!(
        answer.is_empty() || answer.starts_with("HTTP/1.1 431"),
        "{answer}"
    );
}

#[tokio::test]
async fn an_oversized_message_ends_the_connection_and_reaches_nobody() {
    let rig = Rig::start().await;
    let mut browser = rig.browser().await;
    let mut vthal = rig.accept().await;
    let padding = "x".repeat(64 << 10);
    browser
        .say(&format!(r#"{{"c":"hello","name":"{padding}"}}"#))
        .await;
    browser.until_dropped().await;
    assert_eq!(vthal.hear().await, None);
}

#[tokio::test]
async fn a_smuggled_separator_is_refused() {
    let rig = Rig::start().await;
    let mut browser = rig.browser().await;
    let mut vthal = rig.accept().await;
    browser.say("{\"c\":\"stop\"}\u{1f}{\"c\":\"start\"}").await;
    assert!(browser.hear().await.contains(r#""reason":"syntax""#));
    browser.say(r#"{"c":"stop"}"#).await;
    assert_eq!(vthal.hear().await.as_deref(), Some(r#"{"c":"stop"}"#));
}

#[tokio::test]
async fn a_flood_ends_the_connection() {
    let rig = Rig::start().await;
    let mut browser = rig.browser().await;
    let _vthal = rig.accept().await;
    for _ in 0..250 {
        browser.say(r#"{"c":"locate"}"#).await;
    }
    browser.until_dropped().await;
}
