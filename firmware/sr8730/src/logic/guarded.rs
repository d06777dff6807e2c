//! Critical variables with their complement (S21): a flipped bit in memory must not switch on a motor or the charger.

use core::sync::atomic::{AtomicU32, Ordering};

/// A word that is stored twice, once inverted. It has one writer and any number of readers.
#[derive(Debug)]
pub struct Guarded {
    value: AtomicU32,
    inverse: AtomicU32,
}

/// The word and its complement disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Disagreement;

impl Guarded {
    /// Holds `value`.
    #[must_use]
    pub const fn new(value: u32) -> Self {
        Self {
            value: AtomicU32::new(value),
            inverse: AtomicU32::new(!value),
        }
    }

    /// Changes the value. A reader between the two writes would see a disagreement, so no reading interrupt may come in
    /// between: write with interrupts off, or from a higher level than all readers.
    #[inline(always)]
    pub fn set(&self, value: u32) {
        self.value.store(value, Ordering::Relaxed);
        self.inverse.store(!value, Ordering::Relaxed);
    }

    /// The value.
    ///
    /// # Errors
    /// [`Disagreement`] if one of the two was changed by anything but [`Self::set`].
    #[inline(always)]
    pub fn get(&self) -> Result<u32, Disagreement> {
        let value = self.value.load(Ordering::Relaxed);
        if value == !self.inverse.load(Ordering::Relaxed) {
            Ok(value)
        } else {
            Err(Disagreement)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Disagreement, Guarded};
    use core::sync::atomic::Ordering;

    #[test]
    fn what_was_set_is_read() {
        let guarded = Guarded::new(5);
        assert_eq!(guarded.get(), Ok(5));
        guarded.set(u32::MAX);
        assert_eq!(guarded.get(), Ok(u32::MAX));
    }

    #[test]
    fn any_flipped_bit_is_a_disagreement() {
        for bit in 0..32 {
            let guarded = Guarded::new(0);
            guarded.value.fetch_xor(1 << bit, Ordering::Relaxed);
            assert_eq!(guarded.get(), Err(Disagreement));
            let guarded = Guarded::new(0);
            guarded.inverse.fetch_xor(1 << bit, Ordering::Relaxed);
            assert_eq!(guarded.get(), Err(Disagreement));
        }
    }
}
