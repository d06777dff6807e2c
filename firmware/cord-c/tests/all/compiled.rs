//! Programs of the C cord for this machine, with the sanitizers of gcc, which end a program at the first error.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// Tests run side by side, each with a program of its own.
static PROGRAMS: AtomicU32 = AtomicU32::new(0);

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

pub(crate) fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The modules that read packets; they need no board.
const PARSER: [&str; 6] = ["command", "crc", "frame", "number", "scan", "tables"];

/// Compiles `host/NAME.c` with the parser.
pub(crate) fn program(name: &str) -> PathBuf {
    let number = PROGRAMS.fetch_add(1, Ordering::Relaxed);
    let file = format!("{name}-{}-{number}", std::process::id());
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(file);
    let sources = PARSER.map(|module| format!("cord/{module}.c"));
    let compiled = Command::new("gcc")
        .args(FLAGS)
        .args([
            "-Icord",
            "-Igenerated",
            "-Ihost",
            "-I../cordlib-c/include",
            "-I../relax/board/generated",
            "-o",
        ])
        .arg(&out)
        .arg(format!("host/{name}.c"))
        .args(sources)
        .current_dir(folder())
        .output()
        .expect("gcc runs");
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );
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

pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

pub(crate) fn from_hex(digits: &str) -> Vec<u8> {
    (0..digits.len())
        .step_by(2)
        .map(|at| u8::from_str_radix(&digits[at..at + 2], 16).expect("hexadecimal digits"))
        .collect()
}
