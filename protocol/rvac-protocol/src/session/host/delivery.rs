//! Commands that must arrive: repeated until they are answered, a bounded number of times.

use heapless::Vec;
use rvac_units::Tick;

use crate::message::{Command, Sequence};
use crate::session::COMMANDS_UNDER_WAY;

/// Pause between repeats.
pub(super) const REPEAT_MS: u32 = 100;
/// How often a command is sent before it counts as unanswered.
const SENDS_MAX: u8 = 10;

#[derive(Clone, Copy, Debug)]
struct UnderWay {
    command: Command,
    sequence: Sequence,
    sent: Tick,
    sends: u8,
}

/// The pending commands.
#[derive(Clone, Debug, Default)]
pub(super) struct Delivery {
    commands: Vec<UnderWay, COMMANDS_UNDER_WAY>,
}

impl Delivery {
    pub(super) fn is_full(&self) -> bool {
        self.commands.is_full()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.commands.is_empty()
    }

    /// Notes that a command was sent for the first time.
    pub(super) fn sent(&mut self, command: Command, sequence: Sequence, now: Tick) {
        let under_way = UnderWay {
            command,
            sequence,
            sent: now,
            sends: 1,
        };
        // The sender has checked `is_full` before.
        self.commands.push(under_way).ok();
    }

    /// The command whose repeat is due.
    pub(super) fn take_due(&mut self, now: Tick) -> Option<Command> {
        let due = self
            .commands
            .iter_mut()
            .find(|entry| entry.sends < SENDS_MAX && now.since(entry.sent) >= REPEAT_MS)?;
        due.sends = due.sends.saturating_add(1);
        due.sent = now;
        Some(due.command)
    }

    /// Removes a command that was sent the maximum number of times without an answer.
    pub(super) fn take_hopeless(&mut self, now: Tick) -> Option<Sequence> {
        let index = self
            .commands
            .iter()
            .position(|entry| entry.sends >= SENDS_MAX && now.since(entry.sent) >= REPEAT_MS)?;
        Some(self.commands.remove(index).sequence)
    }

    /// Removes any command, when the session is over.
    pub(super) fn take_any(&mut self) -> Option<Sequence> {
        self.commands.pop().map(|entry| entry.sequence)
    }

    /// Whether this answers a pending command; the round trip, if that was sent only once.
    pub(super) fn answered(&mut self, sequence: Sequence, now: Tick) -> Option<Option<u32>> {
        let index = self
            .commands
            .iter()
            .position(|entry| entry.sequence == sequence)?;
        let entry = self.commands.remove(index);
        Some((entry.sends == 1).then(|| now.since(entry.sent)))
    }
}
