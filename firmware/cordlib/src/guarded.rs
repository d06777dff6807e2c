//! Critical flags that a flipped bit in memory cannot raise (S21).

use rvac_protocol::message::{Inhibit, Inhibits};

/// A permission. Its two patterns differ in every bit, and any other pattern counts as refused: only a flip of all eight
/// bits at once turns a refusal into a permission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Permission(u8);

const GIVEN: u8 = 0b0101_1010;
const REFUSED: u8 = !GIVEN;

impl Permission {
    pub(crate) const REFUSED: Self = Self(REFUSED);
    pub(crate) const GIVEN: Self = Self(GIVEN);

    /// Whether it is given.
    pub(crate) const fn is_given(self) -> bool {
        self.0 == GIVEN
    }
}

impl Default for Permission {
    fn default() -> Self {
        Self::REFUSED
    }
}

/// A set of inhibits that is stored twice, once as its complement. A member is absent only if both copies agree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Latches {
    set: u32,
    complement: u32,
}

impl Default for Latches {
    fn default() -> Self {
        Self {
            set: 0,
            complement: u32::MAX,
        }
    }
}

impl Latches {
    /// All that either copy holds.
    pub(crate) const fn members(self) -> Inhibits {
        Inhibits::from_bits(self.set | !self.complement)
    }

    pub(crate) const fn insert(&mut self, inhibit: Inhibit) {
        self.add(Inhibits::from_bits(1 << inhibit as u32));
    }

    pub(crate) const fn add(&mut self, inhibits: Inhibits) {
        self.set |= inhibits.bits();
        self.complement &= !inhibits.bits();
    }

    pub(crate) const fn remove(&mut self, inhibit: Inhibit) {
        self.set &= !(1 << inhibit as u32);
        self.complement |= 1 << inhibit as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::{Latches, Permission};
    use rvac_protocol::message::Inhibit;

    #[test]
    fn no_flip_of_up_to_seven_bits_gives_a_refused_permission() {
        for mask in 1..=u8::MAX {
            let flipped = Permission(Permission::REFUSED.0 ^ mask);
            assert_eq!(flipped.is_given(), mask == u8::MAX, "{mask:#010b}");
        }
        for bit in 0..8 {
            assert!(!Permission(Permission::GIVEN.0 ^ 1 << bit).is_given());
        }
    }

    #[test]
    fn a_flip_never_takes_a_latch_away() {
        let mut latches = Latches::default();
        assert!(latches.members().is_empty());
        latches.insert(Inhibit::Runaway);
        let flips = (0..32).flat_map(|bit| {
            let (mut first, mut second) = (latches, latches);
            first.set ^= 1 << bit;
            second.complement ^= 1 << bit;
            [first, second]
        });
        for flipped in flips {
            assert!(flipped.members().contains(Inhibit::Runaway));
        }
        latches.remove(Inhibit::Runaway);
        assert!(latches.members().is_empty());
    }
}
