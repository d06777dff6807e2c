//! The C cord's other half: what is made for it from Rust and TOML.
//!
//! The firmware itself stands in `cord/`, in C, for chips without a Rust compiler. Everything that both languages must agree
//! on is made here: names and their order, ranges, the CRC's tables, and what a robot tells of itself. [`host`] runs the cord
//! on this machine under sanitizers; [`corruption`] sends it damaged packets.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod corruption;
pub mod host;
mod machine;
mod tables;
mod wire;

use std::path::Path;

/// A file that is made: its path in the project, and its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MadeFile {
    /// Below the project's folder.
    pub path: &'static str,
    /// What it should hold.
    pub text: String,
}

/// All files, for a project in this folder.
///
/// # Errors
/// When the description of a robot cannot be read.
pub fn files(root: &Path) -> anyhow::Result<Vec<MadeFile>> {
    Ok(vec![
        MadeFile {
            path: "firmware/cord-c/generated/wire.h",
            text: wire::source()?,
        },
        MadeFile {
            path: "firmware/cord-c/generated/tables.h",
            text: tables::source()?,
        },
        MadeFile {
            path: "firmware/relax/board/generated/machine.h",
            text: machine::source(root)?,
        },
    ])
}

/// A name as a constant of C.
fn constant(name: &str) -> String {
    name.replace(['-', ' '], "_").to_uppercase()
}
