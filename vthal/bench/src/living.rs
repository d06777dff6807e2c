//! A robot that lives beside the test.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::SyntheticRobot;

/// Looks this often whether it is to end.
const LOOK_EVERY: Duration = Duration::from_millis(200);

/// A robot that sends and answers whatever else the test does, until this is dropped.
#[derive(Debug)]
pub struct LivingRobot {
    ends: Arc<AtomicBool>,
    life: Option<JoinHandle<()>>,
}

impl LivingRobot {
    /// Lets it live.
    pub fn new(mut robot: SyntheticRobot) -> Self {
        let ends = Arc::new(AtomicBool::new(false));
        let told = Arc::clone(&ends);
        let life = thread::spawn(move || {
            while !told.load(Ordering::Relaxed) {
                if let Err(error) = robot.live_until(Instant::now() + LOOK_EVERY, |_| false) {
                    eprintln!("the robot: {error}");
                    return;
                }
            }
        });
        Self {
            ends,
            life: Some(life),
        }
    }
}

impl Drop for LivingRobot {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        if let Some(life) = self.life.take()
            && life.join().is_err()
        {
            eprintln!("the robot's thread panicked");
        }
    }
}
