//! `rvac-metrics`: the robot's figures, as Prometheus collects them.
#![forbid(unsafe_code)]

mod exposition;
mod figures;

use std::io::Write as _;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use anyhow::Context as _;
use axum::extract::State;
use axum::http::header::CONTENT_TYPE;
use axum::response::IntoResponse;
use axum::routing::get;
use bridge::service::ConfigurationError;
use bridge::{Daemon, News, service};
use clap::Parser;
use figures::Figures;
use rvac_api::{RequestBody, Topic, Update};
use tokio::net::TcpListener;
use tokio::time::{MissedTickBehavior, interval};

const TOPICS: [Topic; 5] = [
    Topic::Status,
    Topic::Device,
    Topic::Estimate,
    Topic::Runs,
    Topic::Standstills,
];
/// Pause between questions about wear.
const WEAR_EVERY: Duration = Duration::from_secs(15 * 60);

/// Serves the robot's figures to Prometheus.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Unix socket of vthal
    #[arg(long, value_name = "SOCKET", default_value = "/run/vthal/vthal.sock")]
    vthal: PathBuf,
    /// Address to listen on; figures tell whoever reads them when nobody is at home
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// Port to listen on; 0 takes any free one
    #[arg(long, default_value_t = 9779)]
    port: u16,
}

type Shared = Arc<Mutex<Figures>>;

fn main() -> ExitCode {
    service::start("rvac-metrics", run)
}

async fn run(arguments: Arguments) -> anyhow::Result<()> {
    let address = SocketAddr::new(arguments.bind, arguments.port);
    let listener = TcpListener::bind(address).await.map_err(|error| {
        ConfigurationError::Unfit(format!(
            "cannot listen on {address}: {error}; choose another --bind or --port"
        ))
    })?;
    writeln!(
        std::io::stdout(),
        "ready http://{}/metrics",
        listener.local_addr()?
    )?;
    service::tell_ready();
    let figures = Shared::default();
    let router = axum::Router::new()
        .route("/metrics", get(metrics))
        .with_state(Arc::clone(&figures));
    tokio::select! {
        () = follow(arguments.vthal, figures) => Ok(()),
        ended = axum::serve(listener, router) => ended.context("the server"),
    }
}

async fn metrics(State(figures): State<Shared>) -> impl IntoResponse {
    (
        [(CONTENT_TYPE, "text/plain; version=0.0.4; charset=utf-8")],
        lock(&figures).page(),
    )
}

/// Nobody holds it over a wait, and nothing that is done under it can panic half way.
fn lock(figures: &Shared) -> MutexGuard<'_, Figures> {
    figures.lock().unwrap_or_else(PoisonError::into_inner)
}

async fn follow(socket: PathBuf, figures: Shared) {
    let mut daemon = Daemon::new(socket, "rvac-metrics", &TOPICS);
    let mut wear = interval(WEAR_EVERY);
    wear.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        tokio::select! {
            news = daemon.next() => match news {
                News::Connected => {
                    lock(&figures).daemon(true);
                    wear.reset_immediately();
                    daemon.request(RequestBody::Statistics).await.ok();
                }
                News::Lost => lock(&figures).daemon(false),
                News::Update(update) => {
                    let is_new = {
                        let mut figures = lock(&figures);
                        figures.take(&update);
                        figures.known.wants_hello()
                    };
                    if is_new {
                        // A daemon that is away says it when it is there again.
                        daemon.hello().await.ok();
                    }
                    if matches!(*update, Update::RunKept(_)) {
                        daemon.request(RequestBody::Statistics).await.ok();
                    }
                }
            },
            _ = wear.tick() => {
                // Without a daemon there is nobody to ask; it is asked when it comes.
                daemon.request(RequestBody::Health).await.ok();
            }
        }
    }
}
