//! The server's own interface: who is asking, who is let in, and who was.

use std::net::IpAddr;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::extract::{Extension, Request, State};
use axum::http::{Response, StatusCode, header};
use axum::response::IntoResponse;
use axum::routing::{get, post};
use pairing::wire::{
    AskMatched, Begin, ClientRow, Finish, Join, Matched, OpenWindow, Refused, Revoke, Session, SetRole,
};
use pairing::{Refusal, Role, Token};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::gate::Gate;
use crate::guarded::{Known, NotDone, refused, set_cookie};
use crate::matter;
use crate::server::Site;
use crate::software::SoftwareDesk;
use crate::system;

/// Bytes of a request's body.
const BODY_BYTES_MAX: usize = 64 << 10;

/// A client that takes longer for a body is dropped.
const BODY_TIME_MAX: Duration = Duration::from_secs(10);

/// Where a request comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peer(pub(crate) IpAddr);

type Answer = Result<Response<Body>, Fault>;

/// Why a request is not done.
#[derive(Debug)]
enum Fault {
    /// On the robot's own computer no pairing is needed.
    NoGate,
    /// The body is none of ours.
    Body(String),
    NotDone(NotDone),
}

impl From<NotDone> for Fault {
    fn from(error: NotDone) -> Self {
        Self::NotDone(error)
    }
}

impl IntoResponse for Fault {
    fn into_response(self) -> Response<Body> {
        let (status, refused) = match self {
            Self::NoGate => (
                StatusCode::NOT_FOUND,
                refused_as(
                    "no-gate",
                    "This panel is only for the computer it runs on, where nobody needs to be let in; start panel-server with --state to pair devices.",
                ),
            ),
            Self::Body(why) => (
                StatusCode::BAD_REQUEST,
                refused_as(
                    "syntax",
                    &format!("The request could not be read: {why}. Reload the page."),
                ),
            ),
            Self::NotDone(error) => (status_of(&error), refused(&error)),
        };
        json(status, &refused)
    }
}

fn status_of(error: &NotDone) -> StatusCode {
    match error {
        NotDone::Refused(Refusal::NoClient) => StatusCode::NOT_FOUND,
        NotDone::Refused(Refusal::Malformed) => StatusCode::BAD_REQUEST,
        NotDone::Refused(Refusal::Waiting { .. }) => StatusCode::TOO_MANY_REQUESTS,
        NotDone::Refused(_) => StatusCode::FORBIDDEN,
        NotDone::Disk(_) | NotDone::Random(_) | NotDone::Identity(_) => StatusCode::INTERNAL_SERVER_ERROR,
    }
}

/// A refusal of the server's own.
pub(crate) fn refused_as(reason: &str, text: &str) -> Refused {
    Refused {
        reason: reason.to_owned(),
        text: text.to_owned(),
    }
}

/// An answer in JSON that is not cached.
pub(crate) fn json(status: StatusCode, body: &impl Serialize) -> Response<Body> {
    let text = serde_json::to_vec(body).unwrap_or_default();
    let headers = [
        (header::CONTENT_TYPE, "application/json"),
        (header::CACHE_CONTROL, "no-store"),
    ];
    (status, headers, text).into_response()
}

/// The addresses of this interface, without the WebSocket. `pairing::ROUTES` says who may use each.
pub(crate) fn routes() -> Router<Arc<Site>> {
    Router::new()
        .route("/api/openapi.json", get(description))
        .route("/api/session", get(session))
        .route("/api/system", get(system))
        .route("/api/matter", get(of_matter))
        .route("/api/pairing", get(invitation))
        .route("/api/pairing/begin", post(begin))
        .route("/api/pairing/finish", post(finish))
        .route("/api/pairing/match", post(join))
        .route("/api/pairing/matched", post(ask_matched))
        .route("/api/pairing/open", post(open))
        .route("/api/update", get(software).post(take_update))
        .route("/api/clients", get(clients))
        .route("/api/clients/revoke", post(revoke))
        .route("/api/clients/role", post(set_role))
}

/// What all of this is, for programs.
async fn description() -> Response<Body> {
    let headers = [
        (header::CONTENT_TYPE, "application/json"),
        (header::CACHE_CONTROL, "no-cache"),
    ];
    (headers, include_str!("../openapi.json")).into_response()
}

fn gate(site: &Site) -> Result<&Arc<Gate>, Fault> {
    site.gate().ok_or(Fault::NoGate)
}

async fn session(State(site): State<Arc<Site>>, known: Option<Extension<Known>>) -> Answer {
    let session = match (site.gate(), known) {
        (Some(gate), Some(Extension(known))) => Session {
            role: known.role,
            client: Some(known.id),
            nonce: Some(gate.guarded.nonce(known.id)?),
        },
        _ => Session {
            role: Role::Admin,
            client: None,
            nonce: None,
        },
    };
    Ok(json(StatusCode::OK, &session))
}

/// The computer that this runs on.
async fn system(State(site): State<Arc<Site>>) -> Response<Body> {
    let urls = site.gate().map(|gate| gate.addresses()).unwrap_or_default();
    json(StatusCode::OK, &system::report(Path::new("/"), urls))
}

/// The code for homes that speak Matter; nothing where `rvac-matter` does not run.
async fn of_matter(State(site): State<Arc<Site>>) -> Response<Body> {
    let told = match site.matter() {
        Some(socket) => matter::invitation(socket).await,
        None => None,
    };
    told.map_or_else(
        || StatusCode::NO_CONTENT.into_response(),
        |told| json(StatusCode::OK, &told),
    )
}

async fn invitation(State(site): State<Arc<Site>>) -> Answer {
    let invitation = gate(&site)?.guarded.invitation().await;
    Ok(json(StatusCode::OK, &invitation))
}

async fn begin(State(site): State<Arc<Site>>, request: Request) -> Answer {
    let gate = gate(&site)?;
    let begin: Begin = read(request).await?;
    Ok(json(StatusCode::OK, &gate.guarded.begin(begin).await?))
}

async fn finish(
    State(site): State<Arc<Site>>,
    Extension(Peer(ip)): Extension<Peer>,
    request: Request,
) -> Answer {
    let gate = gate(&site)?;
    let finish: Finish = read(request).await?;
    let (finished, token) = gate
        .guarded
        .finish(&finish, &ip.to_canonical().to_string())
        .await?;
    gate.beep();
    Ok(with_cookie(json(StatusCode::OK, &finished), &token))
}

async fn join(
    State(site): State<Arc<Site>>,
    Extension(Peer(ip)): Extension<Peer>,
    request: Request,
) -> Answer {
    let gate = gate(&site)?;
    let join: Join = read(request).await?;
    let joined = gate.guarded.join(join, &ip.to_canonical().to_string()).await?;
    Ok(json(StatusCode::OK, &joined))
}

async fn ask_matched(
    State(site): State<Arc<Site>>,
    Extension(Peer(ip)): Extension<Peer>,
    request: Request,
) -> Answer {
    let gate = gate(&site)?;
    let asked: AskMatched = read(request).await?;
    let from = ip.to_canonical().to_string();
    let Some((role, token)) = gate.guarded.ask_matched(&asked, &from).await? else {
        return Ok(json(StatusCode::OK, &Matched { role: None }));
    };
    gate.beep();
    let matched = Matched { role: Some(role) };
    Ok(with_cookie(json(StatusCode::OK, &matched), &token))
}

fn with_cookie(mut response: Response<Body>, token: &Token) -> Response<Body> {
    if let Some(cookie) = set_cookie(token) {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    response
}

async fn open(State(site): State<Arc<Site>>, request: Request) -> Answer {
    let gate = gate(&site)?;
    let wanted: OpenWindow = read(request).await?;
    Ok(json(StatusCode::OK, &gate.open(wanted).await?))
}

async fn clients(State(site): State<Arc<Site>>) -> Answer {
    let register = gate(&site)?.guarded.watch();
    let rows: Vec<ClientRow> = register.borrow().iter().map(Into::into).collect();
    Ok(json(StatusCode::OK, &rows))
}

async fn revoke(State(site): State<Arc<Site>>, request: Request) -> Answer {
    let gate = gate(&site)?;
    let Revoke { id } = read(request).await?;
    gate.guarded.revoke(id).await?;
    Ok(StatusCode::NO_CONTENT.into_response())
}

async fn set_role(State(site): State<Arc<Site>>, request: Request) -> Answer {
    let gate = gate(&site)?;
    let SetRole { id, role } = read(request).await?;
    gate.guarded.set_role(id, role).await?;
    Ok(StatusCode::NO_CONTENT.into_response())
}

/// The last update, or the one that goes on; nothing if there was none.
async fn software(State(site): State<Arc<Site>>) -> Answer {
    let told = gate(&site)?.software.watch().borrow().clone();
    Ok(match told {
        Some(told) => json(StatusCode::OK, &told),
        None => StatusCode::NO_CONTENT.into_response(),
    })
}

async fn take_update(State(site): State<Arc<Site>>, request: Request) -> Answer {
    let desk = &gate(&site)?.software;
    let (parts, body) = request.into_parts();
    let taken = SoftwareDesk::take(desk, &parts.headers, body).await;
    Ok(taken.unwrap_or_else(|refused| refused.answer()))
}

/// The body of a request, whose kind the rules have checked.
async fn read<T: DeserializeOwned>(request: Request) -> Result<T, Fault> {
    let body = tokio::time::timeout(BODY_TIME_MAX, to_bytes(request.into_body(), BODY_BYTES_MAX));
    let bytes = match body.await {
        Ok(Ok(bytes)) => bytes,
        Ok(Err(error)) => return Err(Fault::Body(error.to_string())),
        Err(_) => return Err(Fault::Body("it did not come in time".to_owned())),
    };
    serde_json::from_slice(&bytes).map_err(|error| Fault::Body(error.to_string()))
}

/// Nobody known asks for something that is not for everybody.
pub(crate) fn not_paired() -> Response<Body> {
    let text = "This device is not paired with the robot: open the panel on it and follow what it says.";
    json(StatusCode::UNAUTHORIZED, &refused_as("not-paired", text))
}

/// Somebody known asks for what is not theirs.
pub(crate) fn not_allowed(role: Role) -> Response<Body> {
    let text = format!(
        "This device may only {}: an administrator can change that.",
        may(role)
    );
    json(StatusCode::FORBIDDEN, &refused_as("not-allowed", &text))
}

/// What a role may, in words.
pub(crate) const fn may(role: Role) -> &'static str {
    match role {
        Role::View => "look and stop the robot",
        Role::Drive => "drive the robot, not change its settings",
        Role::Admin => "do everything",
    }
}
