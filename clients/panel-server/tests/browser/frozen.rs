//! A program that stops in the middle of a word, with all that it has started.

use rustix::process::{Pid, Signal, kill_process};

/// Goes on when it is dropped.
#[derive(Debug)]
pub(crate) struct Frozen {
    processes: Vec<Pid>,
}

impl Frozen {
    /// Stops what descends from the process of this number, but not that process.
    pub(crate) fn descendants_of(ancestor: u32) -> Self {
        let parents = parents();
        let descends = |mut process: u32| {
            while let Some((_, parent)) = parents.iter().find(|(child, _)| *child == process) {
                if *parent == ancestor {
                    return true;
                }
                process = *parent;
            }
            false
        };
        let processes: Vec<Pid> = parents
            .iter()
            .filter(|(process, _)| descends(*process))
            .filter_map(|(process, _)| Pid::from_raw(i32::try_from(*process).ok()?))
            .collect();
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

/// Each process and the one that started it.
fn parents() -> Vec<(u32, u32)> {
    let parent = |process: u32| {
        let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("PPid:"))?;
        Some((process, line.trim().parse().ok()?))
    };
    let entries = std::fs::read_dir("/proc").unwrap().flatten();
    let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    numbers.filter_map(parent).collect()
}
