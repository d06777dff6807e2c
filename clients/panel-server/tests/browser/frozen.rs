//! A program that stops in the middle of a word, with all that it has started.

use rustix::process::{Pid, Signal, kill_process};

use crate::processes;

/// Goes on when it is dropped.
#[derive(Debug)]
pub(crate) struct Frozen {
    processes: Vec<Pid>,
}

impl Frozen {
    /// Stops what descends from the process of this number, but not that process.
    pub(crate) fn descendants_of(ancestor: u32) -> Self {
        let number = |process: u32| Pid::from_raw(i32::try_from(process).ok()?);
        let processes = processes::descendants_of(ancestor);
        let processes = processes.into_iter().filter_map(number).collect();
        let frozen = Self { processes };
        frozen.tell(Signal::STOP);
        frozen
    }

    /// How many processes it has stopped.
    pub(crate) fn count(&self) -> usize {
        self.processes.len()
    }

    fn tell(&self, signal: Signal) {
        for process in &self.processes {
            kill_process(*process, signal).ok(); // It may have ended meanwhile.
        }
    }
}

impl Drop for Frozen {
    fn drop(&mut self) {
        self.tell(Signal::CONT);
    }
}
