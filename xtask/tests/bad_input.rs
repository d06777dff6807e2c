//! What a person can get wrong about the demo and the firmware: one clear sentence each, and nothing is started or written.

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder for temporary files that is empty before and must be empty after.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("xtask-{name}-{}", std::process::id()));
        std::fs::create_dir(&folder).expect("a new folder");
        Self(folder)
    }

    fn demo(&self, words: &[&str]) -> Output {
        self.xtask(&[&["demo"], words].concat())
    }

    fn xtask(&self, words: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
        command.args(words).env("TMPDIR", &self.0);
        command.output().expect("xtask starts")
    }

    fn is_empty(&self) -> bool {
        std::fs::read_dir(&self.0)
            .expect("the folder is still there")
            .next()
            .is_none()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// Runs the demo with `words` and expects a refusal of one sentence that holds all of `parts`.
fn refused(name: &str, words: &[&str], parts: &[&str]) {
    let scratch = Scratch::new(name);
    is_refusal(&scratch, &scratch.demo(words), parts);
}

fn is_refusal(scratch: &Scratch, output: &Output, parts: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success(), "{said}");
    assert!(output.stdout.is_empty(), "nothing is printed as a result");
    assert_eq!(said.trim_end().lines().count(), 1, "one line: {said}");
    for part in parts {
        assert!(said.contains(part), "{part:?} is missing in: {said}");
    }
    assert!(scratch.is_empty(), "something was written");
}

fn some_home() -> String {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    here.display().to_string()
}

#[test]
fn a_missing_home_is_named() {
    refused(
        "missing",
        &["--home", "no/such/home.toml"],
        &["no/such/home.toml", "no such file", "give"],
    );
}

#[test]
fn a_folder_is_no_home() {
    refused("folder", &["--home", "/"], &["home /", "not a file"]);
}

#[test]
fn an_unknown_robot_is_answered_with_the_known_ones() {
    refused(
        "robot",
        &["--home", &some_home(), "--robot", "roomba"],
        &["\"roomba\"", "unknown", "sr8730"],
    );
}

#[test]
fn a_port_in_use_is_named() {
    let taken = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let port = taken.local_addr().expect("an address").port().to_string();
    refused(
        "port",
        &["--home", &some_home(), "--port", &port],
        &[&port, "in use", "--port"],
    );
}

/// What a person can get wrong about the firmware is said before anything is built.
#[test]
fn what_is_wrong_with_a_wanted_firmware_is_named() {
    let scratch = Scratch::new("firmware");
    let table: [(&[&str], &[&str]); 3] = [
        (&["roomba"], &["no firmware", "\"roomba\"", "sr8730"]),
        (
            &["sr8730", "--calibration", "/no/such.toml"],
            &["/no/such.toml", "No such file"],
        ),
        (
            &["sr8730", "--calibration", env!("CARGO_MANIFEST_PATH")],
            &["Cargo.toml", "[values]"],
        ),
    ];
    for (words, parts) in table {
        let output = scratch.xtask(&[&["firmware"], words].concat());
        is_refusal(&scratch, &output, parts);
    }
}

#[test]
fn a_run_without_length_is_refused() {
    refused(
        "minutes",
        &["--home", &some_home(), "--headless", "--minutes", "0"],
        &["--minutes 0", "above 0"],
    );
}
