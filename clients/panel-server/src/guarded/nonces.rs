//! Words that open one WebSocket each, so that what was said on one connection is worth nothing on another.

use data_encoding::HEXLOWER;
use pairing::TokenId;

/// How long one may wait to be used.
const LIFE_US: u64 = 60_000_000;

/// Unused words of one client; a page that is loaded again and again drops its oldest.
const OF_ONE_MAX: usize = 8;

#[derive(Debug)]
struct Nonce {
    id: TokenId,
    word: String,
    until_us: u64,
}

/// The words that were given out and not used yet.
#[derive(Debug, Default)]
pub(super) struct Nonces {
    waiting: Vec<Nonce>,
}

impl Nonces {
    pub(super) fn make(&mut self, now_us: u64, id: TokenId, random: &[u8; 16]) -> String {
        self.forget_old(now_us);
        if self.waiting.iter().filter(|nonce| nonce.id == id).count() >= OF_ONE_MAX
            && let Some(oldest) = self.waiting.iter().position(|nonce| nonce.id == id)
        {
            self.waiting.remove(oldest);
        }
        let word = HEXLOWER.encode(random);
        self.waiting.push(Nonce {
            id,
            word: word.clone(),
            until_us: now_us + LIFE_US,
        });
        word
    }

    pub(super) fn take(&mut self, now_us: u64, id: TokenId, word: &str) -> bool {
        self.forget_old(now_us);
        let place = self
            .waiting
            .iter()
            .position(|nonce| nonce.id == id && nonce.word == word);
        place.map(|place| self.waiting.remove(place)).is_some()
    }

    fn forget_old(&mut self, now_us: u64) {
        self.waiting.retain(|nonce| now_us < nonce.until_us);
    }
}

#[cfg(test)]
mod tests {
    use super::{LIFE_US, Nonces, OF_ONE_MAX};

    #[test]
    fn a_word_counts_once_for_one_client_and_not_for_ever() {
        let [one, other]: [pairing::TokenId; 2] =
            ["0000000000000001", "0000000000000002"].map(|id| id.parse().unwrap());
        let mut nonces = Nonces::default();
        let word = nonces.make(0, one, &[1; 16]);
        assert!(!nonces.take(1, other, &word));
        assert!(nonces.take(1, one, &word));
        assert!(!nonces.take(1, one, &word), "used");
        let word = nonces.make(0, one, &[2; 16]);
        assert!(!nonces.take(LIFE_US, one, &word), "too old");
        let oldest = nonces.make(0, one, &[3; 16]);
        for number in 0..OF_ONE_MAX {
            nonces.make(0, one, &[10 + number as u8; 16]);
        }
        assert!(!nonces.take(1, one, &oldest), "dropped");
    }
}
