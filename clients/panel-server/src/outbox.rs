//! What waits to be sent to one browser: bounded, newest wins for readings, nothing lost of the rest.

use std::collections::VecDeque;

use serde::Deserialize;

/// Messages that may wait. At some hundred a second this is a stall of seconds.
const WAITING_MAX: usize = 1024;

/// Bytes that may wait. One large map is about 2 MiB.
const WAITING_BYTES_MAX: usize = 16 << 20;

/// The browser takes its messages too slowly and must be dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stalled;

/// Readings of which only the newest matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reading {
    Pose,
    Truth,
    Device,
    Home,
    Estimate,
    PlannedPath,
    Inputs,
}

impl Reading {
    fn of(text: &str) -> Option<Self> {
        #[derive(Deserialize)]
        struct Kind<'t> {
            #[serde(borrow)]
            e: &'t str,
        }
        match serde_json::from_str::<Kind<'_>>(text).ok()?.e {
            "pose" => Some(Self::Pose),
            "simulated-truth" => Some(Self::Truth),
            "device" => Some(Self::Device),
            "home" => Some(Self::Home),
            "estimate" => Some(Self::Estimate),
            "way" => Some(Self::PlannedPath),
            "inputs" => Some(Self::Inputs),
            _ => None,
        }
    }
}

/// The queue. It does no I/O.
#[derive(Debug, Default)]
pub struct Outbox {
    /// In the order in which they go out, as in the daemon's own queues: the last view of a topic ends what was asked for before it.
    waiting: VecDeque<(Option<Reading>, String)>,
    /// Those of them that must not be lost.
    lossless: usize,
    lossless_bytes: usize,
}

impl Outbox {
    /// Adds one message in its text form. A newer pose, truth or device table takes the place of one that still waits.
    ///
    /// # Errors
    /// [`Stalled`] when too much waits already; the message is not added.
    pub fn push(&mut self, text: String) -> Result<(), Stalled> {
        let reading = Reading::of(&text);
        if reading.is_some() {
            match self.waiting.iter_mut().find(|(other, _)| *other == reading) {
                Some((_, older)) => *older = text,
                None => self.waiting.push_back((reading, text)),
            }
            return Ok(());
        }
        if self.lossless >= WAITING_MAX || self.lossless_bytes + text.len() > WAITING_BYTES_MAX {
            return Err(Stalled);
        }
        self.lossless += 1;
        self.lossless_bytes += text.len();
        self.waiting.push_back((None, text));
        Ok(())
    }

    /// Takes the next message.
    pub fn pop(&mut self) -> Option<String> {
        let (reading, text) = self.waiting.pop_front()?;
        if reading.is_none() {
            self.lossless -= 1;
            self.lossless_bytes -= text.len();
        }
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::{Outbox, Stalled, WAITING_BYTES_MAX, WAITING_MAX};

    #[test]
    fn newest_reading_wins_in_the_place_of_the_older_one_and_the_order_is_kept() {
        let mut outbox = Outbox::default();
        for text in [
            r#"{"e":"pose","x":1}"#,
            r#"{"e":"log","number":1}"#,
            r#"{"e":"pose","x":2}"#,
            r#"{"e":"log","number":2}"#,
            r#"{"e":"device","n":1}"#,
            r#"{"e":"simulated-truth","n":1}"#,
            r#"{"e":"device","n":2}"#,
        ] {
            outbox.push(text.to_owned()).unwrap();
        }
        let sent: Vec<_> = std::iter::from_fn(|| outbox.pop()).collect();
        assert_eq!(
            sent,
            [
                r#"{"e":"pose","x":2}"#,
                r#"{"e":"log","number":1}"#,
                r#"{"e":"log","number":2}"#,
                r#"{"e":"device","n":2}"#,
                r#"{"e":"simulated-truth","n":1}"#,
            ]
        );
    }

    #[test]
    fn a_stalled_browser_is_noticed_by_count_but_never_by_readings() {
        let mut outbox = Outbox::default();
        for _ in 0..10 * WAITING_MAX {
            outbox.push(r#"{"e":"pose"}"#.to_owned()).unwrap();
        }
        for _ in 0..WAITING_MAX {
            outbox.push(r#"{"e":"log"}"#.to_owned()).unwrap();
        }
        assert_eq!(outbox.push(r#"{"e":"log"}"#.to_owned()), Err(Stalled));
        for sent in [r#"{"e":"pose"}"#, r#"{"e":"log"}"#] {
            assert_eq!(outbox.pop().as_deref(), Some(sent));
        }
        assert_eq!(outbox.push(r#"{"e":"log"}"#.to_owned()), Ok(()));
    }

    #[test]
    fn a_stalled_browser_is_noticed_by_bytes() {
        let mut outbox = Outbox::default();
        outbox.push("x".repeat(WAITING_BYTES_MAX)).unwrap();
        assert_eq!(outbox.push("y".to_owned()), Err(Stalled));
        outbox.pop().unwrap();
        assert_eq!(outbox.push("y".to_owned()), Ok(()));
    }
}
