//! A job from the command line to its end.

use std::io::{IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context as _, bail};
use calibration_values::{Catalog, Measurements, ValuesError, record};
use pic32_icsp::Part;
use stc_isp::{Entry, Report, Step};

use crate::arguments::{FlashJob, FlashVerb, Safeguards};
use crate::backups::Backups;
use crate::gpio_lines::GpioLines;
use crate::hex;
use crate::journal::Journal;
use crate::line_loan::{LineLoan, RobotAnswers};
use crate::progress_line::progress_line;
use crate::serial_line::SerialLine;
use crate::settings::{FlashSettings, RobotName};
use crate::wired_robot::entry_of;
use crate::{relax, sr8730};

/// Where the daemon listens.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DaemonSocket(pub PathBuf);

/// Does the job.
///
/// # Errors
/// Why it was not done, and what to do.
pub fn run(job: &FlashJob, socket: &DaemonSocket) -> anyhow::Result<ExitCode> {
    let settings = FlashSettings::read(&job.wiring)?;
    let answers = match job.robot_is_silent {
        true => RobotAnswers::Silent,
        false => RobotAnswers::Expected,
    };
    // Files first: a robot is not disturbed for a file that is damaged.
    let content = FileContent::read(&job.verb, settings.robot)?;
    let journal = Journal::new(&settings.folder);
    if let Some(warning) = journal.warning() {
        eprintln!("{warning}");
    }
    match settings.robot {
        RobotName::Sr8730 => {
            let wiring = settings
                .icsp
                .as_ref()
                .context("the wiring has no [icsp]: the lines to the programming port")?;
            let _loan = LineLoan::take(&socket.0, &settings.serial, answers)?;
            let mut lines = GpioLines::open(wiring)
                .with_context(|| format!("cannot use the lines of [icsp] on {}", wiring.chip.display()))?;
            on_sr8730(&mut lines, (&job.verb, &content), &settings.folder)?;
        }
        RobotName::Relax => {
            let _loan = LineLoan::take(&socket.0, &settings.serial, answers)?;
            let mut line = SerialLine::open(&settings.serial, settings.power.as_ref())
                .with_context(|| format!("cannot use {}", settings.serial.display()))?;
            on_relax(
                &mut line,
                (&job.verb, &content, entry_of(&settings)),
                &settings.folder,
            )?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// What the job's file holds.
enum FileContent {
    /// The job has none.
    None,
    Firmware(Vec<hex::Piece>),
    Calibration {
        record: Vec<u8>,
        count: usize,
    },
}

impl FileContent {
    fn read(verb: &FlashVerb, robot: RobotName) -> anyhow::Result<Self> {
        Ok(match verb {
            FlashVerb::Write { file, .. } | FlashVerb::Verify { file } => Self::Firmware(read_hex(file)?),
            FlashVerb::Calibration { file } => read_calibration(file, robot)?,
            FlashVerb::Probe | FlashVerb::Backup | FlashVerb::Restore { .. } => Self::None,
        })
    }

    fn pieces(&self) -> &[hex::Piece] {
        match self {
            Self::Firmware(pieces) => pieces,
            Self::None | Self::Calibration { .. } => &[],
        }
    }
}

fn read_calibration(path: &Path, robot: RobotName) -> anyhow::Result<FileContent> {
    let catalog = Catalog::of(robot.name())?;
    let measured = Measurements::open(path, &catalog)?;
    if measured.count() == 0 {
        return Err(ValuesError::Empty(path.to_owned()).into());
    }
    Ok(FileContent::Calibration {
        record: record(&catalog, &measured)?,
        count: measured.count(),
    })
}

fn read_hex(path: &Path) -> anyhow::Result<Vec<hex::Piece>> {
    let text = kept_file::read_text(path).with_context(|| path.display().to_string())?;
    hex::parse(&text).with_context(|| path.display().to_string())
}

pub(crate) fn now() -> String {
    jiff::Timestamp::now()
        .round(jiff::Unit::Second)
        .map_or_else(|_| String::from("1970-01-01T00:00:00Z"), |now| now.to_string())
}

fn on_sr8730(
    lines: &mut GpioLines,
    (verb, content): (&FlashVerb, &FileContent),
    folder: &Path,
) -> anyhow::Result<()> {
    let keeping = sr8730::Keeping {
        backups: Backups::new(folder),
        journal: Journal::new(folder),
        date: now(),
    };
    let mut shown = shown_on_terminal();
    let mut show = |progress: pic32_icsp::Progress| {
        shown(
            sr8730::word(progress.task),
            (progress.done_bytes, progress.total_bytes),
        );
    };
    match verb {
        FlashVerb::Probe => {
            let id = sr8730::probe(lines, &mut show)?;
            let name = Part::of_id(id).map_or("unknown", |part| part.name);
            println!("{name}, revision {}, not protected", id >> 28);
        }
        FlashVerb::Backup => {
            let name = sr8730::backup(lines, &keeping, &mut show)?;
            println!("kept {name} in {}", folder.display());
            println!(
                "Copy both of its files to another computer: they are the way back if this board's card dies."
            );
        }
        FlashVerb::Write { safeguards, .. } => {
            let image = sr8730::image_of(content.pieces())?;
            sr8730::write(lines, (&image, *safeguards), &keeping, &mut show)?;
            println!("written and verified");
        }
        FlashVerb::Calibration { .. } => {
            if let FileContent::Calibration { record, count } = content {
                sr8730::write_calibration(lines, record, &keeping, &mut show)?;
                println!("{count} values are in the robot. `rvac status` says what it still lacks.");
            }
        }
        FlashVerb::Verify { .. } => {
            sr8730::verify(lines, &sr8730::image_of(content.pieces())?, &mut show)?;
            println!("the chip holds this image");
        }
        FlashVerb::Restore { name, safeguards } => {
            let backup = keeping.backups.load(name.as_deref())?;
            sr8730::restore(lines, (&backup, *safeguards), &keeping, &mut show)?;
            println!("{} is in the chip again, verified", backup.name);
        }
    }
    Ok(())
}

fn on_relax(
    line: &mut SerialLine,
    (verb, content, entry): (&FlashVerb, &FileContent, Entry),
    folder: &Path,
) -> anyhow::Result<()> {
    let keeping = relax::KeptImages {
        folder: folder.to_owned(),
        journal: Journal::new(folder),
        date: now(),
    };
    let mut shown = shown_on_terminal();
    let mut show = |step: Step, progress| {
        if matches!(step, Step::Write { .. }) {
            shown("write", progress);
        }
    };
    match verb {
        FlashVerb::Probe => say(&relax::probe(line, entry, &mut show)?),
        FlashVerb::Backup => bail!("this chip cannot be read: nobody can back up what is in it"),
        FlashVerb::Calibration { .. } => bail!("this robot keeps no measured values in its flash"),
        FlashVerb::Verify { .. } => {
            bail!("this chip cannot be read: it is verified block by block while it is written")
        }
        FlashVerb::Write { safeguards, .. } => {
            let image = relax::image_of(content.pieces())?;
            say(&relax::write(
                line,
                (&image, *safeguards, entry),
                &keeping,
                &mut show,
            )?);
        }
        FlashVerb::Restore { .. } => {
            let image = keeping
                .way_back()
                .context("no image is known that ran on this robot: write one with `rvac flash write`")?;
            let sure = Safeguards::default();
            say(&relax::write(line, (&image, sure, entry), &keeping, &mut show)?);
        }
    }
    Ok(())
}

fn say(report: &Report) {
    println!(
        "{}, {:.3} MHz, {} clocks a cycle, loader {}.{}",
        report.model.name,
        report.clock.hz as f64 / 1e6,
        report.clock.clocks_per_cycle,
        report.loader_version >> 4,
        report.loader_version & 15
    );
    if let Some(baud) = report.baud {
        println!(
            "{} bytes written at {baud} baud, each block confirmed by its sum",
            report.written_bytes
        );
    }
}

/// Shows progress on a terminal, and nothing elsewhere.
pub(crate) fn shown_on_terminal() -> impl FnMut(&str, (usize, usize)) {
    let is_terminal = std::io::stderr().is_terminal();
    let mut task = (String::new(), Instant::now());
    let mut last = String::new();
    move |what: &str, progress: (usize, usize)| {
        if task.0 != what {
            task = (what.to_owned(), Instant::now());
        }
        let elapsed_ms = u64::try_from(task.1.elapsed().as_millis()).unwrap_or(u64::MAX);
        let line = progress_line(what, progress, elapsed_ms);
        if is_terminal && line != last {
            let end = if progress.0 >= progress.1 { "\n" } else { "" };
            // Progress that cannot be shown stops no write.
            write!(std::io::stderr(), "\r{line}\x1b[K{end}").ok();
        }
        last = line;
    }
}
