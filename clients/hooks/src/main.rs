//! `rvac-hooks`: notifications of what happens to the robot, and a calendar of its runs.
#![forbid(unsafe_code)]

mod calendar;
mod configuration;
mod delivery;
mod watcher;

use std::io::Write as _;
use std::net::SocketAddr;
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
use bridge::{Daemon, News, picture, service};
use clap::Parser;
use configuration::Configuration;
use delivery::{Letter, Recipient};
use rvac_api::{RequestBody, Run, Schedules, Topic, Update};
use tokio::net::TcpListener;
use tokio::time::{Instant, MissedTickBehavior, interval};
use watcher::{Notice, Watcher};

const TOPICS: [Topic; 6] = [
    Topic::Status,
    Topic::Device,
    Topic::Map,
    Topic::Home,
    Topic::Schedules,
    Topic::Runs,
];
/// Past runs in the calendar.
const RUNS_MAX: u8 = 50;

/// Tells people what happens to the robot, and serves its calendar.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Configuration
    #[arg(long, value_name = "FILE", default_value = "/etc/rvac-hooks.toml")]
    config: PathBuf,
}

/// What the calendar shows.
#[derive(Debug, Default)]
struct Diary {
    name: String,
    runs: Vec<Run>,
    schedules: Option<Schedules>,
}

type Shared = Arc<Mutex<Diary>>;

fn main() -> ExitCode {
    service::start("rvac-hooks", |arguments: Arguments| async move {
        run(service::read(&arguments.config)?).await
    })
}

async fn run(configuration: Configuration) -> anyhow::Result<()> {
    configuration.check()?;
    let diary = Shared::default();
    lock(&diary).name.clone_from(&configuration.name);
    let served = match &configuration.calendar {
        None => None,
        Some(place) => {
            let address = SocketAddr::new(place.bind, place.port);
            let listener = TcpListener::bind(address)
                .await
                .map_err(|error| ConfigurationError::Unfit(format!("cannot listen on {address}: {error}")))?;
            Some(listener)
        }
    };
    let address = served.as_ref().map(TcpListener::local_addr).transpose()?;
    let told = address.map_or_else(String::new, |address| format!(" http://{address}/runs.ics"));
    writeln!(std::io::stdout(), "ready{told}")?;
    service::tell_ready();
    let follower = follow(configuration, Arc::clone(&diary));
    match served {
        None => follower.await,
        Some(listener) => {
            let router = axum::Router::new()
                .route("/runs.ics", get(calendar_file))
                .with_state(diary);
            tokio::select! {
                () = follower => {}
                ended = axum::serve(listener, router) => ended.context("the calendar")?,
            }
        }
    }
    Ok(())
}

async fn calendar_file(State(diary): State<Shared>) -> impl IntoResponse {
    let diary = lock(&diary);
    let text = calendar::calendar(&diary.name, &diary.runs, diary.schedules.as_ref());
    ([(CONTENT_TYPE, "text/calendar; charset=utf-8")], text)
}

/// Nobody holds it over a wait, and nothing that is done under it can panic half way.
fn lock(diary: &Shared) -> MutexGuard<'_, Diary> {
    diary.lock().unwrap_or_else(PoisonError::into_inner)
}

async fn follow(configuration: Configuration, diary: Shared) {
    let begun = Instant::now();
    let recipients: Vec<Recipient> = configuration.target.into_iter().map(Recipient::new).collect();
    let mut daemon = Daemon::new(configuration.vthal, "rvac-hooks", &TOPICS);
    let mut watcher = Watcher::default();
    let mut ticks = interval(Duration::from_secs(1));
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let runs = RequestBody::Runs {
        before: None,
        count: Some(RUNS_MAX),
    };
    loop {
        let notice = tokio::select! {
            news = daemon.next() => match news {
                News::Connected => {
                    // Without an answer the calendar shows what it showed.
                    daemon.request(runs.clone()).await.ok();
                    None
                }
                News::Lost => {
                    watcher.daemon_went(begun.elapsed());
                    None
                }
                News::Update(update) => {
                    write_down(&mut lock(&diary), &update);
                    let notice = watcher.update(&update, begun.elapsed());
                    if watcher.known.wants_hello() {
                        // A daemon that is away says it when it is there again.
                        daemon.hello().await.ok();
                    }
                    notice
                }
            },
            _ = ticks.tick() => watcher.wake(begun.elapsed()),
        };
        if let Some(notice) = notice {
            tell(&recipients, &watcher, (&configuration.name, notice));
        }
    }
}

fn write_down(diary: &mut Diary, update: &Update) {
    match update {
        Update::Runs { runs, .. } => diary.runs.clone_from(runs),
        Update::RunKept(run) => {
            diary.runs.insert(0, (**run).clone());
            diary.runs.truncate(usize::from(RUNS_MAX));
        }
        Update::Schedules(schedules) => diary.schedules = Some(schedules.clone()),
        _ => {}
    }
}

fn tell(recipients: &[Recipient], watcher: &Watcher, (robot, notice): (&str, Notice)) {
    let letter = Letter {
        robot: robot.to_owned(),
        notice,
        picture: picture::png(&watcher.known, &[]).map(Arc::new),
    };
    recipients.iter().for_each(|recipient| recipient.tell(&letter));
}
