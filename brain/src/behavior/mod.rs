//! What the robot does and why: the state machine above tasks and manoeuvres.
//!
//! Each step goes the same way: commands are admitted or refused and change the *mode*; what was perceived may change it
//! again, the graver cause winning; the mode then says how to move; and a last gate takes out every motion that the
//! firmware would have to refuse.

mod facts;
mod gyro_rest;
mod job;
mod job_checkpoint;
mod machine;
mod second_look;
mod state;

pub use job_checkpoint::JobCheckpoint;
pub(crate) use machine::{Behavior, JobStart};
pub use state::{BehaviorState, JobFigures, JobKind, Status};
