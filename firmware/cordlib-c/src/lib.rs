//! C interface of cordlib.
//!
//! One robot for each process, as on a microcontroller. The firmware sets callbacks for its outputs and its clock, tells
//! what the machine has, and pushes what its inputs show with `cord_event_...`. Continuous values are `double`; a NaN is
//! taken for the safe value or refused, and a callback that is not set is not called.
//!
//! Inputs and both byte queues may be used from any thread and from inside callbacks. The main loop may not be entered
//! from inside a callback of its own: `cord_step` refuses that.

pub mod board;
pub mod callbacks;
pub mod connection;
pub mod inputs;
pub mod machine;
pub mod main_loop;
pub mod requests;
pub mod time;
