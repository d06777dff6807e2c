//! Warnings and errors of the daemon's own threads reach clients too, not only the log file: a layer of the log collects them, and the
//! event loop hands them to the core once a second.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::{Duration, Instant};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::Context;

use rvac_api::LogLevel;

/// Target of lines that come from the core and are known to clients already.
pub(crate) const CORE_LINES: &str = "core";
/// Lines that wait at most; what comes meanwhile stands in the log file alone.
const WAITING_MAX: usize = 64;
/// The same line is handed on again after this time.
const SAME_AFTER: Duration = Duration::from_secs(60);
/// So many different lines are remembered for that.
const REMEMBERED_MAX: usize = 32;

/// A line of the shell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ToldLine {
    pub(crate) level: LogLevel,
    pub(crate) text: String,
}

/// A layer, and where its lines come out.
pub(crate) fn told_lines() -> (TellingLayer, ToldLines) {
    let (sender, receiver) = sync_channel(WAITING_MAX);
    let lines = ToldLines {
        receiver,
        told: VecDeque::new(),
    };
    (TellingLayer { sender }, lines)
}

/// Collects warnings and errors of the shell.
pub(crate) struct TellingLayer {
    sender: SyncSender<ToldLine>,
}

/// The event loop's end.
#[derive(Debug)]
pub(crate) struct ToldLines {
    receiver: Receiver<ToldLine>,
    told: VecDeque<(Instant, ToldLine)>,
}

impl ToldLines {
    /// What is new.
    pub(crate) fn take(&mut self) -> Vec<ToldLine> {
        let now = Instant::now();
        self.told.retain(|(at, _)| now.duration_since(*at) < SAME_AFTER);
        let mut new = Vec::new();
        for line in self.receiver.try_iter().take(WAITING_MAX) {
            if self.told.iter().any(|(_, told)| *told == line) {
                continue;
            }
            if self.told.len() >= REMEMBERED_MAX {
                self.told.pop_front();
            }
            self.told.push_back((now, line.clone()));
            new.push(line);
        }
        new
    }
}

impl<S: Subscriber> Layer<S> for TellingLayer {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let level = match *event.metadata().level() {
            Level::ERROR => LogLevel::Error,
            Level::WARN => LogLevel::Warn,
            _ => return,
        };
        if event.metadata().target() == CORE_LINES {
            return;
        }
        let mut words = Words::default();
        event.record(&mut words);
        // A queue that is full loses lines for clients; the log file has them.
        self.sender
            .try_send(ToldLine {
                level,
                text: words.sentence(),
            })
            .ok();
    }
}

/// The part and the text of a line.
#[derive(Default)]
struct Words {
    part: Option<String>,
    text: String,
}

impl Words {
    fn sentence(self) -> String {
        match self.part {
            Some(part) if part != "vthal" => format!("{part}: {}", self.text),
            _ => self.text,
        }
    }
}

impl Visit for Words {
    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == "part" {
            self.part = Some(value.to_owned());
        }
    }

    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        if field.name() == "message" {
            self.text = format!("{value:?}");
        }
    }
}

#[cfg(test)]
mod tests {
    use tracing_subscriber::layer::SubscriberExt;

    use super::{CORE_LINES, LogLevel, ToldLine, told_lines};

    #[test]
    fn warnings_of_the_shell_are_told_once_a_minute_and_those_of_the_core_are_not() {
        let (layer, mut lines) = told_lines();
        tracing::subscriber::with_default(tracing_subscriber::registry().with(layer), || {
            for _ in 0..3 {
                tracing::warn!(part = "imu", "no heading: {}", "gone");
            }
            tracing::error!("the disk is full");
            tracing::info!("nothing new");
            tracing::warn!(target: CORE_LINES, part = "link", "known already");
        });
        let told = [
            (LogLevel::Warn, "imu: no heading: gone"),
            (LogLevel::Error, "the disk is full"),
        ]
        .map(|(level, text)| ToldLine {
            level,
            text: text.to_owned(),
        });
        assert_eq!(lines.take(), told);
        assert_eq!(lines.take(), []);
    }
}
