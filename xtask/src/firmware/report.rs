//! What a firmware takes of its chip, beside what it may take.

use super::elf::{Elf, Section};
use super::flow::{self, Flow};
use super::graph::Depth;
use crate::chip::{Chip, Region};
use crate::process;
use serde::Serialize;

/// What a firmware may take of a PIC32.
#[derive(Clone, Debug)]
pub(super) struct ChipMemory {
    /// Its budget is that of all flash.
    program_flash: Region,
    boot_flash: Region,
    configuration: Region,
    ram: Region,
}

impl ChipMemory {
    /// The regions of a chip that a PIC32 has.
    pub(super) fn of(chip: &Chip) -> anyhow::Result<Self> {
        Ok(Self {
            program_flash: chip.region("program-flash")?.clone(),
            boot_flash: chip.region("boot-flash")?.clone(),
            configuration: chip.region("configuration")?.clone(),
            ram: chip.region("ram")?.clone(),
        })
    }

    /// The same where the firmware may take more of the flash.
    pub(super) fn with_flash_allowance(self, bytes: u32) -> Self {
        Self {
            program_flash: self.program_flash.with_allowance(bytes),
            ..self
        }
    }
}

/// What was measured; the JSON object of `--json`.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    flash_bytes: u32,
    flash_budget_bytes: u32,
    ram_static_bytes: u32,
    ram_budget_bytes: u32,
    /// A bound from the calls in the program, not a measurement.
    stack_worst_bytes: u32,
    stack_room_bytes: u32,
    reachable_panics: usize,
    soft_float_functions: usize,
    soft_float_in_handlers: usize,
    configuration_words: bool,
    /// Whether a build in another folder gave the same bytes; `null` when that was not tried.
    reproducible: Option<bool>,
    sections: Vec<Row>,
    panics: Vec<String>,
    floats: Vec<String>,
    /// Why the bound of the stack is none.
    stack_doubts: Vec<String>,
    /// The main program's deepest chain of calls.
    stack_chain: Vec<String>,
    stack_main_bytes: u32,
    #[serde(skip)]
    handlers: Vec<Depth>,
    #[serde(skip)]
    stray: Vec<u32>,
}

/// A section that takes memory.
#[derive(Debug, Serialize)]
struct Row {
    name: String,
    address: u32,
    flash_bytes: u32,
    ram_bytes: u32,
}

impl Report {
    /// Measures a program.
    pub(super) fn of(program: &Elf, memory: &ChipMemory, reproducible: Option<bool>) -> anyhow::Result<Self> {
        let Flow {
            stack,
            panics,
            floats,
            floats_in_handlers,
        } = flow::examine(program)?;
        let sections: Vec<Row> = program
            .sections
            .iter()
            .filter(|section| section.size > 0)
            .map(|section| row(section, &memory.ram))
            .collect();
        let ram_static_bytes = sections.iter().map(|row| row.ram_bytes).sum();
        Ok(Self {
            flash_bytes: flash_bytes(program, &memory.configuration),
            flash_budget_bytes: memory.program_flash.budget_bytes(),
            ram_static_bytes,
            ram_budget_bytes: memory.ram.budget_bytes(),
            stack_worst_bytes: stack.worst_bytes(),
            stack_room_bytes: memory.ram.bytes.saturating_sub(ram_static_bytes),
            reachable_panics: panics.len(),
            soft_float_functions: floats.len(),
            soft_float_in_handlers: floats_in_handlers.len(),
            configuration_words: configuration_is_whole(program, &memory.configuration),
            reproducible,
            sections,
            panics: panics.into_iter().collect(),
            floats: floats.into_iter().collect(),
            stack_doubts: stack.doubts.into_iter().collect(),
            stack_chain: stack.main.chain,
            stack_main_bytes: stack.main.bytes,
            handlers: stack.handlers,
            stray: stray(program, memory),
        })
    }

    /// What is too much or wrong, with the remedy.
    pub(super) fn faults(&self) -> Vec<String> {
        let (flash, flash_most) = (self.flash_bytes, self.flash_budget_bytes);
        let (memory, memory_most) = (self.ram_static_bytes, self.ram_budget_bytes);
        let stack = self.stack_worst_bytes;
        let table = [
            (
                flash > flash_most,
                format!("over budget: {flash} bytes of flash, {flash_most} allowed"),
            ),
            (
                memory > memory_most,
                format!("over budget: {memory} bytes of static memory, {memory_most} allowed"),
            ),
            (
                stack > self.stack_room_bytes,
                format!(
                    "the stack can need {stack} bytes and has {}",
                    self.stack_room_bytes
                ),
            ),
            (
                !self.stack_doubts.is_empty(),
                format!(
                    "the stack has no bound because of {}",
                    self.stack_doubts.join(", ")
                ),
            ),
            (
                !self.panics.is_empty(),
                format!("panics can be reached from {}", self.panics.join(", ")),
            ),
            (
                !self.floats.is_empty(),
                format!("floating point is used: {}", self.floats.join(", ")),
            ),
            (
                !self.configuration_words,
                "the four configuration words are not all in the program".to_owned(),
            ),
            (
                self.reproducible == Some(false),
                "a build in another folder gave other bytes".to_owned(),
            ),
        ];
        let strays = self.stray.iter();
        let strays = strays
            .map(|address| format!("there are bytes at {address:#010x}, which is no flash of the chip"));
        let found = table
            .into_iter()
            .filter(|(wrong, _)| *wrong)
            .map(|(_, text)| text);
        found.chain(strays).collect()
    }

    /// Prints the report for people.
    pub(super) fn print(&self) {
        process::print("section                  address     flash       RAM");
        for row in &self.sections {
            let Row {
                name,
                address,
                flash_bytes,
                ram_bytes,
            } = row;
            process::print(&format!(
                "{name:24} {address:#010x} {flash_bytes:8} {ram_bytes:9}"
            ));
        }
        let line =
            |what: &str, bytes: u32, of: u32| process::print(&format!("{what:35} {bytes:8} of {of} bytes"));
        process::print("");
        line("flash", self.flash_bytes, self.flash_budget_bytes);
        line("static memory", self.ram_static_bytes, self.ram_budget_bytes);
        line(
            "stack, bound by analysis of all calls",
            self.stack_worst_bytes,
            self.stack_room_bytes,
        );
        process::print(&format!(
            "  main program {:6}: {}",
            self.stack_main_bytes,
            self.stack_chain.join(" > ")
        ));
        for handler in &self.handlers {
            process::print(&format!(
                "  handler      {:6}: {}",
                handler.bytes,
                handler.chain.join(" > ")
            ));
        }
        process::print(&format!("panics that can be reached: {}", self.reachable_panics));
        process::print(&format!(
            "floating point functions: {}, in interrupt handlers: {}",
            self.soft_float_functions, self.soft_float_in_handlers
        ));
        let same = match self.reproducible {
            Some(true) => "the same bytes",
            Some(false) => "OTHER BYTES",
            None => "not tried",
        };
        process::print(&format!("build in another folder: {same}"));
    }
}

fn row(section: &Section, ram: &Region) -> Row {
    // RAM is seen at two addresses that differ in whether the cache is used; flash and peripherals lie above both.
    let physical = section.address & 0x1FFF_FFFF;
    let in_ram = section.address < 0xB000_0000 && ram.addresses().contains(&physical);
    // Room that the linker script keeps for the stack is not taken by anything static.
    let is_stack = section.name.contains("stack");
    Row {
        name: section.name.clone(),
        address: section.address,
        flash_bytes: if section.bytes.is_some() { section.size } else { 0 },
        ram_bytes: if in_ram && !is_stack { section.size } else { 0 },
    }
}

fn flash_bytes(program: &Elf, configuration: &Region) -> u32 {
    let configuration = configuration.addresses();
    let in_flash = program
        .segments
        .iter()
        .filter(|segment| !configuration.contains(&segment.physical));
    in_flash.map(|segment| segment.bytes.len() as u32).sum()
}

fn configuration_is_whole(program: &Elf, configuration: &Region) -> bool {
    configuration
        .addresses()
        .step_by(4)
        .all(|address| holds(program, address))
}

fn holds(program: &Elf, address: u32) -> bool {
    program.segments.iter().any(|segment| {
        let at = address.wrapping_sub(segment.physical) as usize;
        address >= segment.physical && segment.bytes.len() >= at + 4
    })
}

/// Addresses of segments that do not lie in flash as a whole.
fn stray(program: &Elf, memory: &ChipMemory) -> Vec<u32> {
    let fits =
        |range: &std::ops::Range<u32>, first: u32, last: u32| range.contains(&first) && range.contains(&last);
    let outside = program.segments.iter().filter(|segment| {
        let last = segment.physical.saturating_add(segment.bytes.len() as u32 - 1);
        ![&memory.program_flash, &memory.boot_flash, &memory.configuration]
            .iter()
            .any(|region| fits(&region.addresses(), segment.physical, last))
    });
    outside.map(|segment| segment.physical).collect()
}

#[cfg(test)]
mod tests {
    use super::{ChipMemory, Report};
    use crate::chip::Chip;
    use crate::firmware::elf::{Elf, Segment};
    use crate::firmware::sample::linked;
    use crate::workspace;

    fn program(flash_bytes: u32, configuration_bytes: usize) -> Elf {
        let mut elf = linked(&[(".text", &[("__start", &[0, 0])])], &[]);
        let segment = |physical, length| Segment {
            physical,
            offset: 0,
            bytes: vec![0; length],
        };
        elf.segments = vec![
            segment(0x1D00_0000, flash_bytes as usize),
            segment(0x1FC0_2FF0, configuration_bytes),
        ];
        elf
    }

    const FLASH_MAX: u32 = 160 * 1024;

    fn memory() -> ChipMemory {
        let robots = workspace::root().join("robots");
        let chip = Chip::load(&robots, "pic32mx360f256l").expect("it is described");
        ChipMemory::of(&chip).expect("it has all regions")
    }

    fn faults(elf: &Elf, reproducible: Option<bool>) -> Vec<String> {
        let report = Report::of(elf, &memory(), reproducible);
        report.expect("it has a start").faults()
    }

    #[test]
    fn what_keeps_to_its_budget_is_accepted_and_configuration_is_no_flash() {
        assert!(faults(&program(FLASH_MAX, 16), Some(true)).is_empty());
        assert!(faults(&program(FLASH_MAX, 16), None).is_empty());
    }

    #[test]
    fn each_fault_is_named_with_its_limit() {
        let mut greedy = program(4, 16);
        if let Some(section) = greedy.sections.last_mut() {
            (section.address, section.size) = (0x8000_0000, 20_481);
        }
        let mut astray = program(4, 16);
        astray.segments[0].physical = 0x1D04_0000;
        let table = [
            (
                program(FLASH_MAX + 4, 16),
                None,
                "over budget: 163844 bytes of flash, 163840 allowed",
            ),
            (
                greedy,
                None,
                "over budget: 20481 bytes of static memory, 20480 allowed",
            ),
            (
                program(4, 12),
                None,
                "configuration words are not all in the program",
            ),
            (program(4, 16), Some(false), "other bytes"),
            (astray, None, "0x1d040000, which is no flash"),
        ];
        for (elf, reproducible, wanted) in table {
            let found = faults(&elf, reproducible);
            assert!(
                found.len() == 1 && found[0].contains(wanted),
                "{wanted}: {found:?}"
            );
        }
    }
}
