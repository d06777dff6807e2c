//! What kind of crate each is: without the standard library, without unsafe code.

use super::Finding;
use super::files::Files;
use super::rust_text::code;

/// Crates that run on a microcontroller.
const NO_STD: [&str; 8] = [
    "firmware/pic32mx3-hal",
    "firmware/size-probe",
    "firmware/soft-uart",
    "firmware/sr8730",
    "sim/pic32/proof",
    "protocol/rvac-units",
    "protocol/rvac-protocol",
    "firmware/cordlib",
];

/// The only crates that may hold unsafe code, and why.
const UNSAFE: [(&str, &str); 5] = [
    (
        "clients/panel",
        "the macro that marks where the page is split declares what comes with the later file; all else is denied it",
    ),
    ("firmware/cordlib-c", "a C interface takes pointers"),
    (
        "firmware/pic32mx3-hal",
        "registers are addresses, start-up and interrupts are assembly",
    ),
    (
        "firmware/size-probe",
        "a program without an operating system names its own entry point",
    ),
    (
        "firmware/sr8730",
        "a program without an operating system names its own entry point and handlers",
    ),
];

/// Looks at the head of each crate.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let mut found = Vec::new();
    for (path, text) in files.texts(&["src/lib.rs", "src/main.rs"]) {
        let Some(folder) = path
            .strip_suffix("/src/lib.rs")
            .or_else(|| path.strip_suffix("/src/main.rs"))
        else {
            continue;
        };
        let code = code(text);
        let is_port = is_port(files, folder);
        if (is_port || NO_STD.contains(&folder)) && !is_without_std(&code) {
            found.push(format!("{path}: lacks #![no_std]; it runs on a microcontroller"));
        }
        let allowed = is_port || UNSAFE.iter().any(|(crate_folder, _)| *crate_folder == folder);
        if !allowed && !code.contains("#![forbid(unsafe_code)]") && !forbidden_in_manifest(files, folder) {
            found.push(format!(
                "{path}: lacks #![forbid(unsafe_code)]; only a C interface may do without"
            ));
        }
    }
    Ok(Finding::Checked(found))
}

/// Everywhere, or where it matters: not in tests, or not on another machine than the robot's.
fn is_without_std(code: &str) -> bool {
    let names_it = |line: &str| line.split([' ', '(', ')', ',']).any(|word| word == "no_std");
    code.lines()
        .any(|line| line == "#![no_std]" || (line.starts_with("#![cfg_attr(") && names_it(line)))
}

/// Firmware that its manifest names as such, and no list: a program without an operating system names its own entry point and handlers.
fn is_port(files: &Files, folder: &str) -> bool {
    manifest(files, folder).is_some_and(|text| text.contains("[package.metadata.librervac]"))
}

fn manifest<'a>(files: &'a Files, folder: &str) -> Option<&'a str> {
    files.text(&format!("{folder}/Cargo.toml"))
}

fn forbidden_in_manifest(files: &Files, folder: &str) -> bool {
    manifest(files, folder).is_some_and(|text| text.contains("unsafe_code = \"forbid\""))
}
