//! The page at the plain HTTP port: it points to the HTTPS address and does nothing else.

use std::sync::Arc;

use axum::Router;
use axum::extract::State;
use axum::http::{HeaderName, HeaderValue, header};
use axum::response::{Html, IntoResponse, Response};

use crate::gate::Gate;

/// Answers every request with the HTTPS address of the robot.
pub(crate) fn router(gate: Arc<Gate>) -> Router {
    Router::new().fallback(point_to_https).with_state(gate)
}

async fn point_to_https(State(gate): State<Arc<Gate>>) -> Response {
    let links: String = gate
        .addresses()
        .iter()
        .map(|address| format!("<li><a href=\"{address}\">{address}</a></li>\n"))
        .collect();
    let page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>LibreRVAC</title>\n<h1>This robot is spoken to over HTTPS</h1>\n<p>Its panel is at:</p>\n<ul>\n{links}</ul>\n\
         <p>The robot vouches for itself, so your browser will warn you once. To be sure that it is your robot, run \
         <code>rvac trust</code> on it and compare the fingerprint, or install its certificate as the book tells.</p>\n</html>\n"
    );
    let headers: [(HeaderName, HeaderValue); 3] = [
        (
            header::CONTENT_SECURITY_POLICY,
            HeaderValue::from_static(
                "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
            ),
        ),
        (
            header::X_CONTENT_TYPE_OPTIONS,
            HeaderValue::from_static("nosniff"),
        ),
        (header::CACHE_CONTROL, HeaderValue::from_static("no-store")),
    ];
    (headers, Html(page)).into_response()
}
