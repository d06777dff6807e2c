//! One trouble: an honest client presses Stop, another reads telemetry, and the daemon is looked at.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Context;
use rvac_api::{LogLevel, Update};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{
    Client, Daemon, Delays, HostileKind, Processor, Scratch, Siege, SyntheticRobot, keep_home,
    resident_max_mib,
};

use crate::card::{self, CardState, Passage};
use crate::line::LineState;

/// The most memory that the daemon may ask for.
const ADDRESS_SPACE_BYTES: u64 = 256 << 20;
/// A robot has described itself, and its map is taken up, after this time.
const SETTLE: Duration = Duration::from_secs(3);
/// Between two presses of Stop.
const PRESS_EVERY: Duration = Duration::from_millis(50);
/// A press that is not answered by then ends the measurement.
const PATIENCE: Duration = Duration::from_secs(20);

/// What besets the daemon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Trouble {
    /// Clients of this kind.
    Clients(HostileKind),
    /// The line to the robot.
    Line(LineState),
    /// The card on which everything is kept.
    Card(CardState),
}

impl Trouble {
    /// For tables.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Clients(kind) => kind.name(),
            Self::Line(state) => state.name(),
            Self::Card(state) => state.name(),
        }
    }

    const fn line(self) -> LineState {
        match self {
            Self::Clients(_) | Self::Card(_) => LineState::Sound,
            Self::Line(state) => state,
        }
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trial {
    /// What besets the daemon.
    pub(crate) trouble: Trouble,
    /// Clients of a kind.
    pub(crate) of_a_kind: u64,
    /// For so long.
    pub(crate) time: Duration,
}

/// What was measured.
#[derive(Clone, Debug)]
pub(crate) struct Figures {
    /// Presses of Stop.
    pub(crate) stops: usize,
    /// From the press to the answer.
    pub(crate) stop_ms: Delays,
    /// From the robot's clock in a report to the client that follows packets; none where no report comes. Its clock has whole
    /// milliseconds.
    pub(crate) telemetry_ms: Option<Delays>,
    /// Of one core.
    pub(crate) cpu_share: f64,
    /// Share of the time in which the daemon could run and others had the processors.
    pub(crate) wait_share: f64,
    /// Most memory.
    pub(crate) rss_max_mib: f64,
    /// Lines of the log for people.
    pub(crate) log_lines_per_s: f64,
    /// What became of changes on a card that takes nothing.
    pub(crate) passage: Option<Passage>,
}

/// Ends all threads of a trial when it goes.
struct End<'a>(&'a AtomicBool);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Trial {
    /// Starts everybody and measures.
    pub(crate) fn run(self, vthal: &Path) -> anyhow::Result<Figures> {
        let scratch = Scratch::new()?;
        keep_home(&scratch)?;
        let mut robot = SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::NONE, 1)?;
        robot.dock();
        let clock_began = robot.started();
        let daemon = self.start(vthal, &scratch)?;
        let socket = scratch.join("vthal.sock");
        if self.trouble.line() == LineState::Sound {
            robot.live_until(Instant::now() + SETTLE, |_| false)?;
        }
        let is_over = AtomicBool::new(false);
        thread::scope(|scope| {
            let _end = End(&is_over);
            let line = scope.spawn(|| self.trouble.line().keep(robot, &is_over));
            let listener = scope.spawn(|| listen(&socket, clock_began, &is_over));
            let passage = match self.trouble {
                Trouble::Card(_) => Some(card::try_changes(&socket)?),
                _ => None,
            };
            let figures = self.besiege(&daemon, &socket)?;
            is_over.store(true, Ordering::Relaxed);
            let heard = listener.join().ok().context("the listener panicked")??;
            line.join().ok().context("the robot panicked")??;
            Ok(Figures {
                telemetry_ms: Delays::of(heard.delays_ms),
                log_lines_per_s: heard.lines as f64 / self.time.as_secs_f64(),
                passage,
                ..figures
            })
        })
    }

    fn start(self, vthal: &Path, scratch: &Scratch) -> std::io::Result<Daemon> {
        let arguments = ["--seed", "1"];
        match self.trouble {
            Trouble::Card(state) => {
                let mut command = state.command(&scratch.join("state"));
                command
                    .arg("prlimit")
                    .arg(format!("--as={ADDRESS_SPACE_BYTES}"))
                    .arg(vthal);
                Daemon::start_as(command, scratch, &arguments)
            }
            Trouble::Clients(_) | Trouble::Line(_) => {
                Daemon::start_within(ADDRESS_SPACE_BYTES, vthal, scratch, &arguments)
            }
        }
    }

    /// Presses Stop while those of the kind do their deeds.
    fn besiege(self, daemon: &Daemon, socket: &Path) -> anyhow::Result<Figures> {
        let siege = Siege::default();
        thread::scope(|scope| {
            let _end = siege.end();
            if let Trouble::Clients(kind) = self.trouble {
                for number in 1..=self.of_a_kind {
                    let siege = &siege;
                    scope.spawn(move || kind.besiege(socket, number, siege));
                }
            }
            let mut honest = Client::connect(socket)?;
            let (began, before) = (Instant::now(), Processor::of(daemon.id())?);
            let mut delays_ms = Vec::new();
            let mut next = began;
            while began.elapsed() < self.time {
                let id = delays_ms.len() as u32 + 1;
                delays_ms.push(honest.press_stop(id, PATIENCE)?.as_secs_f64() * 1e3);
                next += PRESS_EVERY;
                thread::sleep(next.saturating_duration_since(Instant::now()));
            }
            let took_s = began.elapsed().as_secs_f64();
            let after = Processor::of(daemon.id())?;
            Ok(Figures {
                stops: delays_ms.len(),
                stop_ms: Delays::of(delays_ms).context("Stop was not pressed")?,
                telemetry_ms: None,
                cpu_share: (after.ran_s - before.ran_s) / took_s,
                wait_share: (after.waited_s - before.waited_s) / took_s,
                rss_max_mib: resident_max_mib(daemon.id())?,
                log_lines_per_s: 0.0,
                passage: None,
            })
        })
    }
}

/// What a client heard that follows packets and the log.
#[derive(Default)]
struct Heard {
    delays_ms: Vec<f64>,
    lines: usize,
}

fn listen(socket: &Path, clock_began: Instant, is_over: &AtomicBool) -> anyhow::Result<Heard> {
    let mut client = Client::watching(socket, r#"["packets","log"]"#)?;
    let mut heard = Heard::default();
    while !is_over.load(Ordering::Relaxed) {
        client.wait_for(Instant::now() + PRESS_EVERY, |update| {
            match update {
                Update::Packet {
                    direction: '<', text, ..
                } => {
                    let sent = clock_of(text).map(|clock| clock_began + clock);
                    heard
                        .delays_ms
                        .extend(sent.map(|sent| sent.elapsed().as_secs_f64() * 1e3));
                }
                Update::Log(line) if line.level != LogLevel::Debug => heard.lines += 1,
                _ => {}
            }
            false
        })?;
    }
    Ok(heard)
}

/// What the robot's clock showed in a report of its state.
fn clock_of(packet: &str) -> Option<Duration> {
    let clock = packet.strip_prefix(r#"{"c":"state","t":"#)?;
    let (clock_ms, _) = clock.split_once(',')?;
    clock_ms.parse().ok().map(Duration::from_millis)
}
