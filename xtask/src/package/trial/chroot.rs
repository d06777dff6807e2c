//! A bare Debian in a folder, with the devices of this machine while it is used.

use crate::package::folder;
use crate::package::machine::Machine;
use crate::{process, system};
use anyhow::{Context, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The Debian on which the packages are tried: the oldest that they are for.
const SUITE: &str = "bookworm";
/// The kernel's list of emulators of other processors.
const EMULATORS: &str = "/proc/sys/fs/binfmt_misc";

/// A folder with a Debian.
#[derive(Debug)]
pub(super) struct Chroot {
    folder: PathBuf,
}

impl Chroot {
    /// Makes it anew: nothing of an earlier trial is in it.
    pub(super) fn bare(machine: Machine) -> anyhow::Result<Self> {
        if !rustix::process::geteuid().is_root() {
            bail!(
                "only root may try packages in a bare Debian: start this with sudo, or leave the stage packages out"
            );
        }
        let place = folder().join(format!("chroot-{}", machine.name()));
        let chroot = Self { folder: place };
        chroot.clear()?;
        if machine != Machine::Amd64 {
            emulate_arm()?;
        }
        let mut make = Command::new("debootstrap");
        make.args(["--variant=minbase", "--arch", machine.debian(), SUITE])
            .arg(&chroot.folder)
            .stdout(Stdio::null());
        process::run(
            &format!(
                "install a bare Debian for {} (a minute; longer under an emulator)",
                machine.name()
            ),
            &mut make,
        )?;
        for (kind, inside) in [("--rbind", "dev"), ("--rbind", "proc")] {
            let mut mount = Command::new("mount");
            mount.arg(kind).arg(format!("/{inside}")).arg(chroot.path(inside));
            process::capture(&mut mount)
                .with_context(|| format!("cannot show /{inside} to the bare Debian"))?;
            // What is taken away at the end is taken from the folder alone.
            process::capture(
                Command::new("mount")
                    .arg("--make-rslave")
                    .arg(chroot.path(inside)),
            )?;
        }
        Ok(chroot)
    }

    /// A path inside.
    pub(super) fn path(&self, inside: &str) -> PathBuf {
        self.folder.join(inside.trim_start_matches('/'))
    }

    /// A command that runs inside, as root.
    pub(super) fn command(&self, program: &str) -> Command {
        let mut command = Command::new("chroot");
        command.arg(&self.folder).arg(program);
        command.env_clear().env(
            "PATH",
            "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
        );
        command.env("LC_ALL", "C.UTF-8").stdin(Stdio::null());
        command
    }

    /// Runs a command inside to its end and gives what it says.
    pub(super) fn run(&self, words: &[&str]) -> anyhow::Result<String> {
        let Some((program, arguments)) = words.split_first() else {
            bail!("no command");
        };
        process::capture(self.command(program).args(arguments))
    }

    /// Whether a command inside succeeds.
    pub(super) fn succeeds(&self, words: &[&str]) -> bool {
        words.split_first().is_some_and(|(program, arguments)| {
            self.command(program)
                .args(arguments)
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .status()
                .is_ok_and(|status| status.success())
        })
    }

    fn clear(&self) -> anyhow::Result<()> {
        for inside in ["dev", "proc"] {
            unmount(&self.path(inside));
        }
        if self.folder.exists() {
            // With --one-file-system nothing is deleted that is only shown in the folder.
            let mut remove = Command::new("rm");
            remove
                .args(["--recursive", "--force", "--one-file-system"])
                .arg(&self.folder);
            process::capture(&mut remove)?;
        }
        Ok(())
    }
}

impl Drop for Chroot {
    fn drop(&mut self) {
        for inside in ["dev", "proc"] {
            unmount(&self.path(inside));
        }
    }
}

fn unmount(place: &Path) {
    // Nothing may be mounted there, which is no fault.
    Command::new("umount")
        .args(["--recursive", "--lazy"])
        .arg(place)
        .stderr(Stdio::null())
        .status()
        .ok();
}

/// Has the kernel run programs for ARM by qemu.
fn emulate_arm() -> anyhow::Result<()> {
    system::need("qemu-arm-static", &["qemu-user-static"])?;
    let entry = Path::new(EMULATORS).join("qemu-arm");
    if entry.exists() {
        return Ok(());
    }
    if !Path::new(EMULATORS).join("register").exists() {
        process::capture(Command::new("mount").args(["-t", "binfmt_misc", "binfmt_misc", EMULATORS]))
            .context("this kernel runs no programs for other processors (binfmt_misc)")?;
    }
    let line = std::fs::read_to_string("/usr/lib/binfmt.d/qemu-arm.conf")
        .context("qemu-user-static says nothing of the programs that it runs")?;
    std::fs::write(Path::new(EMULATORS).join("register"), line.trim())
        .context("the kernel does not take qemu for ARM programs")
}
