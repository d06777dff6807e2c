//! What a run has shown of the map with which it began.

/// What came of comparing the map of the home with the home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapTrial {
    /// Much of it was met, and it was not doubted.
    Held,
    /// It was doubted.
    Doubted,
}
