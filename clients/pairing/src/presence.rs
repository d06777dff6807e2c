//! Proof that somebody stands beside the robot, or sits at its console, for what must not be done from afar by whoever got hold of an
//! administrator's device.

use crate::TokenId;

/// How long a press is waited for.
const ASKED_US: u64 = 60_000_000;

/// How long a proof holds.
const PROVEN_US: u64 = 300_000_000;

/// Which clients have asked for a proof, and which have it.
#[derive(Clone, Debug, Default)]
pub struct Presence {
    asked: Vec<(TokenId, u64)>,
    proven: Vec<(TokenId, u64)>,
}

impl Presence {
    /// Whether the client's proof holds.
    #[must_use]
    pub fn is_proven(&self, now_us: u64, id: TokenId) -> bool {
        self.proven
            .iter()
            .any(|(known, until_us)| *known == id && now_us < *until_us)
    }

    /// The client waits for a press.
    pub fn ask(&mut self, now_us: u64, id: TokenId) {
        self.forget_old(now_us);
        self.asked.retain(|(known, _)| *known != id);
        self.asked.push((id, now_us + ASKED_US));
    }

    /// Whether a press is waited for: then it is for nothing else.
    #[must_use]
    pub fn is_waited(&self, now_us: u64) -> bool {
        self.asked.iter().any(|(_, until_us)| now_us < *until_us)
    }

    /// A button was pressed. It proves nothing while several clients wait: nobody knows whose it is.
    pub fn press(&mut self, now_us: u64) -> Option<TokenId> {
        self.forget_old(now_us);
        let asked = std::mem::take(&mut self.asked);
        let [(id, _)] = *asked.as_slice() else { return None };
        self.prove(now_us, id);
        Some(id)
    }

    /// Somebody at the console vouches for the client.
    pub fn prove(&mut self, now_us: u64, id: TokenId) {
        self.forget_old(now_us);
        self.proven.retain(|(known, _)| *known != id);
        self.proven.push((id, now_us + PROVEN_US));
    }

    fn forget_old(&mut self, now_us: u64) {
        for list in [&mut self.asked, &mut self.proven] {
            list.retain(|(_, until_us)| now_us < *until_us);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ASKED_US, PROVEN_US, Presence};
    use crate::TokenId;

    fn ids() -> [TokenId; 2] {
        ["0000000000000001", "0000000000000002"].map(|id| id.parse().unwrap())
    }

    #[test]
    fn a_press_proves_for_the_one_who_asked_and_not_for_ever() {
        let ([one, other], mut presence) = (ids(), Presence::default());
        assert_eq!(presence.press(0), None, "nobody asked");
        presence.ask(1, one);
        assert!(!presence.is_proven(1, one) && presence.is_waited(1));
        assert_eq!(presence.press(2), Some(one));
        assert!(presence.is_proven(2, one) && !presence.is_proven(2, other) && !presence.is_waited(2));
        assert!(!presence.is_proven(2 + PROVEN_US, one));
        presence.ask(0, other);
        assert_eq!(presence.press(ASKED_US), None, "too late");
    }

    #[test]
    fn a_press_for_two_proves_for_neither() {
        let ([one, other], mut presence) = (ids(), Presence::default());
        presence.ask(0, one);
        presence.ask(0, other);
        assert_eq!(presence.press(1), None);
        assert!(!presence.is_proven(1, one) && !presence.is_proven(1, other));
    }
}
