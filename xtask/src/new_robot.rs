//! `cargo xtask new-robot`: the folders of a robot that nobody has described yet, filled with what builds and says hello.
//!
//! Its firmware is a copy of the reference for its chip, its figures are those of a small round robot and marked as nobody's.

use crate::{codegen, process, workspace};
use anyhow::{Context, bail};
use std::fmt::Write;
use std::path::Path;

/// Arguments of `cargo xtask new-robot`.
#[derive(Debug, clap::Args)]
pub(crate) struct NewRobotArguments {
    /// Its name: small letters, digits and hyphens, such as maker-model.
    name: String,
    /// Its microcontroller.
    #[arg(long)]
    chip: NewChip,
}

/// Microcontrollers for which there is firmware to begin with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum NewChip {
    /// Raspberry Pi RP2040.
    Rp2040,
}

impl NewChip {
    /// The firmware that is copied.
    const fn reference(self) -> &'static str {
        match self {
            Self::Rp2040 => "rp2040-reference",
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Rp2040 => "rp2040",
        }
    }

    /// The pins that its reference uses: what for, port pin, function, and how they are driven.
    const fn link(self) -> [Line; 2] {
        match self {
            Self::Rp2040 => [
                Line {
                    name: "link-transmit",
                    port: "GPIO0",
                    function: "UART0TX",
                    kind: "output",
                },
                Line {
                    name: "link-receive",
                    port: "GPIO1",
                    function: "UART0RX",
                    kind: "input",
                },
            ],
        }
    }
}

/// A line of the link.
struct Line {
    name: &'static str,
    port: &'static str,
    function: &'static str,
    kind: &'static str,
}

/// Whose figures a new robot begins with.
const FIGURES: &str = "robots/vileda-relax/robot.toml";

/// Makes both folders; changes nothing that is there.
pub(crate) fn run(arguments: &NewRobotArguments) -> anyhow::Result<()> {
    let (name, chip) = (arguments.name.as_str(), arguments.chip);
    check(name)?;
    let root = workspace::root();
    let (facts, firmware) = (root.join("robots").join(name), root.join("firmware").join(name));
    for folder in [&facts, &firmware] {
        if folder.exists() {
            bail!("{} is there already: choose another name", folder.display());
        }
    }
    copy(
        &root.join("firmware").join(chip.reference()),
        &firmware,
        (chip.reference(), name),
    )?;
    std::fs::create_dir_all(&facts)?;
    let figures = std::fs::read_to_string(root.join(FIGURES)).context(FIGURES)?;
    std::fs::write(facts.join("robot.toml"), robot_file(&figures, name)?)?;
    std::fs::write(facts.join("pinout.toml"), pinout(&root, chip)?)?;
    std::fs::write(facts.join("README.md"), readme(name, chip))?;
    codegen::run(&codegen::CodegenArguments { check: false })?;
    process::say(&format!(
        "made robots/{name} and firmware/{name}. Next: cargo xtask firmware {name}, then docs/book/src/porting.md"
    ));
    Ok(())
}

fn check(name: &str) -> anyhow::Result<()> {
    let plain = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-';
    let begins = name.starts_with(|letter: char| letter.is_ascii_lowercase());
    if !begins || name.ends_with('-') || name.len() > 30 || !name.chars().all(plain) {
        bail!("{name:?} is no name: up to 30 small letters, digits and hyphens, such as maker-model");
    }
    Ok(())
}

/// Copies sources with another name in them; the emulator stays with the reference.
fn copy(from: &Path, to: &Path, (old, new): (&str, &str)) -> anyhow::Result<()> {
    std::fs::create_dir_all(to).with_context(|| format!("cannot make {}", to.display()))?;
    for entry in std::fs::read_dir(from).with_context(|| format!("cannot read {}", from.display()))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default();
        if path.is_dir() {
            if name != "emulator" && name != "target" {
                copy(&path, &to.join(name), (old, new))?;
            }
        } else if name == "README.md" {
            std::fs::write(to.join(name), firmware_readme(new))?;
        } else {
            let text =
                std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
            std::fs::write(to.join(name), text.replace(old, new))?;
        }
    }
    Ok(())
}

fn firmware_readme(name: &str) -> String {
    format!(
        "# Firmware of {name}\n\nA clock, a link and a watchdog so far: `cargo xtask firmware {name}` builds it and lets it say hello in an \
         emulator.\n[Its facts](../../robots/{name}/README.md). Next: the [porting guide](../../docs/book/src/porting.md).\n"
    )
}

/// Figures of another robot under the name of this one, each marked as nobody's.
fn robot_file(figures: &str, name: &str) -> anyhow::Result<String> {
    let mut text = format!(
        "# {name}: geometry, limits, motors, sensors, battery. Nobody has measured anything yet: every figure is that of another small \
         robot.\n#\n# Every figure has a unit, a word of confidence and a source: known, estimated, or placeholder. Axes: x forward, \
         y left, angles\n# counter-clockwise from straight ahead, origin between the wheels.\n"
    );
    for line in figures.lines().filter(|line| !line.starts_with('#')) {
        let line = match line.split_once(", confidence = ") {
            Some((figure, _)) => {
                format!("{figure}, confidence = \"placeholder\", source = \"not measured\" }}")
            }
            None if line.starts_with("name = ") => format!("name = \"{name}\""),
            None if line.starts_with("title = ") => format!("title = \"{name}\""),
            None => line.to_owned(),
        };
        writeln!(text, "{line}")?;
    }
    Ok(text)
}

/// Every pin of the chip: the link's, and spares.
fn pinout(root: &Path, chip: NewChip) -> anyhow::Result<String> {
    let file = root.join("robots/chips").join(format!("{}.toml", chip.name()));
    let table: toml::Table = std::fs::read_to_string(&file)
        .with_context(|| format!("cannot read {}", file.display()))?
        .parse()?;
    let pins = table
        .get("pins")
        .and_then(toml::Value::as_table)
        .context("a chip without pins")?;
    let mut pins: Vec<(u16, Vec<&str>)> = pins
        .iter()
        .map(|(pin, functions)| {
            let functions = functions.as_array().into_iter().flatten();
            Ok((pin.parse()?, functions.filter_map(toml::Value::as_str).collect()))
        })
        .collect::<anyhow::Result<_>>()?;
    pins.sort();
    let mut text = format!(
        "# Every port pin of its {}. Change a spare into what you find on the board; the keys are those of robots/README.md.\n\n\
         chip = \"{}\"\n",
        chip.name(),
        chip.name()
    );
    let lines = chip.link();
    for (pin, functions) in pins {
        let Some(port) = functions.iter().find(|function| function.starts_with("GPIO")) else {
            continue;
        };
        let line = lines.iter().find(|line| line.port == *port);
        write!(text, "\n[[signal]]\n")?;
        match line {
            Some(line) => {
                writeln!(text, "name = \"{}\"\nport = \"{port}\"\npin = {pin}", line.name)?;
                writeln!(text, "kind = \"{}\"\nactive = \"high\"", line.kind)?;
                writeln!(text, "pull = \"none\"\nfunction = \"{}\"", line.function)?;
                if line.kind == "output" {
                    writeln!(text, "safe = \"high\"")?;
                }
                writeln!(
                    text,
                    "confidence = \"placeholder\"\nsource = \"the reference firmware\""
                )?;
            }
            None => {
                let name = port.to_lowercase();
                writeln!(text, "name = \"spare-{name}\"\nport = \"{port}\"\npin = {pin}")?;
                writeln!(text, "kind = \"spare\"\nactive = \"unknown\"\npull = \"unknown\"")?;
                writeln!(text, "confidence = \"unknown\"\nsource = \"nobody has looked\"")?;
            }
        }
    }
    Ok(text)
}

fn readme(name: &str, chip: NewChip) -> String {
    format!(
        "# {name}\n\nA robot with an {}. What is known of it: nothing yet.\n\n\
         <!-- Between these marks: made by cargo xtask codegen from pinout.toml and robot.toml. -->\n\
         <!-- End of what cargo xtask codegen makes. -->\n",
        chip.name().to_uppercase()
    )
}

#[cfg(test)]
mod tests {
    use super::{check, robot_file};

    #[test]
    fn names_are_names_of_folders_and_of_crates() {
        for good in ["acme-3000", "r2"] {
            assert!(check(good).is_ok(), "{good}");
        }
        for bad in [
            "",
            "-a",
            "a-",
            "A",
            "a_b",
            "3d",
            "../x",
            "a very long name that nobody can type",
        ] {
            assert!(check(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn no_figure_claims_to_be_known() {
        let figures = "# of another\nname = \"old\"\ntitle = \"Old\"\n[body]\nradius = { value = 1.0, unit = \"m\", confidence = \"known\", source = \"sheet\" }\n";
        let text = robot_file(figures, "new").expect("written");
        assert!(text.contains("name = \"new\"\ntitle = \"new\"\n"), "{text}");
        assert!(
            text.contains("confidence = \"placeholder\", source = \"not measured\" }"),
            "{text}"
        );
        assert!(
            !text.contains("sheet") && text.parse::<toml::Table>().is_ok(),
            "{text}"
        );
    }
}
