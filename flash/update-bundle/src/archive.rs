//! The archive: checked from its first byte to its last.

use std::io::{self, Read};

use tar::{Archive, Entries, Entry, EntryType};

use crate::error::BundleError;
use crate::hashing::Hashing;
use crate::keys::PublicKeys;
use crate::manifest::{ListedFile, Manifest};

pub(crate) const MANIFEST: &str = "manifest.json";
pub(crate) const SIGNATURE: &str = "manifest.json.minisig";
/// The manifest of two thousand files is shorter.
const MANIFEST_BYTES_MAX: u64 = 1 << 20;
/// A signature has four lines.
const SIGNATURE_BYTES_MAX: u64 = 4 << 10;
/// A tar archive is made of blocks; two empty ones end it.
const BLOCK_BYTES: u64 = 512;

/// An update whose every byte was checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifiedBundle {
    /// What is in it.
    pub manifest: Manifest,
    manifest_bytes: Vec<u8>,
    signature: Vec<u8>,
}

/// Takes one file of an update: what it is, and its bytes.
pub type FileTaker<'a> = &'a mut dyn FnMut(&ListedFile, &mut dyn Read) -> io::Result<()>;

/// Checks signature, manifest and all files. The archive is read once, from its start to its end, and `take` sees each file before its hash
/// is known: whatever it makes of it must wait for the outcome.
///
/// # Errors
/// The first thing that is wrong.
pub fn verify(
    archive: impl Read,
    keys: &PublicKeys,
    take: FileTaker<'_>,
) -> Result<VerifiedBundle, BundleError> {
    let mut counted = Counting::new(archive);
    let outcome = verify_counted(&mut counted, keys, take);
    counted.explain(outcome)
}

fn verify_counted(
    counted: &mut Counting<impl Read>,
    keys: &PublicKeys,
    take: FileTaker<'_>,
) -> Result<VerifiedBundle, BundleError> {
    let mut archive = Archive::new(&mut *counted);
    let mut entries = archive.entries().map_err(BundleError::Unreadable)?;
    let manifest_bytes = small(&mut entries, MANIFEST, MANIFEST_BYTES_MAX)?;
    let signature = small(&mut entries, SIGNATURE, SIGNATURE_BYTES_MAX)?;
    let text = std::str::from_utf8(&signature).map_err(|_| BundleError::SignatureFormat)?;
    keys.check(&manifest_bytes, text)?;
    let bundle = VerifiedBundle {
        manifest: Manifest::parse(&manifest_bytes)?,
        manifest_bytes,
        signature,
    };
    files(&mut entries, &bundle.manifest, take)?;
    counted.finish(bundle.archive_bytes())?;
    Ok(bundle)
}

/// Hands out the files of an update that was verified, and checks them once more: the file may have changed since.
///
/// # Errors
/// The first thing that is wrong; what was handed out by then must not be used.
pub fn unpack(archive: impl Read, bundle: &VerifiedBundle, take: FileTaker<'_>) -> Result<(), BundleError> {
    let mut counted = Counting::new(archive);
    let outcome = unpack_counted(&mut counted, bundle, take);
    counted.explain(outcome)
}

fn unpack_counted(
    counted: &mut Counting<impl Read>,
    bundle: &VerifiedBundle,
    take: FileTaker<'_>,
) -> Result<(), BundleError> {
    let mut archive = Archive::new(&mut *counted);
    let mut entries = archive.entries().map_err(BundleError::Unreadable)?;
    let known = [(MANIFEST, &bundle.manifest_bytes), (SIGNATURE, &bundle.signature)];
    for (name, wanted) in known {
        if small(&mut entries, name, MANIFEST_BYTES_MAX)? != *wanted {
            return Err(BundleError::WrongHash(name.to_owned()));
        }
    }
    files(&mut entries, &bundle.manifest, take)?;
    counted.finish(bundle.archive_bytes())
}

impl VerifiedBundle {
    /// How long the archive must be: a header and whole blocks for each entry, and two empty blocks.
    fn archive_bytes(&self) -> u64 {
        let own = [self.manifest_bytes.len() as u64, self.signature.len() as u64];
        let listed = self.manifest.files.iter().map(|file| file.bytes);
        let entries = own.into_iter().chain(listed);
        entries
            .map(|bytes| BLOCK_BYTES + bytes.next_multiple_of(BLOCK_BYTES))
            .sum::<u64>()
            + 2 * BLOCK_BYTES
    }
}

/// The next entry, which must be a plain file of this name.
fn next<'a, R: Read>(entries: &mut Entries<'a, R>, wanted: &str) -> Result<Entry<'a, R>, BundleError> {
    let entry = match entries.next() {
        None => return Err(not_a_bundle(wanted, "the end")),
        Some(Err(_)) => return Err(BundleError::Damaged(wanted.to_owned())),
        Some(Ok(entry)) => entry,
    };
    let found = String::from_utf8_lossy(&entry.path_bytes()).into_owned();
    if entry.header().entry_type() != EntryType::Regular || found != wanted {
        return Err(not_a_bundle(wanted, &found));
    }
    Ok(entry)
}

fn not_a_bundle(wanted: &str, found: &str) -> BundleError {
    BundleError::NotABundle {
        wanted: wanted.to_owned(),
        found: found.to_owned(),
    }
}

/// An entry that is read before anything is known to be signed.
fn small(entries: &mut Entries<'_, impl Read>, wanted: &str, bytes_max: u64) -> Result<Vec<u8>, BundleError> {
    let mut entry = next(entries, wanted)?;
    if entry.size() > bytes_max {
        return Err(BundleError::TooLong {
            path: wanted.to_owned(),
            bytes: entry.size(),
        });
    }
    let mut bytes = Vec::new();
    entry.read_to_end(&mut bytes).map_err(BundleError::Unreadable)?;
    Ok(bytes)
}

fn files(
    entries: &mut Entries<'_, impl Read>,
    manifest: &Manifest,
    take: FileTaker<'_>,
) -> Result<(), BundleError> {
    for listed in &manifest.files {
        let entry = next(entries, &listed.path)?;
        let found_bytes = entry.size();
        if found_bytes != listed.bytes {
            return Err(BundleError::WrongSize {
                path: listed.path.clone(),
                found_bytes,
                wanted_bytes: listed.bytes,
            });
        }
        let mut hashing = Hashing::new(entry);
        take(listed, &mut hashing).map_err(|error| BundleError::Kept {
            path: listed.path.clone(),
            error,
        })?;
        io::copy(&mut hashing, &mut io::sink()).map_err(BundleError::Unreadable)?;
        if hashing.bytes != listed.bytes || hashing.finish() != listed.sha256 {
            return Err(BundleError::WrongHash(listed.path.clone()));
        }
    }
    Ok(())
}

/// A reader that counts, so that a file which is cut off is told from one that is damaged.
struct Counting<R> {
    inner: R,
    bytes: u64,
    is_at_end: bool,
}

impl<R: Read> Counting<R> {
    const fn new(inner: R) -> Self {
        Self {
            inner,
            bytes: 0,
            is_at_end: false,
        }
    }

    /// The rest must be empty, and exactly long enough.
    fn finish(&mut self, wanted_bytes: u64) -> Result<(), BundleError> {
        let mut buffer = [0; 4096];
        loop {
            let count = self.read(&mut buffer).map_err(BundleError::Unreadable)?;
            let is_empty = buffer.iter().take(count).all(|byte| *byte == 0);
            if !is_empty || self.bytes > wanted_bytes {
                return Err(BundleError::Longer(wanted_bytes.min(self.bytes)));
            }
            if count == 0 {
                break;
            }
        }
        if self.bytes < wanted_bytes {
            return Err(BundleError::CutOff {
                found_bytes: self.bytes,
                wanted_bytes,
            });
        }
        Ok(())
    }

    /// A failure at the end of the file is the missing end, whatever it looked like.
    fn explain<T>(&self, outcome: Result<T, BundleError>) -> Result<T, BundleError> {
        match outcome {
            Err(
                BundleError::Unreadable(_)
                | BundleError::Damaged(_)
                | BundleError::Kept { .. }
                | BundleError::WrongHash(_)
                | BundleError::NotABundle { .. }
                | BundleError::SignatureFormat
                | BundleError::WrongSignature,
            ) if self.is_at_end => Err(BundleError::CutOff {
                found_bytes: self.bytes,
                wanted_bytes: self.bytes + 1,
            }),
            outcome => outcome,
        }
    }
}

impl<R: Read> Read for Counting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.is_at_end |= count == 0 && !buffer.is_empty();
        self.bytes += count as u64;
        Ok(count)
    }
}
