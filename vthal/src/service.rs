//! Puts the daemon together and runs it.

use std::io::{self, Write};
use std::time::{SystemTime, UNIX_EPOCH};

use brain::SensorLayout;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::mpsc;
use tokio::task::{LocalSet, spawn_local};
use vthal_core::device::{Make, cordlib};
use vthal_core::{Checkpoint, Checkpoints, Core, CoreConfig, ExpertAccess, Recording, cut_short};

use crate::checkpoint_file::{self, BootTime, Found};
use crate::checkpoint_thread::KeptPaths;
use crate::clock::Clock;
use crate::config::Config;
use crate::daemon::{Daemon, Wiring};
use crate::event::Event;
use crate::floor_folder::FloorFolder;
use crate::health_file;
use crate::instance::{self, InstanceError};
use crate::learnt_file;
use crate::mix_folder::MixFolder;
use crate::recording::{self, Library, LibraryLimits, RecorderHandle};
use crate::robot_file::{self, RobotFileError};
use crate::run_folder::RunFolder;
use crate::schedule_file;
use crate::serial::{self, RobotLine};
use crate::socket::{self, SocketError};
use crate::system_zone::system_zone;
use crate::{board, checkpoint_thread, imu, logging, radio, run_thread};

/// Make of the robot that this daemon serves.
const MAKE: Make = cordlib::MAKE;

/// Events that may wait for the loop; whoever brings more waits too.
const EVENTS_MAX: usize = 64;
/// Batches of bytes that may wait for the serial line.
const TO_ROBOT_MAX: usize = 64;

/// Name of the file of the checkpoint in the state folder.
const CHECKPOINT: &str = "checkpoint";
/// Name of the folder of maps in the state folder.
const MAPS: &str = "maps";
/// Name of the folder of records of runs in the state folder.
const HISTORY: &str = "history";
/// Name of the folder of recordings in the state folder.
const RECORDINGS: &str = "runs";
/// Name of the folder of control mixes in the state folder.
const MIXES: &str = "mixes";
/// Name of the file of schedules in the state folder.
const SCHEDULES: &str = "schedules.json";
/// Name of the file of the motors' loads in the state folder.
const HEALTH: &str = "health.json";

/// Name of the file of what robots have learnt in the state folder.
const LEARNT: &str = "learnt.json";

/// Why the daemon did not start.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The state folder is taken.
    #[error(transparent)]
    Instance(#[from] InstanceError),
    /// There is no socket.
    #[error(transparent)]
    Socket(#[from] SocketError),
    /// The log cannot be written.
    #[error("cannot write the log in the state folder: {0}; check that it may be written")]
    Log(#[source] io::Error),
    /// The folder of recordings cannot be used.
    #[error("cannot use the folder of recordings: {0}; check that the state folder may be written")]
    Recordings(#[source] io::Error),
    /// The description of the robot cannot be used.
    #[error(transparent)]
    Robot(#[from] RobotFileError),
    /// The system refuses something that a daemon needs.
    #[error("the system refuses to start the daemon: {0}")]
    System(#[from] io::Error),
}

/// Runs the daemon until a signal ends it. Its clock runs `speed` times as fast as real time.
///
/// # Errors
/// See [`ServeError`].
pub fn serve(config: &Config, speed: f64) -> Result<(), ServeError> {
    let _lock = instance::take(&config.state)?;
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()?;
    LocalSet::new().block_on(&runtime, start(config, speed))
}

async fn start(config: &Config, speed: f64) -> Result<(), ServeError> {
    let listener = socket::listen(&config.socket)?;
    logging::start(&config.state.join("log"), &config.log).map_err(ServeError::Log)?;
    let kept = KeptPaths {
        checkpoint: config.state.join(CHECKPOINT),
        floors: FloorFolder::new(config.state.join(MAPS)),
        mixes: MixFolder::new(config.state.join(MIXES)),
        schedules: config.state.join(SCHEDULES),
        health: config.state.join(HEALTH),
        learnt: config.state.join(LEARNT),
        runs: RunFolder::new(config.state.join(HISTORY), config.state.join(RECORDINGS)),
    };
    let core_config = core_config(config, &kept)?;
    let (event_sender, events) = mpsc::channel(EVENTS_MAX);
    let (to_robot, robot_queue) = mpsc::channel(TO_ROBOT_MAX);
    let lights = match &config.board {
        Some(settings) => Some(board::start(settings.clone(), event_sender.clone())?),
        None => None,
    };
    let wiring = Wiring {
        lights,
        events,
        event_sender: event_sender.clone(),
        to_robot,
        recorder: recorder(config, &event_sender)?,
        runs: run_thread::start(kept.runs.clone(), event_sender.clone())?,
        checkpoints: checkpoint_thread::start(kept, event_sender.clone())?,
        socket: config.socket.clone(),
        clients_max: config.clients_max,
    };
    watch_signals(&event_sender)?;
    spawn_local(socket::serve(listener, event_sender.clone()));
    let robot = RobotLine {
        path: config.serial.clone(),
        rates_baud: match config.baud {
            Some(baud) => vec![baud],
            None => MAKE.opening.rates_baud.to_vec(),
        },
        opening: MAKE.opening,
    };
    if let Some(imu) = &config.imu {
        imu::start(imu.clone(), event_sender.clone())?;
    }
    if let Some(radio) = &config.radio {
        spawn_local(radio::serve(radio.clone(), event_sender.clone()));
    }
    spawn_local(serial::serve(robot, event_sender, robot_queue));
    tracing::info!(
        part = "vthal",
        "version {} listens on {}",
        env!("CARGO_PKG_VERSION"),
        config.socket.display()
    );
    announce()?;
    let daemon = Daemon::new(Core::new(core_config), Clock::start(speed), wiring);
    // As a task among its own kind: what the serial line's task wakes runs in the same round of the scheduler, without a
    // poll the system in between.
    Ok(spawn_local(daemon.run()).await.map_err(io::Error::other)?)
}

/// Settings of the core, with what is kept in the state folder.
fn core_config(config: &Config, kept: &KeptPaths) -> Result<CoreConfig, ServeError> {
    let found = schedule_file::load(&kept.schedules);
    let (health, health_complaints) = health_file::load(&kept.health);
    let (learnt, learnt_complaints) = learnt_file::load(&kept.learnt);
    let (floors, floor_complaints) = kept.floors.load();
    let complaints = [
        found.complaints,
        health_complaints,
        learnt_complaints,
        floor_complaints,
    ]
    .concat();
    for complaint in &complaints {
        tracing::error!(part = "vthal", "{complaint}");
    }
    let sensors = match &config.description {
        Some(path) => robot_file::load(path)?,
        None => SensorLayout::default(),
    };
    let (resume, next_run) = left_over(kept);
    Ok(CoreConfig {
        make: MAKE,
        schedules: found.book,
        health,
        learnt,
        schedules_distrusted: found.distrusted,
        zone: system_zone(),
        floors,
        complaints,
        sensors,
        seed: config.seed.unwrap_or_else(seed_from_clock),
        strategy: config.strategy,
        expert: if config.expert {
            ExpertAccess::Allowed
        } else {
            ExpertAccess::Denied
        },
        recording: if config.recording.enabled {
            Recording::On
        } else {
            Recording::Off
        },
        checkpoints: Checkpoints::On,
        task_budget_s: config.task_budget_min * 60,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        resume,
        next_run,
    })
}

/// The job that goes on, and the number of the next run. A run that is not continued is stored as cut short.
fn left_over(kept: &KeptPaths) -> (Option<Checkpoint>, u64) {
    let now = BootTime::now().ok();
    let found = now.and_then(|now| checkpoint_file::newest(&kept.checkpoint, &now));
    let run = found.as_ref().and_then(|found| found.checkpoint.run.as_ref());
    let left = run.map_or(0, |run| run.run.number);
    let next_run = kept.runs.newest().max(left) + 1;
    let Some(Found { checkpoint, is_young }) = found else {
        return (None, next_run);
    };
    if is_young {
        return (Some(checkpoint), next_run);
    }
    if let Some(record) = cut_short(checkpoint).filter(|record| !kept.runs.has(record.run.number)) {
        let number = record.run.number;
        match kept.runs.keep(&record) {
            Ok(()) => tracing::info!(
                part = "vthal",
                "run {number} was cut short: what was known of it is kept"
            ),
            Err(error) => tracing::error!(
                part = "vthal",
                "cannot write what was known of run {number} in {}: {error}",
                kept.runs.path().display()
            ),
        }
    }
    (None, next_run)
}

/// Tells whoever started the daemon that its socket is open.
fn announce() -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    writeln!(stdout, "ready").and_then(|()| stdout.flush())
}

fn recorder(config: &Config, events: &mpsc::Sender<Event>) -> Result<Option<RecorderHandle>, ServeError> {
    if !config.recording.enabled {
        return Ok(None);
    }
    let limits = LibraryLimits {
        files_max: config.recording.files as usize,
        bytes_max: u64::from(config.recording.total_mib) << 20,
    };
    let library = Library::open(&config.state.join(RECORDINGS), limits).map_err(ServeError::Recordings)?;
    let events = events.clone();
    // A daemon that ends has no use for the name.
    let opened = move |run, name| drop(events.blocking_send(Event::RecordingOpened(run, name)));
    Ok(Some(recording::start(library, format!("{config:?}"), opened)?))
}

fn watch_signals(events: &mpsc::Sender<Event>) -> io::Result<()> {
    for (kind, name) in [
        (SignalKind::terminate(), "SIGTERM"),
        (SignalKind::interrupt(), "SIGINT"),
    ] {
        let mut stream = signal(kind)?;
        let events = events.clone();
        spawn_local(async move {
            while stream.recv().await.is_some() {
                if events.send(Event::Terminate(name)).await.is_err() {
                    return;
                }
            }
        });
    }
    Ok(())
}

/// Different at each start; recorded, so that a replay has it.
fn seed_from_clock() -> u64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(1, |since| since.as_micros() as u64)
}
