//! What can be wrong with the line or the chip.

/// Faults to inject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoaderFaults {
    /// Something else comes before the first status.
    pub garbage_first: bool,
    /// Identity that it tells in place of its own.
    pub model: Option<u16>,
    /// It does not answer an order of a faster rate: the cable cannot do it.
    pub deaf_above_baud: Option<u32>,
    /// One byte in so many is not heard, once the conversation has begun; 0 for none.
    pub drop_one_in: u32,
    /// One answer in so many is spoilt; 0 for none.
    pub spoil_one_in: u32,
    /// The first byte of the block at this address does not hold what is written.
    pub weak_cell: Option<u16>,
    /// Seed of everything that is drawn.
    pub seed: u64,
}
