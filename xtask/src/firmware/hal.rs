//! `cargo xtask firmware hal`: the library of the SR8730's chip as a crate that others can take: what it has, which examples run in
//! the emulator, how much of it is documented, and whether its package builds alone.

use super::build::build_others;
use crate::{process, toolchain, workspace};
use anyhow::{Context, bail, ensure};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Its name among the robots.
pub(super) const NAME: &str = "hal";
/// Its folder, and the file in which its parts have owners.
const FOLDER: &str = "firmware/pic32mx3-hal";
const PARTS: &str = "src/peripherals.rs";
/// Words of this project, which a crate for others does not have.
const FOREIGN_WORDS: [&str; 3] = ["librervac", "rvac", "cordlib"];
/// What the tests of the examples print before each example that they run.
const RUNS_EXAMPLE: &str = "runs example ";

/// What came of it.
#[derive(Debug, Serialize)]
struct HalReport {
    /// The types that own a part of the chip.
    peripherals: Vec<String>,
    /// Examples that did in the emulator what their tests expect.
    examples_run: usize,
    /// Of all that is public.
    documented_percent: f64,
    /// The package has no warnings and no word of this project, and was built alone for this machine and for the chip.
    package_clean: bool,
}

/// Measures, prints, and fails when something is missing.
pub(super) fn run(json: bool) -> anyhow::Result<()> {
    let folder = workspace::root().join(FOLDER);
    let parts = std::fs::read_to_string(folder.join(PARTS)).context("cannot read the parts of the chip")?;
    let peripherals = peripherals(&parts)?;
    let faults = package_faults(&folder)?;
    let documented_percent = documented_percent(&folder)?;
    let expected = example_names(&folder)?;
    let run = run_examples()?;
    let report = HalReport {
        peripherals,
        examples_run: expected.intersection(&run).count(),
        documented_percent,
        package_clean: faults.is_empty(),
    };
    if json {
        process::print(&serde_json::to_string(&report)?);
    } else {
        process::print(&format!("peripherals         {}", report.peripherals.join(", ")));
        process::print(&format!("examples run        {}", report.examples_run));
        process::print(&format!("documented          {:.1} %", report.documented_percent));
        process::print(&format!("package clean       {}", report.package_clean));
    }
    ensure!(
        faults.is_empty(),
        "the package is not clean: {}",
        faults.join("; ")
    );
    let missing: Vec<&String> = expected.difference(&run).collect();
    ensure!(
        missing.is_empty(),
        "examples without a test in the emulator: {missing:?}"
    );
    ensure!(
        documented_percent >= 100.0,
        "only {documented_percent:.1} % is documented"
    );
    Ok(())
}

/// The types of the fields of `Peripherals`, each once.
fn peripherals(source: &str) -> anyhow::Result<Vec<String>> {
    let (_, fields) = source
        .split_once("pub struct Peripherals {")
        .context("there is no struct Peripherals")?;
    let fields = fields.split_once("\n}").map_or(fields, |(fields, _)| fields);
    let kinds = fields.lines().filter_map(|line| {
        let (_, kind) = line.trim().strip_prefix("pub ")?.split_once(": ")?;
        kind.split(['<', ',']).next().map(str::to_owned)
    });
    Ok(kinds.collect::<BTreeSet<_>>().into_iter().collect())
}

/// Packs it, which builds the package alone for this machine, and builds that for the chip; gives what is wrong with it.
fn package_faults(folder: &Path) -> anyhow::Result<Vec<String>> {
    let target = workspace::target().join("firmware/package");
    let mut command = workspace::cargo();
    command.args(["package", "--locked", "--allow-dirty", "--manifest-path"]);
    command
        .arg(folder.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target);
    process::say("pack pic32mx3-hal and build the package alone");
    let output = process::finish(&mut command)?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    ensure!(output.status.success(), "cargo package failed:\n{text}");
    let mut faults: Vec<String> = text
        .lines()
        .filter(|line| line.starts_with("warning"))
        .map(str::to_owned)
        .collect();
    let packed = unpacked(&target.join("package"))?;
    for file in files_below(&packed)? {
        let Ok(content) = std::fs::read_to_string(&file) else {
            continue;
        };
        let content = content.to_lowercase();
        let words = FOREIGN_WORDS.iter().filter(|word| content.contains(**word));
        faults.extend(words.map(|word| format!("{} says {word}", file.display())));
    }
    let alone = std::env::temp_dir().join(format!("pic32mx3-hal-{}", std::process::id()));
    let built = build_alone(&packed, &alone);
    // Nobody looks into it afterwards.
    std::fs::remove_dir_all(&alone).ok();
    built?;
    Ok(faults)
}

/// Builds the package for the chip in a folder that nothing of this project is around.
fn build_alone(packed: &Path, alone: &Path) -> anyhow::Result<()> {
    for file in files_below(packed)? {
        let to = alone.join(file.strip_prefix(packed)?);
        if let Some(folder) = to.parent() {
            std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
        }
        std::fs::copy(&file, &to).with_context(|| format!("cannot write {}", to.display()))?;
    }
    let tools = toolchain::choose(&toolchain::MIPS)?;
    let mut command = tools.cargo();
    command
        .args(["build", "--release", "--lib", "--manifest-path"])
        .arg(alone.join("Cargo.toml"))
        .args(["--target", toolchain::MIPS.triple, "--target-dir"])
        .arg(workspace::target().join("cross"));
    process::run("build the package alone for the chip", &mut command)
}

/// The folder that the package was unpacked into.
fn unpacked(packages: &Path) -> anyhow::Result<PathBuf> {
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(packages).with_context(|| format!("cannot read {}", packages.display()))? {
        let path = entry?.path();
        if path.join("Cargo.toml").is_file() {
            folders.push(path);
        }
    }
    match folders.as_slice() {
        [one] => Ok(one.clone()),
        _ => bail!("{} holds {} packages", packages.display(), folders.len()),
    }
}

fn files_below(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(files_below(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}

/// How much of a file's public parts has documentation, as rustdoc counts.
#[derive(Debug, serde::Deserialize)]
struct Coverage {
    total: u32,
    with_docs: u32,
}

/// Asks rustdoc, whose count stable Rust keeps behind a variable.
fn documented_percent(folder: &Path) -> anyhow::Result<f64> {
    let mut command = workspace::cargo();
    command.env("RUSTC_BOOTSTRAP", "1");
    command.args(["rustdoc", "--lib", "--locked", "--manifest-path"]);
    command.arg(folder.join("Cargo.toml")).arg("--target-dir");
    command.arg(workspace::target().join("firmware/package"));
    command.args([
        "--",
        "-Zunstable-options",
        "--show-coverage",
        "--output-format=json",
    ]);
    process::say("count what of pic32mx3-hal is documented");
    percent(&process::capture(&mut command)?)
}

fn percent(answer: &str) -> anyhow::Result<f64> {
    let line = answer
        .lines()
        .rfind(|line| line.starts_with('{'))
        .context("rustdoc counted nothing")?;
    let files: BTreeMap<String, Coverage> = serde_json::from_str(line).context("rustdoc's count")?;
    let total: u32 = files.values().map(|file| file.total).sum();
    let documented: u32 = files.values().map(|file| file.with_docs).sum();
    ensure!(total > 0, "rustdoc counted nothing");
    Ok(f64::from(documented) * 100.0 / f64::from(total))
}

/// All examples of the folder.
fn example_names(folder: &Path) -> anyhow::Result<BTreeSet<String>> {
    let examples = folder.join("examples");
    let mut names = BTreeSet::new();
    for entry in
        std::fs::read_dir(&examples).with_context(|| format!("cannot read {}", examples.display()))?
    {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "rs")
            && let Some(name) = path.file_stem()
        {
            names.insert(name.to_string_lossy().into_owned());
        }
    }
    Ok(names)
}

/// Builds the examples, and that of soft-uart, which stands beside the robot's program so that this crate needs no other one; gives
/// their folder.
pub(crate) fn build_examples() -> anyhow::Result<PathBuf> {
    let manifest = format!("{FOLDER}/Cargo.toml");
    let words = ["--manifest-path", manifest.as_str(), "--examples"];
    build_others("the examples of pic32mx3-hal", &words)?;
    let words = [
        "--manifest-path",
        "firmware/sr8730/Cargo.toml",
        "--example",
        "soft_uart",
        // Its decoder runs for every edge of a line.
        "--config",
        "profile.release.package.soft-uart.opt-level=3",
    ];
    Ok(build_others("the example of soft-uart", &words)?.join("examples"))
}

/// Lets the tests of the examples run, and gives the names of those that ran.
fn run_examples() -> anyhow::Result<BTreeSet<String>> {
    let examples = build_examples()?;
    let mut command = workspace::cargo();
    // No package is named, so that nothing is built a second time with other features.
    command
        .args(["test", "--locked", "--test", "hal_examples"])
        .args(["--", "--nocapture", "--test-threads=1"])
        .env("RVAC_EXAMPLES", examples);
    process::say("run the examples in the emulator");
    Ok(names_in(&process::capture(&mut command)?))
}

fn names_in(output: &str) -> BTreeSet<String> {
    output
        .lines()
        .filter_map(|line| line.split_once(RUNS_EXAMPLE))
        .map(|(_, name)| name.trim().to_owned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{names_in, percent, peripherals};

    #[test]
    fn parts_are_the_types_of_the_fields() {
        let source = "/// All.\npub struct Peripherals {\n    /// T.\n    pub timer1: Timer<1>,\n    pub timer2: Timer<2>,\n    \
                      pub adc: Adc,\n}\nimpl Peripherals { pub other: Other, }";
        assert_eq!(
            peripherals(source).ok(),
            Some(vec!["Adc".to_owned(), "Timer".to_owned()])
        );
        assert!(peripherals("pub struct Others {}").is_err());
    }

    #[test]
    fn coverage_is_the_share_over_all_files() {
        let answer = "{\"a.rs\":{\"total\":3,\"with_docs\":3,\"total_examples\":1,\"with_examples\":0},\
                      \"b.rs\":{\"total\":1,\"with_docs\":0,\"total_examples\":1,\"with_examples\":0}}\n";
        assert_eq!(percent(answer).ok(), Some(75.0));
        assert!(percent("{}").is_err() && percent("").is_err());
    }

    #[test]
    fn examples_are_those_that_the_tests_name() {
        let output = "test a ... runs example blink\nok\nruns example adc_scan\nruns example blink\n";
        assert_eq!(
            names_in(output).into_iter().collect::<Vec<_>>(),
            ["adc_scan", "blink"]
        );
    }
}
