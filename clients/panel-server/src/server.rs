//! Listens, limits connections, and answers requests that pass the rules.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Request, State};
use axum::http::{HeaderName, HeaderValue, Response, header};
use axum::middleware::{self, Next};
use axum::response::IntoResponse;
use axum::routing::get;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tracing::{debug, warn};

use crate::browser;
use crate::upstream::Upstream;
use crate::{Assets, Rules, Settings, StartError};

/// Connections at one time; a page needs two.
const CONNECTIONS_MAX: usize = 64;

/// Bytes of a request's head, the least that hyper accepts.
const HEAD_BYTES_MAX: usize = 8 << 10;

/// A client that takes longer for the head of a request is dropped.
const HEAD_TIME_MAX: Duration = Duration::from_secs(10);

/// Bytes of one WebSocket message from a browser.
const MESSAGE_BYTES_MAX: usize = 64 << 10;

const SECURITY_HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; style-src 'self'; img-src 'self' data:; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (header::REFERRER_POLICY, "no-referrer"),
    (
        HeaderName::from_static("cross-origin-opener-policy"),
        "same-origin",
    ),
    (
        HeaderName::from_static("cross-origin-resource-policy"),
        "same-origin",
    ),
];

/// A server that listens already.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    site: Arc<Site>,
}

#[derive(Debug)]
struct Site {
    rules: Rules,
    assets: Assets,
    vthal: PathBuf,
    simulator: Option<PathBuf>,
}

impl Server {
    /// Reads the panel's files and begins to listen.
    ///
    /// # Errors
    /// See [`StartError`].
    pub async fn bind(settings: Settings) -> Result<Self, StartError> {
        settings.check_reach()?;
        let assets = Assets::read(&settings.assets)?;
        let wanted = settings.address;
        let listener = TcpListener::bind(wanted)
            .await
            .map_err(|source| listen_error(wanted, source))?;
        let address = listener
            .local_addr()
            .map_err(|source| listen_error(wanted, source))?;
        let own_ip = authority_of(address);
        let names = settings
            .host_names
            .iter()
            .map(String::as_str)
            .chain([own_ip.as_str()]);
        let rules = Rules::new(address.port(), names);
        let site = Site {
            rules,
            assets,
            vthal: settings.vthal,
            simulator: settings.simulator,
        };
        Ok(Self {
            listener,
            address,
            site: Arc::new(site),
        })
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers connections for ever.
    pub async fn run(self) {
        let router = Router::new()
            .route("/api/ws", get(open_socket))
            .fallback(serve_asset)
            .layer(middleware::from_fn_with_state(Arc::clone(&self.site), guard))
            .with_state(self.site);
        let seats = Arc::new(Semaphore::new(CONNECTIONS_MAX));
        loop {
            let Ok(seat) = Arc::clone(&seats).acquire_owned().await else {
                return;
            };
            match self.listener.accept().await {
                Ok((stream, _)) => {
                    let router = router.clone();
                    tokio::spawn(async move {
                        serve(stream, router).await;
                        drop(seat);
                    });
                }
                Err(error) => {
                    warn!(%error, "cannot accept a connection");
                    tokio::time::sleep(Duration::from_millis(100)).await;
                }
            }
        }
    }
}

/// The address as a browser writes it in `Host`, without the port.
fn authority_of(address: SocketAddr) -> String {
    match address {
        SocketAddr::V4(address) => address.ip().to_string(),
        SocketAddr::V6(address) => format!("[{}]", address.ip()),
    }
}

fn listen_error(address: SocketAddr, source: io::Error) -> StartError {
    if source.kind() == io::ErrorKind::AddrInUse {
        return StartError::PortInUse(address);
    }
    StartError::Listen { address, source }
}

async fn serve(stream: TcpStream, router: Router) {
    stream.set_nodelay(true).ok(); // Only costs latency when it fails.
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIME_MAX)
        .max_buf_size(HEAD_BYTES_MAX)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router))
        .with_upgrades();
    if let Err(error) = connection.await {
        debug!(%error, "connection ended early");
    }
}

/// Lets through what keeps to the rules and adds the security headers to every answer.
async fn guard(State(site): State<Arc<Site>>, request: Request, next: Next) -> Response<Body> {
    let (parts, body) = request.into_parts();
    let mut response = match site.rules.check(&parts) {
        Ok(()) => next.run(Request::from_parts(parts, body)).await,
        Err(refusal) => (refusal.status(), refusal.text()).into_response(),
    };
    for (name, value) in SECURITY_HEADERS {
        response
            .headers_mut()
            .insert(name, HeaderValue::from_static(value));
    }
    response
}

async fn serve_asset(State(site): State<Arc<Site>>, request: Request) -> Response<Body> {
    site.assets.answer(request.uri().path(), request.headers())
}

async fn open_socket(State(site): State<Arc<Site>>, upgrade: WebSocketUpgrade) -> Response<Body> {
    let vthal = Upstream::new(site.vthal.clone());
    let simulator = site.simulator.clone().map(Upstream::new);
    upgrade
        .max_message_size(MESSAGE_BYTES_MAX)
        .max_frame_size(MESSAGE_BYTES_MAX)
        .on_upgrade(move |socket| browser::relay(socket, vthal, simulator))
}
