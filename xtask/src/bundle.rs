//! `cargo xtask bundle`: one signed file with daemon, panel and firmware, for one robot and one processor.

use crate::firmware::RobotFirmware;
use crate::package::machine::Machine;
use crate::package::{self, Origin};
use crate::panel::{self, Page};
use crate::{process, workspace};
use anyhow::{Context, bail};
use minisign::{KeyPair, SecretKey, SecretKeyBox};
use serde::Serialize;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use update_bundle::{FirmwareImage, MANIFEST_FORMAT, Manifest, PublicKeys, list_folder, pack, verify};

/// Programs that an update brings. `rvac`, which installs it, comes with the package.
const PROGRAMS: [&str; 2] = ["vthal", "panel-server"];
const SECRET: &str = "update.key";
const PUBLIC: &str = "update.pub";

/// Arguments of `cargo xtask bundle`.
#[derive(Debug, clap::Args)]
pub(crate) struct BundleArguments {
    /// Make a pair of keys in this folder, and nothing else: update.key signs and stays with you, update.pub goes to the boards.
    #[arg(long, value_name = "DIR", exclusive = true)]
    new_key: Option<PathBuf>,
    /// The robot.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Processor of the board: arm (ARMv6, the Pi Zero), armv7, arm64 or amd64.
    #[arg(long, default_value = "arm")]
    machine: Machine,
    /// Grows with each release: boards take no lower one, and none twice.
    #[arg(long, required_unless_present = "new_key")]
    epoch: Option<u64>,
    /// The key that signs, as minisign or --new-key made it; a password is asked for when it has one.
    #[arg(long, value_name = "FILE", required_unless_present = "new_key")]
    key: Option<PathBuf>,
    /// Leave the robot's firmware as it is.
    #[arg(long)]
    without_firmware: bool,
    /// This computer's development programs, for a trial on it.
    #[arg(long)]
    host_programs: bool,
    /// The file; target/bundle/librervac-EPOCH-ROBOT-MACHINE.update when not given.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// What was made.
#[derive(Debug, Serialize)]
struct BundleReport<'a> {
    file: &'a Path,
    bytes: u64,
    manifest: &'a Manifest,
}

/// Makes an update or a pair of keys.
pub(crate) fn run(arguments: &BundleArguments) -> anyhow::Result<()> {
    if let Some(folder) = &arguments.new_key {
        return make_keys(folder);
    }
    let (Some(epoch), Some(key)) = (arguments.epoch, &arguments.key) else {
        bail!("an update needs --epoch and --key");
    };
    // A password is asked for before anything is built for minutes.
    let key = secret_key(key)?;
    let folder = workspace::target().join("bundle");
    let name = format!(
        "librervac-{epoch}-{}-{}",
        arguments.robot,
        arguments.machine.name()
    );
    let root = folder.join(&name);
    let firmware = lay(arguments, &root)?;
    let manifest = Manifest {
        format: MANIFEST_FORMAT,
        epoch,
        version: package::version().to_owned(),
        robot: arguments.robot.clone(),
        machine: arguments.machine.name().to_owned(),
        firmware,
        files: list_folder(&root)?,
    };
    manifest.check()?;
    let usual = folder.join(format!("{name}.update"));
    let out = arguments.out.as_ref().unwrap_or(&usual);
    write(out, (&manifest, &key), &root)?;
    let report = BundleReport {
        file: out,
        bytes: fs::metadata(out)?.len(),
        manifest: &manifest,
    };
    process::print(&match arguments.json {
        true => serde_json::to_string(&report)?,
        false => format!("{}, {} bytes", out.display(), report.bytes),
    });
    Ok(())
}

/// Signs and packs, and reads the file again as a board will.
fn write(out: &Path, (manifest, key): (&Manifest, &SecretKey), root: &Path) -> anyhow::Result<()> {
    let bytes = serde_json::to_vec_pretty(manifest)?;
    let comment = format!(
        "librervac {} {} {}",
        manifest.epoch, manifest.robot, manifest.machine
    );
    let signature = minisign::sign(None, key, &bytes[..], Some(&comment), None)?.into_string();
    let file = File::create(out).with_context(|| format!("cannot write {}", out.display()))?;
    pack(
        BufWriter::new(file),
        (&bytes, &signature),
        (root, &manifest.files),
    )?;
    let public = minisign::PublicKey::from_secret_key(key)?.to_base64();
    verify(File::open(out)?, &PublicKeys::parse(&[public])?, &mut |_, _| {
        Ok(())
    })?;
    Ok(())
}

/// Lays the files out as they will lie on the board; gives what the firmware is.
fn lay(arguments: &BundleArguments, root: &Path) -> anyhow::Result<Option<FirmwareImage>> {
    if root.exists() {
        fs::remove_dir_all(root)?;
    }
    let (origin, page) = match arguments.host_programs {
        true => (Origin::Host, Page::Demo),
        false => (Origin::Released, Page::Release),
    };
    let programs = package::programs(arguments.machine, origin)?;
    for program in PROGRAMS {
        let built = programs.iter().find(|path| path.ends_with(program));
        let built = built.with_context(|| format!("{program} was not built"))?;
        copy(built, &root.join("bin").join(program), 0o755)?;
    }
    copy_folder(&panel::build(page)?, &root.join("panel"))?;
    if arguments.without_firmware {
        return Ok(None);
    }
    let hex = RobotFirmware::of(&arguments.robot)?.hex()?;
    let path = format!("firmware/{}.hex", arguments.robot);
    copy(&hex, &root.join(&path), 0o644)?;
    Ok(Some(FirmwareImage {
        path,
        version: package::version().to_owned(),
    }))
}

fn copy_folder(from: &Path, to: &Path) -> anyhow::Result<()> {
    for entry in fs::read_dir(from).with_context(|| format!("cannot read {}", from.display()))? {
        let path = entry?.path();
        let place = to.join(path.file_name().unwrap_or_default());
        match path.is_dir() {
            true => copy_folder(&path, &place)?,
            false => copy(&path, &place, 0o644)?,
        }
    }
    Ok(())
}

fn copy(from: &Path, to: &Path, mode: u32) -> anyhow::Result<()> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::copy(from, to).with_context(|| format!("cannot copy {}", from.display()))?;
    fs::set_permissions(to, fs::Permissions::from_mode(mode))?;
    Ok(())
}

/// Makes a pair of keys; one that is there already is not replaced.
fn make_keys(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder)?;
    let pair = KeyPair::generate_unencrypted_keypair()?;
    let secret = folder.join(SECRET);
    let mut file = File::options()
        .write(true)
        .create_new(true)
        .mode(0o600)
        .open(&secret)
        .with_context(|| format!("{}: a key that is there stays", secret.display()))?;
    file.write_all(
        pair.sk
            .to_box(Some("signs updates of LibreRVAC"))?
            .into_string()
            .as_bytes(),
    )?;
    let public = folder.join(PUBLIC);
    fs::write(&public, pair.pk.to_box()?.into_string())?;
    process::print(&format!(
        "{} signs: keep it on a computer without a network, and a copy of it. {} goes to /etc/librervac/update-keys on boards",
        secret.display(),
        public.display()
    ));
    Ok(())
}

/// Reads the key that signs; one with a password asks for it.
fn secret_key(path: &Path) -> anyhow::Result<SecretKey> {
    let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let plain = SecretKeyBox::from_string(&text)?.into_unencrypted_secret_key();
    match plain {
        Ok(key) => Ok(key),
        Err(_) => Ok(SecretKeyBox::from_string(&text)?.into_secret_key(None)?),
    }
}
