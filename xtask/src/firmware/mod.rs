//! `cargo xtask firmware ROBOT`: builds a robot's firmware as ELF and Intel HEX and tells what it takes of the chip. `hal` in place of
//! a robot measures the library of the SR8730's chip.

pub(crate) mod build;
mod checksum;
pub(crate) mod elf;
mod flow;
mod graph;
pub(crate) mod hal;
mod hex;
mod image_crc;
mod instruction;
mod record;
mod report;
pub(crate) mod rp2040;
#[cfg(test)]
mod sample;
pub(crate) mod sdcc;
mod sister;
mod symbol_name;

use crate::chip::Chip;
use crate::codegen::board::calibration::Calibration;
use crate::codegen::board::{Board, WrittenIn};
use crate::{process, toolchain, workspace};
use anyhow::{Context, bail};
use build::{Options, Place};
use elf::{Elf, Segment};
use report::{ChipMemory, Report};
use sister::Choice;
use std::path::{Path, PathBuf};

/// The robot whose firmware tests and measurements use.
pub(crate) const ROBOT: &str = "sr8730";
/// Features for links that the host clocks, and the argument that names such a firmware to `bench-links`.
pub(crate) const CLOCKED_LINKS: [(&str, &str); 2] =
    [("link-spi", "--firmware-spi"), ("link-i2c", "--firmware-i2c")];

/// A sister of it whose firmware drives a display.
pub(crate) const WITH_DISPLAY: &str = "sr8750";

/// Arguments of `cargo xtask firmware`.
#[derive(Debug, clap::Args)]
pub(crate) struct FirmwareArguments {
    /// Robot, by the name of its robot.toml or of a variant with the same board; or "hal", the library of the SR8730's chip.
    robot: String,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Put the measured values of this file into the HEX file.
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// Features of the firmware, separated by commas.
    #[arg(long, value_delimiter = ',')]
    features: Vec<String>,
    /// Build once: do not show that a build in another folder gives the same bytes.
    #[arg(long)]
    once: bool,
}

/// A robot's firmware, by the language that its chip leaves.
#[derive(Clone, Debug)]
pub(crate) enum RobotFirmware {
    /// In Rust, as ELF and Intel HEX.
    InRust(RustBoard),
    /// In C: the Relax's, as Intel HEX.
    InC,
}

/// A board with firmware in Rust.
#[derive(Clone, Debug)]
pub(crate) struct RustBoard {
    board: Board,
    /// The program of its workspace which is the firmware.
    program: String,
    /// The sister of the robot that it is built for: a feature of the program.
    variant: Option<String>,
    /// How much more of the flash that sister's may take.
    flash_allowance_bytes: u32,
}

impl RobotFirmware {
    /// That of the robot with this name.
    pub(crate) fn of(robot: &str) -> anyhow::Result<Self> {
        let Choice {
            board,
            variant,
            flash_allowance_bytes,
        } = choose(robot)?;
        Ok(match (board.written_in.clone(), variant) {
            (WrittenIn::Rust { program }, variant) => Self::InRust(RustBoard {
                board,
                program,
                variant,
                flash_allowance_bytes,
            }),
            (WrittenIn::C, variant) => {
                if let Some(variant) = variant {
                    process::say(&format!("{variant} takes the image of {} as it is", board.name));
                }
                Self::InC
            }
        })
    }

    /// The file that is flashed, built if it is not fresh.
    pub(crate) fn hex(&self) -> anyhow::Result<PathBuf> {
        match self {
            Self::InRust(board) => Ok(build(board, &Options::default(), None)?.hex),
            Self::InC => sdcc::image(),
        }
    }

    /// The image, built if it is not fresh, with the measured values of a file if there is one.
    pub(crate) fn image(&self, calibration: Option<&Path>) -> anyhow::Result<PathBuf> {
        match self {
            Self::InRust(board) => {
                let files = build(board, &Options::default(), calibration)?;
                // The HEX file is the one that has a calibration.
                Ok(if calibration.is_some() {
                    files.hex
                } else {
                    files.elf
                })
            }
            Self::InC if calibration.is_some() => {
                bail!("no calibration is put into the image of relax: leave out --calibration")
            }
            Self::InC => sdcc::image(),
        }
    }
}

/// Builds, writes what is flashed, prints what the firmware takes, and fails when that is too much.
pub(crate) fn run(arguments: &FirmwareArguments) -> anyhow::Result<()> {
    if arguments.robot == hal::NAME {
        if arguments.calibration.is_some() || !arguments.features.is_empty() {
            bail!("the library of the chip has no features and no calibration");
        }
        return hal::run(arguments.json);
    }
    if let Some(port) = rp2040::ports()?.iter().find(|port| port.name == arguments.robot) {
        if arguments.calibration.is_some() || !arguments.features.is_empty() {
            bail!("the firmware of {} has no features and no calibration", port.name);
        }
        return rp2040::run(port, arguments.json);
    }
    match RobotFirmware::of(&arguments.robot)? {
        RobotFirmware::InRust(board) => run_in_rust(arguments, &board),
        RobotFirmware::InC if arguments.calibration.is_some() || !arguments.features.is_empty() => {
            bail!("the firmware of relax has no features, and no calibration is put into its image")
        }
        RobotFirmware::InC => sdcc::run(arguments),
    }
}

fn run_in_rust(arguments: &FirmwareArguments, board: &RustBoard) -> anyhow::Result<()> {
    let record = arguments
        .calibration
        .as_deref()
        .map(|file| record_of(file, board))
        .transpose()?;
    let options = Options {
        features: arguments.features.clone(),
    };
    let linked = link(board, &Place::here(), &options)?;
    let files = FirmwareFiles::write(&stem(board, &options), &linked, record)?;
    let reproducible = match arguments.once {
        true => None,
        false => Some(link(board, &Place::elsewhere()?, &options)? == linked),
    };
    let report = Report::of(&Elf::read(&linked)?, &board.memory()?, reproducible)?;
    if arguments.json {
        process::print(&serde_json::to_string(&report)?);
    } else {
        report.print();
        process::say(&format!("{} and {}", files.elf.display(), files.hex.display()));
    }
    match report.faults() {
        faults if faults.is_empty() => Ok(()),
        faults => bail!("{}", faults.join("; ")),
    }
}

/// What a firmware that was built takes, as the JSON object of `--json`.
pub(crate) fn report(elf: &Path) -> anyhow::Result<serde_json::Value> {
    let bytes = std::fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
    let memory = rust_board(ROBOT)?.memory()?;
    Ok(serde_json::to_value(Report::of(
        &Elf::read(&bytes)?,
        &memory,
        None,
    )?)?)
}

/// The robot of this name, or the one whose sister it is, if there is firmware for it.
fn choose(robot: &str) -> anyhow::Result<Choice> {
    let root = workspace::root();
    let boards = Board::all(&root)?;
    let ports = rp2040::ports().unwrap_or_default();
    let known: Vec<&str> = boards
        .iter()
        .map(|board| board.name.as_str())
        .chain(ports.iter().map(|port| port.name.as_str()))
        .collect();
    sister::choose(&root, &boards, robot)?.with_context(|| {
        format!(
            "there is no firmware for a robot {robot:?}; there is one for: {}",
            known.join(", ")
        )
    })
}

/// The same, which must be in Rust.
fn rust_board(robot: &str) -> anyhow::Result<RustBoard> {
    match RobotFirmware::of(robot)? {
        RobotFirmware::InRust(board) => Ok(board),
        RobotFirmware::InC => bail!("the firmware of {robot} is in C"),
    }
}

impl RustBoard {
    fn memory(&self) -> anyhow::Result<ChipMemory> {
        let chip = Chip::load(&workspace::root().join("robots"), &self.board.chip)?;
        Ok(ChipMemory::of(&chip)?.with_flash_allowance(self.flash_allowance_bytes))
    }
}

/// Builds the firmware once and leaves both files.
pub(crate) fn build(
    board: &RustBoard,
    options: &Options,
    calibration: Option<&Path>,
) -> anyhow::Result<FirmwareFiles> {
    let record = calibration.map(|file| record_of(file, board)).transpose()?;
    let linked = link(board, &Place::here(), options)?;
    FirmwareFiles::write(&stem(board, options), &linked, record)
}

/// Name of the files: `sr8730` or that of a sister, or with features `sr8730-link-sampled`.
fn stem(board: &RustBoard, options: &Options) -> String {
    let mut features = options.features.clone();
    features.sort();
    std::iter::once(board.variant.as_ref().unwrap_or(&board.board.name).clone())
        .chain(features)
        .collect::<Vec<_>>()
        .join("-")
}

/// The robot's firmware as ELF file, built if it is not fresh.
pub(crate) fn usual_elf() -> anyhow::Result<PathBuf> {
    Ok(build(&rust_board(ROBOT)?, &Options::default(), None)?.elf)
}

/// That of a sister with a display.
pub(crate) fn display_elf() -> anyhow::Result<PathBuf> {
    Ok(build(&rust_board(WITH_DISPLAY)?, &Options::default(), None)?.elf)
}

/// The same with a main loop that does not sleep.
pub(crate) fn free_running_elf() -> anyhow::Result<PathBuf> {
    elf_with("free-running")
}

/// The same with this feature.
pub(crate) fn elf_with(feature: &str) -> anyhow::Result<PathBuf> {
    Ok(files_with(feature)?.elf)
}

fn files_with(feature: &str) -> anyhow::Result<FirmwareFiles> {
    let options = Options {
        features: vec![feature.to_owned()],
    };
    build(&rust_board(ROBOT)?, &options, None)
}

/// What owners flash: names of files, and the images, built if they are not fresh.
pub(crate) fn images_for_owners() -> anyhow::Result<[(&'static str, PathBuf); 3]> {
    Ok([
        ("sr8730.hex", RobotFirmware::of(ROBOT)?.hex()?),
        ("sr8730-link-sampled.hex", files_with("link-sampled")?.hex),
        ("relax.hex", RobotFirmware::of(sdcc::ROBOT)?.hex()?),
    ])
}

/// Builds the firmware in a place; gives the bytes of the ELF file with its checksums.
fn link(board: &RustBoard, place: &Place, options: &Options) -> anyhow::Result<Vec<u8>> {
    let tools = toolchain::choose(&toolchain::MIPS)?;
    let path = build::build(board, &tools, place, options)?;
    let bytes = std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let program = Elf::read(&bytes).with_context(|| path.display().to_string())?;
    match image_crc::with_crc(bytes, &program).with_context(|| path.display().to_string())? {
        (bytes, true) => Ok(bytes),
        (_, false) => bail!("{} keeps no words for its checksums (image_crc!)", path.display()),
    }
}

fn record_of(file: &Path, board: &RustBoard) -> anyhow::Result<Segment> {
    let folder = workspace::root().join(&board.board.facts);
    // Faults of the table that the firmware was made from are told in full.
    Calibration::load(&folder)?;
    record::load(file, &board.board.name, &folder)
}

/// What is left for people and programmers.
#[derive(Debug)]
pub(crate) struct FirmwareFiles {
    /// With names and debug information, without a calibration.
    pub(crate) elf: PathBuf,
    /// What is flashed, with the calibration if there is one.
    pub(crate) hex: PathBuf,
}

impl FirmwareFiles {
    fn write(stem: &str, linked: &[u8], record: Option<Segment>) -> anyhow::Result<Self> {
        let folder = workspace::target().join("firmware");
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let files = Self {
            elf: folder.join(format!("{stem}.elf")),
            hex: folder.join(format!("{stem}.hex")),
        };
        let mut segments = Elf::read(linked)?.segments;
        segments.extend(record);
        segments.sort_by_key(|segment| segment.physical);
        let write = |path: &Path, content: &[u8]| {
            std::fs::write(path, content).with_context(|| format!("cannot write {}", path.display()))
        };
        write(&files.elf, linked)?;
        write(&files.hex, hex::text(&segments).as_bytes())?;
        Ok(files)
    }
}
