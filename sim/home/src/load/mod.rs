//! Loading of homes.

mod error;

pub use error::HomeError;
