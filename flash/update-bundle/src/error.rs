//! Why a file is no update that can be trusted.

use crate::manifest::ManifestFault;

/// Each of these comes before anything is touched.
#[derive(Debug, thiserror::Error)]
pub enum BundleError {
    /// The file cannot be read.
    #[error("the file cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// Its end is missing.
    #[error(
        "the file is cut off: {found_bytes} bytes, and {wanted_bytes} are needed at least. Copy it again"
    )]
    CutOff {
        /// Bytes that are there.
        found_bytes: u64,
        /// Bytes that must be there.
        wanted_bytes: u64,
    },
    /// Something follows its end.
    #[error("something follows the end of the update, from byte {0} on")]
    Longer(u64),
    /// It is something else.
    #[error("this is no update: {found:?} stands where {wanted:?} must be")]
    NotABundle {
        /// Name of the entry that must be there.
        wanted: String,
        /// What is there.
        found: String,
    },
    /// An entry's header is damaged.
    #[error("the archive is damaged before {0:?}")]
    Damaged(String),
    /// An entry is longer than it may be.
    #[error("{path:?} has {bytes} bytes, more than any update needs")]
    TooLong {
        /// Which.
        path: String,
        /// Its length.
        bytes: u64,
    },
    /// The signature is none.
    #[error("the signature is not in minisign's format")]
    SignatureFormat,
    /// Signed by somebody else.
    #[error("the update is signed with a key that this robot does not accept")]
    UnknownKey,
    /// The manifest is not what was signed.
    #[error("the signature does not fit the manifest: one of them was changed")]
    WrongSignature,
    /// What was signed is not understood.
    #[error("the manifest: {0}")]
    Manifest(#[from] ManifestFault),
    /// A file has another length than its manifest says.
    #[error("{path:?} has {found_bytes} bytes, and the manifest says {wanted_bytes}")]
    WrongSize {
        /// Which.
        path: String,
        /// Its length.
        found_bytes: u64,
        /// What was signed.
        wanted_bytes: u64,
    },
    /// A file has other bytes than were signed.
    #[error("{0:?} has not the bytes that were signed")]
    WrongHash(String),
    /// Whoever takes the files could not.
    #[error("{path:?} cannot be kept: {error}")]
    Kept {
        /// Which file of the update.
        path: String,
        /// Why.
        error: std::io::Error,
    },
}
