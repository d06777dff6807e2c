//! What an owner does with a package, step after step.

use super::chroot::Chroot;
use super::{Editions, Scope, Trial};
use crate::package::images;
use crate::package::machine::Machine;
use crate::workspace::{self, Profile};
use crate::{process, system};
use anyhow::{Context, bail};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Under an emulated processor everything takes ten times as long.
const PATIENCE: Duration = Duration::from_secs(120);
const LOOK: Duration = Duration::from_millis(100);
/// What `rvac setup` writes.
const CONFIGURATION: &str = "etc/vthal.toml";
/// The simulated robot's end of the line, as the bare Debian sees it.
const ROBOT: &str = "/tmp/robot";
/// A kept file, to see whether it stays.
const MARK: &str = "/var/lib/vthal/mark";

/// A program that is ended with the trial.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // A daemon stops the wheels before it ends.
        Command::new("kill").arg(self.0.id().to_string()).status().ok();
        let deadline = Instant::now() + Duration::from_secs(5);
        while Instant::now() < deadline {
            if matches!(self.0.try_wait(), Ok(Some(_))) {
                return;
            }
            std::thread::sleep(LOOK);
        }
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

/// Tries one package.
pub(super) fn run(chroot: &Chroot, packages: &Editions, scope: Scope) -> anyhow::Result<Trial> {
    system::need("curl", &["curl"])?;
    workspace::build(&["rvac-sim"], Profile::Dev)?;
    install(chroot, &packages.first)?;
    let installed = chroot.succeeds(&["rvac", "--version"])
        && chroot.succeeds(&["getent", "passwd", "vthal"])
        && has_images(chroot);
    let _robot = robot(chroot)?;
    let _bridge = set_up_with(chroot, packages.machine)?;
    let set_up = chroot.path(CONFIGURATION).is_file();
    let used = use_it(chroot)?;
    std::fs::write(chroot.path(MARK), "kept")?;
    install(chroot, &packages.next)?;
    let kept = || chroot.path(MARK).is_file() && chroot.path(CONFIGURATION).is_file();
    let upgraded = kept()
        && chroot
            .run(&["dpkg-query", "--show", "librervac"])?
            .contains("+next");
    chroot.run(&["dpkg", "--remove", "librervac"])?;
    let removal_kept_state = kept() && !chroot.path("usr/bin/vthal").exists();
    chroot.run(&["dpkg", "--purge", "librervac"])?;
    let left = [
        CONFIGURATION,
        "var/lib/vthal",
        "var/lib/rvac-panel",
        "usr/share/librervac",
    ];
    let purged = !left.iter().any(|path| chroot.path(path).exists())
        && !chroot.succeeds(&["getent", "passwd", "vthal"]);
    Ok(Trial {
        machine: packages.machine.name(),
        released: scope == Scope::Released,
        installed,
        set_up,
        answered: used.answered,
        panel_over_tls: used.panel_over_tls,
        upgraded,
        removal_kept_state,
        purged,
        answers_after_ms: used.answers_after_ms,
        vthal_rss_kib: used.vthal_rss_kib,
        panel_server_rss_kib: used.panel_server_rss_kib,
    })
}

/// Whether `rvac flash` finds in the package what the guide writes into robots.
fn has_images(chroot: &Chroot) -> bool {
    ["sr8730.hex", "sr8730-link-sampled.hex", "relax.hex"]
        .iter()
        .all(|name| chroot.path(images::PLACE).join(name).is_file())
}

fn install(chroot: &Chroot, package: &Path) -> anyhow::Result<()> {
    std::fs::copy(package, chroot.path("librervac.deb"))?;
    chroot.run(&["dpkg", "--install", "/librervac.deb"]).map(drop)
}

/// Runs `rvac setup`. On this machine's own processor it finds the robot on its serial device. The emulator of others has no serial devices (the
/// requests of termios2 are missing in it), so the robot is named there, and reached over the network.
fn set_up_with(chroot: &Chroot, machine: Machine) -> anyhow::Result<Option<Running>> {
    if machine == Machine::Amd64 {
        chroot.run(&["rvac", "setup", "--yes", "--serial", ROBOT])?;
        return Ok(None);
    }
    chroot.run(&["rvac", "setup", "--yes", "--model", "sr8730"])?;
    let port = free_port()?;
    let file = chroot.path(CONFIGURATION);
    let written = std::fs::read_to_string(&file).context("rvac setup has written no configuration")?;
    let rest: String = written
        .split_inclusive('\n')
        // Its table says a serial device.
        .filter(|line| !line.starts_with("[link]") && !line.starts_with("serial ="))
        .collect();
    std::fs::write(&file, format!("link = \"tcp:127.0.0.1:{port}\"\n{rest}"))?;
    system::need("socat", &["socat"])?;
    let mut socat = Command::new("socat");
    socat
        .arg(format!("TCP-LISTEN:{port},bind=127.0.0.1,reuseaddr,fork"))
        .arg(format!("FILE:{},rawer", chroot.path(ROBOT).display()));
    Ok(Some(Running(socat.spawn().context("cannot start socat")?)))
}

/// A simulated robot on a terminal that the bare Debian's daemon may open.
fn robot(chroot: &Chroot) -> anyhow::Result<Running> {
    let link = chroot.path(ROBOT);
    let mut serve = Command::new(workspace::program("rvac-sim", Profile::Dev));
    serve
        .args(["serve", "--home"])
        .arg(workspace::root().join("homes/two-room-flat.toml"))
        .arg("--link")
        .arg(&link)
        .arg("--socket")
        .arg(chroot.path("tmp/simulator.sock"))
        .stdout(Stdio::null());
    let robot = Running(serve.spawn().context("cannot start the simulated robot")?);
    await_that("the simulated robot is there", || link.symlink_metadata().is_ok())?;
    // The daemon's user is in the group of serial devices, to which a pseudo terminal does not belong.
    process::capture(Command::new("chmod").arg("666").arg(std::fs::read_link(&link)?))?;
    Ok(robot)
}

/// What was seen while both services ran.
struct Used {
    answered: bool,
    panel_over_tls: bool,
    answers_after_ms: u64,
    vthal_rss_kib: u64,
    panel_server_rss_kib: u64,
}

fn use_it(chroot: &Chroot) -> anyhow::Result<Used> {
    // systemd's service makes this folder; the package's line for tmpfiles says how.
    chroot.run(&[
        "install",
        "-d",
        "-m",
        "0750",
        "-o",
        "vthal",
        "-g",
        "librervac",
        "/run/vthal",
    ])?;
    let begun = Instant::now();
    let vthal = service(chroot, "vthal.service", &[])?;
    await_that("the robot answers", || {
        chroot.succeeds(&["sh", "-c", "rvac status | grep -q 'link up'"])
    })?;
    let answers_after_ms = begun.elapsed().as_millis() as u64;
    let port = free_port()?;
    let panel = service(
        chroot,
        "rvac-panel.service",
        &[
            ("--port 443", format!("--port {port}")),
            ("--page-port 80", String::new()),
        ],
    )?;
    let answered = chroot.succeeds(&["rvac", "start"])
        && await_that("the robot drives", || {
            chroot.succeeds(&["sh", "-c", "rvac status | grep -q '(cleaning|starting)' -E"])
        })
        .is_ok();
    let page = format!("https://127.0.0.1:{port}/");
    let panel_over_tls = await_that("the panel answers", || page_comes(&page)).is_ok();
    chroot.run(&["rvac", "stop"])?;
    Ok(Used {
        answered,
        panel_over_tls,
        answers_after_ms,
        vthal_rss_kib: memory_kib(&vthal)?,
        panel_server_rss_kib: memory_kib(&panel)?,
    })
}

fn page_comes(page: &str) -> bool {
    let output = process::finish(Command::new("curl").args(["--insecure", "--silent", "--fail", page]));
    output.is_ok_and(|output| output.status.success() && output.stdout.starts_with(b"<!"))
}

/// Starts what a unit starts, as its user and group, since no systemd runs in the folder.
fn service(chroot: &Chroot, unit: &str, changes: &[(&str, String)]) -> anyhow::Result<Running> {
    let text = std::fs::read_to_string(chroot.path("lib/systemd/system").join(unit))?;
    let text = text.replace("\\\n", " ");
    let value = |key: &str| {
        text.lines()
            .find_map(|line| line.strip_prefix(key)?.strip_prefix('='))
            .with_context(|| format!("{unit} has no {key}"))
    };
    let mut line = value("ExecStart")?.replace("$RVAC_PANEL_OPTIONS", "");
    for (from, to) in changes {
        if !line.contains(from) {
            bail!("{unit} does not say {from}");
        }
        line = line.replace(from, to);
    }
    let mut command = chroot.command("setpriv");
    command
        .arg(format!("--reuid={}", value("User")?))
        .arg(format!("--regid={}", value("Group")?))
        .args(["--init-groups", "--no-new-privs"])
        .args(line.split_whitespace())
        .stdout(Stdio::null());
    Ok(Running(command.spawn()?))
}

fn memory_kib(running: &Running) -> anyhow::Result<u64> {
    // chroot and setpriv become the program: the process is the same.
    let status = std::fs::read_to_string(format!("/proc/{}/status", running.0.id()))?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let number = line
        .and_then(|line| line.split_whitespace().next())
        .context("no VmRSS")?;
    number.parse().context("VmRSS")
}

fn free_port() -> anyhow::Result<u16> {
    Ok(TcpListener::bind("127.0.0.1:0")?.local_addr()?.port())
}

fn await_that(what: &str, is_so: impl Fn() -> bool) -> anyhow::Result<()> {
    let deadline = Instant::now() + PATIENCE;
    while !is_so() {
        if Instant::now() > deadline {
            bail!("{what}: not within {} s", PATIENCE.as_secs());
        }
        std::thread::sleep(LOOK);
    }
    Ok(())
}
