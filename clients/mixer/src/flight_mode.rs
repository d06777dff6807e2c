//! Flight modes, as radio transmitters call them: while a switch is on other lines count, and other trims.
//!
//! The first mode whose switch is on holds. Without one all lines count that name no mode.

use serde::{Deserialize, Serialize};

use crate::left_out::is_none_ms;
use crate::{Name, TrimValue};

/// A flight mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct FlightMode {
    /// Its name.
    pub name: Name,
    /// The switch that must be on.
    pub when: Name,
    /// Time in which the outputs go over from the mode before, milliseconds.
    #[serde(default, skip_serializing_if = "is_none_ms")]
    pub fade_ms: u16,
    /// Trims that it has for itself; those of other outputs it shares with all other modes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trims: Vec<TrimValue>,
}

/// Going over to another flight mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fade {
    pub(crate) began_us: u64,
    pub(crate) length_us: u64,
}

impl Fade {
    /// What an output makes at a moment that made `from` when the mode changed, and is to make `to`.
    pub(crate) fn between(self, from: f64, to: f64, now_us: u64) -> f64 {
        let passed_us = now_us.saturating_sub(self.began_us);
        if passed_us >= self.length_us {
            return to;
        }
        from + (to - from) * (passed_us as f64 / self.length_us as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::Fade;

    #[test]
    fn it_goes_evenly_from_one_to_the_other() {
        let fade = Fade {
            began_us: 1_000,
            length_us: 2_000,
        };
        assert_eq!(fade.between(1.0, 0.0, 1_000), 1.0);
        assert_eq!(fade.between(1.0, 0.0, 2_000), 0.5);
        assert_eq!(fade.between(1.0, 0.0, 3_000), 0.0);
        let at_once = Fade { length_us: 0, ..fade };
        assert_eq!(at_once.between(1.0, 0.0, 1_000), 0.0);
    }
}
