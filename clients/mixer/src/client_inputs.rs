//! Inputs of other clients, as the robot passes them on. Each expires by itself at the client that drives by it.

use std::collections::BTreeMap;

use rvac_api::{ClientInput, INPUT_LEASE_MS_MAX, INPUTS_MAX};

use crate::Name;

/// Inputs of other clients with the ends of their leases, by the clock of whoever mixes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClientInputs {
    inputs: BTreeMap<Name, LeasedInput>,
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
        self.inputs = valid.collect();
    }

    /// Forgets all inputs, because the connection to the robot is lost.
    pub fn forget(&mut self) {
        self.inputs.clear();
    }

    /// The inputs that are valid at this moment, for [`crate::Readings::clients`].
    #[must_use]
    pub fn at(&self, now_us: u64) -> BTreeMap<Name, f64> {
        let live = self.inputs.iter().filter(|(_, input)| now_us < input.until_us);
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

    fn at(inputs: &ClientInputs, now_us: u64) -> Vec<(String, f64)> {
        let all = inputs.at(now_us).into_iter();
        all.map(|(name, value)| (name.to_string(), value)).collect()
    }

    #[test]
    fn each_input_ends_with_its_own_lease() {
        let mut inputs = ClientInputs::default();
        inputs.replace(1_000, &[input("go", 1.0, 300), input("steer", -0.5, 100)]);
        assert_eq!(
            at(&inputs, 100_999),
            [("go".to_owned(), 1.0), ("steer".to_owned(), -0.5)]
        );
        assert_eq!(at(&inputs, 101_000), [("go".to_owned(), 1.0)]);
        assert_eq!(at(&inputs, 301_000), []);
        inputs.replace(302_000, &[input("steer", 0.0, 100)]);
        assert_eq!(at(&inputs, 302_000), [("steer".to_owned(), 0.0)]);
        inputs.forget();
        assert_eq!(at(&inputs, 302_000), []);
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
        assert_eq!(at(&inputs, 0), []);
        inputs.replace(0, &[input("long", 1.0, u16::MAX)]);
        assert_eq!(at(&inputs, 399_999).len(), 1);
        assert_eq!(at(&inputs, 400_000), [], "no lease is longer than the longest");
        let flood: Vec<ClientInput> = (0..1000)
            .map(|number| input(&format!("x{number}"), 0.0, 300))
            .collect();
        inputs.replace(0, &flood);
        assert_eq!(at(&inputs, 0).len(), INPUTS_MAX);
    }
}
