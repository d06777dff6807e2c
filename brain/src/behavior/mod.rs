//! The state machine above tasks and manoeuvres: what the robot does and why.
//!
//! Each step has the same order. Commands are admitted or refused and change the *mode*. The observation may change it again, the most
//! severe cause first. The mode then determines the motion. A last check removes every motion that the firmware would have to refuse.

mod contact_watch;
mod dock_retry;
mod facts;
mod gyro_rest;
mod job;
mod job_checkpoint;
mod machine;
mod parameters;
mod state;

pub use job_checkpoint::JobCheckpoint;
pub(crate) use machine::{Behavior, JobStart};
pub use state::{BehaviorState, JobFigures, JobKind, Status};
