//! What a process has had of the machine, from /proc.

use std::fs;
use std::io;
use std::time::Duration;

/// What a process has had of the processors so far, over all threads.
#[derive(Clone, Copy, Debug)]
pub struct Processor {
    /// Seconds in which it ran.
    pub ran_s: f64,
    /// Seconds in which it could have run and other programs had the processors.
    pub waited_s: f64,
}

impl Processor {
    /// Of the process of this number.
    ///
    /// # Errors
    /// When the process is gone, or /proc tells no processor times.
    pub fn of(process: u32) -> io::Result<Self> {
        let (mut ran_ns, mut waited_ns) = (0, 0);
        for task in fs::read_dir(format!("/proc/{process}/task"))? {
            let text = fs::read_to_string(task?.path().join("schedstat"))?;
            let mut words = text.split(' ').map_while(|word| word.parse::<u64>().ok());
            let (ran, waited) = words
                .next()
                .zip(words.next())
                .ok_or_else(|| io::Error::other("no processor times in /proc"))?;
            ran_ns += ran;
            waited_ns += waited;
        }
        Ok(Self {
            ran_s: Duration::from_nanos(ran_ns).as_secs_f64(),
            waited_s: Duration::from_nanos(waited_ns).as_secs_f64(),
        })
    }
}

/// Memory of a process that is in RAM, MiB.
///
/// # Errors
/// When the process is gone.
pub fn resident_mib(process: u32) -> io::Result<f64> {
    in_mib(process, "VmRSS:")
}

/// The most that it ever had there, MiB.
///
/// # Errors
/// When the process is gone.
pub fn resident_max_mib(process: u32) -> io::Result<f64> {
    in_mib(process, "VmHWM:")
}

fn in_mib(process: u32, key: &str) -> io::Result<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status"))?;
    let line = status.lines().find_map(|line| line.strip_prefix(key));
    let kib = line
        .and_then(|line| line.trim().strip_suffix(" kB"))
        .and_then(|kib| kib.parse::<f64>().ok());
    Ok(kib.ok_or_else(|| io::Error::other("no memory in /proc"))? / 1024.0)
}
