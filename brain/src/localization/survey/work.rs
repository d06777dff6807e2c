//! How much may be done in one step of the brain.

/// Work that is left, in multiplications and things that take as long as one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work {
    left: usize,
}

impl Work {
    /// So much may be done.
    pub(super) const fn of(left: usize) -> Self {
        Self { left }
    }

    /// So much was done.
    pub(super) const fn spend(&mut self, done: usize) {
        self.left = self.left.saturating_sub(done);
    }

    /// Whether more may be done.
    pub(super) const fn is_left(self) -> bool {
        self.left > 0
    }
}
