//! The file of an update: one tar archive with a signed list of all that is in it.
//!
//! Its entries are `manifest.json`, `manifest.json.minisig`, and then the files that the manifest lists, in that order and nothing else.
//! [`verify`] believes nothing that is not signed: it checks the signature before it parses the manifest, and then each file's size and
//! hash, to the last byte of the archive. [`unpack`] does the same once more while it hands the files out. Nothing here writes a file.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod archive;
mod error;
mod hashing;
mod keys;
mod manifest;
mod pack;

pub use archive::{FileTaker, VerifiedBundle, unpack, verify};
pub use error::BundleError;
pub use hashing::hash_of;
pub use keys::{KeyError, PublicKeys};
pub use manifest::{
    FIRMWARE_BYTES_MAX, FirmwareImage, ListedFile, MANIFEST_FORMAT, Manifest, ManifestFault, is_firmware,
};
pub use pack::{list_folder, pack};
