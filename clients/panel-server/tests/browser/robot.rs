//! Where the simulated robot really is, beside everything that is tested.
#![allow(
    dead_code,
    reason = "each of the tests that share this file needs a part of it"
)]

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use rvac_api::{Pose, SEPARATOR, Update};

/// Poses closer than this are the same: the wheels do not turn.
const STILL_M: f64 = 0.0005;
const STILL_RAD: f64 = 0.002;
/// The wheels have stopped when the robot is at the same pose for so long: two of the poses that the simulator sends by itself.
const STILL_FOR: Duration = Duration::from_millis(190);

/// Period of polling the robot's pose during a measurement.
const CLOSE_LOOK: Duration = Duration::from_millis(10);

/// Hears the true poses, ten a second, or asks for more.
#[derive(Debug)]
pub(crate) struct Observer {
    poses: Receiver<(Instant, Pose)>,
}

impl Observer {
    pub(crate) fn watch(socket: &Path) -> Self {
        Self::hear(UnixStream::connect(socket).unwrap())
    }

    fn hear(stream: UnixStream) -> Self {
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

    /// Looks a hundred times a second, for what must be known to the hundredth of a second.
    pub(crate) fn watch_closely(socket: &Path) -> Self {
        let mut stream = UnixStream::connect(socket).unwrap();
        let witness = Self::hear(stream.try_clone().unwrap());
        std::thread::spawn(move || {
            while stream.write_all(b"{\"c\":\"truth\"}\x1f").is_ok() {
                std::thread::sleep(CLOSE_LOOK);
            }
        });
        witness
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

    /// The time of the first of the equal poses of a robot that stands; none when it does not before the patience ends.
    pub(crate) fn stands_within(&self, patience: Duration) -> Option<Instant> {
        let deadline = Instant::now() + patience;
        while self.poses.try_recv().is_ok() {}
        let mut first: Option<(Instant, Pose)> = None;
        while let Some((when, pose)) = self.next(deadline) {
            match first.filter(|(_, stood)| same(*stood, pose)) {
                Some((since, _)) if when.duration_since(since) >= STILL_FOR => return Some(since),
                Some(_) => {}
                None => first = Some((when, pose)),
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
