//! One trial: robots that send at 50 Hz by turns, then each as fast as everybody reads.

use std::time::{Duration, Instant};

use anyhow::{Context, bail};

use crate::lane::{Lane, listen};
use crate::reader::read_ready;
use vthal_bench::{Processor, resident_mib};

/// Packets under way at most in the test of the highest rate: nobody's queue overflows.
const UNDER_WAY: u64 = 200;
/// Packets sent between two looks at what came.
const BURST: u64 = 20;
/// Telemetry of the SR8730.
const PERIOD: Duration = Duration::from_millis(20);
/// For packets that are under way when time is over.
const LAST_WAIT: Duration = Duration::from_secs(2);

/// What was measured of one relay.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures {
    /// To each client, at the highest rate without loss.
    pub(crate) packets_per_s: f64,
    /// From the write to the terminal to the end of the read from the socket, at 50 Hz, over all clients.
    pub(crate) latency_median_us: f64,
    pub(crate) latency_p99_us: f64,
    /// Of one core, at 50 Hz.
    pub(crate) cpu_share: f64,
    /// Share of the time in which it could run and other programs had the processors, at 50 Hz.
    pub(crate) wait_share: f64,
    pub(crate) rss_mib: f64,
}

/// Measures lanes beside each other: what else the machine does at that time then delays all of them alike.
pub(crate) fn run(mut lanes: Vec<Lane>, time: Duration) -> anyhow::Result<Vec<Figures>> {
    let began = Instant::now();
    let before: Vec<Processor> = usage(&lanes)?;
    at_fifty_hertz(&mut lanes, time)?;
    let elapsed_s = began.elapsed().as_secs_f64();
    let after = usage(&lanes)?;
    let mut all = Vec::new();
    for (mut lane, (before, after)) in lanes.into_iter().zip(before.iter().zip(&after)) {
        let rss_mib = resident_mib(lane.daemon.id())?;
        let packets_per_s = at_highest_rate(&mut lane, time / 4)?;
        lane.latencies_us.sort_by(f64::total_cmp);
        let count = lane.latencies_us.len() as f64;
        let rank = |share: f64| lane.latencies_us.get((count * share) as usize).copied();
        all.push(Figures {
            packets_per_s,
            latency_median_us: rank(0.5).context("nothing came")?,
            latency_p99_us: rank(0.99).context("nothing came")?,
            cpu_share: (after.ran_s - before.ran_s) / elapsed_s,
            wait_share: (after.waited_s - before.waited_s) / elapsed_s,
            rss_mib,
        });
    }
    Ok(all)
}

fn at_fifty_hertz(lanes: &mut [Lane], time: Duration) -> anyhow::Result<()> {
    let began = Instant::now();
    let gap = PERIOD / lanes.len().max(1) as u32;
    let mut next = began;
    while began.elapsed() < time {
        for turn in 0..lanes.len() {
            if let Some(lane) = lanes.get_mut(turn) {
                lane.report()?;
                lane.robot.listen(Instant::now())?;
            }
            next += gap;
            while Instant::now() < next {
                listen(lanes, next.saturating_duration_since(Instant::now()))?;
            }
        }
    }
    let deadline = Instant::now() + LAST_WAIT;
    while lanes.iter().any(Lane::waits) && Instant::now() < deadline {
        listen(lanes, PERIOD)?;
    }
    if let Some(lane) = lanes.iter().find(|lane| lane.waits()) {
        bail!("{} lost packets at 50 Hz", lane.relay.name());
    }
    Ok(())
}

fn at_highest_rate(lane: &mut Lane, time: Duration) -> anyhow::Result<f64> {
    lane.drain()?;
    let began = Instant::now();
    let mut sent: u64 = 0;
    while began.elapsed() < time {
        let free = sent - lane.arrived().min(sent) < UNDER_WAY;
        let pause = if free {
            for _ in 0..BURST {
                lane.robot.report()?;
            }
            sent += BURST;
            lane.robot.listen(Instant::now())?;
            Duration::ZERO
        } else {
            Duration::from_millis(100)
        };
        read_ready(&mut lane.readers.iter_mut().collect::<Vec<_>>(), pause)?;
    }
    Ok(lane.arrived() as f64 / began.elapsed().as_secs_f64())
}

fn usage(lanes: &[Lane]) -> anyhow::Result<Vec<Processor>> {
    let of = |lane: &Lane| Ok(Processor::of(lane.daemon.id())?);
    lanes.iter().map(of).collect()
}
