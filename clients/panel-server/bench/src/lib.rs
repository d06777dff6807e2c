//! The panel's server as a process, and what its measurements have in common.
#![forbid(unsafe_code)]

mod door;
mod home;
pub mod http;

pub use door::{Caller, Door, PATIENCE, Stream, Tls};
pub use home::keep_large_home;
