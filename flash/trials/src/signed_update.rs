//! Updates as files, signed as an owner's computer does it.

use std::fs::{self, File};
use std::io::Write;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use minisign::KeyPair;
use update_bundle::{MANIFEST_FORMAT, Manifest, list_folder, pack};

/// Writes manifest, signature, and the files that it lists from below `root`.
///
/// # Errors
/// When a file cannot be read or the archive not written.
pub fn sign_and_pack(
    out: impl Write,
    (manifest, pair): (&Manifest, &KeyPair),
    root: &Path,
) -> anyhow::Result<()> {
    let bytes = serde_json::to_vec(manifest)?;
    let signature = minisign::sign(None, &pair.sk, &bytes[..], None, None)?.into_string();
    pack(out, (&bytes, &signature), (root, &manifest.files))?;
    Ok(())
}

/// The file of an update of an SR8730's board, this very machine, whose only program is this daemon.
///
/// # Errors
/// When a file cannot be written.
pub fn update_of_daemon(
    folder: &Path,
    (epoch, pair): (u64, &KeyPair),
    daemon: &[u8],
) -> anyhow::Result<PathBuf> {
    let root = folder.join("root");
    let program = root.join("bin/vthal");
    fs::create_dir_all(root.join("bin"))?;
    fs::write(&program, daemon)?;
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755))?;
    let manifest = Manifest {
        format: MANIFEST_FORMAT,
        epoch,
        version: format!("0.{epoch}.0"),
        robot: "sr8730".to_owned(),
        machine: match std::env::consts::ARCH {
            "aarch64" => "arm64".to_owned(),
            _ => "amd64".to_owned(),
        },
        firmware: None,
        files: list_folder(&root)?,
    };
    let path = folder.join(format!("{epoch}.update"));
    sign_and_pack(File::create(&path)?, (&manifest, pair), &root)?;
    Ok(path)
}
