//! Programs of `tests/programs`, compiled by SDCC.

use crate::lockstep::{Extent, Start, compare};
use crate::process::{Folder, UcSim};
use crate::state::{DUMP_XRAM, Printed};
use stc90::image::Image;
use stc90::machine::Machine;
use std::path::Path;
use std::process::Command;

const COMPILER: &str = "sdcc";
/// The limits of the part.
const OPTIONS: [&str; 8] = [
    "-mmcs51",
    "--model-large",
    "--xram-size",
    "1024",
    "--iram-size",
    "256",
    "--code-size",
    "32768",
];

/// Where the programs leave their results in external memory.
const RESULTS: std::ops::Range<usize> = 0x200..0x400;

/// Longest run of a program.
const EXTENT: Extent = Extent {
    instructions: 2_000_000,
    stride: 2_000,
};

/// Compiles a program. On the build machine the compiler must be there; elsewhere its absence is told.
fn compile(name: &str) -> Option<Start> {
    let folder = Folder::new();
    let (source, image) = (Path::new("tests/programs").join(name), folder.file("image.ihx"));
    let mut command = Command::new(COMPILER);
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(OPTIONS);
    let output = match command.arg(source).arg("-o").arg(&image).output() {
        Ok(output) => output,
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "{COMPILER}: {error}");
            println!("skipped: {COMPILER} is not installed (Debian: apt-get install sdcc)");
            return None;
        }
    };
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {told}");
    let text = std::fs::read_to_string(&image).expect("the compiler's image");
    let image = Image::from_hex(&text).expect("an image for this part");
    Some(Start {
        code: image.flash()[..image.end()].to_vec(),
        ram: vec![0; 256],
        xram: vec![0; 1024],
    })
}

/// Runs it in both to its end, step by step.
fn agrees(name: &str) {
    let (Some(ucsim), Some(start)) = (UcSim::find(), compile(name)) else {
        return;
    };
    let compared = compare(&ucsim, &start, EXTENT, 0);
    println!(
        "{name}: {} instructions agree, {} different ones",
        compared.instructions,
        compared.opcodes.len()
    );
    assert!(compared.instructions > 1_000, "{name} did nothing");
    assert!(
        compared.instructions < u64::from(EXTENT.instructions),
        "{name} has no end"
    );
}

#[test]
fn arithmetic_agrees() {
    agrees("arithmetic.c");
}

#[test]
fn memory_agrees() {
    agrees("memory.c");
}

#[test]
fn packets_agree() {
    agrees("packets.c");
}

/// Runs to the jump to itself that ends a program.
fn run_to_end(machine: &mut Machine) {
    let is_at_end = |machine: &Machine| {
        let (code, pc) = (machine.cpu().code(), machine.cpu().pc());
        [code.byte(pc), code.byte(pc.wrapping_add(1))] == [0x80, 0xFE]
    };
    while !is_at_end(machine) {
        machine.step();
        assert!(machine.cycle() < 10_000_000, "the program has no end");
    }
}

/// With interrupts the cycles differ on purpose; what a program makes of them does not.
#[test]
fn interrupts_have_the_same_results() {
    let (Some(ucsim), Some(start)) = (UcSim::find(), compile("interrupts.c")) else {
        return;
    };
    let mut machine = start.machine();
    run_to_end(&mut machine);
    let sent: Vec<u8> = machine.take_sent().iter().map(|frame| frame.byte).collect();
    let expected: Vec<u8> = (0..40).map(|n| n * 3).collect();
    assert_eq!(sent, expected);
    let end = machine.cpu().pc();
    let output = ucsim.run(
        &start.hex(),
        &format!("fill xram 0 1023 0\nbreak {end}\nrun\n{DUMP_XRAM}"),
    );
    assert_eq!(output.sent, sent);
    let results = Printed(&output.printed).xram();
    assert_eq!(results[RESULTS], machine.xram()[RESULTS]);
    assert_eq!(machine.xram()[RESULTS][..10], [39, 0, 5, 0, 5, 0, 1, 0, 1, 0]);
    assert_eq!(machine.misuses(), []);
}
