//! One trial: a robot that sends as fast as everybody reads, then at 50 Hz, and the clients that read.

use std::fs;
use std::io::Read;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rvac_protocol::message::BinaryKinds;

use crate::peer::{Client, Daemon, Scratch, SyntheticRobot};

/// Packets under way at most in the test of the highest rate: nobody's queue overflows.
const UNDER_WAY: u64 = 200;
/// Packets sent between two looks at what came.
const BURST: u64 = 20;
/// Telemetry of the SR8730.
const PERIOD: Duration = Duration::from_millis(20);
/// What marks a telemetry packet, in both relays' output.
const MARK: &[u8] = b"state";

/// Who relays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Relay {
    /// The daemon.
    Vthal,
    /// The plain one.
    Plain,
}

impl Relay {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Vthal => "vthal",
            Self::Plain => "plain",
        }
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trial {
    pub(crate) relay: Relay,
    pub(crate) clients: usize,
    pub(crate) time: Duration,
}

/// What was measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures {
    /// To each client, at the highest rate without loss.
    pub(crate) packets_per_s: f64,
    /// From the write to the terminal to the end of the read from the socket, at 50 Hz, over all clients.
    pub(crate) latency_median_us: f64,
    pub(crate) latency_p99_us: f64,
    /// Of one core, at 50 Hz.
    pub(crate) cpu_share: f64,
    pub(crate) rss_mib: f64,
}

/// A robot that sends text, as the one of 2016 did and as a person reads it.
pub(crate) fn switch_on(scratch: &Scratch) -> anyhow::Result<SyntheticRobot> {
    Ok(SyntheticRobot::switch_on(
        &scratch.join("tty"),
        BinaryKinds::NONE,
        1,
    )?)
}

pub(crate) fn run(
    trial: &Trial,
    (mut robot, daemon): (SyntheticRobot, &Daemon),
    socket: &Path,
) -> anyhow::Result<Figures> {
    if trial.relay == Relay::Vthal {
        let deadline = Instant::now() + Duration::from_secs(10);
        if !robot.live_until(deadline, SyntheticRobot::is_sealed)? {
            bail!("the daemon opened no session");
        }
        robot.live_until(Instant::now() + Duration::from_millis(500), |_| false)?;
    }
    let mut readers = connect(trial, socket)?;
    robot.live_until(Instant::now() + Duration::from_millis(300), |_| false)?;
    drain(&mut readers)?;
    let (cpu, began) = (cpu_time(daemon)?, Instant::now());
    let mut latencies_us = at_fifty_hertz(trial, &mut robot, &mut readers)?;
    let cpu_share = (cpu_time(daemon)? - cpu).as_secs_f64() / began.elapsed().as_secs_f64();
    let rss_mib = resident_mib(daemon)?;
    let packets_per_s = at_highest_rate(trial, &mut robot, &mut readers)?;
    latencies_us.sort_by(f64::total_cmp);
    let rank = |share: f64| {
        latencies_us
            .get((latencies_us.len() as f64 * share) as usize)
            .copied()
    };
    Ok(Figures {
        packets_per_s,
        latency_median_us: rank(0.5).context("nothing came")?,
        latency_p99_us: rank(0.99).context("nothing came")?,
        cpu_share,
        rss_mib,
    })
}

/// A client that only counts telemetry packets.
struct Reader {
    stream: UnixStream,
    /// Packets that came.
    packets: u64,
    /// Whether the packet that is coming has the mark; what it began with.
    part: Vec<u8>,
}

fn connect(trial: &Trial, socket: &Path) -> anyhow::Result<Vec<Reader>> {
    (0..trial.clients)
        .map(|_| {
            let mut client = Client::connect(socket)?;
            if trial.relay == Relay::Vthal {
                client.send(r#"{"c":"watch","topics":["packets"]}"#)?;
            }
            client.stream.set_nonblocking(true)?;
            Ok(Reader {
                stream: client.stream,
                packets: 0,
                part: Vec::new(),
            })
        })
        .collect()
}

impl Reader {
    fn read(&mut self) -> anyhow::Result<()> {
        let mut bytes = [0; 64 << 10];
        match self.stream.read(&mut bytes) {
            Ok(0) => bail!("the relay hung up"),
            Ok(count) => self.count(bytes.get(..count).unwrap_or_default()),
            Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }

    fn count(&mut self, bytes: &[u8]) {
        for piece in bytes.split_inclusive(|byte| *byte == rvac_api::SEPARATOR) {
            // The mark stands within the first bytes of a packet.
            let room = 80_usize.saturating_sub(self.part.len());
            self.part.extend(piece.iter().take(room));
            if piece.ends_with(&[rvac_api::SEPARATOR]) {
                self.packets += u64::from(self.part.windows(MARK.len()).any(|window| window == MARK));
                self.part.clear();
            }
        }
    }
}

/// Reads whatever comes within `pause`, from whomever.
fn read_ready(readers: &mut [Reader], pause: Duration) -> anyhow::Result<bool> {
    let timeout = Timespec::try_from(pause).unwrap_or_default();
    let ready: Vec<bool> = {
        let mut polled: Vec<PollFd<'_>> = readers
            .iter()
            .map(|reader| PollFd::new(&reader.stream, PollFlags::IN))
            .collect();
        poll(&mut polled, Some(&timeout))?;
        polled.iter().map(|polled| !polled.revents().is_empty()).collect()
    };
    for (reader, _) in readers.iter_mut().zip(&ready).filter(|(_, ready)| **ready) {
        reader.read()?;
    }
    Ok(ready.contains(&true))
}

fn drain(readers: &mut [Reader]) -> anyhow::Result<()> {
    while read_ready(readers, Duration::from_millis(50))? {}
    for reader in readers {
        reader.packets = 0;
    }
    Ok(())
}

fn at_fifty_hertz(
    trial: &Trial,
    robot: &mut SyntheticRobot,
    readers: &mut [Reader],
) -> anyhow::Result<Vec<f64>> {
    let mut latencies_us = Vec::new();
    let end = Instant::now() + trial.time;
    let mut sent = 0;
    while Instant::now() < end {
        let next = Instant::now() + PERIOD;
        let moment = robot.report()?;
        sent += 1;
        while Instant::now() < next {
            let before: Vec<u64> = readers.iter().map(|reader| reader.packets).collect();
            read_ready(readers, next.saturating_duration_since(Instant::now()))?;
            let latency_us = moment.elapsed().as_secs_f64() * 1e6;
            let came = readers
                .iter()
                .zip(&before)
                .filter(|(reader, before)| reader.packets > **before)
                .count();
            latencies_us.extend(std::iter::repeat_n(latency_us, came));
        }
        robot.listen(Instant::now())?;
    }
    if readers.iter().any(|reader| reader.packets + 1 < sent) {
        bail!("packets were lost at 50 Hz");
    }
    Ok(latencies_us)
}

fn at_highest_rate(trial: &Trial, robot: &mut SyntheticRobot, readers: &mut [Reader]) -> anyhow::Result<f64> {
    drain(readers)?;
    let began = Instant::now();
    let mut sent: u64 = 0;
    while began.elapsed() < trial.time {
        let arrived = readers
            .iter()
            .map(|reader| reader.packets)
            .min()
            .unwrap_or_default();
        if sent - arrived.min(sent) < UNDER_WAY {
            for _ in 0..BURST {
                robot.report()?;
            }
            sent += BURST;
            robot.listen(Instant::now())?;
            read_ready(readers, Duration::ZERO)?;
        } else {
            read_ready(readers, Duration::from_millis(100))?;
        }
    }
    let arrived = readers
        .iter()
        .map(|reader| reader.packets)
        .min()
        .unwrap_or_default();
    Ok(arrived as f64 / began.elapsed().as_secs_f64())
}

/// Time on a processor of all threads so far.
fn cpu_time(daemon: &Daemon) -> anyhow::Result<Duration> {
    let mut total_ns = 0;
    for task in fs::read_dir(format!("/proc/{}/task", daemon.id()))? {
        let text = fs::read_to_string(task?.path().join("schedstat"))?;
        let on_cpu = text.split(' ').next().and_then(|word| word.parse::<u64>().ok());
        total_ns += on_cpu.context("no processor times in /proc")?;
    }
    Ok(Duration::from_nanos(total_ns))
}

fn resident_mib(daemon: &Daemon) -> anyhow::Result<f64> {
    let status = fs::read_to_string(format!("/proc/{}/status", daemon.id()))?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line
        .and_then(|line| line.trim().strip_suffix(" kB"))
        .and_then(|kib| kib.parse::<f64>().ok());
    Ok(kib.context("no memory in /proc")? / 1024.0)
}
