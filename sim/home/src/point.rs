//! A point of a floor plan as files and generators write it.

/// x and y in metres.
pub(crate) type Point = [f64; 2];
