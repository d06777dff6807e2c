//! Who is let in: by the name that the client calls this computer, the page that it belongs to, and the password.
//!
//! A page of another site can make the browser of somebody at home send requests here. The browser tells its origin in headers that the
//! page cannot forge, and a page whose name was pointed to this address betrays itself by its name in `Host`.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use axum::body::Body;
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, Response, StatusCode, header};
use axum::response::IntoResponse;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use bridge::Limiter;

use crate::configuration::Configuration;

const SEC_FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
/// Wrong passwords of one address at once, and the pause that allows one more.
const GUESSES_MAX: u32 = 10;
const GUESS_EVERY: Duration = Duration::from_secs(6);
/// Addresses whose guesses are remembered.
const GUESSERS_MAX: usize = 256;

/// Why a client is not let in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Denial {
    /// No name in `Host`, or several.
    HostUnclear,
    /// It is a name that is not ours.
    HostForeign,
    /// A page of another site asks.
    CrossSite,
    /// A command that a form could have sent.
    NotJson,
    /// No password, or a wrong one.
    Password,
    /// Too many wrong ones from this address.
    Guesses,
    /// The owner has not allowed commands.
    ReadOnly,
}

impl IntoResponse for Denial {
    fn into_response(self) -> Response<Body> {
        let (status, text) = match self {
            Self::HostUnclear => (StatusCode::BAD_REQUEST, "The request does not name one host."),
            Self::HostForeign => (
                StatusCode::MISDIRECTED_REQUEST,
                "This computer does not go by that name: use its address, or add the name to hosts in /etc/rvac-dialect.toml.",
            ),
            Self::CrossSite => (StatusCode::FORBIDDEN, "A page of another site asks."),
            Self::NotJson => (
                StatusCode::UNSUPPORTED_MEDIA_TYPE,
                "A command is sent as application/json.",
            ),
            Self::Password => (StatusCode::UNAUTHORIZED, "User and password are wanted."),
            Self::Guesses => (
                StatusCode::TOO_MANY_REQUESTS,
                "Too many wrong passwords came from this address: wait a minute.",
            ),
            Self::ReadOnly => (
                StatusCode::FORBIDDEN,
                "The robot takes no commands here: set a password in /etc/rvac-dialect.toml, or commands = true.",
            ),
        };
        let mut answer = (status, format!("{text}\n")).into_response();
        if self == Self::Password {
            let realm = HeaderValue::from_static("Basic realm=\"LibreRVAC\"");
            answer.headers_mut().insert(header::WWW_AUTHENTICATE, realm);
        }
        answer
    }
}

/// Who is let in.
#[derive(Debug)]
pub(crate) struct Access {
    hosts: Vec<String>,
    /// `user:password`.
    login: Option<String>,
    takes_commands: bool,
    guessers: Mutex<BTreeMap<IpAddr, Limiter>>,
}

impl Access {
    pub(crate) fn new(configuration: &Configuration) -> Self {
        let lower = |name: &String| name.to_ascii_lowercase();
        let password = configuration.password.as_ref();
        Self {
            hosts: configuration.hosts.iter().map(lower).collect(),
            login: password.map(|password| format!("{}:{password}", configuration.user)),
            takes_commands: configuration.takes_commands(),
            guessers: Mutex::default(),
        }
    }

    /// Looks at the head of a request from `peer`.
    ///
    /// # Errors
    /// [`Denial`].
    pub(crate) fn check(&self, parts: &Parts, peer: IpAddr, now: Duration) -> Result<(), Denial> {
        let host = self.host(&parts.headers)?;
        if comes_from_another_site(&parts.headers, host) {
            return Err(Denial::CrossSite);
        }
        self.check_password(&parts.headers, peer, now)?;
        let is_read = matches!(parts.method, Method::GET | Method::HEAD);
        if !is_read && !is_json(&parts.headers) {
            return Err(Denial::NotJson);
        }
        if !is_read && !self.takes_commands {
            return Err(Denial::ReadOnly);
        }
        Ok(())
    }

    fn host<'a>(&self, headers: &'a HeaderMap) -> Result<&'a str, Denial> {
        let mut hosts = headers.get_all(header::HOST).iter();
        let (Some(host), None) = (hosts.next(), hosts.next()) else {
            return Err(Denial::HostUnclear);
        };
        let host = host.to_str().map_err(|_| Denial::HostUnclear)?;
        let name = name_of(host).ok_or(Denial::HostUnclear)?;
        let is_ours = name.parse::<IpAddr>().is_ok()
            || name.eq_ignore_ascii_case("localhost")
            || self.hosts.iter().any(|own| name.eq_ignore_ascii_case(own));
        is_ours.then_some(host).ok_or(Denial::HostForeign)
    }

    fn check_password(&self, headers: &HeaderMap, peer: IpAddr, now: Duration) -> Result<(), Denial> {
        let Some(login) = &self.login else {
            return Ok(());
        };
        // A browser asks once without; that is no guess.
        let Some(given) = headers.get(header::AUTHORIZATION) else {
            return Err(Denial::Password);
        };
        let mut guessers = self.guessers.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(guesses) = guessers.get_mut(&peer)
            && !guesses.has_room(now)
        {
            return Err(Denial::Guesses);
        }
        if given_login(given).is_some_and(|given| is_same(&given, login.as_bytes())) {
            guessers.remove(&peer);
            return Ok(());
        }
        if guessers.len() >= GUESSERS_MAX && !guessers.contains_key(&peer) {
            guessers.pop_first();
        }
        guessers
            .entry(peer)
            .or_insert_with(|| Limiter::new(GUESSES_MAX, GUESS_EVERY))
            .allows(now);
        Err(Denial::Password)
    }
}

/// The name or address in `Host`, without the port.
fn name_of(host: &str) -> Option<&str> {
    match host.strip_prefix('[') {
        Some(address) => address.split_once(']').map(|(address, _)| address),
        None => host.split(':').next().filter(|name| !name.is_empty()),
    }
}

fn comes_from_another_site(headers: &HeaderMap, host: &str) -> bool {
    let site = headers.get(SEC_FETCH_SITE);
    let is_foreign_site = site.is_some_and(|site| site != "same-origin" && site != "none");
    let mut origins = headers.get_all(header::ORIGIN).iter();
    let is_foreign_origin = origins.any(|origin| {
        let page = origin.to_str().ok();
        let authority = page.and_then(|page| page.strip_prefix("http://").or(page.strip_prefix("https://")));
        !authority.is_some_and(|authority| authority.eq_ignore_ascii_case(host))
    });
    is_foreign_site || is_foreign_origin
}

fn is_json(headers: &HeaderMap) -> bool {
    let medium = headers
        .get(header::CONTENT_TYPE)
        .and_then(|value| value.to_str().ok());
    let medium = medium.and_then(|value| value.split(';').next());
    medium.is_some_and(|medium| medium.trim().eq_ignore_ascii_case("application/json"))
}

/// What `Authorization: Basic` carries.
fn given_login(value: &HeaderValue) -> Option<Vec<u8>> {
    let (scheme, coded) = value.to_str().ok()?.split_once(' ')?;
    if !scheme.eq_ignore_ascii_case("basic") {
        return None;
    }
    STANDARD.decode(coded.trim()).ok()
}

/// Takes as long for every wrong login, so that nobody measures how much of it is right.
fn is_same(given: &[u8], login: &[u8]) -> bool {
    let differs = given
        .iter()
        .zip(login.iter().cycle())
        .fold(0, |differs, (given, right)| differs | (given ^ right));
    given.len() == login.len() && differs == 0
}

#[cfg(test)]
mod tests {
    use std::net::{IpAddr, Ipv4Addr};
    use std::time::Duration;

    use axum::http::Request;
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;

    use super::{Access, Denial, GUESSERS_MAX, GUESSES_MAX};

    const PEER: IpAddr = IpAddr::V4(Ipv4Addr::new(10, 0, 0, 9));

    fn access(more: &str) -> Access {
        let text = format!(r#"{{"hosts": ["robo.local"]{more}}}"#);
        Access::new(&serde_json::from_str(&text).expect("a configuration"))
    }

    fn check(access: &Access, method: &str, headers: &[(&str, &str)]) -> Result<(), Denial> {
        let mut request = Request::builder().method(method).uri("/api/v2/robot");
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        let (parts, ()) = request.body(()).expect("a request").into_parts();
        access.check(&parts, PEER, Duration::from_secs(1))
    }

    #[test]
    fn a_page_that_borrows_a_browser_is_kept_out() {
        let access = access(r#", "commands": true"#);
        let get = |headers: &[(&str, &str)]| check(&access, "GET", headers);
        for host in [
            "127.0.0.1:9781",
            "[::1]:9781",
            "localhost",
            "Robo.Local:80",
            "192.168.1.7",
        ] {
            assert_eq!(get(&[("host", host)]), Ok(()), "{host}");
        }
        for host in [
            "evil.example",
            "robo.local.evil.example",
            "127.0.0.1.evil.example",
        ] {
            assert_eq!(get(&[("host", host)]), Err(Denial::HostForeign), "{host}");
        }
        assert_eq!(get(&[]), Err(Denial::HostUnclear));
        assert_eq!(get(&[("host", "a"), ("host", "b")]), Err(Denial::HostUnclear));
        let own = ("host", "127.0.0.1:9781");
        for foreign in [
            ("origin", "http://evil.example"),
            ("origin", "null"),
            ("origin", "http://127.0.0.1:80"),
            ("sec-fetch-site", "cross-site"),
            ("sec-fetch-site", "same-site"),
        ] {
            assert_eq!(get(&[own, foreign]), Err(Denial::CrossSite), "{foreign:?}");
        }
        assert_eq!(
            get(&[
                own,
                ("origin", "http://127.0.0.1:9781"),
                ("sec-fetch-site", "same-origin")
            ]),
            Ok(())
        );
        let put = |medium: &str| check(&access, "PUT", &[own, ("content-type", medium)]);
        assert_eq!(put("text/plain"), Err(Denial::NotJson));
        assert_eq!(put("application/json; charset=utf-8"), Ok(()));
    }

    #[test]
    fn the_right_password_comes_in_and_guesses_end() {
        let access = access(r#", "password": "long enough""#);
        let with = |text: &str, now_s: u64| {
            let coded = format!("Basic {}", STANDARD.encode(text));
            let request = Request::builder()
                .header("host", "localhost")
                .header("authorization", coded);
            let (parts, ()) = request.body(()).expect("a request").into_parts();
            access.check(&parts, PEER, Duration::from_secs(now_s))
        };
        assert_eq!(
            check(&access, "GET", &[("host", "localhost")]),
            Err(Denial::Password)
        );
        assert_eq!(with("robo:long enough", 100), Ok(()));
        for guess in ["", "robo", "robo:", "robo:long enough2", "robo:long enougH", "x"] {
            assert_eq!(with(guess, 100), Err(Denial::Password), "{guess}");
        }
        for _ in 6..GUESSES_MAX {
            assert_eq!(with("robo:guess", 100), Err(Denial::Password));
        }
        assert_eq!(with("robo:long enough", 100), Err(Denial::Guesses));
        assert_eq!(with("robo:long enough", 107), Ok(()), "it is let in again");
    }

    #[test]
    fn guesses_from_everywhere_fill_no_memory_and_nobody_commands_without_a_word_of_the_owner() {
        let guarded = access(r#", "password": "long enough""#);
        let request = Request::builder()
            .header("host", "localhost")
            .header("authorization", "Basic eA==");
        let (parts, ()) = request.body(()).expect("a request").into_parts();
        for number in 0..2_000 {
            let peer = IpAddr::V4(Ipv4Addr::from_bits(number));
            guarded.check(&parts, peer, Duration::from_secs(1)).ok();
        }
        assert!(guarded.guessers.lock().unwrap().len() <= GUESSERS_MAX);
        let open = access("");
        let json = [("host", "localhost"), ("content-type", "application/json")];
        assert_eq!(check(&open, "GET", &json), Ok(()));
        assert_eq!(check(&open, "PUT", &json), Err(Denial::ReadOnly));
    }
}
