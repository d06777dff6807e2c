//! What the host's ends of all links have in common that it clocks itself.

/// Bytes that wait for a transfer.
pub trait ClockedHost {
    /// These bytes are for the robot.
    fn send(&mut self, bytes: &[u8]);

    /// Bytes that wait, in the form of this link.
    fn waiting(&self) -> usize;
}

/// Transfers over a bus of this kind.
pub trait TransfersOver<B>: ClockedHost {
    /// Why the bus does not work.
    type Error;

    /// One transfer; what the robot said is appended to `heard`. Gives whether anything was said or taken.
    ///
    /// # Errors
    /// The bus does not work; what was to be sent stays.
    fn transfer(&mut self, bus: &mut B, heard: &mut Vec<u8>) -> Result<bool, Self::Error>;
}
