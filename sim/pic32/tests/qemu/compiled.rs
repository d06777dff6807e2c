//! Compiled code in both: the programs of `sim/pic32/proof`, built by `cargo xtask test`.

use crate::chip::{Bare, written};
use crate::process::Qemu;
use pic32::cpu::{Cpu, ExceptionCode, Exit};
use pic32::image::Image;
use pic32::memory::Memory;
use std::path::{Path, PathBuf};

/// The programs, if they were built. Where they must be there, the folder is named.
fn programs() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let named = std::env::var_os("RVAC_PROOF").map(PathBuf::from);
    let built = root.join("target/cross/mipsel-unknown-none/release");
    let folder = named.clone().unwrap_or(built);
    let is_there = ["chip", "user"]
        .iter()
        .all(|program| folder.join(program).is_file());
    assert!(
        is_there || named.is_none(),
        "{} holds no programs",
        folder.display()
    );
    if !is_there {
        println!("skipped: sim/pic32/proof is not built (cargo xtask test --only emulator builds it)");
    }
    is_there.then_some(folder)
}

#[test]
fn compiled_code_gives_the_same_results() {
    let (Some(folder), Some(qemu)) = (programs(), Qemu::find()) else {
        return;
    };
    let read = |program: &str| std::fs::read(folder.join(program)).expect("the program is there");
    let expected = qemu.run(&read("user"));
    let image = Image::from_elf(&read("chip")).expect("the program is for this part");
    let mut memory = Memory::new(&image);
    let mut cpu = Cpu::new();
    let mut found = Vec::new();
    while found.len() < expected.len() {
        match cpu.run(&mut memory, &mut Bare, u64::MAX) {
            Exit::CoreTimer => {}
            Exit::Exception(exception) if exception.code == ExceptionCode::Syscall => {
                found.extend(written(&cpu, &memory));
                cpu.set_pc(exception.address + 4);
            }
            other => panic!("the program ended with {other:x?}"),
        }
    }
    assert!(expected.len() >= 16 * 40, "{} bytes are few", expected.len());
    assert_eq!(found, expected);
}
