//! What a client is answered when something is not done.

use axum::body::Body;
use axum::http::{HeaderValue, Response, StatusCode, header};
use axum::response::IntoResponse;
use dialect::BodyError;
use rvac_api::Failure;

/// Why a request is not done.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Refusal {
    /// There is no such address.
    NotFound,
    /// The address is not asked so.
    Method(&'static str),
    /// The body cannot be read.
    Unreadable(String),
    /// The body says what cannot be.
    Body(BodyError),
    /// `action`, or another word, is none of these.
    Word {
        field: &'static str,
        known: &'static str,
    },
    /// The daemon refuses.
    Daemon(Failure),
    /// The daemon is away.
    Away,
    /// The daemon has not answered.
    Late,
    /// So many questions wait that no more are taken.
    Busy,
    /// Commands come faster than people say them.
    TooFast,
    /// Nobody has switched manual control on.
    NotEnabled,
    /// Another client drives.
    DriverBusy,
    /// A stream of moves did not begin from rest.
    NotFromRest,
}

impl From<BodyError> for Refusal {
    fn from(error: BodyError) -> Self {
        Self::Body(error)
    }
}

impl Refusal {
    pub(crate) fn status(&self) -> StatusCode {
        match self {
            Self::NotFound => StatusCode::NOT_FOUND,
            Self::Method(_) => StatusCode::METHOD_NOT_ALLOWED,
            Self::Unreadable(_) | Self::Body(_) | Self::Word { .. } => StatusCode::BAD_REQUEST,
            Self::Daemon(failure) => status_of(&failure.reason),
            Self::Away | Self::Busy => StatusCode::SERVICE_UNAVAILABLE,
            Self::Late => StatusCode::GATEWAY_TIMEOUT,
            Self::TooFast => StatusCode::TOO_MANY_REQUESTS,
            Self::NotEnabled | Self::DriverBusy | Self::NotFromRest => StatusCode::CONFLICT,
        }
    }

    fn text(&self) -> String {
        match self {
            Self::NotFound => "There is no such address.".to_owned(),
            Self::Method(allowed) => format!("This address takes only {allowed}."),
            Self::Unreadable(why) => format!("The body is no JSON that can be read: {why}."),
            Self::Body(error) => format!("The body is no command: {error}."),
            Self::Word { field, known } => format!("{field} must be one of: {known}."),
            Self::Daemon(failure) => format!("{} ({})", failure.text, failure.reason),
            Self::Away => "The robot's daemon is away. (no-daemon)".to_owned(),
            Self::Late => "The robot's daemon does not answer.".to_owned(),
            Self::Busy => "Too many requests wait for the robot's daemon.".to_owned(),
            Self::TooFast => "Commands come too fast. (busy)".to_owned(),
            Self::NotEnabled => "Manual control is off: send the action enable first.".to_owned(),
            Self::DriverBusy => "Another client drives. (driver-busy)".to_owned(),
            Self::NotFromRest => {
                "These moves go on since before driving began or was refused: send none for a second, or one at rest. (centre-first)"
                    .to_owned()
            }
        }
    }
}

/// By the daemon's named reason.
fn status_of(reason: &str) -> StatusCode {
    let is_in_body = ["bad-", "no-such-", "unknown-", "too-many-", "line-"]
        .iter()
        .any(|beginning| reason.starts_with(beginning));
    match reason {
        "range" | "syntax" | "name-taken" | "part-too-small" | "rooms-apart" | "no-floor-there" => {
            StatusCode::BAD_REQUEST
        }
        _ if is_in_body && reason != "unknown-inhibit" && !reason.starts_with("line-has") => {
            StatusCode::BAD_REQUEST
        }
        "no-robot" | "link-lost" | "no-daemon" => StatusCode::SERVICE_UNAVAILABLE,
        _ => StatusCode::CONFLICT,
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response<Body> {
        let mut answer = (self.status(), format!("{}\n", self.text())).into_response();
        if let Self::Method(allowed) = self {
            let allowed = HeaderValue::from_static(allowed);
            answer.headers_mut().insert(header::ALLOW, allowed);
        }
        answer
    }
}

#[cfg(test)]
mod tests {
    use axum::http::StatusCode;

    use super::status_of;

    #[test]
    fn a_refusal_says_whose_fault_it_is() {
        for reason in [
            "no-such-room",
            "range",
            "bad-zone",
            "line-misses-room",
            "name-taken",
        ] {
            assert_eq!(status_of(reason), StatusCode::BAD_REQUEST, "{reason}");
        }
        for reason in [
            "job-runs",
            "inhibited",
            "wheel-drop",
            "centre-first",
            "of-tomorrow",
        ] {
            assert_eq!(status_of(reason), StatusCode::CONFLICT, "{reason}");
        }
        assert_eq!(status_of("no-robot"), StatusCode::SERVICE_UNAVAILABLE);
    }
}
