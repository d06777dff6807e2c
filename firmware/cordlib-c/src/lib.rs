//! C interface of cordlib.
//!
//! One robot per process, as on a microcontroller. The firmware sets callbacks for its outputs and its clock, declares
//! the parts of the machine, and pushes the state of its inputs with `cord_event_...`. Continuous values are `double`.
//! A NaN counts as the safe value or is refused. A callback that is not set is not called.
//!
//! Inputs and both byte queues may be used from any thread and from inside callbacks. The main loop must not be entered
//! from inside one of its callbacks: `cord_step` refuses that.

pub mod board;
pub mod callbacks;
pub mod connection;
pub mod inputs;
mod kept;
pub mod machine;
pub mod main_loop;
pub mod requests;
pub mod time;
