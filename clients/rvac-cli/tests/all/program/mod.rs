//! `rvac` as a process, as a person calls it.

use std::ffi::OsStr;
use std::io::Write as _;
use std::process::{Command, Output, Stdio};

/// Runs `rvac` with the arguments, types `typed`, ends the input, and waits for the end of the program.
pub(crate) fn rvac<Argument: AsRef<OsStr>>(
    arguments: impl IntoIterator<Item = Argument>,
    typed: &[u8],
) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_rvac"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("rvac starts");
    // A program that does not read the input closes it.
    child.stdin.take().expect("a pipe").write_all(typed).ok();
    child.wait_with_output().expect("rvac ends")
}
