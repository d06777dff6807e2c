//! Programs of the C cord for this machine, each in a place of its own.

use cord_c::host::{Modules, compile};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// Tests run side by side, each with a program of its own.
static PROGRAMS: AtomicU32 = AtomicU32::new(0);

/// A place for a program.
pub(crate) fn place(name: &str) -> PathBuf {
    let number = PROGRAMS.fetch_add(1, Ordering::Relaxed);
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}-{number}", std::process::id()))
}

/// Compiles `host/NAME.c` with the parser.
pub(crate) fn program(name: &str) -> PathBuf {
    let out = place(name);
    compile(name, Modules::Parser, &out).expect("gcc compiles it");
    out
}

/// What a program answers to these lines, line by line.
pub(crate) fn answers(program: &Path, lines: &[String]) -> Vec<String> {
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut input = child.stdin.take().expect("a pipe");
    let text = lines.concat();
    let writer = std::thread::spawn(move || input.write_all(text.as_bytes()));
    let output = child.wait_with_output().expect("the program ends");
    writer
        .join()
        .expect("the writer ends")
        .expect("it reads everything");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let answers: Vec<String> = String::from_utf8(output.stdout)
        .expect("text")
        .lines()
        .map(str::to_owned)
        .collect();
    assert_eq!(answers.len(), lines.len());
    answers
}
