//! How much of its floor a job has swept.

/// Share of the floor that a job wants and knows which it has swept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SweptShare {
    /// As the robot believes, 0..=1.
    pub share: f64,
    /// The same if it knows its place half as well as it believes.
    pub share_low: f64,
    /// What of it is left, square metres.
    pub left_m2: f64,
}
