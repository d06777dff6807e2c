//! Latency of telemetry at 50 Hz to clients that follow the topics of a page, on all routes in the same seconds.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};

use crate::peer::Peer;
use crate::stage::{Route, Stage};

/// What a page follows, and the packets by which telemetry is counted.
const WATCH: &str = r#"{"c":"watch","topics":["status","pose","device","map","home","estimate","way","decisions","log","schedules","runs","floors","standstills","packets"]}"#;
/// How a packet of the wire begins, and what marks one of telemetry within the first bytes.
const PACKET: &str = r#"{"e":"packet""#;
const MARK: &str = "state";
const HEAD_BYTES: usize = 80;
/// Telemetry of the SR8730.
const PERIOD: Duration = Duration::from_millis(20);
/// For messages in transit when time is over.
const LAST_WAIT: Duration = Duration::from_secs(3);

/// From the write to the terminal to the end of the read by a client, over all clients of a route.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Delays {
    pub(crate) median_ms: f64,
    pub(crate) p99_ms: f64,
    /// How long telemetry came.
    pub(crate) took: Duration,
}

/// What a client reports while it listens.
#[derive(Default)]
struct Shared {
    /// Packets are counted from now on.
    counts: AtomicBool,
    ends: AtomicBool,
}

struct Listener {
    packets: Arc<AtomicU64>,
    life: JoinHandle<anyhow::Result<Vec<Instant>>>,
}

pub(crate) fn measure(
    stage: &mut Stage,
    routes: &[Route],
    clients: usize,
    time: Duration,
) -> anyhow::Result<Vec<Delays>> {
    let shared = Arc::new(Shared::default());
    let mut listeners = Vec::new();
    for route in routes {
        for _ in 0..clients {
            let mut peer = stage.peer(route.kind)?;
            peer.say(WATCH)?;
            listeners.push(listen(peer, Arc::clone(&shared)));
        }
    }
    // The first messages, the map above all, arrive before the first packet that counts.
    stage
        .robot
        .live_until(Instant::now() + Duration::from_secs(2), |_| false)?;
    thread::sleep(Duration::from_millis(500));
    shared.counts.store(true, Ordering::SeqCst);
    let began = Instant::now();
    let moments = report(stage, time)?;
    let took = began.elapsed();
    let deadline = Instant::now() + LAST_WAIT;
    let count = moments.len() as u64;
    while Instant::now() < deadline
        && listeners
            .iter()
            .any(|listener| listener.packets.load(Ordering::SeqCst) < count)
    {
        thread::sleep(PERIOD);
    }
    shared.ends.store(true, Ordering::SeqCst);
    let mut heard = Vec::new();
    for listener in listeners {
        let Ok(arrivals) = listener.life.join() else {
            bail!("a client's thread panicked");
        };
        heard.push(arrivals?);
    }
    routes
        .iter()
        .zip(heard.chunks(clients))
        .map(|(route, heard)| delays(&moments, heard, took).with_context(|| route.name))
        .collect()
}

/// Telemetry for a while; gives when each packet went out.
fn report(stage: &mut Stage, time: Duration) -> anyhow::Result<Vec<Instant>> {
    let mut moments = Vec::new();
    let began = Instant::now();
    let mut next = began;
    while began.elapsed() < time {
        moments.push(stage.robot.report()?);
        next += PERIOD;
        while Instant::now() < next {
            stage.robot.listen(next)?;
        }
    }
    Ok(moments)
}

fn listen(mut peer: Peer, shared: Arc<Shared>) -> Listener {
    let packets = Arc::new(AtomicU64::new(0));
    let counted = Arc::clone(&packets);
    let life = thread::spawn(move || {
        let mut arrivals = Vec::new();
        while !shared.ends.load(Ordering::SeqCst) {
            let Some(text) = peer.hear()? else { continue };
            let head = text.as_bytes().get(..HEAD_BYTES).unwrap_or(text.as_bytes());
            let is_state =
                text.starts_with(PACKET) && head.windows(MARK.len()).any(|window| window == MARK.as_bytes());
            if is_state && shared.counts.load(Ordering::SeqCst) {
                arrivals.push(Instant::now());
                counted.fetch_add(1, Ordering::SeqCst);
            }
        }
        Ok(arrivals)
    });
    Listener { packets, life }
}

fn delays(sent: &[Instant], heard: &[Vec<Instant>], took: Duration) -> anyhow::Result<Delays> {
    let mut all_ms = Vec::new();
    for arrivals in heard {
        if arrivals.len() != sent.len() {
            bail!("{} packets of {} arrived", arrivals.len(), sent.len());
        }
        let delays = arrivals.iter().zip(sent);
        all_ms.extend(delays.map(|(arrived, sent)| arrived.duration_since(*sent).as_secs_f64() * 1e3));
    }
    let [median_ms, p99_ms] = ranks(&mut all_ms).context("nothing came")?;
    Ok(Delays {
        median_ms,
        p99_ms,
        took,
    })
}

/// Median and 99th percentile.
pub(crate) fn ranks(all_ms: &mut [f64]) -> Option<[f64; 2]> {
    all_ms.sort_by(f64::total_cmp);
    let rank = |share: f64| all_ms.get((all_ms.len() as f64 * share) as usize).copied();
    Some([rank(0.5)?, rank(0.99)?])
}
