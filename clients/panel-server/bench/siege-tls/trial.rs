//! One kind of hostile peers, beside three honest phones: one presses Stop, one follows telemetry, one comes anew each second.

use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Context;
use pairing::Role;
use panel_bench::{Caller, Door, keep_large_home};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{
    Client, Daemon, Delays, LivingRobot, Processor, Scratch, SyntheticRobot, needed_beside, resident_max_mib,
};

use crate::honest::{self, Phone, Watch};
use crate::hostile::{Besieger, Kind, LARGE_FILE, LARGE_FILE_BYTES, Siege};

/// A robot has described itself, and its map is taken up, after this time.
const SETTLE: Duration = Duration::from_secs(3);
/// Those who besiege are at it.
const BEGIN: Duration = Duration::from_millis(500);
/// A run that can be fetched takes so long.
const RUN: Duration = Duration::from_secs(2);
/// For an honest phone that comes before the siege.
const PATIENCE: Duration = Duration::from_secs(10);

/// What is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trial {
    pub(crate) kind: Kind,
    pub(crate) of_a_kind: u64,
    pub(crate) time: Duration,
}

/// What a process took.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taken {
    /// Of one core.
    pub(crate) cpu_share: f64,
    /// Share of the time in which it could run and others had the processors.
    pub(crate) wait_share: f64,
    /// Most memory.
    pub(crate) rss_max_mib: f64,
}

/// What was measured.
#[derive(Debug)]
pub(crate) struct Figures {
    pub(crate) stops: usize,
    pub(crate) stop_ms: Delays,
    /// From the robot's clock in a report to the phone. Its clock has whole milliseconds, and is this program's.
    pub(crate) telemetry_ms: Delays,
    /// Of those who came anew and got through; none where nobody did.
    pub(crate) newcomer_ms: Option<Delays>,
    pub(crate) newcomers: usize,
    /// Why some of them did not get through.
    pub(crate) lost_newcomers: Vec<String>,
    pub(crate) server: Taken,
    pub(crate) daemon: Taken,
    pub(crate) connections: u64,
    pub(crate) refused: u64,
    pub(crate) requests: u64,
}

/// Ends the siege, also when a check has failed.
struct End<'a>(&'a Siege, &'a Watch);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.end();
        self.1.is_over.store(true, Ordering::Relaxed);
    }
}

/// What the honest phones found.
struct Found {
    stops_ms: Vec<f64>,
    reports_ms: Vec<f64>,
    newcomers: Vec<anyhow::Result<f64>>,
}

impl Trial {
    /// Starts everybody and measures.
    pub(crate) fn run(self) -> anyhow::Result<Figures> {
        let scratch = Scratch::new()?;
        keep_large_home(&scratch)?;
        let page = scratch.join("page");
        std::fs::create_dir_all(&page)?;
        std::fs::write(page.join(LARGE_FILE), vec![0; LARGE_FILE_BYTES])?;
        let mut robot = SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::NONE, 1)?;
        robot.dock();
        let clock_began = robot.started();
        let daemon = Daemon::start(&needed_beside("vthal")?, &scratch, &["--seed", "1"])?;
        let _robot = LivingRobot::new(robot);
        thread::sleep(SETTLE);
        keep_run(&scratch)?;
        let door = Door::start(&scratch, true)?;
        self.besiege(&door, &daemon, clock_began)
    }

    fn besiege(self, door: &Door, daemon: &Daemon, clock_began: Instant) -> anyhow::Result<Figures> {
        let owner = door.owner();
        let presser = Phone::come(door, &owner, PATIENCE)?;
        let mut follower = Phone::come(door, &owner, PATIENCE)?;
        follower.say(r#"{"c":"watch","topics":["packets"]}"#)?;
        if self.kind == Kind::GuessCodes {
            door.open_window()?;
        }
        let (siege, watch) = (Siege::default(), Watch::default());
        let processes = [door.id(), daemon.id()];
        thread::scope(|scope| {
            let _end = End(&siege, &watch);
            let follower = scope.spawn(|| honest::follow(follower, clock_began, &watch));
            for number in 0..self.kind.count(self.of_a_kind) {
                let besieger = Besieger {
                    kind: self.kind,
                    door,
                    siege: &siege,
                    caller: self.caller(door, number)?,
                    random: (number + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1,
                };
                scope.spawn(move || besieger.besiege());
            }
            thread::sleep(BEGIN);
            let (began, before) = (Instant::now(), usage(processes)?);
            let (seen, asked, sent) = (siege.refused(), siege.begun(), siege.done());
            watch.counts.store(true, Ordering::Relaxed);
            let newcomers = scope.spawn(|| honest::come_and_stop(door, &owner, self.time));
            let stops_ms = honest::press(presser, self.time)?;
            let newcomers = newcomers.join().ok().context("a thread panicked")??;
            watch.is_over.store(true, Ordering::Relaxed);
            let reports_ms = follower.join().ok().context("a thread panicked")??;
            let taken = taken(processes, before, began.elapsed())?;
            let found = Found {
                stops_ms,
                reports_ms,
                newcomers,
            };
            let figures = figures(found, taken)?;
            Ok(Figures {
                connections: siege.begun() - asked,
                refused: siege.refused() - seen,
                requests: siege.done() - sent,
                ..figures
            })
        })
    }

    fn caller(self, door: &Door, number: u64) -> anyhow::Result<Caller> {
        let token = match self.kind.is_paired() {
            true => Some(door.add(&format!("hostile {number}"), Role::View)?),
            false => None,
        };
        let from = Some(self.kind.address(number));
        Ok(Caller { from, token })
    }
}

/// A run of which there is a recording.
fn keep_run(scratch: &Scratch) -> anyhow::Result<()> {
    let mut client = Client::connect(&scratch.join("vthal.sock"))?;
    client.send(r#"{"c":"start","id":1}"#)?;
    thread::sleep(RUN);
    client.press_stop(2, PATIENCE)?;
    Ok(())
}

fn usage(processes: [u32; 2]) -> anyhow::Result<[Processor; 2]> {
    let [server, daemon] = processes;
    Ok([Processor::of(server)?, Processor::of(daemon)?])
}

fn taken(processes: [u32; 2], before: [Processor; 2], time: Duration) -> anyhow::Result<[Taken; 2]> {
    let after = usage(processes)?;
    let one = |process: u32, before: Processor, after: Processor| -> anyhow::Result<Taken> {
        Ok(Taken {
            cpu_share: (after.ran_s - before.ran_s) / time.as_secs_f64(),
            wait_share: (after.waited_s - before.waited_s) / time.as_secs_f64(),
            rss_max_mib: resident_max_mib(process)?,
        })
    };
    Ok([
        one(processes[0], before[0], after[0])?,
        one(processes[1], before[1], after[1])?,
    ])
}

fn figures(found: Found, [server, daemon]: [Taken; 2]) -> anyhow::Result<Figures> {
    let newcomers = found.newcomers.len();
    let (mut came_ms, mut lost_newcomers) = (Vec::new(), Vec::new());
    for newcomer in found.newcomers {
        match newcomer {
            Ok(ms) => came_ms.push(ms),
            Err(error) => lost_newcomers.push(format!("{error:#}")),
        }
    }
    Ok(Figures {
        stops: found.stops_ms.len(),
        stop_ms: Delays::of(found.stops_ms).context("Stop was not pressed")?,
        telemetry_ms: Delays::of(found.reports_ms).context("no telemetry came")?,
        newcomer_ms: Delays::of(came_ms),
        newcomers,
        lost_newcomers,
        server,
        daemon,
        connections: 0,
        refused: 0,
        requests: 0,
    })
}
