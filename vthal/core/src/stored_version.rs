//! The version that kept data carries.

/// Kept data that another daemon has written, in a form that this one does not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it has version {found}, and this daemon reads version {read}")]
pub struct OtherVersion {
    found: u32,
    read: u32,
}

impl OtherVersion {
    /// Whether what was `found` is what this daemon reads.
    pub(crate) fn expect(found: u32, read: u32) -> Result<(), Self> {
        if found == read {
            Ok(())
        } else {
            Err(Self { found, read })
        }
    }
}
