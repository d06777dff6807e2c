//! Requests of the simulator's clients, and the answers.

use rvac_api::Failure;
use serde::{Deserialize, Serialize};

use crate::RunReport;

/// A request, for example `{"c":"report"}`, `{"c":"lift"}` or `{"c":"press","button":0}`; the book has them all.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
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
        /// How long, simulated milliseconds.
        #[serde(default)]
        ms: Option<u32>,
    },
    /// Pushes the robot over the floor; answered at the end, as `turn` and `roll` are.
    Push {
        /// Straight ahead, metres.
        #[serde(alias = "way")]
        distance: f64,
    },
    /// Turns it on the spot.
    Turn {
        /// Counter-clockwise.
        turns: f64,
    },
    /// Turns a wheel of a lifted robot.
    Roll {
        /// Which.
        wheel: WheelChoice,
        /// Distance of the rim, forward positive, metres.
        #[serde(alias = "way")]
        distance: f64,
    },
    /// Holds both wheels fast, or lets go of them.
    Hold {
        /// Whether to hold.
        on: bool,
    },
    /// Holds white paper against a proximity sensor and nowhere else; without a number takes it away.
    Paper {
        /// By number, from the right.
        #[serde(default)]
        sensor: Option<u8>,
    },
    /// Winds hair around the main brush.
    Hair {
        /// Factor on the current of its motor.
        times: f64,
    },
    /// Puts the robot somewhere else, in the frame of the plan that the socket gives.
    Place {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
        /// Radians.
        heading: f64,
    },
    /// Reads a multimeter at the pack's contacts and an ammeter in its line.
    Meters,
}

/// A wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum WheelChoice {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

/// An answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "e", rename_all = "kebab-case", rename_all_fields = "kebab-case")]
pub(crate) enum RequestReply {
    /// To `report`.
    Report(RunReport),
    /// To `meters`.
    Meters {
        /// At the pack's contacts, volts.
        pack_v: f64,
        /// Out of the pack, ampere.
        drawn_a: f64,
    },
    /// Answer to a request of a hand: to `push`, `turn` and `roll` at the end of the movement, to others at once.
    Done,
    /// To what could not be understood or done.
    Failed(Failure),
}

/// The answer to a hand that would push through a wall, or to a second hand.
pub(crate) fn blocked(text: &str) -> RequestReply {
    RequestReply::Failed(Failure {
        id: None,
        reason: "blocked".to_owned(),
        text: text.to_owned(),
    })
}

impl SimulatorRequest {
    /// Reads one message.
    pub(crate) fn read(message: &[u8]) -> Result<Self, Failure> {
        serde_json::from_slice(message).map_err(|error| Failure {
            id: None,
            reason: "unknown".to_owned(),
            text: format!(
                "this is no request to the simulator ({error}); known are report, truth, lift, put-down, press, \
                 push, turn, roll, hold, paper, hair, place and meters"
            ),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{SimulatorRequest, WheelChoice};

    #[test]
    fn requests_are_read_exactly() {
        assert_eq!(
            SimulatorRequest::read(br#"{"c":"put-down"}"#),
            Ok(SimulatorRequest::PutDown)
        );
        assert_eq!(
            SimulatorRequest::read(br#"{"c":"press","button":2}"#),
            Ok(SimulatorRequest::Press { button: 2, ms: None })
        );
        assert_eq!(
            SimulatorRequest::read(br#"{"c":"roll","wheel":"left","way":-0.1}"#),
            Ok(SimulatorRequest::Roll {
                wheel: WheelChoice::Left,
                distance: -0.1
            })
        );
        assert_eq!(
            SimulatorRequest::read(br#"{"c":"roll","wheel":"left","distance":-0.1}"#),
            SimulatorRequest::read(br#"{"c":"roll","wheel":"left","way":-0.1}"#)
        );
        for wrong in [&b"{}"[..], b"", b"\xff", br#"{"c":"press"}"#, br#"{"c":"rep"}"#] {
            assert_eq!(SimulatorRequest::read(wrong).unwrap_err().reason, "unknown");
        }
    }
}
