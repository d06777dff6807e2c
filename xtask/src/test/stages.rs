//! The stages in the order in which they run: the quick ones first, so that a slip shows at once.

use super::count::Count;
use super::robot;
use super::runner::{Result, all, check, checks, tests};
use crate::workspace::{self, Profile, program};
use crate::{codegen, firmware, panel, process, system, tidy};
use std::path::PathBuf;
use std::process::Command;

/// One stage.
pub(super) struct Stage {
    /// What `--only` takes.
    pub(super) name: &'static str,
    /// One line for people.
    pub(super) does: &'static str,
    /// Whether it runs in real time, or measures a time, so that nothing else may run beside it.
    pub(super) wants_the_machine: bool,
    /// Runs it; the argument asks for the long form.
    pub(super) run: fn(bool) -> Result,
}

/// All stages.
pub(super) const STAGES: [Stage; 17] = [
    Stage {
        name: "fmt",
        does: "the code is formatted",
        wants_the_machine: false,
        run: fmt,
    },
    Stage {
        name: "tidy",
        does: "the rules of the repository hold",
        wants_the_machine: false,
        run: |_| one(tidy::run()),
    },
    Stage {
        name: "codegen",
        does: "generated files are fresh",
        wants_the_machine: false,
        run: codegen_check,
    },
    Stage {
        name: "clippy",
        does: "the linter finds nothing",
        wants_the_machine: false,
        run: clippy,
    },
    Stage {
        name: "firmware",
        does: "the robot's firmware keeps to its budgets; its parts pass their tests",
        wants_the_machine: false,
        run: robot::of_firmware,
    },
    Stage {
        name: "emulator",
        does: "the emulated chip runs programs as other implementations do",
        wants_the_machine: false,
        run: robot::of_emulator,
    },
    Stage {
        name: "tests",
        does: "unit and integration tests, C and Raku included",
        wants_the_machine: false,
        run: workspace_tests,
    },
    Stage {
        name: "attacks",
        does: "each line of the attack table, against a real server on real sockets",
        wants_the_machine: false,
        run: attacks,
    },
    Stage {
        name: "doctests",
        does: "examples in the documentation compile and run",
        wants_the_machine: false,
        run: doctests,
    },
    Stage {
        name: "panel",
        does: "tests of the panel's logic",
        wants_the_machine: false,
        run: panel_tests,
    },
    Stage {
        name: "fuzz",
        does: "the fuzz targets can be built",
        wants_the_machine: false,
        run: fuzz,
    },
    Stage {
        name: "link",
        does: "corrupted packets cause no wrong actuation",
        wants_the_machine: false,
        run: link,
    },
    Stage {
        name: "faults",
        does: "simulations with random faults violate nothing",
        wants_the_machine: false,
        run: faults,
    },
    Stage {
        name: "headless",
        does: "the demo cleans without a browser, with either robot",
        wants_the_machine: true,
        run: headless,
    },
    Stage {
        name: "kill",
        does: "a robot stands soon after its daemon was killed",
        wants_the_machine: true,
        run: kill,
    },
    Stage {
        name: "writes",
        does: "nothing acknowledged is lost when what keeps it is killed while it writes",
        wants_the_machine: true,
        run: writes,
    },
    Stage {
        name: "browser",
        does: "the demo works in a browser",
        wants_the_machine: true,
        run: browser,
    },
];

/// Manifests of the workspaces besides the main one.
const OTHERS: [&str; 7] = [
    "clients/panel/Cargo.toml",
    "firmware/size-probe/Cargo.toml",
    "firmware/pic32mx3-hal/Cargo.toml",
    "firmware/sr8730/Cargo.toml",
    "sim/pic32/proof/Cargo.toml",
    "xtask/uipack/Cargo.toml",
    "protocol/fuzz/Cargo.toml",
];

fn one(result: anyhow::Result<()>) -> Result {
    result?;
    Ok(Count::ONE)
}

fn cargo(words: &[&str]) -> Command {
    let mut command = workspace::cargo();
    command.args(words);
    command
}

fn fmt(_long: bool) -> Result {
    let mut commands = vec![cargo(&["fmt", "--all", "--check"])];
    commands.extend(OTHERS.map(|manifest| cargo(&["fmt", "--all", "--check", "--manifest-path", manifest])));
    checks(&mut commands)
}

fn codegen_check(_long: bool) -> Result {
    one(codegen::run(&codegen::Arguments { check: true }))
}

fn clippy(_long: bool) -> Result {
    check(&mut cargo(&[
        "clippy",
        "--workspace",
        "--all-targets",
        "--locked",
        "--",
        "-D",
        "warnings",
    ]))
}

/// Prepares what tests start: programs of the workspace, a C compiler, Raku. What needs the firmware of a robot or another
/// emulator passes itself over here, and has a stage of its own.
fn workspace_tests(long: bool) -> Result {
    system::need("cc", &["gcc", "libc6-dev"])?;
    system::need("raku", &["rakudo"])?;
    system::need("socat", &["socat"])?;
    system::need("curl", &["curl"])?;
    let build = check(&mut cargo(&["build", "--workspace", "--locked", "--all-targets"]));
    let run = if system::find("cargo-nextest").is_some() {
        tests(&mut cargo(&[
            "nextest",
            "run",
            "--workspace",
            "--locked",
            "--no-fail-fast",
        ]))
    } else {
        tests(&mut cargo(&[
            "test",
            "--workspace",
            "--locked",
            "--all-targets",
            "--no-fail-fast",
        ]))
    };
    let zones = long.then(|| tests(&mut cargo(&ALL_ZONES)));
    all([build, run].into_iter().chain(zones))
}

/// Every change of the clock of every time zone, for every kind of schedule.
const ALL_ZONES: [&str; 7] = [
    "test",
    "--release",
    "--locked",
    "--test",
    "schedule",
    "--",
    "--ignored",
];

/// No package is named: with one cargo would choose other features for what all share, and build it a second time.
const ATTACKS: [&str; 5] = ["test", "--quiet", "--locked", "--test", "attacks"];

fn attacks(_long: bool) -> Result {
    workspace::build(&["rvac-sim", "vthal"], Profile::Dev)?;
    check(&mut cargo(&ATTACKS))
}

/// The same for programs: nothing but the table goes to the output.
pub(super) fn attacks_as_json() -> anyhow::Result<()> {
    workspace::build(&["rvac-sim", "vthal"], Profile::Dev)?;
    let mut command = cargo(&ATTACKS);
    command.args(["--", "--json"]);
    let status = command.status()?;
    anyhow::ensure!(
        status.success(),
        "some attacks came out otherwise than they should"
    );
    Ok(())
}

fn doctests(_long: bool) -> Result {
    check(&mut cargo(&[
        "test",
        "--workspace",
        "--locked",
        "--doc",
        "--no-fail-fast",
    ]))
}

fn panel_tests(_long: bool) -> Result {
    let mut command = cargo(&[
        "test",
        "--locked",
        "--manifest-path",
        "clients/panel/Cargo.toml",
        "--package",
        "panel-logic",
    ]);
    command
        .arg("--target-dir")
        .arg(workspace::target().join("panel-logic"));
    tests(&mut command)
}

/// The bodies of the targets run on mutated packets among the tests of rvac-protocol; here the targets are linked.
fn fuzz(_long: bool) -> Result {
    system::need("c++", &["g++"])?;
    let mut command = cargo(&["build", "--locked", "--manifest-path", "protocol/fuzz/Cargo.toml"]);
    command.arg("--target-dir").arg(workspace::target().join("fuzz"));
    check(&mut command)
}

fn link(long: bool) -> Result {
    workspace::build(&["bench-link"], Profile::Dev)?;
    let mut command = Command::new(program("bench-link", Profile::Dev));
    command.current_dir(workspace::root()).arg("--json");
    command.args(if long {
        ["--long"].as_slice()
    } else {
        ["--packets", "1000000"].as_slice()
    });
    check(&mut command)
}

/// Many runs of the logic built for this machine, some of them for the other robot, and a few of the real firmware, which take
/// two thousand times as long.
fn faults(long: bool) -> Result {
    workspace::build(&["rvac-sim"], Profile::Dev)?;
    let elf = firmware::usual_elf()?;
    let run = |words: &[&str]| {
        let mut command = Command::new(program("rvac-sim", Profile::Dev));
        command.current_dir(workspace::root()).arg("faults").args(words);
        command
    };
    let seeds = if long { "0..100000" } else { "0..1000" };
    let mut on_chip = run(&[
        "--seeds",
        if long { "0..100" } else { "0..4" },
        "--minutes",
        "1",
        "--firmware",
    ]);
    on_chip.arg(elf);
    let other_seeds = if long { "0..10000" } else { "0..100" };
    let other = run(&["--robot", "relax", "--seeds", other_seeds, "--minutes", "2"]);
    let minutes = if long { "10" } else { "2" };
    checks(&mut [run(&["--seeds", seeds, "--minutes", minutes]), other, on_chip])
}

fn headless(_long: bool) -> Result {
    let usual = ["xtask", "demo", "--headless", "--minutes", "3", "--seed", "1"];
    let emulated = [
        "xtask",
        "demo",
        "--headless",
        "--emulated",
        "--minutes",
        "0.5",
        "--seed",
        "1",
    ];
    checks(&mut [cargo(&usual), cargo(&emulated)])
}

fn kill(long: bool) -> Result {
    workspace::build(&["rvac-sim", "vthal", "bench-kill"], Profile::Dev)?;
    let mut command = Command::new(program("bench-kill", Profile::Dev));
    command.current_dir(workspace::root());
    command.args([
        "--home",
        "homes/two-room-flat.toml",
        "--robots",
        "4",
        "--kills",
        if long { "200" } else { "20" },
    ]);
    check(&mut command)
}

fn writes(long: bool) -> Result {
    workspace::build(&["vthal", "panel-server", "bench-writes"], Profile::Dev)?;
    let mut command = Command::new(program("bench-writes", Profile::Dev));
    command.args(["--kills", if long { "100000" } else { "2000" }]);
    check(&mut command)
}

/// The tests take turns in one process: those that measure a time have the machine for themselves.
fn browser(long: bool) -> Result {
    system::need("chromium", &["chromium"])?;
    system::need("chromedriver", &["chromium-driver"])?;
    let assets = panel::build()?;
    let elf = firmware::usual_elf()?;
    workspace::build(&["rvac-sim", "vthal", "panel-server", "rvac"], Profile::Dev)?;
    let screenshots = workspace::target().join("screenshots");
    std::fs::create_dir_all(&screenshots).map_err(anyhow::Error::from)?;
    let axe = axe()?;
    let mut command = cargo(&["test", "--locked", "--test", "browser", "--", "--nocapture"]);
    command
        .env("RVAC_AXE", axe)
        .env("RVAC_BROWSER_TESTS", "1")
        .env("RVAC_LOSSES", if long { "100" } else { "1" })
        .env("RVAC_WATCH_MINUTES", if long { "60" } else { "0.2" })
        .env("RVAC_PANEL", assets)
        .env("RVAC_FIRMWARE", elf)
        .env("RVAC_SCREENSHOTS", screenshots);
    tests(&mut command)
}

/// Fetches axe-core, which looks for faults of accessibility; the lock file beside its manifest names version and checksum.
fn axe() -> anyhow::Result<PathBuf> {
    system::need("npm", &["npm"])?;
    let folder = workspace::target().join("axe");
    let script = folder.join("node_modules/axe-core/axe.min.js");
    std::fs::create_dir_all(&folder)?;
    let lists = workspace::root().join("clients/panel-server/tests/axe");
    for list in ["package.json", "package-lock.json"] {
        std::fs::copy(lists.join(list), folder.join(list))?;
    }
    let mut npm = Command::new("npm");
    npm.args(["ci", "--ignore-scripts", "--no-audit", "--no-fund"])
        .current_dir(&folder);
    process::run("fetch axe-core", &mut npm)?;
    if !script.is_file() {
        anyhow::bail!("npm has fetched axe-core but {} is missing", script.display());
    }
    Ok(script)
}
