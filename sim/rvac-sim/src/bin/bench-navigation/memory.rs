//! Memory of this process.

use std::fs;

/// Its peak memory so far, MiB, where the system reports it.
pub(crate) fn peak_mib() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::peak_mib;

    #[test]
    fn a_process_holds_something() {
        assert!(peak_mib().is_some_and(|mib| mib > 0.5));
    }
}
