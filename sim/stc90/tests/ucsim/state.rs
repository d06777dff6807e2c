//! What is compared: registers, memories and the number of cycles.

use stc90::machine::Machine;

/// Registers that are compared: those of the core, latches of ports, timers. uCsim has the others as plain bytes, or not.
const REGISTERS: [u8; 21] = [
    0x80, 0x81, 0x82, 0x83, 0x88, 0x89, 0x8A, 0x8B, 0x8C, 0x8D, 0x90, 0xA0, 0xB0, 0xC8, 0xCA, 0xCB, 0xCC,
    0xCD, 0xD0, 0xE0, 0xF0,
];

/// Clocks of a cycle in uCsim.
const CLOCKS: u64 = 12;

/// The state after some instructions.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct State {
    pub(crate) pc: u16,
    pub(crate) cycle: u64,
    pub(crate) registers: [u8; REGISTERS.len()],
    ram: Vec<u8>,
}

impl State {
    /// That of our chip.
    pub(crate) fn of(machine: &Machine) -> Self {
        Self {
            pc: machine.cpu().pc(),
            cycle: machine.cycle(),
            registers: REGISTERS.map(|register| machine.register(register)),
            ram: machine.cpu().ram().to_vec(),
        }
    }

    /// Names what differs.
    pub(crate) fn difference(&self, other: &Self) -> String {
        let mut text = String::new();
        if (self.pc, self.cycle) != (other.pc, other.cycle) {
            text += &format!(
                "pc {:04x} and {:04x}, cycle {} and {}; ",
                self.pc, other.pc, self.cycle, other.cycle
            );
        }
        for (number, register) in REGISTERS.iter().enumerate() {
            let (ours, theirs) = (self.registers[number], other.registers[number]);
            // uCsim keeps a parity that was written until the accumulator changes. Programs read the right one.
            let compared = if *register == 0xD0 { 0xFE } else { 0xFF };
            if (ours ^ theirs) & compared != 0 {
                text += &format!("register {register:02x}: {ours:02x} and {theirs:02x}; ");
            }
        }
        for (address, (ours, theirs)) in self.ram.iter().zip(&other.ram).enumerate() {
            if ours != theirs {
                text += &format!("ram {address:02x}: {ours:02x} and {theirs:02x}; ");
            }
        }
        text
    }
}

/// Commands that execute so many instructions and print the state.
pub(crate) fn commands(instructions: u32) -> String {
    format!("step {instructions}\nstate\ndump /b iram 0 255\ndump /b sfr 128 255\n")
}

/// Command that prints external memory.
pub(crate) const DUMP_XRAM: &str = "dump /b xram 0 1023\n";

/// What uCsim has printed and was not read yet.
#[derive(Debug)]
pub(crate) struct Printed<'a>(pub(crate) &'a [u8]);

impl<'a> Printed<'a> {
    /// Skips to behind a text.
    fn skip(&mut self, text: &str) {
        let found = self
            .0
            .windows(text.len())
            .position(|window| window == text.as_bytes());
        let place = found.unwrap_or_else(|| panic!("uCsim does not print {text:?} any more"));
        self.0 = &self.0[place + text.len()..];
    }

    fn take(&mut self, count: usize) -> &'a [u8] {
        assert!(self.0.len() >= count, "uCsim's output is cut off");
        let (taken, rest) = self.0.split_at(count);
        self.0 = rest;
        taken
    }

    /// The word up to a delimiter.
    fn word(&mut self, delimiter: u8) -> String {
        let length = self.0.iter().position(|byte| *byte == delimiter).unwrap_or(0);
        String::from_utf8_lossy(self.take(length)).into_owned()
    }

    /// The next state.
    pub(crate) fn state(&mut self) -> State {
        self.skip("\nCPU state= OK PC= 0x");
        let pc = u32::from_str_radix(&self.word(b' '), 16).expect("an address");
        self.skip("Total time since last reset=");
        self.skip("(");
        let clocks: u64 = self.word(b' ').parse().expect("a number of clocks");
        self.skip("Simulation: stopped\ndump /b iram 0 255\n");
        let ram = self.take(256).to_vec();
        self.skip("dump /b sfr 128 255\n");
        let registers = self.take(128);
        State {
            pc: pc as u16,
            cycle: clocks / CLOCKS,
            registers: REGISTERS.map(|register| registers[usize::from(register) - 128]),
            ram,
        }
    }

    /// External memory.
    pub(crate) fn xram(&mut self) -> &'a [u8] {
        self.skip(DUMP_XRAM);
        self.take(1024)
    }
}
