//! What clients were refused, for the log: a client that asks again and again, as one that drives does, fills it with nothing.

use rvac_api::Failure;

use crate::ClientId;

/// A refusal is logged again after this time, and this many different ones within that time.
const SILENT_US: u64 = 5_000_000;
const LOGGED_MAX: usize = 8;

/// Refusals that are in the log.
#[derive(Debug, Default)]
pub(super) struct RefusalLog {
    logged: Vec<(u64, ClientId, Failure)>,
}

impl RefusalLog {
    /// Whether it goes into the log.
    pub(super) fn is_news(&mut self, now_us: u64, client: ClientId, failure: &Failure) -> bool {
        self.logged
            .retain(|(at_us, ..)| now_us.saturating_sub(*at_us) < SILENT_US);
        let is_same = |(_, other, known): &(u64, ClientId, Failure)| {
            *other == client && known.reason == failure.reason && known.text == failure.text
        };
        let is_news = self.logged.len() < LOGGED_MAX && !self.logged.iter().any(is_same);
        if is_news {
            self.logged.push((now_us, client, failure.clone()));
        }
        is_news
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::Failure;

    use super::{LOGGED_MAX, RefusalLog, SILENT_US};
    use crate::ClientId;

    fn failure(reason: &str) -> Failure {
        Failure {
            id: None,
            reason: reason.to_owned(),
            text: String::new(),
        }
    }

    #[test]
    fn the_same_refusal_is_reported_once_in_a_while() {
        let mut log = RefusalLog::default();
        let busy = failure("driver-busy");
        let logged: Vec<bool> = (0..200)
            .map(|step| log.is_news(step * SILENT_US / 100, ClientId(1), &busy))
            .collect();
        assert_eq!(logged.iter().filter(|logged| **logged).count(), 2);
        assert!(
            log.is_news(0, ClientId(2), &busy),
            "another client hears of it too"
        );
    }

    #[test]
    fn many_different_ones_do_not_flood_the_log() {
        let mut log = RefusalLog::default();
        let logged = (0..1000).filter(|number| log.is_news(0, ClientId(1), &failure(&number.to_string())));
        assert_eq!(logged.count(), LOGGED_MAX);
    }
}
