//! A job from the command line to its end.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context as _, bail};
use rustix::fs::{FlockOperation, Mode, OFlags, flock};
use rustix::process::umask;
use rvac_flash::{DaemonSocket, FlashSettings, WiredRobot};
use serde::Serialize;
use update_bundle::PublicKeys;

use crate::arguments::UpdateJob;
use crate::disk::RealDisk;
use crate::error::UpdateError;
use crate::fallback::{DaemonEnd, FAILURES_MAX, Fallback, Moment};
use crate::journal::{Installed, Pending};
use crate::progress::{ProgressFile, tell_given_up};
use crate::services::{Restart, Services};
use crate::slots::{Programs, Slots};
use crate::updater::{Accepted, Settled, UpdateStep, Updater, WayBack};
use crate::wired_chip::WiredChip;

/// How often somebody who only looks may be in the way of a lock.
const LOCK_ATTEMPTS: u32 = 20;
const LOCK_PAUSE: Duration = Duration::from_millis(100);

/// Does the job.
///
/// # Errors
/// Why it was not done, and what to do.
pub fn run(job: &UpdateJob, socket: &Path) -> anyhow::Result<ExitCode> {
    let slots = Slots::at(&job.folder);
    if job.daemon_starts || job.daemon_ended.is_some() {
        count_start(job, &slots)?;
        return Ok(ExitCode::SUCCESS);
    }
    if job.file.is_none() && !job.settle {
        show(&slots, job.json)?;
        return Ok(ExitCode::SUCCESS);
    }
    // The services' users read all of it, whatever the habits of whoever runs this.
    umask(Mode::from_raw_mode(0o022));
    std::fs::create_dir_all(&job.folder).with_context(|| job.folder.display().to_string())?;
    let _lock = lock(job)?;
    let mut progress = match job.settle {
        true => ProgressFile::resume(&job.folder),
        false => ProgressFile::begin(&job.folder),
    };
    if let Err(error) = work(job, (&slots, socket), &mut progress) {
        progress.failed(&error);
        return Err(error);
    }
    show(&slots, job.json)?;
    Ok(ExitCode::SUCCESS)
}

fn work(
    job: &UpdateJob,
    (slots, socket): (&Slots, &Path),
    progress: &mut ProgressFile,
) -> anyhow::Result<()> {
    // The file first: one that is handed over is gone afterwards, whatever else is wrong.
    let archive = job
        .file
        .as_deref()
        .map(|file| open(file, job.take).with_context(|| file.display().to_string()));
    let archive = archive.transpose()?;
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
    let mut tell = |step: UpdateStep| {
        progress.on_step(&step);
        say(&step);
    };
    let Some(mut archive) = archive else {
        let settled = updater.settle(&mut tell)?;
        match settled {
            Settled::Nothing => {}
            Settled::WentBack => eprintln!("the update that was cut off is undone"),
            Settled::WentOn => eprintln!("the update that was cut off is in use"),
        }
        progress.settled(settled);
        return Ok(());
    };
    let accepted = accepted(job, robot)?;
    updater.install(&mut archive, &accepted, &mut tell)?;
    progress.installed();
    Ok(())
}

/// Opens the file of an update. One that is taken comes from a folder that others write: what is no plain file is not followed.
fn open(path: &Path, take: bool) -> std::io::Result<File> {
    if !take {
        return File::open(path);
    }
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let file = File::from(rustix::fs::open(path, flags, Mode::empty())?);
    std::fs::remove_file(path)?;
    if !file.metadata()?.is_file() {
        return Err(std::io::Error::new(
            std::io::ErrorKind::InvalidInput,
            "it is no plain file",
        ));
    }
    Ok(file)
}

/// What systemd says of the daemon, for an update that fails again and again.
fn count_start(job: &UpdateJob, slots: &Slots) -> anyhow::Result<()> {
    let mut fallback = Fallback {
        slots,
        disk: &mut RealDisk,
    };
    let now = moment()?;
    let Some(ended) = &job.daemon_ended else {
        return Ok(fallback.daemon_starts(now)?);
    };
    let end = DaemonEnd {
        result: ended.first().map_or("", String::as_str),
        status: ended.get(1).map_or("", String::as_str),
    };
    if let Some(given_up) = fallback.daemon_ended(end, &now)? {
        tell_given_up(slots.root(), &given_up);
        eprintln!(
            "the daemon of update {} failed {FAILURES_MAX} times, one after the other: the programs before it run again",
            given_up.epoch
        );
    }
    Ok(())
}

/// Now, on the clock of this start of the board.
fn moment() -> anyhow::Result<Moment> {
    let uptime = std::fs::read_to_string("/proc/uptime").context("/proc/uptime")?;
    let s = uptime.split(' ').next().and_then(|word| word.parse().ok());
    let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").context("boot_id")?;
    Ok(Moment {
        boot: boot.trim().to_owned(),
        s: s.context("/proc/uptime")?,
    })
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
    // The error stays what it is below its context: it has a code.
    PublicKeys::parse(&texts)
        .map_err(UpdateError::from)
        .with_context(|| format!("keys in {}", folder.display()))
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
fn lock(job: &UpdateJob) -> anyhow::Result<File> {
    let path = job.folder.join("lock");
    let file = File::create(&path).with_context(|| path.display().to_string())?;
    if job.take {
        flock(&file, FlockOperation::LockExclusive).with_context(|| path.display().to_string())?;
        return Ok(file);
    }
    for _ in 0..LOCK_ATTEMPTS {
        if flock(&file, FlockOperation::NonBlockingLockExclusive).is_ok() {
            return Ok(file);
        }
        std::thread::sleep(LOCK_PAUSE);
    }
    bail!("another update runs");
}

fn say(step: &UpdateStep) {
    let words = match step {
        UpdateStep::Verified { .. } => return,
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
    if report.installed.given_up {
        writeln!(
            out,
            "update {} is not in use any more: its daemon failed {FAILURES_MAX} times; the programs before it run",
            report.installed.epoch
        )?;
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
