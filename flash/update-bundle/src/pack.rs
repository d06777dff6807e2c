//! Makes the archive. The same files make the same bytes.

use std::fs::File;
use std::io::{self, Read, Write};
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;

use tar::{Builder, Header};

use crate::archive::{MANIFEST, SIGNATURE};
use crate::hashing::Hashing;
use crate::manifest::ListedFile;

/// Lists all files below a folder, in the order of their paths.
///
/// # Errors
/// When one cannot be read.
pub fn list_folder(root: &Path) -> io::Result<Vec<ListedFile>> {
    let mut files = Vec::new();
    gather(root, "", &mut files)?;
    files.sort_by(|one, other| one.path.cmp(&other.path));
    Ok(files)
}

fn gather(folder: &Path, prefix: &str, files: &mut Vec<ListedFile>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{prefix}{name}");
        let about = entry.path().metadata()?;
        if about.is_dir() {
            gather(&entry.path(), &format!("{path}/"), files)?;
            continue;
        }
        let mut hashing = Hashing::new(File::open(entry.path())?);
        io::copy(&mut hashing, &mut io::sink())?;
        files.push(ListedFile {
            path,
            bytes: hashing.bytes,
            executable: about.permissions().mode() & 0o111 != 0,
            sha256: hashing.finish(),
        });
    }
    Ok(())
}

/// Writes manifest, signature, and the listed files from below `root`.
///
/// # Errors
/// When a file cannot be read or the archive not written.
pub fn pack(
    out: impl Write,
    (manifest, signature): (&[u8], &str),
    (root, files): (&Path, &[ListedFile]),
) -> io::Result<()> {
    let mut builder = Builder::new(out);
    append(&mut builder, (MANIFEST, manifest.len() as u64, false), manifest)?;
    let signature = signature.as_bytes();
    append(
        &mut builder,
        (SIGNATURE, signature.len() as u64, false),
        signature,
    )?;
    for file in files {
        let content = File::open(root.join(&file.path))?;
        append(&mut builder, (&file.path, file.bytes, file.executable), content)?;
    }
    builder.into_inner()?.flush()
}

fn append(
    builder: &mut Builder<impl Write>,
    (path, bytes, executable): (&str, u64, bool),
    content: impl Read,
) -> io::Result<()> {
    let mut header = Header::new_ustar();
    header.set_path(path)?;
    header.set_size(bytes);
    header.set_mode(if executable { 0o755 } else { 0o644 });
    header.set_mtime(0);
    header.set_cksum();
    builder.append(&header, content)
}
