//! Puts the daemon together and runs it.

use std::io::{self, Write};
use std::time::{SystemTime, UNIX_EPOCH};

use robot_link::{LinkAddress, UartAddress};
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::{mpsc, watch};
use tokio::task::{LocalSet, spawn_local};
use vthal_core::device::{Make, cordlib};
use vthal_core::{Checkpoints, Core, CoreConfig, ExpertAccess, LineHolder, Recording};

use crate::clock::Clock;
use crate::config::Config;
use crate::daemon::{Daemon, Wiring};
use crate::event::Event;
use crate::instance::{self, InstanceTaken};
use crate::kept_store::{self, KeptStore};
use crate::link::{self, LineOrders, RobotLine};
use crate::recording::{self, Library, LibraryLimits, RecorderHandle};
use crate::robot_file::{self, RobotFacts, RobotFileError};
use crate::socket::{self, SocketError};
use crate::told_lines::CORE_LINES;
use crate::{board, checkpoint_thread, imu, logging, radio, run_thread, systemd, zone};

/// Make of the robot that this daemon serves.
const MAKE: Make = cordlib::MAKE;

/// Events that may wait for the loop; whoever brings more waits too.
const EVENTS_MAX: usize = 64;
/// Batches of bytes that may wait for the link.
const TO_ROBOT_MAX: usize = 64;

/// Why the daemon did not start.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The state folder is taken.
    #[error(transparent)]
    Instance(#[from] InstanceTaken),
    /// There is no socket.
    #[error(transparent)]
    Socket(#[from] SocketError),
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
    let lock = instance::take(&config.state)?;
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()?;
    LocalSet::new().block_on(&runtime, start(config, speed, lock.complaint.clone()))
}

/// `unkept` is why the state folder cannot be written, if it cannot: the daemon serves all the same, and says so.
async fn start(config: &Config, speed: f64, unkept: Option<String>) -> Result<(), ServeError> {
    let listener = socket::listen(&config.socket)?;
    let (told, log_file) = logging::start(&config.state.join("log"), &config.log);
    let kept = KeptStore::new(&config.state);
    let (event_sender, events) = mpsc::channel(EVENTS_MAX);
    let (recorder, unrecorded) = recorder(config, &event_sender)?;
    let unlogged = log_file
        .err()
        .map(|error| format!("cannot write the log in the state folder: {error}"));
    let complaints = [unkept, unlogged, unrecorded].into_iter().flatten();
    let core_config = core_config(config, &kept, complaints.collect())?;
    let (to_robot, robot_queue) = mpsc::channel(TO_ROBOT_MAX);
    let (line_holder, holder) = watch::channel(LineHolder::Daemon);
    let lights = match &config.board {
        Some(settings) => Some(board::start(settings.clone(), event_sender.clone())?),
        None => None,
    };
    let wiring = Wiring {
        lights,
        events,
        event_sender: event_sender.clone(),
        to_robot,
        line_holder,
        recorder,
        runs: run_thread::start(kept.paths().lifetime.clone(), event_sender.clone())?,
        checkpoints: checkpoint_thread::start(kept.into_paths(), event_sender.clone())?,
        socket: config.socket.clone(),
        calibration_file: config.state.join("calibration.toml"),
        clients_max: config.clients_max,
        told,
    };
    let zone = zone::start(event_sender.clone())?;
    watch_signals(&event_sender)?;
    systemd::watch(&event_sender);
    spawn_local(socket::serve(listener, event_sender.clone()));
    let robot = RobotLine {
        rates_baud: match &config.link {
            LinkAddress::Uart(UartAddress { baud: Some(baud), .. }) => vec![*baud],
            _ => MAKE.opening.rates_baud.to_vec(),
        },
        address: config.link.clone(),
        opening: MAKE.opening,
    };
    if let Some(imu) = &config.imu {
        imu::start(imu.clone(), event_sender.clone())?;
    }
    if let Some(radio) = &config.radio {
        spawn_local(radio::serve(radio.clone(), event_sender.clone()));
    }
    let orders = LineOrders {
        to_robot: robot_queue,
        holder,
    };
    spawn_local(link::serve(robot, event_sender, orders));
    tracing::info!(
        part = "vthal",
        "version {} listens on {}",
        env!("CARGO_PKG_VERSION"),
        config.socket.display()
    );
    announce()?;
    let daemon = Daemon::new(Core::new(core_config), Clock::start(speed), wiring);
    // As a task among its own kind: what the link's task wakes runs in the same round of the scheduler, without a
    // poll the system in between.
    Ok(spawn_local(daemon.run(zone)).await.map_err(io::Error::other)?)
}

/// Settings of the core, with what is kept in the state folder, and what is wrong with that.
fn core_config(config: &Config, kept: &KeptStore, complaints: Vec<String>) -> Result<CoreConfig, ServeError> {
    let robot = match &config.description {
        Some(path) => robot_file::load(path)?,
        None => RobotFacts::default(),
    };
    let mut core_config = kept.fill(CoreConfig {
        make: MAKE,
        sensors: robot.sensors,
        calibration: robot.calibration,
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
        ..CoreConfig::default()
    });
    core_config.complaints.splice(..0, complaints);
    for complaint in &core_config.complaints {
        tracing::error!(target: CORE_LINES, part = "vthal", "{complaint}");
    }
    Ok(core_config)
}

/// Tells whoever started the daemon that its socket is open.
fn announce() -> io::Result<()> {
    systemd_notice::tell_ready();
    let mut stdout = io::stdout().lock();
    writeln!(stdout, "ready").and_then(|()| stdout.flush())
}

/// The recorder, or why there is none although there should be one.
fn recorder(
    config: &Config,
    events: &mpsc::Sender<Event>,
) -> io::Result<(Option<RecorderHandle>, Option<String>)> {
    if !config.recording.enabled {
        return Ok((None, None));
    }
    let limits = LibraryLimits {
        files_max: config.recording.files as usize,
        bytes_max: u64::from(config.recording.total_mib) << 20,
    };
    let library = match Library::open(&config.state.join(kept_store::RECORDINGS), limits) {
        Ok(library) => library,
        Err(error) => {
            let complaint = format!("runs are not recorded: cannot use the folder of recordings: {error}");
            return Ok((None, Some(complaint)));
        }
    };
    let events = events.clone();
    // A daemon that ends has no use for the name.
    let opened = move |run, name| drop(events.blocking_send(Event::RecordingOpened(run, name)));
    let handle = recording::start(library, format!("{config:?}"), opened)?;
    Ok((Some(handle), None))
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
