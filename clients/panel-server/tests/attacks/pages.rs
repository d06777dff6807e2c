//! A8 to A12, A19, A21: what pages of other sites and odd requests try, with the owner's own cookie.

use pairing::Role;

use crate::report::Report;
use crate::rig::Rig;

const CHANGE: &str = "/api/pairing/open";

pub(crate) async fn try_all(report: &mut Report) {
    let rig = Rig::start().await;
    let cookie = rig.pair(Role::Admin).await;
    let page = Page { rig: &rig, cookie };
    page.foreign(report).await;
    page.odd_requests(report).await;
    page.paths(report).await;
    let opened = rig.get("/api/pairing", "").await.body.contains("\"open\":true");
    report.row(
        ("A8", "after all of it a window is open"),
        "false",
        opened.to_string(),
    );
}

struct Page<'a> {
    rig: &'a Rig,
    cookie: String,
}

impl Page<'_> {
    fn fill(&self, text: &str) -> String {
        text.replace("HOST", &self.rig.host())
            .replace("PORT", &self.rig.address.port().to_string())
            .replace("NAME", &self.rig.trust.host_name)
            .replace("COOKIE", &self.cookie)
    }

    async fn status(&self, request: &str) -> String {
        self.rig.raw(&self.fill(request)).await.status.to_string()
    }

    async fn post(&self, lines: &str) -> String {
        let body = r#"{"role":"admin"}"#;
        self.status(&format!(
            "POST {CHANGE} HTTP/1.1\r\nHost: HOST\r\nCookie: COOKIE\r\nConnection: close\r\nContent-Length: {}\r\n{lines}\r\n{body}",
            body.len()
        ))
        .await
    }

    async fn upgrade(&self, lines: &str) -> String {
        self.status(&format!(
            "GET /api/ws HTTP/1.1\r\nHost: HOST\r\nCookie: COOKIE\r\nConnection: close, Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n{lines}\r\n"
        ))
        .await
    }

    async fn foreign(&self, report: &mut Report) {
        let json = "Content-Type: application/json\r\nX-Rvac: 1\r\n";
        for (id, what, origin) in [
            ("A8", "another site", "Origin: https://evil.example\r\n"),
            ("A8", "the plain HTTP page", "Origin: http://NAME\r\n"),
            (
                "A9",
                "the same host at another port",
                "Origin: https://NAME:1\r\n",
            ),
            ("A9", "the same host without a port", "Origin: https://NAME\r\n"),
            ("A11", "a sandboxed frame", "Origin: null\r\n"),
            ("A11", "a file", "Origin: file://\r\n"),
            ("A11", "no origin", ""),
        ] {
            let seen = self.post(&format!("{origin}{json}")).await;
            report.row((id, format!("{what}: a change")), "403", seen);
            let seen = self.upgrade(origin).await;
            report.row((id, format!("{what}: a WebSocket")), "403", seen);
        }
        for (what, lines, expected) in [
            ("a form", "Content-Type: text/plain\r\n", "415"),
            (
                "a change without X-Rvac",
                "Content-Type: application/json\r\n",
                "415",
            ),
            (
                "the browser says cross-site",
                "Content-Type: application/json\r\nX-Rvac: 1\r\nSec-Fetch-Site: cross-site\r\n",
                "403",
            ),
            (
                "the browser says same-site",
                "Content-Type: application/json\r\nX-Rvac: 1\r\nSec-Fetch-Site: same-site\r\n",
                "403",
            ),
        ] {
            let seen = self.post(&format!("Origin: https://HOST\r\n{lines}")).await;
            report.row(("A8", what), expected, seen);
        }
        let get = "GET /api/clients HTTP/1.1\r\nHost: HOST\r\nCookie: COOKIE\r\nConnection: close\r\n";
        for site in ["cross-site", "same-site"] {
            let seen = self.status(&format!("{get}Sec-Fetch-Site: {site}\r\n\r\n")).await;
            report.row(("A8", format!("an image or a frame, {site}")), "403", seen);
        }
        let page = self.rig.get("/", &self.cookie).await;
        let refuses =
            page.head.contains("frame-ancestors 'none'") && page.head.contains("default-src 'none'");
        report.row(
            ("A12", "the page says who may frame it"),
            "nobody",
            if refuses { "nobody" } else { "anybody" },
        );
        let rebound = self
            .rig
            .raw("GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n")
            .await;
        let seen = format!("{}, cookie {}", rebound.status, rebound.cookie().is_some());
        report.row(
            ("A10", "a name that was re-pointed to the robot"),
            "421, cookie false",
            seen,
        );
    }

    async fn odd_requests(&self, report: &mut Report) {
        for (what, request, expected) in [
            (
                "two hosts",
                "GET / HTTP/1.1\r\nHost: HOST\r\nHost: evil.example\r\nConnection: close\r\n\r\n",
                "400",
            ),
            (
                "another host in the line",
                "GET https://evil.example/ HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n",
                "400",
            ),
            (
                "two lengths",
                "POST /api/pairing/begin HTTP/1.1\r\nHost: HOST\r\nContent-Length: 2\r\nContent-Length: 3\r\nConnection: close\r\n\r\n{}x",
                "400",
            ),
            (
                "a length and a transfer encoding",
                "POST /api/pairing/begin HTTP/1.1\r\nHost: HOST\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n\
                 Origin: https://HOST\r\nContent-Type: application/json\r\nX-Rvac: 1\r\nConnection: close\r\n\r\n\
                 0\r\n\r\nGET /api/pairing HTTP/1.1\r\nHost: HOST\r\n\r\n",
                "400",
            ),
            (
                "a transfer encoding that nobody knows",
                "POST /api/pairing/begin HTTP/1.1\r\nHost: HOST\r\nTransfer-Encoding: xchunked\r\n\
                 Connection: close\r\n\r\n0\r\n\r\n",
                "400",
            ),
            (
                "a space before the colon",
                "GET / HTTP/1.1\r\nHost : HOST\r\nConnection: close\r\n\r\n",
                "400",
            ),
            ("no host", "GET / HTTP/1.1\r\nConnection: close\r\n\r\n", "400"),
        ] {
            let seen = self.status(request).await;
            report.row(("A21", what), expected, seen);
        }
    }

    async fn paths(&self, report: &mut Report) {
        for path in [
            "/../state/clients.json",
            "/..%2fstate/clients.json",
            "/%2e%2e/state/identity.json",
            "//etc/passwd",
            "/state/clients.json",
            "/vthal.sock",
            "/\\..\\state\\clients.json",
        ] {
            let seen = self
                .status(&format!(
                    "GET {path} HTTP/1.1\r\nHost: HOST\r\nCookie: COOKIE\r\nConnection: close\r\n\r\n"
                ))
                .await;
            let seen = if seen == "400" { "404".to_owned() } else { seen };
            report.row(("A19", format!("GET {path}")), "404", seen);
        }
    }
}
