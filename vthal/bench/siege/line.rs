//! What the line to the robot does.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use vthal_bench::{SyntheticRobot, next_random};

/// Between two pieces of what is no packet.
const PIECE_EVERY: Duration = Duration::from_millis(10);
/// What a line at the wrong speed gave in the case that was reported, in each piece: 2.3 kB a second.
const NOISE_PIECE: usize = 23;
/// As much as a line of 115200 baud can carry.
const FLOOD_PIECE: usize = 115;
const PROMPT: &[u8] = b"\r\nDebian GNU/Linux 13 robot ttyS0\r\n\r\nrobot login: ";

/// A state of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineState {
    /// A robot that reports fifty times a second.
    Sound,
    /// Nothing comes.
    Silent,
    /// The noise of a wrong speed.
    Noise,
    /// As much noise as the line carries.
    Flood,
    /// A login console.
    Console,
    /// The adapter is pulled.
    Pulled,
}

impl LineState {
    /// All of them.
    pub(crate) const ALL: [Self; 6] = [
        Self::Sound,
        Self::Silent,
        Self::Noise,
        Self::Flood,
        Self::Console,
        Self::Pulled,
    ];

    /// For tables.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Sound => "none",
            Self::Silent => "line-silent",
            Self::Noise => "line-noise",
            Self::Flood => "line-flood",
            Self::Console => "line-console",
            Self::Pulled => "line-pulled",
        }
    }

    /// Keeps the line in this state until it is over.
    pub(crate) fn keep(self, mut robot: SyntheticRobot, is_over: &AtomicBool) -> io::Result<()> {
        if self == Self::Pulled {
            drop(robot);
            return Ok(());
        }
        let mut random = 1;
        while !is_over.load(Ordering::Relaxed) {
            let until = Instant::now() + PIECE_EVERY;
            let mut noise =
                |length: usize| -> Vec<u8> { (0..length).map(|_| next_random(&mut random) as u8).collect() };
            match self {
                Self::Sound => {
                    robot.live_until(until, |_| false)?;
                    continue;
                }
                Self::Noise => robot.blurt(&noise(NOISE_PIECE))?,
                Self::Flood => robot.blurt(&noise(FLOOD_PIECE))?,
                Self::Console => robot.blurt(PROMPT)?,
                Self::Silent | Self::Pulled => {}
            }
            std::thread::sleep(until.saturating_duration_since(Instant::now()));
        }
        Ok(())
    }
}
