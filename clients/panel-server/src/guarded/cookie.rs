//! Tokens in the headers of requests: as a cookie of browsers, or as `Authorization: Bearer` of programs.

use axum::http::{HeaderMap, HeaderValue, header};
use pairing::Token;

/// Browsers keep a cookie of this name to themselves, to this host, and to HTTPS.
const NAME: &str = "__Host-rvac";

/// How long a browser keeps it, in seconds: the 400 days that browsers allow.
const AGE_S: u32 = 400 * 86_400;

/// The token, if there is exactly one.
pub(super) fn token_of(headers: &HeaderMap) -> Option<Token> {
    if headers.contains_key(header::AUTHORIZATION) {
        let mut values = headers.get_all(header::AUTHORIZATION).iter();
        let text = values.next()?.to_str().ok()?;
        return values
            .next()
            .is_none()
            .then(|| Token::parse(text.strip_prefix("Bearer ")?))?;
    }
    let cookies = headers
        .get_all(header::COOKIE)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(';'));
    let mut ours = cookies.filter_map(|cookie| cookie.trim().strip_prefix(NAME)?.strip_prefix('='));
    let token = Token::parse(ours.next()?)?;
    ours.next().is_none().then_some(token)
}

/// What gives a browser its token.
pub(crate) fn set_cookie(token: &Token) -> Option<HeaderValue> {
    let text = format!(
        "{NAME}={}; Secure; HttpOnly; SameSite=Strict; Path=/; Max-Age={AGE_S}",
        token.text()
    );
    let mut value = HeaderValue::from_str(&text).ok()?;
    value.set_sensitive(true);
    Some(value)
}

#[cfg(test)]
mod tests {
    use super::{set_cookie, token_of};
    use axum::http::HeaderMap;
    use pairing::Token;

    fn found(lines: &[(&'static str, String)]) -> bool {
        let mut headers = HeaderMap::new();
        for (name, value) in lines {
            headers.append(*name, value.parse().unwrap());
        }
        token_of(&headers).is_some()
    }

    #[test]
    fn one_token_and_no_second() {
        let token = Token::from_random(&[7; 40]).text();
        let cookie = ("cookie", format!("theme=dark; __Host-rvac={token}"));
        let bearer = ("authorization", format!("Bearer {token}"));
        assert!(found(std::slice::from_ref(&cookie)));
        assert!(found(std::slice::from_ref(&bearer)));
        assert!(!found(&[]));
        assert!(!found(&[cookie.clone(), cookie.clone()]));
        assert!(!found(&[bearer.clone(), bearer]));
        assert!(!found(&[cookie, ("authorization", "Basic eDp4".to_owned())]));
        assert!(!found(&[("cookie", format!("rvac={token}"))]));
    }

    #[test]
    fn what_browsers_are_given_they_show() {
        let token = Token::from_random(&[7; 40]);
        let line = set_cookie(&token).unwrap();
        let line = line.to_str().unwrap();
        for word in ["; Secure", "; HttpOnly", "; SameSite=Strict", "; Path=/"] {
            assert!(line.contains(word), "{line}");
        }
        assert!(!line.contains("Domain"));
        assert!(found(&[("cookie", line.split(';').next().unwrap().to_owned())]));
    }
}
