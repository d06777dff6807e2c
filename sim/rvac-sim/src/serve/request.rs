//! What clients of the simulator may ask, and the answers.

use rvac_api::Failure;
use serde::{Deserialize, Serialize};

use crate::Report;

/// A request: `{"c":"report"}`, `{"c":"truth"}`, `{"c":"lift"}`, `{"c":"put-down"}`, `{"c":"press","button":0}`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(tag = "c", rename_all = "kebab-case")]
pub(crate) enum SimulatorRequest {
    /// The figures so far.
    Report,
    /// Where the robot is now, without waiting for the next of the ten words a second.
    Truth,
    /// Lifts the robot.
    Lift,
    /// Puts it down where it was.
    PutDown,
    /// Presses a button for a moment.
    Press {
        /// By number.
        button: u8,
    },
}

/// An answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "e", rename_all = "kebab-case")]
pub(crate) enum Answer {
    /// To `report`.
    Report(Report),
    /// To what could not be understood.
    Failed(Failure),
}

impl SimulatorRequest {
    /// Reads one message.
    pub(crate) fn read(message: &[u8]) -> Result<Self, Failure> {
        serde_json::from_slice(message).map_err(|error| Failure {
            id: None,
            reason: "unknown".to_owned(),
            text: format!(
                "this is no request to the simulator ({error}); known are report, truth, lift, put-down and press"
            ),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::SimulatorRequest;

    #[test]
    fn requests_are_read_exactly() {
        assert_eq!(
            SimulatorRequest::read(br#"{"c":"put-down"}"#),
            Ok(SimulatorRequest::PutDown)
        );
        assert_eq!(
            SimulatorRequest::read(br#"{"c":"press","button":2}"#),
            Ok(SimulatorRequest::Press { button: 2 })
        );
        for wrong in [&b"{}"[..], b"", b"\xff", br#"{"c":"press"}"#, br#"{"c":"rep"}"#] {
            assert_eq!(SimulatorRequest::read(wrong).unwrap_err().reason, "unknown");
        }
    }
}
