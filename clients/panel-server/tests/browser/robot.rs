//! Where the simulated robot really is, beside everything that is tested.

use std::io::{BufRead, BufReader};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use rvac_api::{Pose, SEPARATOR, Update};

/// Poses closer than this are the same: the wheels stand.
const STILL_M: f64 = 0.0005;
const STILL_RAD: f64 = 0.002;

/// Hears the true poses, ten a second.
#[derive(Debug)]
pub(crate) struct Witness {
    poses: Receiver<(Instant, Pose)>,
}

impl Witness {
    pub(crate) fn watch(socket: &Path) -> Self {
        let stream = UnixStream::connect(socket).unwrap();
        let (sender, poses) = channel();
        std::thread::spawn(move || {
            for message in BufReader::new(stream).split(SEPARATOR) {
                let Ok(message) = message else { return };
                if let Ok(Update::SimulatedTruth(truth)) = serde_json::from_slice(&message)
                    && sender.send((Instant::now(), truth.pose)).is_err()
                {
                    return;
                }
            }
        });
        Self { poses }
    }

    /// Whether two poses differ before the patience ends.
    pub(crate) fn moves_within(&self, patience: Duration) -> bool {
        let deadline = Instant::now() + patience;
        let mut last = None;
        while let Some((_, pose)) = self.next(deadline) {
            if last.replace(pose).is_some_and(|last| !same(last, pose)) {
                return true;
            }
        }
        false
    }

    /// The time of the first of three equal poses; none when there are none before the patience ends.
    pub(crate) fn stands_within(&self, patience: Duration) -> Option<Instant> {
        let deadline = Instant::now() + patience;
        while self.poses.try_recv().is_ok() {}
        let mut still: Vec<(Instant, Pose)> = Vec::new();
        while let Some((when, pose)) = self.next(deadline) {
            if still.last().is_some_and(|(_, last)| !same(*last, pose)) {
                still.clear();
            }
            still.push((when, pose));
            if still.len() == 3 {
                return still.first().map(|(when, _)| *when);
            }
        }
        None
    }

    fn next(&self, deadline: Instant) -> Option<(Instant, Pose)> {
        match self
            .poses
            .recv_timeout(deadline.saturating_duration_since(Instant::now()))
        {
            Ok(news) => Some(news),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => panic!("the simulator is gone"),
        }
    }
}

fn same(a: Pose, b: Pose) -> bool {
    (a.x - b.x).hypot(a.y - b.y) < STILL_M && (a.heading - b.heading).abs() < STILL_RAD
}
