//! What the robot does and why: the state machine above strategies and manoeuvres.

mod reason;
mod state;

pub use reason::Reason;
pub use state::{BehaviorState, JobFigures, JobKind, Status};
