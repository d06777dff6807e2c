//! The wrap-safe millisecond clock of the microcontroller.

/// A moment on the microcontroller's clock: milliseconds since its reset, modulo 2^32 (wraps after 49.7 days).
///
/// There is deliberately no `Ord`: on a clock that wraps only differences mean something, and only up to 24.8 days.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Tick(pub u32);

impl Tick {
    /// Milliseconds that passed from `earlier` to `self`. Right as long as less than 49.7 days lie between them.
    #[must_use]
    pub const fn since(self, earlier: Self) -> u32 {
        self.0.wrapping_sub(earlier.0)
    }

    /// The moment `milliseconds` later.
    #[must_use]
    pub const fn after(self, milliseconds: u32) -> Self {
        Self(self.0.wrapping_add(milliseconds))
    }

    /// Whether `deadline` has come: true from the deadline on for the following 24.8 days.
    #[must_use]
    pub const fn reached(self, deadline: Self) -> bool {
        self.0.wrapping_sub(deadline.0) < 1 << 31
    }
}

#[cfg(test)]
mod tests {
    use super::Tick;

    #[test]
    fn differences_survive_the_wrap() {
        let before = Tick(u32::MAX - 9);
        let after = before.after(30);
        assert_eq!(after, Tick(20));
        assert_eq!(after.since(before), 30);
        assert!(after.reached(before));
        assert!(!before.reached(after));
        assert!(after.reached(after));
    }
}
