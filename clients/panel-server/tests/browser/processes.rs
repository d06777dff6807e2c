//! The processes of this computer, as Linux lists them.

/// What descends from the process of this number, without that process.
pub(crate) fn descendants_of(ancestor: u32) -> Vec<u32> {
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
    let all = parents.iter().map(|(process, _)| *process);
    all.filter(|process| descends(*process)).collect()
}

/// A line of the kernel's status of a process.
fn told(process: u32, name: &str) -> Option<String> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    Some(line.trim_start_matches(':').trim().to_owned())
}

/// Memory that a process takes now, KiB; nothing when it has ended.
pub(crate) fn memory_kib(process: u32) -> u64 {
    let memory = told(process, "VmRSS").and_then(|line| line.split(' ').next()?.parse().ok());
    memory.unwrap_or(0)
}

/// Whether a word is on its command line.
pub(crate) fn is_called_with(process: u32, word: &str) -> bool {
    let line = std::fs::read(format!("/proc/{process}/cmdline")).unwrap_or_default();
    String::from_utf8_lossy(&line).contains(word)
}

/// Each process and the one that started it.
fn parents() -> Vec<(u32, u32)> {
    let entries = std::fs::read_dir("/proc").unwrap().flatten();
    let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    numbers
        .filter_map(|process| Some((process, told(process, "PPid")?.parse().ok()?)))
        .collect()
}
