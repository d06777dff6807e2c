//! How current what the page shows is, and updates that come in pieces.

/// What is older than this is not current.
const CURRENT_MS: f64 = 3_000.0;
/// A connection that is silent for so long is given up and made again.
const GIVE_UP_MS: f64 = 9_000.0;

/// Whether what the page shows is true now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Currency {
    /// It is.
    #[default]
    Current,
    /// Nothing was heard for so many whole seconds.
    Silent(u32),
    /// There is no connection, and there was none for a while.
    Away,
}

/// Notes when the page heard something last.
#[derive(Clone, Copy, Debug, Default)]
pub struct News {
    /// When the server was heard last.
    heard_ms: Option<f64>,
    /// Since when the daemon behind it says nothing.
    daemon_ms: Option<f64>,
    is_open: bool,
}

impl News {
    /// The connection is open.
    pub const fn on_open(&mut self, now_ms: f64) {
        self.is_open = true;
        self.heard_ms = Some(now_ms);
        self.daemon_ms = None;
    }

    /// The connection is lost.
    pub const fn on_close(&mut self) {
        self.is_open = false;
    }

    /// Something came.
    pub const fn on_heard(&mut self, now_ms: f64) {
        self.heard_ms = Some(now_ms);
    }

    /// The server is there, and has heard nothing from the daemon for so long; `None` = it has no connection to it, and has said so.
    pub fn on_heartbeat(&mut self, now_ms: f64, silent_ms: Option<u64>) {
        self.daemon_ms = silent_ms.map(|silent_ms| now_ms - silent_ms as f64);
    }

    /// How current things are.
    #[must_use]
    pub fn currency(&self, now_ms: f64) -> Currency {
        let Some(heard_ms) = self.heard_ms else {
            return Currency::Away;
        };
        let oldest_ms = self
            .daemon_ms
            .map_or(heard_ms, |daemon_ms| daemon_ms.min(heard_ms));
        let silent_ms = now_ms - oldest_ms;
        if silent_ms < CURRENT_MS {
            Currency::Current
        } else if self.is_open {
            Currency::Silent((silent_ms / 1000.0) as u32)
        } else {
            Currency::Away
        }
    }

    /// Whether an open connection has been silent for so long that a new one is the better chance.
    #[must_use]
    pub fn gives_up(&self, now_ms: f64) -> bool {
        self.is_open
            && self
                .heard_ms
                .is_some_and(|heard_ms| now_ms - heard_ms > GIVE_UP_MS)
    }
}

/// Lanes on which updates come in pieces at the same time.
const LANES: usize = 2;

/// Joins the pieces of long updates.
#[derive(Clone, Debug, Default)]
pub struct PieceJoiner {
    lanes: [String; LANES],
}

impl PieceJoiner {
    /// Forgets what a lost connection has begun.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Takes a piece; gives the whole update with its last one.
    pub fn push(&mut self, lane: u8, text: &str, last: bool) -> Option<String> {
        let joined = self.lanes.get_mut(usize::from(lane))?;
        joined.push_str(text);
        last.then(|| core::mem::take(joined))
    }
}

#[cfg(test)]
mod tests {
    use super::{Currency, News, PieceJoiner};

    #[test]
    fn silence_is_seen_after_three_seconds_and_a_short_glitch_is_not() {
        let mut news = News::default();
        assert_eq!(news.currency(0.0), Currency::Away, "nothing was ever heard");
        news.on_open(1_000.0);
        assert_eq!(news.currency(3_900.0), Currency::Current);
        assert_eq!(news.currency(5_200.0), Currency::Silent(4));
        assert!(!news.gives_up(9_900.0) && news.gives_up(10_100.0));
        news.on_heard(10_000.0);
        news.on_close();
        assert_eq!(news.currency(10_500.0), Currency::Current, "a glitch");
        assert_eq!(news.currency(13_100.0), Currency::Away);
        assert!(!news.gives_up(30_000.0), "there is nothing to give up");
    }

    #[test]
    fn a_daemon_that_hangs_behind_a_server_that_lives_is_seen() {
        let mut news = News::default();
        news.on_open(0.0);
        for second in 1..=5_u32 {
            let now_ms = f64::from(second) * 1_000.0;
            news.on_heard(now_ms);
            news.on_heartbeat(now_ms, Some(u64::from(second) * 1_000));
        }
        assert_eq!(news.currency(5_000.0), Currency::Silent(5));
        news.on_heartbeat(6_000.0, None);
        news.on_heard(6_000.0);
        assert_eq!(
            news.currency(6_000.0),
            Currency::Current,
            "the state itself says it"
        );
    }

    #[test]
    fn pieces_of_two_updates_come_mixed() {
        let mut joiner = PieceJoiner::default();
        assert_eq!(joiner.push(1, "map", false), None);
        assert_eq!(joiner.push(0, "home", true).as_deref(), Some("home"));
        assert_eq!(joiner.push(1, "!", true).as_deref(), Some("map!"));
        assert_eq!(joiner.push(1, "x", false), None);
        joiner.clear();
        assert_eq!(joiner.push(1, "y", true).as_deref(), Some("y"));
        assert_eq!(joiner.push(9, "z", true), None, "a lane that there is not");
    }
}
