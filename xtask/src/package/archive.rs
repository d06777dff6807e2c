//! A tree of files as a Debian package and as a plain archive. The same tree makes the same bytes.

use super::machine::Machine;
use super::{NAME, folder, version};
use crate::{process, system, workspace};
use anyhow::Context;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Scripts that run when the package is installed, removed and purged.
const SCRIPTS: [&str; 3] = ["postinst", "prerm", "postrm"];

/// What distinguishes packages of one tree.
#[derive(Debug)]
pub(super) struct Edition {
    pub(super) version: String,
    /// The moment that all its files carry, seconds since 1970.
    pub(super) epoch_s: u64,
    pub(super) packing: Packing,
}

/// How hard a package is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    /// As small as xz makes it by default: what is given out.
    Small,
    /// Hardly: large programs that a trial installs once, for which the other takes minutes.
    Quick,
}

impl Packing {
    /// Level for xz.
    const fn option(self) -> &'static str {
        match self {
            Self::Small => "-z6",
            Self::Quick => "-z0",
        }
    }
}

/// Makes the Debian package.
pub(super) fn debian(root: &Path, machine: Machine, epoch_s: u64) -> anyhow::Result<PathBuf> {
    debian_of_version(
        root,
        machine,
        &Edition {
            version: version().to_owned(),
            epoch_s,
            packing: Packing::Small,
        },
    )
}

/// Makes the Debian package of another version.
pub(super) fn debian_of_version(root: &Path, machine: Machine, edition: &Edition) -> anyhow::Result<PathBuf> {
    system::need("dpkg-deb", &["dpkg"])?;
    let staged = folder().join(format!("{}.debian", machine.name()));
    if staged.exists() {
        std::fs::remove_dir_all(&staged)?;
    }
    process::capture(Command::new("cp").arg("--archive").arg(root).arg(&staged))?;
    let control = staged.join("DEBIAN");
    std::fs::create_dir_all(&control)?;
    std::fs::set_permissions(&control, std::fs::Permissions::from_mode(0o755))?;
    std::fs::write(
        control.join("control"),
        fields(machine, &edition.version, size_kib(root)?),
    )?;
    for script in SCRIPTS {
        let place = control.join(script);
        std::fs::copy(workspace::root().join("packaging/debian").join(script), &place)?;
        std::fs::set_permissions(&place, std::fs::Permissions::from_mode(0o755))?;
    }
    open_folders(&staged)?;
    let file = folder().join(format!("{NAME}_{}_{}.deb", edition.version, machine.name()));
    let mut pack = Command::new("dpkg-deb");
    // xz, because the dpkg of Debian 11 knows nothing newer; one thread, because the bytes depend on their number.
    pack.args(["--build", "--root-owner-group", "-Zxz", "--uniform-compression"])
        .arg(edition.packing.option())
        .arg(&staged)
        .arg(&file)
        .env("DPKG_DEB_THREADS_MAX", "1")
        .env("SOURCE_DATE_EPOCH", edition.epoch_s.to_string());
    process::run(&format!("pack for Debian on {}", machine.name()), &mut pack)?;
    Ok(file)
}

/// The package's description for dpkg.
fn fields(machine: Machine, version: &str, size_kib: u64) -> String {
    format!(
        "\
Package: {NAME}
Version: {version}
Architecture: {architecture}
Maintainer: the contributors of LibreRVAC <noreply@librervac.invalid>
Installed-Size: {size_kib}
Depends: passwd
Suggests: systemd, udev, avahi-daemon
Section: misc
Priority: optional
Description: free brain and panel for robot vacuum cleaners
 The daemon on the robot's Linux board (vthal), the web panel with its server, and
 the command line rvac. Set it up with: rvac setup
",
        architecture = machine.debian(),
    )
}

fn size_kib(root: &Path) -> anyhow::Result<u64> {
    let text = process::capture(
        Command::new("du")
            .args(["--summarize", "--apparent-size", "--block-size=1024"])
            .arg(root),
    )?;
    let size = text.split_whitespace().next().context("du says nothing")?;
    size.parse().context("du says no number")
}

/// The umask of whoever packs must not reach the board.
fn open_folders(root: &Path) -> anyhow::Result<()> {
    let mut find = Command::new("find");
    find.arg(root)
        .args(["-type", "d", "-exec", "chmod", "755", "{}", "+"]);
    process::capture(&mut find).map(drop)
}

/// Makes the archive for systems without dpkg.
pub(super) fn plain(root: &Path, machine: Machine, epoch_s: u64) -> anyhow::Result<PathBuf> {
    open_folders(root)?;
    let file = folder().join(format!("{NAME}-{}-{}.tar.xz", version(), machine.name()));
    let mut tar = Command::new("tar");
    tar.args(["--create", "--xz", "--sort=name", "--format=gnu"])
        .args(["--owner=0", "--group=0", "--numeric-owner"])
        .arg(format!("--mtime=@{epoch_s}"))
        .arg("--file")
        .arg(&file)
        .arg("--directory")
        .arg(root)
        .arg(".")
        .env("XZ_OPT", "-6 -T1");
    system::need("xz", &["xz-utils"])?;
    process::run(&format!("pack an archive for {}", machine.name()), &mut tar)?;
    Ok(file)
}
