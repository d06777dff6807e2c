//! How many requests a second clients get answered, each asking again as soon as it has its answer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};

use crate::peer::Asker;
use crate::stage::{Route, Stage};
use crate::telemetry::ranks;

/// What was measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures {
    /// Over all clients.
    pub(crate) per_s: f64,
    pub(crate) median_ms: f64,
    pub(crate) p99_ms: f64,
}

pub(crate) fn measure(
    stage: &mut Stage,
    route: &Route,
    clients: usize,
    time: Duration,
) -> anyhow::Result<Figures> {
    let askers: Vec<Asker> = (0..clients)
        .map(|_| stage.asker(route.kind))
        .collect::<anyhow::Result<_>>()?;
    let ends = Arc::new(AtomicBool::new(false));
    let began = Instant::now();
    let lives: Vec<_> = askers
        .into_iter()
        .map(|asker| {
            let ends = Arc::clone(&ends);
            thread::spawn(move || ask_until(asker, &ends))
        })
        .collect();
    // A robot that falls silent would be lost meanwhile, and the daemon would do other things.
    stage.robot.live_until(began + time, |_| false)?;
    ends.store(true, Ordering::SeqCst);
    let mut all_ms = Vec::new();
    for life in lives {
        let Ok(answers_ms) = life.join() else {
            bail!("a client's thread panicked");
        };
        all_ms.extend(answers_ms?);
    }
    let per_s = all_ms.len() as f64 / began.elapsed().as_secs_f64();
    let [median_ms, p99_ms] = ranks(&mut all_ms).context("no request was answered")?;
    Ok(Figures {
        per_s,
        median_ms,
        p99_ms,
    })
}

fn ask_until(mut asker: Asker, ends: &AtomicBool) -> anyhow::Result<Vec<f64>> {
    let mut answers_ms = Vec::new();
    while !ends.load(Ordering::SeqCst) {
        let asked = Instant::now();
        asker.ask()?;
        answers_ms.push(asked.elapsed().as_secs_f64() * 1e3);
    }
    Ok(answers_ms)
}
