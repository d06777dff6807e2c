//! What waits to be sent to one browser: bounded, newest wins for readings, nothing lost of the rest.
//!
//! To a page that asked for it long updates go in pieces, and whatever is no part of the map overtakes those of the map.

use std::collections::VecDeque;

use rvac_api::Update;
use serde::Deserialize;

/// Messages that may wait. At some hundred a second this is a stall of seconds.
const WAITING_MAX: usize = 1024;

/// Bytes that may wait. One large map is about 2 MiB.
const WAITING_BYTES_MAX: usize = 16 << 20;

/// Bytes of a piece of a long update: a tenth of a second at 640 kbit/s.
const PIECE_BYTES: usize = 8 << 10;

/// Numbers of the lanes of pieces.
const QUICK: u8 = 0;
const BULKY: u8 = 1;

/// The browser takes its messages too slowly and must be dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stalled;

/// What must be known of an update to send it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Reading(Reading),
    /// The map and its changes, which keep their order.
    Map,
    Other,
}

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
    Heartbeat,
    Software,
}

impl Kind {
    fn of(text: &str) -> Self {
        #[derive(Deserialize)]
        struct Name<'t> {
            #[serde(borrow)]
            e: &'t str,
        }
        let Ok(Name { e: name }) = serde_json::from_str::<Name<'_>>(text) else {
            return Self::Other;
        };
        Self::Reading(match name {
            "pose" => Reading::Pose,
            "simulated-truth" => Reading::Truth,
            "device" => Reading::Device,
            "home" => Reading::Home,
            "estimate" => Reading::Estimate,
            "way" => Reading::PlannedPath,
            "inputs" => Reading::Inputs,
            "heartbeat" => Reading::Heartbeat,
            "software-update" => Reading::Software,
            "map" | "map-delta" | "simulated-plan" => return Self::Map,
            _ => return Self::Other,
        })
    }
}

/// An update of which some pieces are sent.
#[derive(Debug)]
struct Begun {
    text: String,
    sent: usize,
}

impl Begun {
    /// The next piece, and whether it is the last one.
    fn next(&mut self, lane: u8) -> (String, bool) {
        let mut end = self.text.len().min(self.sent + PIECE_BYTES);
        while !self.text.is_char_boundary(end) {
            end += 1;
        }
        let text = self.text.get(self.sent..end).unwrap_or_default().to_owned();
        self.sent = end;
        let last = end == self.text.len();
        let piece = serde_json::to_string(&Update::Piece { lane, last, text });
        (piece.expect("plain types without maps can be written"), last)
    }
}

/// The queue. It does no I/O.
#[derive(Debug, Default)]
pub struct Outbox {
    /// In the order in which they go out, as in the daemon's own queues: the last view of a topic ends what was asked for before it.
    waiting: VecDeque<(Option<Reading>, String)>,
    /// Parts of the map, where they are overtaken.
    bulky: VecDeque<String>,
    /// Those of both that must not be lost.
    lossless: usize,
    lossless_bytes: usize,
    /// Long updates go in pieces.
    in_pieces: bool,
    begun: [Option<Begun>; 2],
}

impl Outbox {
    /// One that cuts long updates.
    #[must_use]
    pub fn in_pieces() -> Self {
        Self {
            in_pieces: true,
            ..Self::default()
        }
    }

    /// Adds one message in its text form. A newer pose, truth or device table takes the place of one that still waits.
    ///
    /// # Errors
    /// [`Stalled`] when too much waits already; the message is not added.
    pub fn push(&mut self, text: String) -> Result<(), Stalled> {
        let kind = Kind::of(&text);
        if let Kind::Reading(reading) = kind {
            let same = |(other, _): &&mut (Option<Reading>, String)| *other == Some(reading);
            match self.waiting.iter_mut().find(same) {
                Some((_, older)) => *older = text,
                None => self.waiting.push_back((Some(reading), text)),
            }
            return Ok(());
        }
        if self.lossless >= WAITING_MAX || self.lossless_bytes + text.len() > WAITING_BYTES_MAX {
            return Err(Stalled);
        }
        self.lossless += 1;
        self.lossless_bytes += text.len();
        if self.in_pieces && kind == Kind::Map {
            self.bulky.push_back(text);
        } else {
            self.waiting.push_back((None, text));
        }
        Ok(())
    }

    /// Takes the next message, or the next piece of one.
    pub fn pop(&mut self) -> Option<String> {
        if !self.in_pieces {
            return self.pop_quick();
        }
        if let Some(piece) = self.piece(QUICK) {
            return Some(piece);
        }
        if let Some(text) = self.pop_quick() {
            return Some(self.cut(QUICK, text));
        }
        if let Some(piece) = self.piece(BULKY) {
            return Some(piece);
        }
        let text = self.bulky.pop_front()?;
        self.forget(text.len());
        Some(self.cut(BULKY, text))
    }

    fn pop_quick(&mut self) -> Option<String> {
        let (reading, text) = self.waiting.pop_front()?;
        if reading.is_none() {
            self.forget(text.len());
        }
        Some(text)
    }

    fn forget(&mut self, bytes: usize) {
        self.lossless -= 1;
        self.lossless_bytes -= bytes;
    }

    /// The message, if it is short, or else its first piece.
    fn cut(&mut self, lane: u8, text: String) -> String {
        if text.len() <= PIECE_BYTES {
            return text;
        }
        let mut begun = Begun { text, sent: 0 };
        let (piece, _) = begun.next(lane);
        if let Some(place) = self.begun.get_mut(usize::from(lane)) {
            *place = Some(begun);
        }
        piece
    }

    /// The next piece of what was begun in the lane.
    fn piece(&mut self, lane: u8) -> Option<String> {
        let place = self.begun.get_mut(usize::from(lane))?;
        let (piece, last) = place.as_mut()?.next(lane);
        if last {
            *place = None;
        }
        Some(piece)
    }
}

#[cfg(test)]
mod tests {
    use super::{Outbox, Stalled, WAITING_BYTES_MAX, WAITING_MAX};
    use rvac_api::Update;

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
    fn a_long_map_comes_in_pieces_and_an_answer_overtakes_it() {
        let mut outbox = Outbox::in_pieces();
        let map = format!(r#"{{"e":"map","cells":"{}"}}"#, "ü".repeat(30_000));
        let delta = r#"{"e":"map-delta","n":1}"#;
        let done = r#"{"e":"done","id":1}"#;
        outbox.push(map.clone()).unwrap();
        outbox.push(delta.to_owned()).unwrap();
        let mut joined = String::new();
        let mut join = |text: String| {
            let Ok(Update::Piece { text, last, .. }) = serde_json::from_str(&text) else {
                panic!("{text}");
            };
            joined.push_str(&text);
            last
        };
        assert!(!join(outbox.pop().unwrap()));
        outbox.push(done.to_owned()).unwrap();
        assert_eq!(outbox.pop().as_deref(), Some(done));
        while !join(outbox.pop().unwrap()) {}
        assert_eq!(joined, map);
        assert_eq!(
            outbox.pop().as_deref(),
            Some(delta),
            "what follows the map stays behind it"
        );
        assert_eq!(outbox.pop(), None);
        assert_eq!(outbox.lossless_bytes, 0);
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
