//! Inputs of control mixes that clients send, each under a lease. The driver's mix reads them like a stick.
//!
//! The daemon passes them on and drives nothing by them. It holds to four things: one client at a time sends a name, a value is a
//! share, every input expires by itself, and their number is bounded.

use std::collections::BTreeMap;

use rvac_api::{ClientInput, INPUT_LEASE_MS_MAX, INPUTS_MAX, INPUTS_PER_CLIENT_MAX, is_mix_name};

use crate::ClientId;

/// Why a client may not send this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InputDenied {
    /// The lease is 0 or longer than [`INPUT_LEASE_MS_MAX`].
    LeaseRange,
    /// A name is none.
    Name,
    /// A value is no share of -1..=1.
    Value,
    /// Too many inputs, of this client or of all.
    TooMany,
    /// Another client sends an input of this name.
    Taken,
}

/// All inputs of one client.
#[derive(Clone, Debug)]
struct InputLease {
    values: BTreeMap<String, f64>,
    until_us: u64,
}

/// The inputs of all clients.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClientInputs {
    leases: BTreeMap<ClientId, InputLease>,
    /// Followers have not received it yet.
    is_new: bool,
}

impl ClientInputs {
    /// A client reports these inputs, in place of all that it reported before. `true` if it had reported none.
    ///
    /// # Errors
    /// Why it may not; then its earlier report holds until its lease ends.
    pub(crate) fn set(
        &mut self,
        now_us: u64,
        client: ClientId,
        (values, lease_ms): (BTreeMap<String, f64>, u16),
    ) -> Result<bool, InputDenied> {
        if lease_ms == 0 || lease_ms > INPUT_LEASE_MS_MAX {
            return Err(InputDenied::LeaseRange);
        }
        self.expire(now_us);
        self.check(client, &values)?;
        self.is_new = true;
        if values.is_empty() {
            self.leases.remove(&client);
            return Ok(false);
        }
        let until_us = now_us + u64::from(lease_ms) * 1000;
        Ok(self
            .leases
            .insert(client, InputLease { values, until_us })
            .is_none())
    }

    fn check(&self, client: ClientId, values: &BTreeMap<String, f64>) -> Result<(), InputDenied> {
        let others = || self.leases.iter().filter(|(other, _)| **other != client);
        let of_others: usize = others().map(|(_, lease)| lease.values.len()).sum();
        if values.len() > INPUTS_PER_CLIENT_MAX || values.len() + of_others > INPUTS_MAX {
            return Err(InputDenied::TooMany);
        }
        for (name, value) in values {
            if !is_mix_name(name) {
                return Err(InputDenied::Name);
            }
            // NaN is in no range.
            if !(-1.0..=1.0).contains(value) {
                return Err(InputDenied::Value);
            }
            if others().any(|(_, lease)| lease.values.contains_key(name)) {
                return Err(InputDenied::Taken);
            }
        }
        Ok(())
    }

    /// Forgets those whose lease is over; gives them.
    pub(crate) fn expire(&mut self, now_us: u64) -> Vec<ClientId> {
        let over = self.leases.iter().filter(|(_, lease)| now_us >= lease.until_us);
        let over: Vec<ClientId> = over.map(|(client, _)| *client).collect();
        for client in &over {
            self.forget(*client);
        }
        over
    }

    /// A client reports no inputs any more. `true` if it had reported some.
    pub(crate) fn forget(&mut self, client: ClientId) -> bool {
        let existed = self.leases.remove(&client).is_some();
        self.is_new |= existed;
        existed
    }

    /// When the next lease ends.
    pub(crate) fn lease_end_us(&self) -> Option<u64> {
        self.leases.values().map(|lease| lease.until_us).min()
    }

    /// Whether there is news since the last question.
    pub(crate) fn take_news(&mut self) -> bool {
        core::mem::take(&mut self.is_new)
    }

    /// The inputs that are reported now, by their names.
    pub(crate) fn view(&self, now_us: u64) -> Vec<ClientInput> {
        let mut all: Vec<ClientInput> = Vec::new();
        for lease in self.leases.values() {
            let left_ms = lease.until_us.saturating_sub(now_us) / 1000;
            let left_ms = u16::try_from(left_ms).unwrap_or(INPUT_LEASE_MS_MAX);
            all.extend(lease.values.iter().map(|(name, value)| ClientInput {
                name: name.clone(),
                value: *value,
                left_ms,
            }));
        }
        all.sort_by(|one, other| one.name.cmp(&other.name));
        all
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use rvac_api::{INPUTS_MAX, INPUTS_PER_CLIENT_MAX};

    use super::{ClientInputs, InputDenied};
    use crate::ClientId;

    const ANNA: ClientId = ClientId(1);
    const BERT: ClientId = ClientId(2);

    fn values<const N: usize>(all: [(&str, f64); N]) -> BTreeMap<String, f64> {
        all.map(|(name, value)| (name.to_owned(), value)).into()
    }

    fn many(count: usize, first: &str) -> BTreeMap<String, f64> {
        (0..count)
            .map(|number| (format!("{first}{number}"), 0.0))
            .collect()
    }

    fn seen(inputs: &ClientInputs, now_us: u64) -> Vec<(String, f64, u16)> {
        let all = inputs.view(now_us).into_iter();
        all.map(|input| (input.name, input.value, input.left_ms))
            .collect()
    }

    #[test]
    fn what_is_reported_replaces_what_was_and_ends_with_its_lease() {
        let mut inputs = ClientInputs::default();
        let both = values([("steer", 0.5), ("go", -1.0)]);
        assert_eq!(inputs.set(0, ANNA, (both, 300)), Ok(true));
        let expected = [("go".to_owned(), -1.0, 200), ("steer".to_owned(), 0.5, 200)];
        assert_eq!(seen(&inputs, 100_000), expected);
        assert_eq!(inputs.set(100_000, ANNA, (values([("go", 0.0)]), 400)), Ok(false));
        assert_eq!(seen(&inputs, 100_000), [("go".to_owned(), 0.0, 400)]);
        assert!(inputs.take_news() && !inputs.take_news());
        assert_eq!(inputs.lease_end_us(), Some(500_000));
        assert_eq!(inputs.expire(499_999), []);
        assert!(!inputs.take_news());
        assert_eq!(inputs.expire(500_000), [ANNA]);
        assert!(inputs.take_news());
        assert_eq!(seen(&inputs, 500_000), []);
    }

    #[test]
    fn a_name_has_one_teller_until_that_one_is_gone() {
        let mut inputs = ClientInputs::default();
        let go = || values([("go", 1.0)]);
        inputs.set(0, ANNA, (go(), 400)).expect("free");
        let refused = inputs.set(399_999, BERT, (go(), 400));
        assert_eq!(refused, Err(InputDenied::Taken));
        inputs.set(400_000, BERT, (go(), 400)).expect("the lease is over");
        assert_eq!(inputs.set(400_001, ANNA, (go(), 400)), Err(InputDenied::Taken));
        assert!(inputs.forget(BERT) && !inputs.forget(BERT));
        inputs.set(400_002, ANNA, (go(), 400)).expect("free again");
        assert_eq!(inputs.set(400_003, ANNA, (values([]), 400)), Ok(false));
        inputs.set(400_004, BERT, (go(), 400)).expect("given up");
    }

    #[test]
    fn what_is_wrong_is_refused_and_changes_nothing() {
        let mut inputs = ClientInputs::default();
        inputs.set(0, ANNA, (values([("go", 0.5)]), 400)).expect("free");
        inputs.take_news();
        for (values, lease_ms, denied) in [
            (values([("go", 1.0)]), 0, InputDenied::LeaseRange),
            (values([("go", 1.0)]), 401, InputDenied::LeaseRange),
            (values([("go", 1.001)]), 400, InputDenied::Value),
            (values([("go", f64::NAN)]), 400, InputDenied::Value),
            (values([("go", f64::NEG_INFINITY)]), 400, InputDenied::Value),
            (values([("", 1.0)]), 400, InputDenied::Name),
            (values([("go/there", 1.0)]), 400, InputDenied::Name),
            (values([(&"x".repeat(33), 1.0)]), 400, InputDenied::Name),
            (many(INPUTS_PER_CLIENT_MAX + 1, "x"), 400, InputDenied::TooMany),
        ] {
            let text = format!("{values:?}");
            assert_eq!(inputs.set(1000, ANNA, (values, lease_ms)), Err(denied), "{text}");
        }
        assert_eq!(seen(&inputs, 1000), [("go".to_owned(), 0.5, 399)]);
        assert!(!inputs.take_news());
    }

    #[test]
    fn all_clients_together_are_bounded() {
        let mut inputs = ClientInputs::default();
        let clients = INPUTS_MAX / INPUTS_PER_CLIENT_MAX;
        for number in 0..clients {
            let all = many(INPUTS_PER_CLIENT_MAX, &format!("of {number} - "));
            inputs.set(0, ClientId(number as u64), (all, 400)).expect("fits");
        }
        let one = (many(1, "more"), 400);
        let late = ClientId(99);
        assert_eq!(inputs.set(1, late, one.clone()), Err(InputDenied::TooMany));
        assert_eq!(inputs.view(1).len(), INPUTS_MAX);
        inputs.set(400_000, late, one).expect("the others are over");
    }
}
