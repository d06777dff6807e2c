//! Firmware in C for the Relax's 8051: built with Debian's SDCC, measured in the emulated chip, and compiled for a Cortex-M0
//! as well, so that the cord stays portable.

mod build;
mod memory;
mod sealed;
mod stack;

use super::FirmwareArguments;
use crate::chip::{Chip, Region};
use crate::workspace::{self, Profile};
use crate::{process, system};
use anyhow::{Context, bail};
use build::Built;
use memory::MemoryUse;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The robot by its name.
pub(crate) const ROBOT: &str = "relax";
/// Passes of the main loop that we hold ourselves to.
const IDLE_HZ_LEAST: f64 = 5_000.0;
const DRIVING_HZ_LEAST: f64 = 2_000.0;

/// What the chip has, in the words of its compiler.
#[derive(Clone, Debug)]
pub(crate) struct Mcs51Memory {
    /// Program flash.
    code: Region,
    /// External memory on the chip.
    xdata: Region,
    /// Internal memory: registers, variables and the stack.
    idata: Region,
}

impl Mcs51Memory {
    /// That of the robot's chip.
    fn of_robot() -> anyhow::Result<Self> {
        let chip = Chip::load(
            &workspace::root().join("robots"),
            &super::choose(ROBOT)?.board.chip,
        )?;
        Ok(Self {
            code: chip.region("program-flash")?.clone(),
            xdata: chip.region("external-ram")?.clone(),
            idata: chip.region("internal-ram")?.clone(),
        })
    }

    /// What the linker may use of the flash: the rest is the CRC.
    fn program_bytes(&self) -> u32 {
        self.code.bytes.saturating_sub(sealed::CRC_BYTES)
    }
}

/// What the firmware takes.
#[derive(Debug, Serialize)]
struct ChipUse {
    code_bytes: u32,
    xdata_bytes: u32,
    idata_bytes: u32,
    stack_worst_bytes: u32,
    stack_seen_bytes: u32,
    main_loop_idle_hz: f64,
    main_loop_driving_hz: f64,
    states_per_s: f64,
    bytes_lost: u64,
    violations: u64,
    reproducible: Option<bool>,
    cortex_m0_text_bytes: u32,
    cortex_m0_data_bytes: u32,
    #[serde(skip)]
    chip: Mcs51Memory,
}

/// What the emulated chip showed.
#[derive(serde::Deserialize)]
struct Pace {
    main_loop_idle_hz: f64,
    main_loop_driving_hz: f64,
    stack_to: u32,
    bytes_overrun: u64,
    host_bad_packets: u64,
    robot_lost: u64,
    states_per_s: f64,
    refused: u64,
    resets: u64,
    violations: u64,
    bridge_shorts: u64,
    misuses: u64,
}

/// Builds, measures and prints; fails when something is too much.
pub(super) fn run(arguments: &FirmwareArguments) -> anyhow::Result<()> {
    let built = build::build(&folder("relax"), Mcs51Memory::of_robot()?)?;
    let reproducible = match arguments.once {
        true => None,
        false => {
            Some(build::build(&folder("relax-elsewhere"), Mcs51Memory::of_robot()?)?.hex()? == built.hex()?)
        }
    };
    let report = report(&built, reproducible)?;
    if arguments.json {
        process::print(&serde_json::to_string(&report)?);
    } else {
        report.print();
        process::say(&built.image.display().to_string());
    }
    match report.faults() {
        faults if faults.is_empty() => Ok(()),
        faults => bail!("{}", faults.join("; ")),
    }
}

/// The image as it is flashed.
pub(crate) fn image() -> anyhow::Result<PathBuf> {
    Ok(built()?.image)
}

/// The image, and where its functions are.
pub(crate) fn built() -> anyhow::Result<Built> {
    build::build(&folder("relax"), Mcs51Memory::of_robot()?)
}

fn folder(name: &str) -> PathBuf {
    workspace::target().join("firmware").join(name)
}

fn report(built: &Built, reproducible: Option<bool>) -> anyhow::Result<ChipUse> {
    let memory = MemoryUse::read(built)?;
    let stack_worst_bytes = stack::worst(&built.listings()?)?;
    let pace = pace(built)?;
    if pace.resets + pace.bridge_shorts + pace.misuses + pace.refused > 0 {
        bail!(
            "in the emulated chip: {} resets, {} cycles with both lines of a wheel on, {} misuses, {} refused commands",
            pace.resets,
            pace.bridge_shorts,
            pace.misuses,
            pace.refused
        );
    }
    let (cortex_m0_text_bytes, cortex_m0_data_bytes) = cortex_m0()?;
    Ok(ChipUse {
        code_bytes: memory.code,
        xdata_bytes: memory.xdata,
        idata_bytes: memory.idata,
        stack_worst_bytes,
        stack_seen_bytes: pace.stack_to.saturating_sub(memory.idata - 1),
        main_loop_idle_hz: pace.main_loop_idle_hz,
        main_loop_driving_hz: pace.main_loop_driving_hz,
        states_per_s: pace.states_per_s,
        bytes_lost: pace.bytes_overrun + pace.host_bad_packets + pace.robot_lost,
        violations: pace.violations,
        reproducible,
        cortex_m0_text_bytes,
        cortex_m0_data_bytes,
        chip: built.chip.clone(),
    })
}

/// Lets the image run in the emulated chip with a host that drives it.
fn pace(built: &Built) -> anyhow::Result<Pace> {
    workspace::build(&["relax-pace"], Profile::Dev)?;
    let mut command = Command::new(workspace::program("relax-pace", Profile::Dev));
    command.arg(&built.image).arg(built.address_of("_cord_pass")?);
    let told = process::capture(&mut command)?;
    serde_json::from_str(&told).with_context(|| format!("relax-pace said {told}"))
}

/// Compiles the cord for a Cortex-M0; gives bytes of code with constants, and of variables.
fn cortex_m0() -> anyhow::Result<(u32, u32)> {
    system::need("arm-none-eabi-gcc", &["gcc-arm-none-eabi"])?;
    let out = folder("cortex-m0");
    std::fs::create_dir_all(&out)?;
    let root = workspace::root().join("firmware");
    let sources = build::sources(&root.join("cord-c/cord"))?;
    let mut objects = Vec::new();
    for source in &sources {
        let object = out
            .join(source.file_stem().unwrap_or_default())
            .with_extension("o");
        let mut compiler = Command::new("arm-none-eabi-gcc");
        compiler.args(["-mcpu=cortex-m0", "-mthumb", "-Os", "-std=c99", "-ffreestanding"]);
        compiler
            .args(["-Wall", "-Wextra", "-Werror", "-c", "-o"])
            .arg(&object)
            .arg(source);
        for folder in [
            "cord-c/cord",
            "cord-c/generated",
            "cord-c/host",
            "cordlib-c/include",
            "relax/board/generated",
        ] {
            compiler.arg("-I").arg(root.join(folder));
        }
        process::capture(&mut compiler)?;
        objects.push(object);
    }
    let mut size = Command::new("arm-none-eabi-size");
    let table = process::capture(size.args(&objects))?;
    let sum = |column: usize| -> u32 {
        let cell = |line: &str| line.split_whitespace().nth(column)?.parse::<u32>().ok();
        table.lines().skip(1).filter_map(cell).sum()
    };
    Ok((sum(0), sum(1) + sum(2)))
}

impl ChipUse {
    fn print(&self) {
        let of = |what: &str, used: u32, all: u32| process::print(&format!("{what:<16}{used:>8} of {all}"));
        let idata = self.chip.idata.bytes;
        let stack_room = idata.saturating_sub(self.idata_bytes);
        of("code", self.code_bytes, self.chip.program_bytes());
        of("xdata", self.xdata_bytes, self.chip.xdata.bytes);
        of("idata", self.idata_bytes, idata);
        of("worst stack", self.stack_worst_bytes, stack_room);
        of("stack seen", self.stack_seen_bytes, stack_room);
        let line = |what: &str, value: String| process::print(&format!("{what:<16}{value:>8}"));
        line("passes at rest", format!("{:.0}/s", self.main_loop_idle_hz));
        line("while driving", format!("{:.0}/s", self.main_loop_driving_hz));
        line("telemetry", format!("{:.0}/s", self.states_per_s));
        line("bytes lost", self.bytes_lost.to_string());
        line(
            "Cortex-M0",
            format!("{} + {}", self.cortex_m0_text_bytes, self.cortex_m0_data_bytes),
        );
    }

    fn faults(&self) -> Vec<String> {
        let too_much = [
            ("code", self.code_bytes, self.chip.program_bytes()),
            ("xdata", self.xdata_bytes, self.chip.xdata.budget_bytes()),
            (
                "idata with the worst stack",
                self.idata_bytes + self.stack_worst_bytes,
                self.chip.idata.budget_bytes(),
            ),
        ];
        let mut faults: Vec<String> = too_much
            .iter()
            .filter(|(_, used, most)| used > most)
            .map(|(what, used, most)| format!("{what}: {used} bytes of {most}"))
            .collect();
        let too_slow = [
            ("at rest", self.main_loop_idle_hz, IDLE_HZ_LEAST),
            ("while driving", self.main_loop_driving_hz, DRIVING_HZ_LEAST),
        ];
        faults.extend(
            too_slow
                .iter()
                .filter(|(_, found, least)| found < least)
                .map(|(when, found, least)| {
                    format!("{found:.0} passes a second {when}, less than {least:.0}")
                }),
        );
        if self.bytes_lost + self.violations > 0 {
            faults.push(format!(
                "{} bytes lost, {} violations",
                self.bytes_lost, self.violations
            ));
        }
        if self.reproducible == Some(false) {
            faults.push("a build in another folder gives other bytes".to_owned());
        }
        faults
    }
}

/// The file with this ending among what SDCC leaves.
fn beside(image: &Path, ending: &str) -> PathBuf {
    image.with_extension(ending)
}
