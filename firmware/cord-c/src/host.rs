//! Programs of the C cord for this machine, with the sanitizers of gcc, which end a program at the first error.

use anyhow::{Context, bail};
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

const FLAGS: [&str; 9] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Wconversion",
    "-O1",
    "-g",
    "-fsanitize=address,undefined",
    "-fno-sanitize-recover=all",
];
/// Folders with headers.
const INCLUDED: [&str; 5] = [
    "cord",
    "generated",
    "host",
    "../cordlib-c/include",
    "../relax/board/generated",
];
/// The modules that read packets; they need no board.
const PARSER: [&str; 6] = ["command", "crc", "frame", "number", "scan", "tables"];

/// What is compiled beside a program of `host/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modules {
    /// Those that read packets.
    Parser,
    /// All.
    Cord,
}

/// This crate's folder.
#[must_use]
pub fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Compiles `host/NAME.c` with these modules into `out`.
///
/// # Errors
/// When gcc is not there, or what it says.
pub fn compile(name: &str, modules: Modules, out: &Path) -> anyhow::Result<()> {
    let cord = folder().join("cord");
    let mut sources: Vec<PathBuf> = match modules {
        Modules::Parser => PARSER.map(|module| cord.join(module).with_extension("c")).into(),
        Modules::Cord => Vec::new(),
    };
    if modules == Modules::Cord {
        for entry in std::fs::read_dir(&cord).with_context(|| format!("cannot read {}", cord.display()))? {
            let path = entry?.path();
            sources.extend(
                path.extension()
                    .is_some_and(|ending| ending == "c")
                    .then_some(path),
            );
        }
        sources.sort();
    }
    let mut compiler = Command::new("gcc");
    compiler.current_dir(folder()).args(FLAGS);
    for included in INCLUDED {
        compiler.arg("-I").arg(included);
    }
    compiler
        .arg("-o")
        .arg(out)
        .arg(format!("host/{name}.c"))
        .args(sources);
    let compiled = compiler.output().context("cannot start gcc")?;
    if !compiled.status.success() {
        bail!("{}", String::from_utf8_lossy(&compiled.stderr));
    }
    Ok(())
}

/// `host/robot.c`: the whole cord on a board of plain memory. It ends with this value.
#[derive(Debug)]
pub struct HostedCord {
    child: Child,
    input: BufWriter<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl HostedCord {
    /// Compiles it into `out` and starts it.
    ///
    /// # Errors
    /// When it cannot be compiled or started.
    pub fn start(out: &Path) -> anyhow::Result<Self> {
        compile("robot", Modules::Cord, out)?;
        let mut child = Command::new(out)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot start {}", out.display()))?;
        let input = BufWriter::new(child.stdin.take().context("no pipe to the cord")?);
        let output = BufReader::new(child.stdout.take().context("no pipe from the cord")?);
        Ok(Self { child, input, output })
    }

    /// What the cord answers to these lines, of which there are not more than a pipe holds answers to.
    ///
    /// # Errors
    /// When it has ended, which it does when a sanitizer finds something.
    pub fn ask(&mut self, lines: &[String]) -> anyhow::Result<Vec<String>> {
        for line in lines {
            writeln!(self.input, "{line}")?;
        }
        writeln!(self.input, "!")?;
        self.input.flush().context("the cord has ended")?;
        let mut answers = Vec::new();
        for line in lines {
            let mut answer = String::new();
            if self.output.read_line(&mut answer)? == 0 {
                bail!("the cord has ended at: {line}");
            }
            answers.push(answer.trim_end().to_owned());
        }
        Ok(answers)
    }
}

impl Drop for HostedCord {
    fn drop(&mut self) {
        // A program that has ended already needs no end.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// Bytes as digits.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Digits as bytes; none where a pair is no number.
#[must_use]
pub fn from_hex(digits: &str) -> Vec<u8> {
    let pair = |at| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    (0..digits.len()).step_by(2).filter_map(pair).collect()
}
