//! Listens, limits connections, and answers requests that pass the rules.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::extract::rejection::PathRejection;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Extension, Path, Request, State};
use axum::http::{HeaderName, HeaderValue, Response, StatusCode, Uri, header};
use axum::middleware::{self, Next};
use axum::response::IntoResponse;
use axum::routing::get;
use futures_util::future::OptionFuture;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use pairing::need_of;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpSocket, TcpStream, UnixListener};
use tokio::task::{JoinSet, yield_now};
use tokio::time::timeout;
use tokio_rustls::TlsAcceptor;
use tracing::{debug, error, warn};

use crate::announcement::announce;
use crate::api::{self, Peer};
use crate::browser::{self, Delivery, Guest};
use crate::buttons::watch_buttons;
use crate::download::{self, Wanted};
use crate::gate::Gate;
use crate::guarded::{Known, listen_console, serve_console};
use crate::pace::Pace;
use crate::page;
use crate::pass::Pass;
use crate::reset_file;
use crate::rules::in_authority;
use crate::seats::{Holder, Seat, Seats};
use crate::upstream::Upstream;
use crate::write_deadline::WriteDeadline;
use crate::{Assets, Guard, Rules, Scheme, Settings, StartError};

/// Bytes of a request's head, the least that hyper accepts.
const HEAD_BYTES_MAX: usize = 8 << 10;

/// A client that takes longer for the head of a request is dropped.
const HEAD_TIME_MAX: Duration = Duration::from_secs(10);
/// A peer that takes nothing of an answer for so long is gone.
const WRITE_TIME_MAX: Duration = Duration::from_secs(10);

/// Bytes that the system keeps of what one peer has not taken, doubled by Linux for its own book-keeping. Unbounded it is megabytes: so much
/// is encrypted in one go for each that asks for a large file and takes nothing, while everybody else waits. A tenth of a second at 5 Mbit/s.
const SEND_BYTES_MAX: u32 = 64 << 10;

/// Connections that wait to be accepted.
const BACKLOG: u32 = 1024;

/// Bytes of one WebSocket message from a browser.
const MESSAGE_BYTES_MAX: usize = 64 << 10;

const SECURITY_HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; style-src 'self'; img-src 'self' data:; \
         manifest-src 'self'; worker-src 'self'; \
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
    url: String,
    page: Option<TcpListener>,
    console: Option<UnixListener>,
    /// Whether the robot's name is announced.
    announce: bool,
    site: Arc<Site>,
}

#[derive(Debug)]
pub(crate) struct Site {
    rules: RwLock<Rules>,
    assets: Assets,
    vthal: PathBuf,
    simulator: Option<PathBuf>,
    matter: Option<PathBuf>,
    gate: Option<Arc<Gate>>,
}

impl Site {
    pub(crate) const fn gate(&self) -> Option<&Arc<Gate>> {
        self.gate.as_ref()
    }

    /// Where `rvac-matter` tells its code.
    pub(crate) fn matter(&self) -> Option<&std::path::Path> {
        self.matter.as_deref()
    }
}

impl Server {
    /// Reads the panel's files and begins to listen.
    ///
    /// # Errors
    /// See [`StartError`].
    pub async fn bind(settings: Settings) -> Result<Self, StartError> {
        settings.check_reach()?;
        let assets = Assets::read(&settings.assets)?;
        let (listener, address) = listen(settings.address)?;
        let mut server = Self {
            listener,
            address,
            url: format!("http://{address}/"),
            page: None,
            console: None,
            announce: false,
            site: Arc::new(Site {
                rules: RwLock::new(plain_rules(address, &settings.host_names)),
                assets,
                vthal: settings.vthal,
                simulator: settings.simulator,
                matter: settings.matter,
                gate: None,
            }),
        };
        if let Some(guard) = settings.guard {
            server.stand_behind(guard, settings.host_names).await?;
        }
        Ok(server)
    }

    /// Puts a gate before everything.
    async fn stand_behind(&mut self, guard: Guard, host_names: Vec<String>) -> Result<(), StartError> {
        let Some(site) = Arc::get_mut(&mut self.site) else {
            return Ok(());
        };
        let gate = Gate::new(&guard, host_names, self.address, site.vthal.clone())?;
        if let Some(wish) = guard.card.as_deref().and_then(reset_file::take) {
            gate.forget(wish)
                .await
                .map_err(|error| StartError::Forget(error.to_string()))?;
        }
        site.rules = RwLock::new(gate.rules());
        site.gate = Some(Arc::new(gate));
        self.url = format!("https://{}/", self.address);
        let path = guard.console.unwrap_or_else(|| guard.state.join("console.sock"));
        let console = listen_console(&path).map_err(|source| StartError::Console { path, source })?;
        self.console = Some(console);
        self.announce = guard.announce;
        if let Some(port) = guard.page_port {
            self.page = Some(listen(SocketAddr::new(self.address.ip(), port))?.0);
        }
        Ok(())
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where its page is.
    #[must_use]
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Address of the page that points to HTTPS.
    #[must_use]
    pub fn page_address(&self) -> Option<SocketAddr> {
        self.page.as_ref()?.local_addr().ok()
    }

    /// Answers connections for ever.
    pub async fn run(self) {
        let router = api::routes()
            .route("/api/ws", get(open_socket))
            .route("/api/runs/{number}/recording", get(download_run))
            .route(
                "/api/runs/{number}/recording/{recording}",
                get(download_recording),
            )
            .route("/api/floors/archive", get(download_floors))
            .fallback(serve_asset)
            .layer(middleware::from_fn_with_state(Arc::clone(&self.site), guard))
            .with_state(Arc::clone(&self.site));
        let seats = Seats::default();
        // Tasks like those of the connections, which have their turn as often: a part of this one would have it far more often, and those who
        // come in crowds would be taken in faster than anybody is served. They end with this.
        let mut entrances = JoinSet::new();
        let Some(gate) = self.site.gate.clone() else {
            entrances.spawn(accept(self.listener, None, router, seats));
            entrances.join_all().await;
            return;
        };
        let handshakes = match gate.acceptor() {
            Ok(acceptor) => Handshakes {
                acceptor,
                pace: Pace::default(),
            },
            Err(error) => {
                error!(%error, "no TLS");
                return;
            }
        };
        if let Some(listener) = self.page {
            let router = page::router(Arc::clone(&gate));
            entrances.spawn(accept(listener, None, router, seats.clone()));
        }
        entrances.spawn(accept(self.listener, Some(handshakes), router, seats));
        let console = self
            .console
            .map(|console| serve_console(console, Arc::clone(&gate)));
        tokio::join!(
            entrances.join_all(),
            gate.keep(&self.site.rules),
            gate.software.keep_looking(),
            watch_buttons(&gate),
            OptionFuture::from(console),
            OptionFuture::from(self.announce.then(|| announce(&gate, self.address.port()))),
        );
    }
}

fn listen(wanted: SocketAddr) -> Result<(TcpListener, SocketAddr), StartError> {
    let listener = bound(wanted).map_err(|source| listen_error(wanted, source))?;
    let address = listener
        .local_addr()
        .map_err(|source| listen_error(wanted, source))?;
    Ok((listener, address))
}

/// Connections inherit what is set here.
fn bound(wanted: SocketAddr) -> io::Result<TcpListener> {
    let socket = match wanted {
        SocketAddr::V4(_) => TcpSocket::new_v4()?,
        SocketAddr::V6(_) => TcpSocket::new_v6()?,
    };
    // A server that starts anew must not wait for connections of the one before.
    socket.set_reuseaddr(true)?;
    socket.set_send_buffer_size(SEND_BYTES_MAX)?;
    socket.bind(wanted)?;
    socket.listen(BACKLOG)
}

/// The rules for a server that only this computer reaches.
fn plain_rules(address: SocketAddr, host_names: &[String]) -> Rules {
    let own_ip = in_authority(address.ip());
    Rules::new(
        Scheme::Http,
        address.port(),
        host_names.iter().cloned().chain([own_ip]),
    )
}

/// What lets connections in by TLS.
#[derive(Clone)]
struct Handshakes {
    acceptor: TlsAcceptor,
    /// A signature and a key exchange take as long as tens of presses of Stop.
    pace: Pace,
}

/// Takes connections for ever, each with its seat.
async fn accept(listener: TcpListener, tls: Option<Handshakes>, router: Router, seats: Seats) {
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                let seat = match seats.take(peer.ip()) {
                    Ok(seat) => Arc::new(seat),
                    Err(reason) => {
                        debug!(%peer, ?reason, "no seat for a connection");
                        continue;
                    }
                };
                let router = router
                    .clone()
                    .layer(Extension(Peer(peer.ip())))
                    .layer(Extension(Arc::clone(&seat)));
                let tls = tls.clone();
                tokio::spawn(async move {
                    tokio::select! {
                        () = welcome(stream, tls, router) => {}
                        () = seat.parting() => debug!(%peer, "leaves for somebody else"),
                    }
                });
                // Whoever was taken in is served before the next one is.
                yield_now().await;
            }
            Err(error) => {
                warn!(%error, "cannot accept a connection");
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}

async fn welcome(stream: TcpStream, tls: Option<Handshakes>, router: Router) {
    stream.set_nodelay(true).ok(); // Only costs latency when it fails.
    let stream = WriteDeadline::new(stream, WRITE_TIME_MAX);
    let Some(tls) = tls else {
        return serve(stream, router).await;
    };
    match timeout(HEAD_TIME_MAX, tls.pace.at(tls.acceptor.accept(stream))).await {
        Ok(Ok(stream)) => serve(stream, router).await,
        Ok(Err(error)) => debug!(%error, "no TLS connection"),
        Err(_) => debug!("a TLS handshake took too long"),
    }
}

fn listen_error(address: SocketAddr, source: io::Error) -> StartError {
    if source.kind() == io::ErrorKind::AddrInUse {
        return StartError::PortInUse(address);
    }
    StartError::Listen { address, source }
}

async fn serve(stream: impl AsyncRead + AsyncWrite + Unpin + Send + 'static, router: Router) {
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

/// Lets requests through that keep the rules and that the gate permits, and adds the security headers to every answer.
async fn guard(State(site): State<Arc<Site>>, request: Request, next: Next) -> Response<Body> {
    let (parts, body) = request.into_parts();
    let checked = site
        .rules
        .read()
        .unwrap_or_else(PoisonError::into_inner)
        .check(&parts);
    let mut response = match checked {
        Ok(()) => admit(&site, Request::from_parts(parts, body), next).await,
        Err(refusal) => refusal.answer(),
    };
    for (name, value) in SECURITY_HEADERS {
        response
            .headers_mut()
            .insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Asks the gate, where there is one.
async fn admit(site: &Site, mut request: Request, next: Next) -> Response<Body> {
    let seat = request.extensions().get::<Arc<Seat>>().cloned();
    let belongs_to = |holder| seat.iter().for_each(|seat| seat.belongs_to(holder));
    let Some(gate) = &site.gate else {
        belongs_to(Holder::Local);
        return next.run(request).await;
    };
    let known = gate.guarded.identify(request.headers());
    if !need_of(request.uri().path()).is_met_by(known.map(|known| known.role)) {
        return known.map_or_else(api::not_paired, |known| api::not_allowed(known.role));
    }
    if let Some(known) = known {
        belongs_to(Holder::Device(known.id));
        request.extensions_mut().insert(known);
    }
    next.run(request).await
}

async fn serve_asset(State(site): State<Arc<Site>>, request: Request) -> Response<Body> {
    if let Some(gate) = &site.gate
        && let Some(file) = trust_file(gate, request.uri().path())
    {
        return file;
    }
    site.assets.answer(request.uri().path(), request.headers())
}

async fn download_run(
    State(site): State<Arc<Site>>,
    number: Result<Path<u64>, PathRejection>,
) -> Response<Body> {
    let Ok(Path(number)) = number else {
        return no_such_run();
    };
    let recording = None;
    download::answer(site.vthal.clone(), Wanted::Recording { number, recording }).await
}

async fn download_recording(
    State(site): State<Arc<Site>>,
    numbers: Result<Path<(u64, u32)>, PathRejection>,
) -> Response<Body> {
    let Ok(Path((number, recording))) = numbers else {
        return no_such_run();
    };
    let recording = Some(recording);
    download::answer(site.vthal.clone(), Wanted::Recording { number, recording }).await
}

/// What stands in the address can be the number of no run.
fn no_such_run() -> Response<Body> {
    let text = "The address of a recording has the number of a run in it.\n";
    (StatusCode::NOT_FOUND, text).into_response()
}

async fn download_floors(State(site): State<Arc<Site>>) -> Response<Body> {
    download::answer(site.vthal.clone(), Wanted::Floors).await
}

/// The robot's certificate for devices that shall trust it; it is public in each TLS connection.
fn trust_file(gate: &Gate, path: &str) -> Option<Response<Body>> {
    let trust = gate.trust();
    let (media_type, bytes) = match path {
        "/robot.crt" => ("application/x-x509-ca-cert", trust.der()?),
        "/robot.mobileconfig" => (
            "application/x-apple-aspen-config",
            trust.mobile_profile()?.into_bytes(),
        ),
        _ => return None,
    };
    Some(([(header::CONTENT_TYPE, media_type)], bytes).into_response())
}

async fn open_socket(
    State(site): State<Arc<Site>>,
    (known, Extension(seat)): (Option<Extension<Known>>, Extension<Arc<Seat>>),
    uri: Uri,
    upgrade: WebSocketUpgrade,
) -> Response<Body> {
    let delivery = match uri.query() {
        Some("live") => Delivery::Live,
        _ => Delivery::Whole,
    };
    let pass = match (&site.gate, known) {
        (None, _) => None,
        (Some(gate), Some(Extension(known))) => Some(Pass::new(Arc::clone(gate), known)),
        (Some(_), None) => return api::not_paired(),
    };
    let vthal = Upstream::new(site.vthal.clone());
    let simulator = site.simulator.clone().map(Upstream::new);
    upgrade
        .max_message_size(MESSAGE_BYTES_MAX)
        .max_frame_size(MESSAGE_BYTES_MAX)
        .on_upgrade(move |socket| browser::relay(socket, (vthal, simulator), Guest { pass, seat }, delivery))
}

#[cfg(test)]
mod tests {
    use std::net::{Ipv4Addr, SocketAddr};

    use axum::Router;
    use tokio::net::TcpStream;
    use tokio::task::yield_now;

    use super::{accept, listen};
    use crate::seats::Seats;

    const ANY_PORT: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

    #[tokio::test]
    async fn who_takes_nothing_is_sent_little() {
        let (listener, address) = listen(ANY_PORT).unwrap();
        let _stranger = TcpStream::connect(address).await.unwrap();
        let (stream, _) = listener.accept().await.unwrap();
        stream.writable().await.unwrap();
        let mut sent = 0;
        while let Ok(bytes) = stream.try_write(&[0; 16 << 10]) {
            sent += bytes;
        }
        assert!(
            (32 << 10..1 << 20).contains(&sent),
            "{sent} bytes were taken from the server at once"
        );
    }

    #[tokio::test]
    async fn of_a_crowd_one_is_taken_in_while_everybody_has_a_turn() {
        let (listener, address) = listen(ANY_PORT).unwrap();
        let crowd = || std::net::TcpStream::connect(address).unwrap();
        let _crowd: Vec<_> = std::iter::repeat_with(crowd).take(100).collect();
        let seats = Seats::default();
        let entrance = tokio::spawn(accept(listener, None, Router::new(), seats.clone()));
        for turns in 1..=20 {
            yield_now().await;
            assert!(seats.count() <= turns, "{} in {turns} turns", seats.count());
        }
        assert!(seats.count() > 5);
        entrance.abort();
    }
}
