//! Critical flags that a flipped bit in memory cannot raise (S21).

use rvac_protocol::message::{Inhibit, Inhibits};

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
    use super::Latches;
    use rvac_protocol::message::Inhibit;

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
