//! Commands that the robot refused or did not answer, for the log: one line when it begins, and one with the number of
//! those that followed when it is over.

/// Failures of a kind that come no farther apart than this belong together: no line of the log comes twice a minute.
const APART_US: u64 = 60_000_000;
/// Kinds that are told apart at a time; of more, each failure is told.
const KINDS_MAX: usize = 8;

/// Failures that were told and go on, or have just ended.
#[derive(Debug, Default)]
pub(crate) struct CommandFailures {
    series: Vec<Series>,
}

/// Failures of one kind.
#[derive(Debug)]
struct Series {
    kind: &'static str,
    newest_us: u64,
    /// Those that were not told.
    untold: u32,
}

impl CommandFailures {
    /// Whether a failure of this kind is told on a line of its own.
    pub(crate) fn is_news(&mut self, now_us: u64, kind: &'static str) -> bool {
        if let Some(series) = self.series.iter_mut().find(|series| series.kind == kind) {
            series.newest_us = now_us;
            series.untold += 1;
            return false;
        }
        if self.series.len() < KINDS_MAX {
            self.series.push(Series {
                kind,
                newest_us: now_us,
                untold: 0,
            });
        }
        true
    }

    /// The lines about series that are over.
    pub(crate) fn ended(&mut self, now_us: u64) -> Vec<String> {
        let is_over = |series: &mut Series| now_us.saturating_sub(series.newest_us) > APART_US;
        let over = self.series.extract_if(.., is_over);
        over.filter(|series| series.untold > 0)
            .map(|series| {
                let (untold, kind) = (series.untold, series.kind);
                let commands = if untold == 1 { "command" } else { "commands" };
                format!("{untold} more {commands} failed in the same way: {kind}")
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{APART_US, CommandFailures};

    #[test]
    fn a_series_is_told_when_it_begins_and_counted_when_it_is_over() {
        let mut failures = CommandFailures::default();
        let told = (0..433).filter(|step| failures.is_news(step * 30_000, "stale"));
        assert_eq!(told.count(), 1);
        let end_us = 432 * 30_000;
        assert!(failures.is_news(end_us, "busy"));
        assert!(failures.ended(end_us + APART_US).is_empty());
        assert_eq!(
            failures.ended(end_us + APART_US + 1),
            ["432 more commands failed in the same way: stale"]
        );
        assert!(failures.is_news(end_us + 2 * APART_US, "stale"));
    }
}
