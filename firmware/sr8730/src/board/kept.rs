//! Memory that a reset leaves alone: latches, faults of the charger, clocks of charging.

use cordlib::board::{KEPT_WORDS, KeptMemory, KeptWords};
use pic32mx3_hal::persistent::Persistent;

/// Two copies, each with its own CRC. They are written one after the other, so that a reset in the middle of one leaves
/// the other whole, and a flipped bit costs nothing.
#[cfg_attr(target_arch = "mips", unsafe(link_section = ".noinit"))]
static COPIES: [Persistent<KEPT_WORDS>; 2] = [const { Persistent::uninitialised() }; 2];

/// The two copies.
#[derive(Debug)]
pub struct KeptCopies;

impl KeptMemory for KeptCopies {
    const PRESENT: bool = true;

    fn load(&mut self) -> Option<KeptWords> {
        COPIES.iter().find_map(read)
    }

    fn store(&mut self, words: &KeptWords) {
        for copy in &COPIES {
            write(copy, words);
        }
    }
}

// One code for both copies: flash is scarce.
#[inline(never)]
fn read(copy: &Persistent<KEPT_WORDS>) -> Option<KeptWords> {
    copy.load()
}

#[inline(never)]
fn write(copy: &Persistent<KEPT_WORDS>, words: &KeptWords) {
    copy.store(*words);
}

#[cfg(test)]
mod tests {
    use super::{COPIES, KeptCopies};
    use cordlib::board::{KEPT_WORDS, KeptMemory};

    #[test]
    fn one_damaged_copy_costs_nothing_and_two_cost_all() {
        let mut kept = KeptCopies;
        assert_eq!(kept.load(), None);
        let words = core::array::from_fn(|place| place as u32);
        kept.store(&words);
        COPIES[0].forget();
        assert_eq!(kept.load(), Some(words));
        kept.store(&[7; KEPT_WORDS]);
        COPIES[1].forget();
        assert_eq!(kept.load(), Some([7; KEPT_WORDS]));
        COPIES[0].forget();
        assert_eq!(kept.load(), None);
    }
}
