//! Stages about the robot's own chip: its firmware, and the emulator that runs it.

use super::count::Count;
use super::extent::Extent;
use super::runner::{Failed, Result, all, cargo, check, checks_side_by_side, tests};
use crate::firmware::build::build_others;
use crate::workspace::{self, Profile, program};
use crate::{firmware, system};
use std::path::Path;
use std::process::Command;

/// Workspaces of firmware, whose parts are also tested on this machine.
const FIRMWARE: [&str; 2] = ["firmware/pic32mx3-hal/Cargo.toml", "firmware/sr8730/Cargo.toml"];

/// The firmware is built and measured, and what of it runs on this machine is tested. With the campaigns a second build in another folder
/// must give the same bytes, and the firmware with each other link and that for a display keep to their budgets, too.
pub(super) fn of_firmware(extent: Extent) -> Result {
    let firmware = |words: &[&str]| {
        let mut command = cargo(&["xtask", "firmware", firmware::ROBOT]);
        command.args(words);
        command
    };
    let builds = if extent.has_campaigns() {
        let with = |feature| firmware(&["--once", "--features", feature]);
        let with_display = cargo(&["xtask", "firmware", firmware::WITH_DISPLAY, "--once"]);
        vec![
            firmware(&[]),
            with("link-sampled"),
            with("link-rs485"),
            with("link-spi"),
            with("link-i2c"),
            with_display,
        ]
    } else {
        vec![firmware(&["--once"])]
    };
    let mut in_c = cargo(&["xtask", "firmware", firmware::sdcc::ROBOT]);
    in_c.args((!extent.has_campaigns()).then_some("--once"));
    let ports = if extent.has_campaigns() {
        ports()
    } else {
        Vec::new()
    };
    let lints = FIRMWARE
        .map(|manifest| on_this_machine("clippy", manifest, &["--all-targets", "--", "-D", "warnings"]));
    let tested =
        FIRMWARE.map(|manifest| on_this_machine("test", manifest, &["--lib", "--tests", "--no-fail-fast"]));
    let lints = lints.into_iter().map(|mut command| check(&mut command));
    let tested = tested.into_iter().map(|mut command| tests(&mut command));
    let builds = builds.into_iter().map(|mut command| check(&mut command));
    all(builds
        .chain([check(&mut in_c)])
        .chain(ports)
        .chain(lints)
        .chain(tested))
}

/// Firmware that is found by its manifest: each is built and says hello in an emulator.
fn ports() -> Vec<Result> {
    let found = match firmware::rp2040::ports() {
        Ok(found) => found,
        Err(error) => {
            return vec![Err(Failed {
                count: Count::default(),
                errors: vec![error],
            })];
        }
    };
    let run = |name: &str| check(&mut cargo(&["xtask", "firmware", name]));
    found.iter().map(|port| run(&port.name)).collect()
}

fn on_this_machine(what: &str, manifest: &str, words: &[&str]) -> Command {
    let mut command = workspace::cargo();
    command.args([what, "--locked", "--manifest-path", manifest, "--target-dir"]);
    command.arg(workspace::target().join("firmware/host")).args(words);
    command
}

/// Tests that need the built firmware, its parts or other people's emulator and debugger. No package is named, so that all is
/// built once for this stage and for the other tests.
const BESIDE_OTHERS: [&str; 7] = [
    "cord_in_chip",
    "gdb",
    "hal_examples",
    "image",
    "lights_and_keys",
    "qemu",
    "ucsim",
];

/// The emulated chips beside qemu-user and uCsim, and with the programs that are written for them.
pub(super) fn of_emulator(_extent: Extent) -> Result {
    system::need("qemu-mipsel-static", &["qemu-user-static"])?;
    let elf = firmware::usual_elf()?;
    let sampled = firmware::elf_with("link-sampled")?;
    let display = firmware::display_elf()?;
    let rs485 = firmware::elf_with("link-rs485")?;
    let relax = firmware::sdcc::image()?;
    system::need("gdb-multiarch", &["gdb-multiarch"])?;
    system::need("sdcc", &["sdcc"])?;
    need_ucsim()?;
    let programs = build_others(
        "the emulator's proof",
        &["--manifest-path", "sim/pic32/proof/Cargo.toml"],
    )?;
    let examples = firmware::hal::build_examples()?;
    let mut command = workspace::cargo();
    command
        .args(["test", "--locked", "--no-fail-fast"])
        .args(BESIDE_OTHERS.map(|test| ["--test", test]).concat())
        .env("RVAC_PROOF", programs)
        .env("RVAC_EXAMPLES", examples)
        .env("RVAC_FIRMWARE", &elf)
        .env("RVAC_FIRMWARE_SAMPLED", sampled)
        .env("RVAC_FIRMWARE_DISPLAY", display)
        .env("RVAC_FIRMWARE_RS485", rs485)
        .env("RVAC_RELAX", relax.with_file_name(""));
    let mut programs = vec![
        "rvac",
        "bench-firmware",
        "bench-links",
        "bench-relax",
        "relax-pace",
    ];
    programs.extend(TRIALS.map(|(program, _)| program));
    workspace::build(&programs, Profile::Dev)?;
    let pace = check(&mut pace(&elf)?);
    let mut trials = TRIALS
        .map(|(program, words)| trial(program, words, &elf))
        .into_iter()
        .collect::<Vec<_>>();
    trials.push(trial("bench-relax", &["--phases", "2"], &relax));
    trials.push(damaged_packets(&relax));
    let trials = checks_side_by_side(trials);
    // In real time, so nothing runs beside it.
    let mut links = trial("bench-links", &["--seconds", "4", "--cuts", "2"], &elf);
    for (feature, argument) in firmware::CLOCKED_LINKS {
        links.arg(argument).arg(firmware::elf_with(feature)?);
    }
    let links = check(&mut links);
    let owner = tests(&mut owner(&elf));
    all([tests(&mut command), owner, pace, trials, links].into_iter())
}

/// Damaged packets for the Relax's image; `cargo xtask bench relax --long` sends more.
fn damaged_packets(image: &Path) -> Command {
    let mut command = Command::new(program("relax-pace", Profile::Dev));
    command.arg(image).args(["0", "--corrupted", "3000"]);
    command
}

/// The 8051's simulator comes in a package of its own, and its program has another name in newer releases.
fn need_ucsim() -> anyhow::Result<()> {
    if ["s51", "ucsim_51"]
        .iter()
        .any(|program| system::find(program).is_some())
    {
        return Ok(());
    }
    system::install(&["sdcc-ucsim"])
}

/// An owner calibrates the emulated robot with `rvac`. Each robot keeps the pace of the clock on the wall, so not more at once than two cores
/// emulate with room to spare.
fn owner(elf: &Path) -> Command {
    let mut command = workspace::cargo();
    command
        .args(["test", "--locked", "--test", "owner"])
        .args(["--no-fail-fast", "--", "--test-threads", "3"])
        .env("RVAC_FIRMWARE", elf)
        .env("RVAC_PROGRAM", program("rvac", Profile::Dev));
    command
}

/// The real firmware under faults, a little of each; `cargo xtask bench safety --long` and its like take more.
const TRIALS: [(&str, &[&str]); 4] = [
    ("bench-safety", &["--phases", "4"]),
    (
        "bench-flips",
        &["--count", "500", "--courses", "1", "--image-checks", "2"],
    ),
    ("bench-charges", &["--count", "4"]),
    ("bench-flood", &["--count", "2"]),
];

fn trial(name: &str, words: &[&str], elf: &Path) -> Command {
    let mut command = Command::new(program(name, Profile::Dev));
    command.current_dir(workspace::root());
    command.args(words).arg("--firmware").arg(elf);
    command
}

/// What `cargo xtask bench firmware` measures, for a moment.
fn pace(elf: &Path) -> anyhow::Result<Command> {
    let words = ["--home", "homes/two-room-flat.toml", "--flood-seconds", "10"];
    let mut command = trial("bench-firmware", &words, elf);
    command.arg("--free-running").arg(firmware::free_running_elf()?);
    Ok(command)
}
