//! What became of a press of a button: on its way, done, or without an answer.

/// An answer that takes longer is missing.
const PATIENCE_MS: f64 = 3_000.0;
/// Numbers of presses, so that they are known from all other requests.
const FIRST_ID: u32 = 100;
const LAST_ID: u32 = 399;

/// A press that was sent, by what it asks for.
#[derive(Clone, Debug, PartialEq)]
struct Sent {
    id: u32,
    verb: String,
    at_ms: f64,
}

/// The presses of this page that wait for an answer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Presses {
    count: u32,
    waiting: Vec<Sent>,
}

impl Presses {
    /// A button was pressed; gives the number for its request.
    pub fn begin(&mut self, verb: &str, now_ms: f64) -> u32 {
        let id = FIRST_ID + self.count % (LAST_ID - FIRST_ID + 1);
        self.count = self.count.wrapping_add(1);
        // A button that is pressed again is asked about once.
        self.waiting.retain(|sent| sent.verb != verb);
        self.waiting.push(Sent {
            id,
            verb: verb.to_owned(),
            at_ms: now_ms,
        });
        id
    }

    /// An answer to the request came; gives what it asked for.
    pub fn end(&mut self, id: u32) -> Option<String> {
        let place = self.waiting.iter().position(|sent| sent.id == id)?;
        Some(self.waiting.remove(place).verb)
    }

    /// Whether a press of this kind waits for its answer.
    #[must_use]
    pub fn is_pending(&self, verb: &str) -> bool {
        self.waiting.iter().any(|sent| sent.verb == verb)
    }

    /// Takes out what waits in vain; gives what it asked for.
    pub fn expire(&mut self, now_ms: f64) -> Option<String> {
        let place = self
            .waiting
            .iter()
            .position(|sent| now_ms - sent.at_ms > PATIENCE_MS)?;
        Some(self.waiting.remove(place).verb)
    }

    /// Whether nothing waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::Presses;

    #[test]
    fn a_press_is_pending_until_its_answer_or_until_patience_ends() {
        let mut presses = Presses::default();
        let start = presses.begin("start", 0.0);
        let stop = presses.begin("stop", 10.0);
        assert_ne!(start, stop);
        assert!(presses.is_pending("start") && presses.is_pending("stop"));
        assert_eq!(presses.end(start).as_deref(), Some("start"));
        assert_eq!(presses.end(start), None, "once");
        assert!(!presses.is_pending("start"));
        assert_eq!(presses.expire(2_900.0), None);
        assert_eq!(presses.expire(3_100.0).as_deref(), Some("stop"));
        assert!(presses.is_empty());
    }

    #[test]
    fn a_second_press_of_the_same_button_waits_once() {
        let mut presses = Presses::default();
        let first = presses.begin("locate", 0.0);
        let second = presses.begin("locate", 1_000.0);
        assert_eq!(presses.end(first), None);
        assert_eq!(presses.end(second).as_deref(), Some("locate"));
    }
}
