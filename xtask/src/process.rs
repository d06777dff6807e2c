//! Starting other programs, and speaking to the person at the terminal.

use anyhow::{Context, bail};
use std::io::{IsTerminal, Write};
use std::process::{Command, Output, Stdio};

/// Says one line of progress. It goes to the error stream, so that the output stream carries results only.
pub(crate) fn say(line: &str) {
    let mut stream = std::io::stderr().lock();
    // A terminal that went away is no reason to stop the work.
    let paint = if stream.is_terminal() {
        ("\x1b[1;36m", "\x1b[0m")
    } else {
        ("", "")
    };
    writeln!(stream, "{}==>{} {line}", paint.0, paint.1).ok();
}

/// Says what went wrong.
pub(crate) fn complain(line: &str) {
    let mut stream = std::io::stderr().lock();
    let paint = if stream.is_terminal() {
        ("\x1b[1;31m", "\x1b[0m")
    } else {
        ("", "")
    };
    writeln!(stream, "{}error:{} {line}", paint.0, paint.1).ok();
}

/// Writes one line of result to the output stream.
pub(crate) fn print(line: &str) {
    let mut stream = std::io::stdout().lock();
    writeln!(stream, "{line}").and_then(|()| stream.flush()).ok();
}

/// Runs a program to its end with our terminal; fails when it fails. What it prints goes to the error stream.
pub(crate) fn run(what: &str, command: &mut Command) -> anyhow::Result<()> {
    say(what);
    let status = command
        .stdin(Stdio::null())
        .stdout(std::io::stderr())
        .status()
        .with_context(|| format!("cannot start {}", name(command)))?;
    if !status.success() {
        bail!("{what} failed: {} ended with {status}", name(command));
    }
    Ok(())
}

/// Runs a program to its end and gives its output stream as text; its error stream goes to the terminal.
pub(crate) fn capture(command: &mut Command) -> anyhow::Result<String> {
    let output = finish(command.stderr(Stdio::inherit()))?;
    if !output.status.success() {
        bail!("{} ended with {}", name(command), output.status);
    }
    String::from_utf8(output.stdout)
        .with_context(|| format!("{} wrote something that is not text", name(command)))
}

/// Runs a program to its end and gives all it wrote, whether or not it succeeded.
pub(crate) fn finish(command: &mut Command) -> anyhow::Result<Output> {
    command.stdin(Stdio::null());
    command
        .output()
        .with_context(|| format!("cannot start {}", name(command)))
}

/// The program and its arguments as a person would type them.
pub(crate) fn name(command: &Command) -> String {
    let mut words = vec![command.get_program().to_string_lossy().into_owned()];
    words.extend(
        command
            .get_args()
            .map(|argument| argument.to_string_lossy().into_owned()),
    );
    words.join(" ")
}
