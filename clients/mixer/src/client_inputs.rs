//! Inputs of other clients, as the robot passes them on. Each expires by itself at the client that drives by it.

use std::collections::{BTreeMap, BTreeSet};

use rvac_api::{ClientInput, INPUT_LEASE_MS_MAX, INPUTS_MAX};

use crate::Name;

/// Inputs of other clients with the ends of their leases, by the clock of whoever mixes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClientInputs {
    inputs: BTreeMap<Name, LeasedInput>,
    /// Those that were absent for a moment since the last look: another client may tell them now.
    interrupted: BTreeSet<Name>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct LeasedInput {
    value: f64,
    until_us: u64,
}

impl ClientInputs {
    /// Replaces all inputs by those that the robot has just sent. An input that no client can have sent is left out and so is absent.
    pub fn replace(&mut self, now_us: u64, inputs: &[ClientInput]) {
        let valid = inputs.iter().take(INPUTS_MAX).filter_map(|input| {
            let name = Name::new(&input.name).ok()?;
            let value = Some(input.value).filter(|value| (-1.0..=1.0).contains(value))?;
            let left_us = u64::from(input.left_ms.min(INPUT_LEASE_MS_MAX)) * 1000;
            let until_us = now_us.saturating_add(left_us);
            Some((name, LeasedInput { value, until_us }))
        });
        let before = std::mem::replace(&mut self.inputs, valid.collect());
        let ended = before
            .into_iter()
            .filter(|(name, input)| now_us >= input.until_us || !self.inputs.contains_key(name));
        self.interrupted.extend(ended.map(|(name, _)| name));
    }

    /// Forgets all inputs, because the connection to the robot is lost.
    pub fn forget(&mut self) {
        let gone = std::mem::take(&mut self.inputs);
        self.interrupted.extend(gone.into_keys());
    }

    /// The inputs that are valid at this moment, for [`crate::Readings::clients`]. One that was absent since the last look is left
    /// out once, so that who mixes sees that.
    #[must_use]
    pub fn at(&mut self, now_us: u64) -> BTreeMap<Name, f64> {
        let interrupted = std::mem::take(&mut self.interrupted);
        self.inputs.retain(|_, input| now_us < input.until_us);
        let live = self
            .inputs
            .iter()
            .filter(|(name, _)| !interrupted.contains(*name));
        live.map(|(name, input)| (name.clone(), input.value)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::ClientInputs;
    use rvac_api::{ClientInput, INPUTS_MAX};

    fn input(name: &str, value: f64, left_ms: u16) -> ClientInput {
        ClientInput {
            name: name.to_owned(),
            value,
            left_ms,
        }
    }

    fn at(inputs: &mut ClientInputs, now_us: u64) -> Vec<(String, f64)> {
        let all = inputs.at(now_us).into_iter();
        all.map(|(name, value)| (name.to_string(), value)).collect()
    }

    #[test]
    fn each_input_ends_with_its_own_lease() {
        let mut inputs = ClientInputs::default();
        inputs.replace(1_000, &[input("go", 1.0, 300), input("steer", -0.5, 100)]);
        assert_eq!(
            at(&mut inputs, 100_999),
            [("go".to_owned(), 1.0), ("steer".to_owned(), -0.5)]
        );
        assert_eq!(at(&mut inputs, 101_000), [("go".to_owned(), 1.0)]);
        assert_eq!(at(&mut inputs, 301_000), []);
        inputs.replace(302_000, &[input("steer", 0.0, 100)]);
        assert_eq!(at(&mut inputs, 302_000), [("steer".to_owned(), 0.0)]);
        inputs.forget();
        assert_eq!(at(&mut inputs, 302_000), []);
    }

    #[test]
    fn an_input_that_was_absent_between_two_looks_is_seen_to_be() {
        let mut inputs = ClientInputs::default();
        let go = [("go".to_owned(), 1.0)];
        inputs.replace(0, &[input("go", 1.0, 300)]);
        assert_eq!(at(&mut inputs, 1), go);
        inputs.replace(2, &[]);
        inputs.replace(3, &[input("go", 1.0, 300)]);
        assert_eq!(at(&mut inputs, 4), [], "another client may hold it now");
        assert_eq!(at(&mut inputs, 5), go);
        inputs.replace(300_003, &[input("go", 1.0, 300)]);
        assert_eq!(at(&mut inputs, 300_004), [], "its lease was over");
        assert_eq!(at(&mut inputs, 300_005), go);
    }

    #[test]
    fn a_daemon_that_tells_nonsense_is_not_believed() {
        let mut inputs = ClientInputs::default();
        let wrong = [
            input("a/b", 1.0, 300),
            input("far", 1.5, 300),
            input("nan", f64::NAN, 300),
            input("over", 1.0, 0),
        ];
        inputs.replace(0, &wrong);
        assert_eq!(at(&mut inputs, 0), []);
        inputs.replace(0, &[input("long", 1.0, u16::MAX)]);
        assert_eq!(at(&mut inputs, 399_999).len(), 1);
        assert_eq!(
            at(&mut inputs, 400_000),
            [],
            "no lease is longer than the longest"
        );
        let flood: Vec<ClientInput> = (0..1000)
            .map(|number| input(&format!("x{number}"), 0.0, 300))
            .collect();
        inputs.replace(0, &flood);
        assert_eq!(at(&mut inputs, 0).len(), INPUTS_MAX);
    }
}
