//! How an owner measures what differs from robot to robot: the steps, and what comes out of them.
//!
//! The steps are the same on a terminal and on a page. What is shown goes to a [`Screen`]; answers come as lines among the events
//! of the [`Robot`]. Whoever opens the link hands in its two ends, so this crate opens no device. A motor runs under a lease that is
//! renewed while it is measured, is always stopped at the end, and runs only while a person holds it where [`Hold::Asked`].
#![forbid(unsafe_code)]

mod arithmetic;
mod bench;
mod driven;
mod error;
mod light;
mod procedure;
mod robot;
mod screen;
mod thermistor;
mod walk;

pub use error::CalibrationError;
pub use procedure::{Danger, Side};
pub use robot::{Hold, OpenLoop, Robot, RobotEvent, Watch};
pub use screen::{Question, Screen, Shown, Task};
pub use walk::{Plan, walk};
