//! Seconds of processor that a stage has taken: on a machine that also does other things they tell more than the clock.

use std::time::Duration;

/// The kernel counts times for programs in hundredths of a second, on every processor that Linux runs on.
const TICK: Duration = Duration::from_millis(10);

/// All processor time of programs that this one has started, and of those that they started, once each has ended; zero where the
/// kernel does not tell.
pub(crate) fn of_ended_children() -> Duration {
    std::fs::read_to_string("/proc/self/stat")
        .ok()
        .and_then(|text| children_ticks(&text))
        .map_or(Duration::ZERO, |ticks| TICK.saturating_mul(ticks))
}

/// The times of ended children, for the program and for the kernel in its name, are the fields 16 and 17 of `proc_pid_stat(5)`. The
/// second field is a name in brackets, which may hold spaces: those behind it begin with the third.
fn children_ticks(text: &str) -> Option<u32> {
    let (_, fields) = text.rsplit_once(')')?;
    let mut fields = fields.split_whitespace().skip(16 - 3);
    let mut next = || fields.next()?.parse::<u32>().ok();
    Some(next()? + next()?)
}

#[cfg(test)]
mod tests {
    use super::children_ticks;

    #[test]
    fn times_of_children_are_found_behind_any_name() {
        let text = "7 (a) b) S 1 7 7 0 -1 4194304 1 2 3 4 50 60 700 80 20 0 1 0 9";
        assert_eq!(children_ticks(text), Some(780));
        assert_eq!(children_ticks("7 (a) S 1"), None);
    }
}
