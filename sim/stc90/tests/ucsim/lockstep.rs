//! The same program in both, compared every few instructions.

use crate::numbers::Numbers;
use crate::process::UcSim;
use crate::state::{DUMP_XRAM, Printed, State, commands};
use stc90::image::Image;
use stc90::machine::{Machine, Options};
use std::collections::BTreeSet;

/// A program and the memories that it begins with.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    pub(crate) code: Vec<u8>,
    pub(crate) ram: Vec<u8>,
    pub(crate) xram: Vec<u8>,
}

/// How far to go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub(crate) instructions: u32,
    /// At most so many instructions between two comparisons.
    pub(crate) stride: u32,
}

/// What was compared.
#[derive(Debug, Default)]
pub(crate) struct Compared {
    pub(crate) instructions: u64,
    pub(crate) opcodes: BTreeSet<u8>,
}

impl Start {
    /// Our chip with it.
    pub(crate) fn machine(&self) -> Machine {
        let mut image = Image::erased();
        assert!(image.write(0, &self.code), "the program fits");
        let mut machine = Machine::new(&image, Options::RELAX);
        machine.cpu_mut().ram_mut().copy_from_slice(&self.ram);
        machine.xram_mut().copy_from_slice(&self.xram);
        machine
    }

    /// As uCsim loads it.
    pub(crate) fn hex(&self) -> String {
        let mut text = String::new();
        for (number, bytes) in self.code.chunks(16).enumerate() {
            text += &record(number as u16 * 16, bytes);
        }
        text + ":00000001FF\n"
    }

    fn memory_commands(&self) -> String {
        let mut text = String::new();
        for (name, memory) in [("iram", &self.ram), ("xram", &self.xram)] {
            for (number, bytes) in memory.chunks(16).enumerate() {
                text += &format!("set memory {name} {}", number * 16);
                for byte in bytes {
                    text += &format!(" {byte}");
                }
                text += "\n";
            }
        }
        text
    }
}

/// A line of Intel HEX.
fn record(address: u16, bytes: &[u8]) -> String {
    let [high, low] = address.to_be_bytes();
    let mut line = vec![bytes.len() as u8, high, low, 0];
    line.extend(bytes);
    let sum = line.iter().fold(0_u8, |sum, byte| sum.wrapping_sub(*byte));
    line.push(sum);
    let digits: String = line.iter().map(|byte| format!("{byte:02X}")).collect();
    format!(":{digits}\n")
}

/// Whether the program goes on, with something that both chips have: no code beyond the flash, no stack over the end, no
/// external memory but the chip's own.
fn is_comparable(machine: &Machine) -> bool {
    let cpu = machine.cpu();
    let opcode = cpu.code().byte(cpu.pc());
    let operand = cpu.code().byte(cpu.pc().wrapping_add(1));
    let can_go_on = match opcode {
        0xE0 | 0xF0 => cpu.dptr() < 0x400,
        0x93 => cpu.dptr() < 0x7E00,
        // A jump to itself: nothing more happens.
        0x80 => operand != 0xFE,
        _ => opcode != 0xA5,
    };
    cpu.pc() < 0x7F00 && (0x07..0xF0).contains(&cpu.sp()) && can_go_on
}

/// Runs a program in both.
pub(crate) fn compare(ucsim: &UcSim, start: &Start, extent: Extent, seed: u64) -> Compared {
    let mut numbers = Numbers::new(seed ^ 0xC0DE);
    let mut machine = start.machine();
    let mut compared = Compared::default();
    let mut script = start.memory_commands();
    let mut states = Vec::new();
    while compared.instructions < u64::from(extent.instructions) {
        let wanted = numbers.below(extent.stride) + 1;
        let mut done = 0;
        while done < wanted && is_comparable(&machine) {
            compared
                .opcodes
                .insert(machine.cpu().code().byte(machine.cpu().pc()));
            machine.step();
            done += 1;
        }
        if done == 0 {
            break;
        }
        compared.instructions += u64::from(done);
        script += &commands(done);
        states.push(State::of(&machine));
    }
    script += DUMP_XRAM;
    let output = ucsim.run(&start.hex(), &script);
    let mut printed = Printed(&output.printed);
    let mut before = 0;
    for ours in states {
        let theirs = printed.state();
        let difference = ours.difference(&theirs);
        assert!(
            difference.is_empty(),
            "seed {seed}, from {before:04x} on ({:02x?}), psw {:02x}, ours first: {difference}",
            (0..4)
                .map(|offset| machine.cpu().code().byte(before + offset))
                .collect::<Vec<u8>>(),
            ours.registers[18],
        );
        before = ours.pc;
    }
    assert_eq!(machine.xram(), printed.xram(), "seed {seed}: external memory");
    compared
}
