//! Doors that open and close while the robot drives.

/// A door: cells that are solid while it is closed.
#[derive(Clone, Debug)]
pub(crate) struct Door {
    /// Cells of the leaf, and what they are when it is open.
    pub(crate) cells: Vec<(usize, super::Cell)>,
    /// It is open.
    pub(crate) open: bool,
    /// Moments in simulated milliseconds at which it shall be open (true) or closed, rising.
    pub(crate) schedule: Vec<(u64, bool)>,
}

impl Door {
    /// Whether it is ever open.
    pub(crate) fn ever_open(&self) -> bool {
        self.open || self.schedule.iter().any(|(_, open)| *open)
    }

    /// Whether it shall be open at this moment.
    pub(crate) fn wanted_open(&self, time_ms: u64, initially: bool) -> bool {
        self.schedule
            .iter()
            .take_while(|(at_ms, _)| *at_ms <= time_ms)
            .last()
            .map_or(initially, |(_, open)| *open)
    }
}
