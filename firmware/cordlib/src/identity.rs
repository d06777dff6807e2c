//! What a robot says of itself when a session opens: its names, its number of starts, and its parts.

use rvac_protocol::message::{BinaryKinds, Capabilities, Description, Name};
use rvac_protocol::session::RobotIdentity;

use crate::board::{Board, Clock, Parts, ResetRecord};
use crate::fitted::gaps;
use crate::parameters::Parameters;

/// What the session tells of the robot.
pub(crate) fn identity<P: Parts>(
    board: &mut Board<P>,
    parameters: &Parameters,
    fitted: Capabilities,
) -> RobotIdentity {
    let boot_count = board.reset.boot_count();
    let moment = board.clock.tick().0 ^ u32::from(board.clock.microseconds()).rotate_left(16);
    RobotIdentity {
        device: name(parameters.device),
        firmware: name(parameters.firmware),
        boot_count,
        reset_cause: board.reset.cause(),
        session_seed: boot_count.wrapping_mul(0x9E37_79B9) ^ moment,
        binary: BinaryKinds {
            state: true,
            drive: true,
        },
        description: Description {
            capabilities: fitted,
            limits: parameters.limits,
            motors: gaps(board, &fitted),
        },
    }
}

/// As much of a name as the wire can carry.
pub(crate) fn name(text: &str) -> Name {
    let mut name = Name::new();
    for letter in text.chars() {
        if name.push(letter).is_err() {
            break;
        }
    }
    name
}
