//! Programs of `tests/programs`, compiled by SDCC.

use crate::lockstep::{Extent, Start, compare};
use crate::process::{Folder, UcSim};
use crate::state::{DUMP_XRAM, Printed};
use stc90::image::Image;
use stc90::machine::Machine;
use stc90::peripheral::LineFrame;
use stc90::pins::Level;
use std::path::Path;
use std::process::Command;

const COMPILER: &str = "sdcc";
/// The limits of the part.
const OPTIONS: [&str; 10] = [
    "-mmcs51",
    "--model-large",
    "--xram-size",
    "1024",
    "--iram-size",
    "256",
    "--code-size",
    "32768",
    "-I",
    "../../firmware/relax/chip/generated",
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

/// Back to back, in both directions at once.
#[test]
fn a_line_is_heard_and_answered_alike() {
    let (Some(ucsim), Some(start)) = (UcSim::find(), compile("echo.c")) else {
        return;
    };
    const TICKS_PER_BYTE: u64 = 10 * 784;
    let line: Vec<u8> = (0..200_u8).map(|number| number.wrapping_mul(91) ^ 0x18).collect();
    let mut machine = start.machine();
    for (number, byte) in (0..).zip(&line) {
        let cycle = 3_000 + number * TICKS_PER_BYTE / 6;
        machine.hear(LineFrame::byte(cycle, 784, *byte));
    }
    run_to_end(&mut machine);
    let sent: Vec<u8> = machine.take_sent().iter().map(|frame| frame.byte).collect();
    let expected: Vec<u8> = line.iter().map(|byte| !byte).collect();
    assert_eq!(sent, expected);
    assert_eq!((machine.overruns(), machine.unheard()), (0, 0));
    let end = machine.cpu().pc();
    let commands = format!("fill xram 0 1023 0\nbreak {end}\nrun\n{DUMP_XRAM}");
    let output = ucsim.run_with_line(&start.hex(), &commands, &line);
    assert_eq!(output.sent, sent);
    let results = Printed(&output.printed).xram();
    assert_eq!(results[RESULTS], machine.xram()[RESULTS]);
}

/// The header that is generated from the Relax's pinout moves the pins that the pinout names.
#[test]
fn generated_pins_are_those_of_the_board() {
    let Some(start) = compile("pins.c") else {
        return;
    };
    let pin = |name: &str| name.parse().expect("a pin");
    for is_pressed in [false, true] {
        let mut machine = start.machine();
        for name in ["P2.0", "P2.1", "P1.3", "P1.4", "P2.7"] {
            machine.watch(pin(name));
        }
        // The light barriers are high when pressed; the left outer floor sensor is low where there is no floor.
        machine.set_input(pin("P2.2"), Level::of(is_pressed));
        machine.set_input(pin("P1.0"), Level::of(!is_pressed));
        machine.set_input(pin("P0.7"), Level::of(!is_pressed));
        machine.set_input(pin("P1.7"), Level::of(!is_pressed));
        run_to_end(&mut machine);
        let edges: Vec<String> = machine
            .take_edges()
            .iter()
            .map(|edge| format!("{} {:?}", edge.pin, edge.level))
            .collect();
        assert_eq!(edges, ["P2.7 Low", "P2.1 Low", "P1.3 Low", "P2.1 High"]);
        let floor = if is_pressed { 0x02 } else { 0x82 };
        let seen = [
            u8::from(is_pressed),
            u8::from(!is_pressed),
            floor,
            u8::from(is_pressed),
        ];
        assert_eq!(machine.xram()[0x201..0x205], seen);
    }
}
