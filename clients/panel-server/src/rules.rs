//! Which requests are answered: the checks of Host, Origin and Sec-Fetch-Site, and of the form of a change.
//!
//! They keep foreign web pages out. A page of another site can make the owner's browser send requests here; the browser tells
//! their origin in headers that the page cannot forge. A page whose name was re-pointed to this address (DNS rebinding) betrays
//! itself by its name in `Host`.

use std::net::IpAddr;

use axum::body::Body;
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, Response, StatusCode, header};
use axum::response::IntoResponse as _;
use pairing::{Ways, ways_of};

const SEC_FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// A header that no form can send, and no page of another site without asking first.
const OURS: HeaderName = HeaderName::from_static("x-rvac");

/// Where files are sent to.
const UPDATE: &str = "/api/update";

/// How the server is spoken to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// On the computer itself.
    Http,
    /// From everywhere else.
    Https,
}

impl Scheme {
    const fn port(self) -> u16 {
        match self {
            Self::Http => 80,
            Self::Https => 443,
        }
    }

    const fn before(self) -> &'static str {
        match self {
            Self::Http => "http://",
            Self::Https => "https://",
        }
    }
}

/// An address as in the header `Host`.
pub(crate) fn in_authority(ip: IpAddr) -> String {
    match ip {
        IpAddr::V4(ip) => ip.to_string(),
        IpAddr::V6(ip) => format!("[{ip}]"),
    }
}

/// The names, the scheme and the port by which browsers may call the server.
#[derive(Clone, Debug)]
pub struct Rules {
    scheme: Scheme,
    authorities: Vec<String>,
}

/// Why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// No `Host`, several, or one that disagrees with the request line.
    HostUnclear,
    /// `Host` is a name that is not ours.
    HostForeign,
    /// A WebSocket or a state change without exactly one `Origin`.
    OriginMissing,
    /// The `Origin` is another scheme, host or port.
    OriginForeign,
    /// `Sec-Fetch-Site` says that another site asks.
    CrossSite,
    /// This address takes only these.
    Method(Ways),
    /// A change that a form could have sent.
    NotOurs,
}

impl Refusal {
    /// The HTTP status.
    #[must_use]
    pub const fn status(self) -> StatusCode {
        match self {
            Self::HostUnclear => StatusCode::BAD_REQUEST,
            Self::HostForeign => StatusCode::MISDIRECTED_REQUEST,
            Self::OriginMissing | Self::OriginForeign | Self::CrossSite => StatusCode::FORBIDDEN,
            Self::Method(_) => StatusCode::METHOD_NOT_ALLOWED,
            Self::NotOurs => StatusCode::UNSUPPORTED_MEDIA_TYPE,
        }
    }

    /// What the browser is told.
    pub(crate) fn answer(self) -> Response<Body> {
        let mut answer = (self.status(), self.text()).into_response();
        if let Self::Method(ways) = self {
            // RFC 9110, section 15.5.6: whoever asks in a wrong way is told the right ones.
            let allowed = match ways {
                Ways::Read => "GET, HEAD",
                Ways::Change => "POST",
                Ways::Both => "GET, HEAD, POST",
            };
            let allowed = HeaderValue::from_static(allowed);
            answer.headers_mut().insert(header::ALLOW, allowed);
        }
        answer
    }

    /// One sentence for the person who sees it in a browser.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::HostUnclear => "The request does not name one host.\n",
            Self::HostForeign => {
                "This server does not go by the name in the address bar: use the address that it printed at its start, or add \
                 the name with --host-name.\n"
            }
            Self::OriginMissing => "The request does not say which page it comes from.\n",
            Self::OriginForeign => "The request comes from a page of another site.\n",
            Self::CrossSite => {
                "Another site led here: type the address of the panel into the address bar instead.\n"
            }
            Self::Method(Ways::Read) => "Only GET and HEAD are answered here.\n",
            Self::Method(Ways::Change) => "Only POST is answered here.\n",
            Self::Method(Ways::Both) => "Only GET, HEAD and POST are answered here.\n",
            Self::NotOurs => {
                "A change is sent as application/json (an update as application/octet-stream), not packed, with the header X-Rvac: 1.\n"
            }
        }
    }
}

impl Rules {
    /// Rules for a server on `port` that goes by the names of loopback and by `host_names` (IPv6 addresses in brackets).
    pub fn new(scheme: Scheme, port: u16, host_names: impl IntoIterator<Item = String>) -> Self {
        let mut authorities = Vec::new();
        let own = ["localhost", "127.0.0.1", "[::1]"].map(str::to_owned);
        for name in own.into_iter().chain(host_names) {
            let name = name.to_ascii_lowercase();
            authorities.push(format!("{name}:{port}"));
            if port == scheme.port() {
                authorities.push(name);
            }
        }
        Self { scheme, authorities }
    }

    /// Checks a request before anything else handles it.
    ///
    /// # Errors
    /// The first rule that it breaks.
    pub fn check(&self, request: &Parts) -> Result<(), Refusal> {
        let host = self.checked_host(request)?;
        let changes = !matches!(request.method, Method::GET | Method::HEAD);
        let upgrades = request.headers.contains_key(header::UPGRADE);
        check_site(&request.headers, changes || upgrades)?;
        if changes || upgrades {
            self.check_origin(&request.headers, &host)?;
        }
        if changes {
            check_change(request)?;
        }
        Ok(())
    }

    /// The lower-case authority of the request, known to be one of ours.
    fn checked_host(&self, request: &Parts) -> Result<String, Refusal> {
        let host = only(&request.headers, &header::HOST).ok_or(Refusal::HostUnclear)?;
        let host = host.to_ascii_lowercase();
        if let Some(authority) = request.uri.authority()
            && authority.as_str().to_ascii_lowercase() != host
        {
            return Err(Refusal::HostUnclear);
        }
        if !self.authorities.contains(&host) {
            return Err(Refusal::HostForeign);
        }
        Ok(host)
    }

    /// The origin must be the scheme that we speak and the very authority that was called.
    fn check_origin(&self, headers: &HeaderMap, host: &str) -> Result<(), Refusal> {
        let origin = only(headers, &header::ORIGIN).ok_or(Refusal::OriginMissing)?;
        if origin.strip_prefix(self.scheme.before()) == Some(host) {
            return Ok(());
        }
        Err(Refusal::OriginForeign)
    }
}

/// A change goes to our own interface and has a form that a page of another site cannot send by itself.
fn check_change(request: &Parts) -> Result<(), Refusal> {
    let path = request.uri.path();
    let is_post = request.method == Method::POST;
    match ways_of(path) {
        Some(Ways::Change | Ways::Both) if is_post => {}
        // An address that there is not is told later.
        None if is_post && path.starts_with("/api/") => {}
        known => return Err(Refusal::Method(known.unwrap_or(Ways::Read))),
    }
    // Nothing here unpacks, so what is packed has no meaning that we know.
    let is_packed = request.headers.contains_key(header::CONTENT_ENCODING);
    // A file is no JSON; no form sends this kind, either.
    let kind = match path {
        UPDATE => "application/octet-stream",
        _ => "application/json",
    };
    let is_ours = !is_packed
        && only(&request.headers, &header::CONTENT_TYPE) == Some(kind)
        && only(&request.headers, &OURS) == Some("1");
    is_ours.then_some(()).ok_or(Refusal::NotOurs)
}

/// The text of a header that is present exactly once.
fn only<'h>(headers: &'h HeaderMap, name: &HeaderName) -> Option<&'h str> {
    let mut values = headers.get_all(name).iter();
    let first = values.next()?;
    if values.next().is_some() {
        return None;
    }
    first.to_str().ok()
}

/// `none` (typed into the address bar) is good enough for reading a page, not for anything that acts.
fn check_site(headers: &HeaderMap, acts: bool) -> Result<(), Refusal> {
    if !headers.contains_key(SEC_FETCH_SITE) {
        return Ok(());
    }
    match only(headers, &SEC_FETCH_SITE) {
        Some("same-origin") => Ok(()),
        Some("none") if !acts => Ok(()),
        _ => Err(Refusal::CrossSite),
    }
}

#[cfg(test)]
mod tests {
    use super::{Refusal, Rules, Scheme, Ways};
    use axum::http::Request;

    /// Checks a request made of `method`, `uri` and header lines against a server on port 8080 with one extra name.
    #[track_caller]
    fn check(line: (&str, &str), headers: &[(&str, &str)], expected: Result<(), Refusal>) {
        let mut request = Request::builder().method(line.0).uri(line.1);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        let (parts, ()) = request.body(()).unwrap().into_parts();
        assert_eq!(
            Rules::new(Scheme::Http, 8080, ["Robot.local".to_owned()]).check(&parts),
            expected,
            "{line:?} {headers:?}"
        );
    }

    const PAGE: (&str, &str) = ("GET", "/");
    const OURS: (&str, &str) = ("host", "localhost:8080");
    const WS: (&str, &str) = ("upgrade", "websocket");

    #[test]
    fn host_must_be_ours() {
        for host in [
            "localhost:8080",
            "127.0.0.1:8080",
            "[::1]:8080",
            "robot.local:8080",
            "LOCALHOST:8080",
        ] {
            check(PAGE, &[("host", host)], Ok(()));
        }
        for host in [
            "localhost",
            "localhost:81",
            "evil.example:8080",
            "127.0.0.1.evil.example:8080",
            "127.0.0.2:8080",
            "",
        ] {
            check(PAGE, &[("host", host)], Err(Refusal::HostForeign));
        }
        check(PAGE, &[], Err(Refusal::HostUnclear));
        check(
            PAGE,
            &[OURS, ("host", "evil.example:8080")],
            Err(Refusal::HostUnclear),
        );
        check(
            ("GET", "http://evil.example:8080/"),
            &[OURS],
            Err(Refusal::HostUnclear),
        );
        check(("GET", "http://localhost:8080/"), &[OURS], Ok(()));
    }

    #[test]
    fn websocket_needs_the_exact_origin() {
        check(PAGE, &[OURS, WS, ("origin", "http://localhost:8080")], Ok(()));
        check(PAGE, &[OURS, WS], Err(Refusal::OriginMissing));
        for origin in [
            "null",
            "https://localhost:8080",
            "http://localhost",
            "http://localhost:8081",
            "http://127.0.0.1:8080",
            "http://evil.example:8080",
            "http://localhost:8080.evil.example",
            "file://",
            "",
        ] {
            check(PAGE, &[OURS, WS, ("origin", origin)], Err(Refusal::OriginForeign));
        }
        let good = ("origin", "http://localhost:8080");
        check(
            PAGE,
            &[OURS, WS, good, ("origin", "null")],
            Err(Refusal::OriginMissing),
        );
    }

    #[test]
    fn other_sites_are_refused_by_fetch_metadata() {
        check(PAGE, &[OURS, ("sec-fetch-site", "none")], Ok(()));
        check(PAGE, &[OURS, ("sec-fetch-site", "same-origin")], Ok(()));
        for site in ["cross-site", "same-site", "other"] {
            check(PAGE, &[OURS, ("sec-fetch-site", site)], Err(Refusal::CrossSite));
        }
        let origin = ("origin", "http://localhost:8080");
        check(
            PAGE,
            &[OURS, WS, origin, ("sec-fetch-site", "none")],
            Err(Refusal::CrossSite),
        );
    }

    #[test]
    fn nothing_but_reading_is_offered() {
        check(("POST", "/"), &[OURS], Err(Refusal::OriginMissing));
        check(
            ("POST", "/"),
            &[OURS, ("origin", "http://evil.example")],
            Err(Refusal::OriginForeign),
        );
        check(
            ("POST", "/"),
            &[OURS, ("origin", "http://localhost:8080")],
            Err(Refusal::Method(Ways::Read)),
        );
        check(("HEAD", "/"), &[OURS], Ok(()));
        let ours = [OURS, ("origin", "http://localhost:8080")];
        check(("POST", "/api/session"), &ours, Err(Refusal::Method(Ways::Read)));
        check(
            ("PUT", "/api/clients/role"),
            &ours,
            Err(Refusal::Method(Ways::Change)),
        );
    }

    #[test]
    fn port_80_may_be_left_out() {
        let (parts, ()) = Request::builder()
            .uri("/")
            .header("host", "localhost")
            .body(())
            .unwrap()
            .into_parts();
        assert_eq!(Rules::new(Scheme::Http, 80, []).check(&parts), Ok(()));
    }

    #[test]
    fn a_change_is_one_that_only_our_page_can_send() {
        let origin = ("origin", "http://localhost:8080");
        let json = ("content-type", "application/json");
        let ours = ("x-rvac", "1");
        let post = ("POST", "/api/clients/revoke");
        check(post, &[OURS, origin, json, ours], Ok(()));
        check(post, &[OURS, json, ours], Err(Refusal::OriginMissing));
        check(post, &[OURS, origin, json], Err(Refusal::NotOurs));
        check(post, &[OURS, origin, ours], Err(Refusal::NotOurs));
        let packed = ("content-encoding", "gzip");
        check(post, &[OURS, origin, json, ours, packed], Err(Refusal::NotOurs));
        check(
            post,
            &[OURS, origin, ours, ("content-type", "text/plain")],
            Err(Refusal::NotOurs),
        );
        let update = ("POST", "/api/update");
        let file = ("content-type", "application/octet-stream");
        check(update, &[OURS, origin, file, ours], Ok(()));
        check(update, &[OURS, origin, file], Err(Refusal::NotOurs));
        check(update, &[OURS, origin, json, ours], Err(Refusal::NotOurs));
        check(post, &[OURS, origin, file, ours], Err(Refusal::NotOurs));
        check(
            ("POST", "/"),
            &[OURS, origin, json, ours],
            Err(Refusal::Method(Ways::Read)),
        );
        check(
            ("DELETE", "/api/clients"),
            &[OURS, origin, json, ours],
            Err(Refusal::Method(Ways::Read)),
        );
    }

    #[test]
    fn over_tls_the_page_is_an_https_page() {
        let request = |origin: &str| {
            let request = Request::builder().uri("/api/ws").header("host", "robot.local");
            let (parts, ()) = request
                .header("upgrade", "websocket")
                .header("origin", origin)
                .body(())
                .unwrap()
                .into_parts();
            Rules::new(Scheme::Https, 443, ["robot.local".to_owned()]).check(&parts)
        };
        assert_eq!(request("https://robot.local"), Ok(()));
        assert_eq!(request("http://robot.local"), Err(Refusal::OriginForeign));
        assert_eq!(request("https://robot.local:8443"), Err(Refusal::OriginForeign));
    }
}
