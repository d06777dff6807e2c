//! Memory that a reset leaves alone.

/// Words of the record that cordlib keeps over a reset.
pub const KEPT_WORDS: usize = 17;

/// The record, in a form that only cordlib reads. It carries the number of its layout: what a firmware with another layout
/// stored counts as nothing.
pub type KeptWords = [u32; KEPT_WORDS];

/// Memory that keeps its content over every reset but a loss of power: latched inhibits, the faults of the charger and
/// the clocks of charging.
///
/// The board seals the record with a CRC, and a reset may come in the middle of [`Self::store`]: keep two copies and write
/// one after the other, so that one of them is always whole.
pub trait KeptMemory {
    /// Whether there is such memory. Without it nothing charges, because a charger that forgets how long it has charged
    /// is not safe.
    const PRESENT: bool;

    /// What was stored last, also before the reset; `None` if there is nothing, or if it is damaged.
    fn load(&mut self) -> Option<KeptWords>;

    /// Stores the record. Called when a latch changes, at most once a millisecond, and every ten seconds.
    fn store(&mut self, words: &KeptWords);
}
