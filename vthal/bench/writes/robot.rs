//! The robot that daemons find at their terminal.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use rvac_protocol::message::BinaryKinds;
use vthal_bench::SyntheticRobot;

/// A robot on its dock, which outlives the daemons.
pub(crate) struct Robot {
    ends: Arc<AtomicBool>,
    life: Option<JoinHandle<()>>,
}

impl Robot {
    pub(crate) fn switch_on(link: &Path) -> anyhow::Result<Self> {
        let ends = Arc::new(AtomicBool::new(false));
        let mut robot = SyntheticRobot::switch_on(link, BinaryKinds::ALL, 1)?;
        robot.dock();
        let told = Arc::clone(&ends);
        let life = thread::spawn(move || {
            while !told.load(Ordering::Relaxed) {
                let deadline = Instant::now() + Duration::from_millis(200);
                if let Err(error) = robot.live_until(deadline, |_| false) {
                    eprintln!("bench-writes: the robot: {error}");
                    return;
                }
            }
        });
        Ok(Self {
            ends,
            life: Some(life),
        })
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        if let Some(life) = self.life.take()
            && life.join().is_err()
        {
            eprintln!("bench-writes: the robot's thread panicked");
        }
    }
}
