//! The library as other languages see it: built, linked with a C program, loaded by Raku, and driven through a whole
//! exchange.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

#[path = "../src/bin/generate-header/header.rs"]
mod header;

fn crate_folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Builds the shared library, which `cargo test` alone does not, and gives its folder.
fn library_folder() -> PathBuf {
    let test = std::env::current_exe().expect("the path of this test");
    let folder = test
        .ancestors()
        .nth(2)
        .expect("the profile's folder above deps")
        .to_path_buf();
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args([
            "build",
            "--quiet",
            "--package",
            "cordlib-c",
            "--lib",
            "--target-dir",
        ])
        .arg(folder.parent().expect("the target folder"))
        .current_dir(crate_folder());
    if folder.ends_with("release") {
        cargo.arg("--release");
    }
    succeed(&cargo.output().expect("cargo runs"), "building the library");
    assert!(
        folder.join("libcordlib.so").exists(),
        "no libcordlib.so in {folder:?}"
    );
    folder
}

fn succeed(output: &Output, what: &str) {
    assert!(
        output.status.success(),
        "{what}: {}\n{}\n{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn the_committed_header_is_that_of_the_source() {
    let committed = std::fs::read_to_string(crate_folder().join("include/cordlib.h")).expect("the header");
    let current = header::generate(&crate_folder().join("src")).expect("a header");
    assert!(
        committed == current,
        "run `cargo run -p cordlib-c --bin generate-header`"
    );
}

/// Firmware in C for a small chip includes the figures of the rules alone, with a compiler of 1990.
#[test]
fn the_figures_of_the_rules_compile_in_old_c() {
    let source = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rules.c");
    std::fs::write(
        &source,
        "#include \"cordlib-rules.h\"\n#if CORD_BUMPER_STUCK_MS != CORD_LIMIT_S7_HELD_MS\n#error differs\n#endif\n\
         long most = CORD_CHARGE_GUARD_FLOW_MAX_MS;\nlong back = CORD_DOCK_ESCAPE_SPEED_UM_PER_S;\n",
    )
    .expect("a file");
    let compiled = Command::new("cc")
        .args(["-std=c90", "-pedantic", "-Wall", "-Wextra", "-Werror", "-c", "-o"])
        .arg(source.with_extension("o"))
        .arg(&source)
        .arg("-I")
        .arg(crate_folder().join("include"))
        .output()
        .expect("cc runs");
    succeed(&compiled, "compiling");
}

#[test]
fn a_c_program_drives_a_robot() {
    let library = library_folder();
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("robot-in-c");
    let compiled = Command::new("cc")
        .args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-o"])
        .arg(&program)
        .arg(crate_folder().join("tests/foreign/robot.c"))
        .arg("-I")
        .arg(crate_folder().join("include"))
        .arg("-L")
        .arg(&library)
        .args(["-lcordlib", "-lm"])
        .output()
        .expect("cc runs");
    succeed(&compiled, "compiling");
    let ran = Command::new(&program)
        .env("LD_LIBRARY_PATH", &library)
        .output()
        .expect("the program runs");
    succeed(&ran, "the C program");
    let report = String::from_utf8_lossy(&ran.stdout);
    assert!(
        report.lines().count() > 40 && !report.contains("not ok"),
        "{report}"
    );
}

#[test]
fn a_raku_program_drives_a_robot() {
    let library = library_folder();
    let script = crate_folder().join("tests/foreign/robot.raku");
    let ran = Command::new("raku")
        .arg(script)
        .env("LD_LIBRARY_PATH", &library)
        .output();
    match ran {
        Ok(output) => {
            succeed(&output, "the Raku program");
            let report = String::from_utf8_lossy(&output.stdout);
            assert!(report.lines().any(|line| line.starts_with("1..")), "{report}");
        }
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "raku: {error}");
            println!("skipped: raku not installed");
        }
    }
}
