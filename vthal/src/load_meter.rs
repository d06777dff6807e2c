//! What the daemon takes of its computer: time in its loop, and memory.

use std::fs;
use std::time::Duration;

use rvac_api::DaemonLoad;

/// The system's word about this process: <https://man7.org/linux/man-pages/man5/proc_pid_status.5.html>.
const STATUS: &str = "/proc/self/status";

/// Counts the turns of the loop.
#[derive(Debug, Default)]
pub(crate) struct LoadMeter {
    busy: Duration,
    longest: Duration,
}

impl LoadMeter {
    /// The loop has worked so long at one thing.
    pub(crate) fn count(&mut self, turn: Duration) {
        self.busy = self.busy.saturating_add(turn);
        self.longest = self.longest.max(turn);
    }

    /// What was counted; the longest turn is looked for anew.
    pub(crate) fn reading(&mut self) -> DaemonLoad {
        let longest = std::mem::take(&mut self.longest);
        DaemonLoad {
            memory_bytes: fs::read_to_string(STATUS)
                .ok()
                .and_then(|status| resident_bytes(&status)),
            busy_s: self.busy.as_secs_f64(),
            longest_turn_ms: longest.as_secs_f64() * 1e3,
        }
    }
}

/// Memory that is in use, from a text like `VmRSS:\t   20480 kB`.
fn resident_bytes(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{LoadMeter, resident_bytes};

    #[test]
    fn turns_add_up_and_the_longest_is_of_the_last_reading_only() {
        let mut meter = LoadMeter::default();
        meter.count(Duration::from_millis(3));
        meter.count(Duration::from_millis(1));
        let first = meter.reading();
        assert!((first.busy_s - 0.004).abs() < 1e-9);
        assert!((first.longest_turn_ms - 3.0).abs() < 1e-9);
        meter.count(Duration::from_millis(2));
        let second = meter.reading();
        assert!((second.busy_s - 0.006).abs() < 1e-9);
        assert!((second.longest_turn_ms - 2.0).abs() < 1e-9);
    }

    #[test]
    fn the_memory_is_read_from_the_systems_word() {
        let status = "Name:\tvthal\nVmHWM:\t   30000 kB\nVmRSS:\t   20480 kB\nThreads:\t9\n";
        assert_eq!(resident_bytes(status), Some(20_480 * 1024));
        assert_eq!(resident_bytes("Name:\tvthal\n"), None);
        assert_eq!(resident_bytes("VmRSS:\t18446744073709551615 kB\n"), None);
        assert!(
            LoadMeter::default().reading().memory_bytes > Some(0),
            "this test takes some"
        );
    }
}
