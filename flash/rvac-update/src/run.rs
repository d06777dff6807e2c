//! A job from the command line to its end.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context as _, bail};
use rustix::fs::{FlockOperation, Mode, flock};
use rustix::process::umask;
use rvac_flash::{DaemonSocket, FlashSettings, WiredRobot};
use serde::Serialize;
use update_bundle::PublicKeys;

use crate::arguments::UpdateJob;
use crate::disk::RealDisk;
use crate::journal::{Installed, Pending};
use crate::services::{Restart, Services};
use crate::slots::{Programs, Slots};
use crate::updater::{Accepted, Settled, UpdateStep, Updater, WayBack};
use crate::wired_chip::WiredChip;

/// Does the job.
///
/// # Errors
/// Why it was not done, and what to do.
pub fn run(job: &UpdateJob, socket: &Path) -> anyhow::Result<ExitCode> {
    let slots = Slots::at(&job.folder);
    if job.file.is_none() && !job.settle {
        show(&slots, job.json)?;
        return Ok(ExitCode::SUCCESS);
    }
    // The services' users read all of it, whatever the habits of whoever runs this.
    umask(Mode::from_raw_mode(0o022));
    std::fs::create_dir_all(&job.folder).with_context(|| job.folder.display().to_string())?;
    let _lock = lock(&job.folder)?;
    let settings = wiring(&job.wiring)?;
    let mut board = services(job, socket);
    let robot = match &settings {
        Some(settings) => Some(settings.robot.name().to_owned()),
        None => board.greet().and_then(|greeting| greeting.robot),
    };
    let mut chip =
        settings.map(|settings| WiredChip(WiredRobot::new(settings, DaemonSocket(socket.to_owned()))));
    let mut updater = Updater {
        slots: slots.clone(),
        disk: &mut RealDisk,
        board: &mut board,
        chip: chip.as_mut(),
    };
    match &job.file {
        Some(file) => {
            let accepted = accepted(job, robot)?;
            let mut archive = File::open(file).with_context(|| file.display().to_string())?;
            updater.install(&mut archive, &accepted, &mut say)?;
        }
        None => match updater.settle(&mut say)? {
            Settled::Nothing => {}
            Settled::WentBack => eprintln!("the update that was cut off is undone"),
            Settled::WentOn => eprintln!("the update that was cut off is in use"),
        },
    }
    show(&slots, job.json)?;
    Ok(ExitCode::SUCCESS)
}

fn services(job: &UpdateJob, socket: &Path) -> Services {
    Services {
        restart: match job.at_boot {
            true => Restart::Later,
            false => Restart::Command(job.restart.split_whitespace().map(str::to_owned).collect()),
        },
        socket: socket.to_owned(),
        page_port: Some(job.page_port).filter(|port| *port != 0),
        patience: Duration::from_secs(job.patience_s),
    }
}

fn accepted(job: &UpdateJob, robot: Option<String>) -> anyhow::Result<Accepted> {
    Ok(Accepted {
        keys: keys(&job.keys)?,
        robot,
        machine: machine()?.to_owned(),
        firmware: !job.without_firmware,
        way_back: match job.no_way_back {
            true => WayBack::None,
            false => WayBack::Needed,
        },
    })
}

/// The wiring; none when there is no such file.
fn wiring(path: &Path) -> anyhow::Result<Option<FlashSettings>> {
    if !path.exists() {
        return Ok(None);
    }
    Ok(Some(FlashSettings::read(path)?))
}

fn keys(folder: &Path) -> anyhow::Result<PublicKeys> {
    let entries = match std::fs::read_dir(folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
        outcome => Some(outcome.with_context(|| folder.display().to_string())?),
    };
    let mut paths: Vec<PathBuf> = entries
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "pub"))
        .collect();
    paths.sort();
    let texts = paths
        .iter()
        .map(|path| std::fs::read_to_string(path).with_context(|| path.display().to_string()));
    let texts = texts.collect::<anyhow::Result<Vec<String>>>()?;
    PublicKeys::parse(&texts).with_context(|| format!("keys in {}", folder.display()))
}

/// The processor that this program was compiled for, in the words of packages.
fn machine() -> anyhow::Result<&'static str> {
    Ok(match std::env::consts::ARCH {
        "x86_64" => "amd64",
        "aarch64" => "arm64",
        "arm" if cfg!(target_feature = "v7") => "armv7",
        "arm" => "arm",
        other => bail!("there are no updates for a {other}"),
    })
}

/// One updater at a time; the kernel gives the lock back when the process ends.
fn lock(folder: &Path) -> anyhow::Result<File> {
    let path = folder.join("lock");
    let file = File::create(&path).with_context(|| path.display().to_string())?;
    if flock(&file, FlockOperation::NonBlockingLockExclusive).is_err() {
        bail!("another update runs");
    }
    Ok(file)
}

fn say(step: UpdateStep) {
    let words = match step {
        UpdateStep::Verify => "checks the file ...",
        UpdateStep::Unpack => "unpacks it ...",
        UpdateStep::TryPrograms => "starts the new programs and waits until they answer ...",
        UpdateStep::KeepFirmware => "keeps what is in the robot's chip ...",
        UpdateStep::WriteFirmware => "writes the robot's firmware: leave it on its dock ...",
        UpdateStep::TryFirmware => "waits until the robot answers ...",
        UpdateStep::GoBack => "goes back ...",
    };
    // Words that cannot be shown stop no update.
    writeln!(std::io::stderr(), "{words}").ok();
}

/// What is installed, for programs.
#[derive(Debug, Serialize)]
struct UpdateReport {
    programs: Programs,
    #[serde(flatten)]
    installed: Installed,
    pending: Option<Pending>,
}

fn show(slots: &Slots, json: bool) -> anyhow::Result<()> {
    let report = UpdateReport {
        programs: slots.current(),
        installed: slots.installed()?,
        pending: slots.pending()?,
    };
    let mut out = std::io::stdout();
    if json {
        writeln!(out, "{}", serde_json::to_string(&report)?)?;
        return Ok(());
    }
    match report.programs {
        Programs::Package => writeln!(out, "the programs of the installed package run")?,
        Programs::Update(_) => writeln!(
            out,
            "the programs of update {} run, version {}",
            report.installed.epoch, report.installed.version
        )?,
    }
    if report.pending.is_some() {
        writeln!(
            out,
            "an update was cut off: rvac update --settle brings it to an end"
        )?;
    }
    Ok(())
}
