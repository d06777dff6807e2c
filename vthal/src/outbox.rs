//! What waits for one client: bounded, so that a stalled client costs a known amount of memory and does not delay others.

use std::collections::VecDeque;
use std::io::{self, IoSlice};
use std::rc::Rc;

use rvac_api::Update;

/// Messages that may wait: twenty seconds of telemetry.
const MESSAGES_MAX: usize = 1024;
/// Bytes that may wait.
const BYTES_MAX: usize = 4 << 20;
/// Messages given to the system in one call.
const SLICES_MAX: usize = 64;

/// How a message behaves when it must wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// A view of the present: a newer one of the same kind takes its place.
    Newest(StateKind),
    /// Part of a story: it waits for its turn.
    Lossless,
}

/// Kinds of state of which only the newest counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StateKind {
    /// [`Update::Status`]
    Status,
    /// [`Update::Pose`]
    Pose,
    /// [`Update::Device`]
    Device,
    /// [`Update::Home`]
    Home,
    /// [`Update::Estimate`]
    Estimate,
    /// [`Update::PlannedPath`]
    PlannedPath,
    /// [`Update::Inputs`]
    Inputs,
}

impl Class {
    /// The class of an update.
    #[must_use]
    pub(crate) fn of(update: &Update) -> Self {
        match update {
            Update::Status(_) => Self::Newest(StateKind::Status),
            Update::Pose(_) => Self::Newest(StateKind::Pose),
            Update::Device(_) => Self::Newest(StateKind::Device),
            Update::Home(_) => Self::Newest(StateKind::Home),
            Update::Estimate(_) => Self::Newest(StateKind::Estimate),
            Update::PlannedPath(_) => Self::Newest(StateKind::PlannedPath),
            Update::Inputs { .. } => Self::Newest(StateKind::Inputs),
            _ => Self::Lossless,
        }
    }
}

/// More waits than a client may have waiting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Overflow;

/// Messages that wait for one client. Each is shared with the other clients that get it.
#[derive(Debug, Default)]
pub(crate) struct Outbox {
    waiting: VecDeque<(Class, Rc<[u8]>)>,
    /// Bytes of the first message that are sent already.
    sent_of_first: usize,
    bytes: usize,
}

impl Outbox {
    /// Whether nothing waits.
    #[must_use]
    pub(crate) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Adds a message, separator included.
    ///
    /// # Errors
    /// [`Overflow`] when too much waits already; the message is not added.
    pub(crate) fn push(&mut self, class: Class, message: Rc<[u8]>) -> Result<(), Overflow> {
        if let Class::Newest(_) = class {
            let first_whole = usize::from(self.sent_of_first > 0);
            let older = self
                .waiting
                .iter_mut()
                .skip(first_whole)
                .find(|(other, _)| *other == class);
            if let Some((_, bytes)) = older {
                self.bytes = self.bytes + message.len() - bytes.len();
                *bytes = message;
                return Ok(());
            }
        }
        if self.waiting.len() >= MESSAGES_MAX || self.bytes + message.len() > BYTES_MAX {
            return Err(Overflow);
        }
        self.bytes += message.len();
        self.waiting.push_back((class, message));
        Ok(())
    }

    /// Forgets all that is not partly sent and puts `message` there instead.
    pub(crate) fn replace_all(&mut self, message: Rc<[u8]>) {
        let kept = usize::from(self.sent_of_first > 0);
        self.waiting.truncate(kept);
        self.waiting.push_back((Class::Lossless, message));
        self.bytes = self.waiting.iter().map(|(_, bytes)| bytes.len()).sum();
    }

    /// Writes as much as `write` takes. `write` gets slices in order and returns the number of bytes it took.
    ///
    /// # Errors
    /// The first error of `write`, `WouldBlock` included.
    pub(crate) fn flush(
        &mut self,
        mut write: impl FnMut(&[IoSlice<'_>]) -> io::Result<usize>,
    ) -> io::Result<()> {
        while !self.waiting.is_empty() {
            let mut slices = [IoSlice::new(&[]); SLICES_MAX];
            let mut skip = self.sent_of_first;
            let mut count = 0;
            for (slice, (_, bytes)) in slices.iter_mut().zip(&self.waiting) {
                *slice = IoSlice::new(bytes.get(skip..).unwrap_or_default());
                skip = 0;
                count += 1;
            }
            let taken = write(slices.get(..count).unwrap_or_default())?;
            if taken == 0 {
                return Err(io::ErrorKind::WriteZero.into());
            }
            self.consume(taken);
        }
        Ok(())
    }

    fn consume(&mut self, taken: usize) {
        self.sent_of_first += taken;
        while let Some((_, first)) = self.waiting.front() {
            if self.sent_of_first < first.len() {
                break;
            }
            self.sent_of_first -= first.len();
            self.bytes -= first.len();
            self.waiting.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io;
    use std::rc::Rc;

    use super::{BYTES_MAX, Class, MESSAGES_MAX, Outbox, Overflow, StateKind};

    fn message(text: &str) -> Rc<[u8]> {
        Rc::from(text.as_bytes())
    }

    fn drain(outbox: &mut Outbox, chunk: usize) -> String {
        let mut all = Vec::new();
        outbox
            .flush(|slices| {
                let joined: Vec<u8> = slices.iter().flat_map(|slice| slice.iter().copied()).collect();
                let taken = joined.len().min(chunk);
                all.extend_from_slice(&joined[..taken]);
                Ok(taken)
            })
            .expect("never blocks");
        String::from_utf8(all).expect("text")
    }

    #[test]
    fn the_newest_state_takes_the_place_of_the_older_and_edges_stay() {
        let mut outbox = Outbox::default();
        let pose = Class::Newest(StateKind::Pose);
        outbox.push(pose, message("a1")).expect("fits");
        outbox.push(Class::Lossless, message("x")).expect("fits");
        outbox.push(pose, message("a22")).expect("fits");
        outbox.push(Class::Lossless, message("y")).expect("fits");
        assert_eq!(drain(&mut outbox, 2), "a22xy");
        assert!(outbox.is_empty());
        assert_eq!(outbox.bytes, 0);
    }

    #[test]
    fn a_partly_sent_message_is_never_replaced() {
        let mut outbox = Outbox::default();
        let pose = Class::Newest(StateKind::Pose);
        outbox.push(pose, message("abc")).expect("fits");
        let mut first = true;
        let blocked = outbox.flush(|_| {
            if core::mem::take(&mut first) {
                Ok(1)
            } else {
                Err(io::ErrorKind::WouldBlock.into())
            }
        });
        assert_eq!(blocked.expect_err("blocks").kind(), io::ErrorKind::WouldBlock);
        outbox.push(pose, message("def")).expect("fits");
        outbox.replace_all(message("end"));
        assert_eq!(drain(&mut outbox, 100), "bcend");
    }

    #[test]
    fn both_bounds_hold() {
        let mut outbox = Outbox::default();
        for _ in 0..MESSAGES_MAX {
            outbox.push(Class::Lossless, message("m")).expect("fits");
        }
        assert_eq!(outbox.push(Class::Lossless, message("m")), Err(Overflow));
        let mut outbox = Outbox::default();
        assert_eq!(
            outbox.push(Class::Lossless, vec![0; BYTES_MAX + 1].into()),
            Err(Overflow)
        );
    }
}
