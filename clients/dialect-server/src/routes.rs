//! The addresses.

use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, to_bytes};
use axum::extract::rejection::PathRejection;
use axum::extract::{Extension, Path, Request, State};
use axum::http::{HeaderName, HeaderValue, Response, header};
use axum::middleware::{self, Next};
use axum::response::IntoResponse;
use axum::routing::get;
use axum::{Json, Router};
use serde_json::Value;
use tokio::time::timeout;

use crate::answer::Refusal;
use crate::capabilities::{self, Capability};
use crate::connections::Peer;
use crate::reads;
use crate::site::{Site, Text};
use crate::streams::{self, Pushed};

/// Bytes of a command, and the time in which it comes.
const BODY_BYTES_MAX: usize = 64 << 10;
const BODY_TIME_MAX: Duration = Duration::from_secs(5);

const HEADERS: [(HeaderName, &str); 3] = [
    (header::CACHE_CONTROL, "no-store"),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; frame-ancestors 'none'",
    ),
];

type Shared = State<Arc<Site>>;

/// All of them, behind the checks of who asks.
pub(crate) fn router(site: Arc<Site>) -> Router {
    let capability = get(read_main).put(command_main);
    let part = get(read_part).put(command_part);
    let robot = Router::new()
        .route("/", get(robot))
        .route("/properties", get(properties))
        .route("/state", get(state))
        .route("/state/attributes", get(attributes))
        .route("/state/map", get(map))
        .route("/state/sse", get(follow_state))
        .route("/state/attributes/sse", get(follow_attributes))
        .route("/state/map/sse", get(follow_map))
        .route("/capabilities", get(capability_names))
        .route("/capabilities/{name}", capability)
        .route("/capabilities/{name}/{*rest}", part);
    Router::new()
        .nest("/api/v2/robot", robot)
        .route("/api/v2/valetudo", get(server))
        .route("/api/v2/valetudo/version", get(version))
        .fallback(nowhere)
        .method_not_allowed_fallback(wrong_method)
        .layer(middleware::from_fn_with_state(Arc::clone(&site), guard))
        .with_state(site)
}

/// Lets in who may be here, and says with every answer that it is nobody's page.
async fn guard(
    State(site): Shared,
    Extension(Peer(peer)): Extension<Peer>,
    request: Request,
    next: Next,
) -> Response<Body> {
    let (parts, body) = request.into_parts();
    let mut answer = match site.access.check(&parts, peer, site.now()) {
        Ok(()) => next.run(Request::from_parts(parts, body)).await,
        Err(denial) => denial.into_response(),
    };
    for (name, value) in HEADERS {
        answer.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    answer
}

async fn nowhere() -> Refusal {
    Refusal::NotFound
}

async fn wrong_method() -> Refusal {
    Refusal::Method("GET, HEAD")
}

async fn robot(State(site): Shared) -> Json<Value> {
    Json(reads::robot(&site.store()))
}

async fn properties(State(site): Shared) -> Json<Value> {
    Json(reads::properties(&site.store()))
}

async fn server(State(site): Shared) -> Json<Value> {
    Json(reads::server(&site.id))
}

async fn version() -> Json<Value> {
    Json(reads::version())
}

fn text(json: String) -> Response<Body> {
    ([(header::CONTENT_TYPE, "application/json")], json).into_response()
}

fn said(text: &Text) -> String {
    text.as_ref().to_owned()
}

async fn state(State(site): Shared) -> Response<Body> {
    let (attributes, map) = (site.attributes(), site.map());
    let state = reads::state_text(&attributes.borrow(), &map.borrow());
    text(state)
}

async fn attributes(State(site): Shared) -> Response<Body> {
    text(said(&site.attributes().borrow()))
}

async fn map(State(site): Shared) -> Response<Body> {
    text(said(&site.map().borrow()))
}

async fn follow_state(State(site): Shared) -> impl IntoResponse {
    streams::follow(&site, Pushed::State)
}

async fn follow_attributes(State(site): Shared) -> impl IntoResponse {
    streams::follow(&site, Pushed::Attributes)
}

async fn follow_map(State(site): Shared) -> impl IntoResponse {
    streams::follow(&site, Pushed::Map)
}

async fn capability_names(State(site): Shared) -> Json<Vec<&'static str>> {
    Json(Capability::names(&site.store()))
}

/// What a path says; one that cannot be read is nowhere.
type Named<T> = Result<Path<T>, PathRejection>;

fn find(site: &Site, name: &str) -> Result<Capability, Refusal> {
    Capability::named(name, &site.store()).ok_or(Refusal::NotFound)
}

async fn read_main(State(site): Shared, path: Named<String>) -> Result<Json<Value>, Refusal> {
    let Path(name) = path.map_err(|_| Refusal::NotFound)?;
    capabilities::read(&site, find(&site, &name)?, "").await.map(Json)
}

async fn read_part(State(site): Shared, path: Named<(String, String)>) -> Result<Json<Value>, Refusal> {
    let Path((name, rest)) = path.map_err(|_| Refusal::NotFound)?;
    capabilities::read(&site, find(&site, &name)?, &rest)
        .await
        .map(Json)
}

async fn command_main(
    State(site): Shared,
    peer: Extension<Peer>,
    path: Named<String>,
    request: Request,
) -> Result<&'static str, Refusal> {
    let Path(name) = path.map_err(|_| Refusal::NotFound)?;
    command(&site, peer, (&name, ""), request).await
}

async fn command_part(
    State(site): Shared,
    peer: Extension<Peer>,
    path: Named<(String, String)>,
    request: Request,
) -> Result<&'static str, Refusal> {
    let Path((name, rest)) = path.map_err(|_| Refusal::NotFound)?;
    command(&site, peer, (&name, &rest), request).await
}

async fn command(
    site: &Site,
    Extension(Peer(peer)): Extension<Peer>,
    (name, rest): (&str, &str),
    request: Request,
) -> Result<&'static str, Refusal> {
    let capability = find(site, name)?;
    let unreadable = |why: String| Refusal::Unreadable(why);
    let body = timeout(BODY_TIME_MAX, to_bytes(request.into_body(), BODY_BYTES_MAX));
    let body = body
        .await
        .map_err(|_| unreadable("it did not come in time".to_owned()))?
        .map_err(|error| unreadable(error.to_string()))?;
    let body: Value = serde_json::from_slice(&body).map_err(|error| unreadable(error.to_string()))?;
    capabilities::command(site, (capability, rest), &body, peer).await?;
    Ok("OK")
}
