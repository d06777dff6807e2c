//! The golden vectors in the emulated chip: the very bytes that are flashed into a Relax read them.
//!
//! `cargo xtask test --only emulator` builds the image and names its folder in `RVAC_RELAX`. Functions of the image are called one
//! by one, as SDCC calls them: the first argument in DPL, others on the stack, the result in DPL.

#[path = "../all/expected.rs"]
mod expected;

use cord_c::host::hex;
use expected::{Case, Question, TICK, golden};
use stc90::image::Image;
use stc90::machine::{Machine, Options};
use std::collections::HashMap;
use std::path::Path;

/// What fits into this chip's buffer: `CORD_PACKET_MOST` of `firmware/relax/chip/port.h`.
const PACKET_MOST: usize = 128;
/// Registers of the core.
const SP: u8 = 0x81;
const DPL: u8 = 0x82;
/// Nothing of the image calls this address.
const RETURN: u16 = 0;
/// No function of the parser takes longer.
const CYCLES_MOST: u64 = 1_000_000;
/// In the order of `frame.h`.
const FRAMED: [&str; 10] = [
    "",
    "open",
    "sealed",
    "missealed",
    "binary",
    "binary-missealed",
    "too-long",
    "control-byte",
    "framing-error",
    "overrun",
];

/// The image in its chip.
struct Chip {
    machine: Machine,
    places: HashMap<String, u16>,
    stack: u8,
}

impl Chip {
    fn new(folder: &Path) -> Self {
        let text = |name: &str| std::fs::read_to_string(folder.join(name)).expect(name);
        let image = Image::from_hex(&text("relax.ihx")).expect("an image");
        let memory = text("linked.mem");
        let stack = memory
            .lines()
            .find_map(|line| line.strip_prefix("Stack starts at: 0x"));
        let stack = stack.and_then(|rest| u8::from_str_radix(&rest[..2], 16).ok());
        let mut places = HashMap::new();
        for line in text("linked.map").lines() {
            let mut words = line.split_whitespace().skip_while(|word| word.ends_with(':'));
            let (Some(address), Some(name)) = (words.next(), words.next()) else {
                continue;
            };
            if let Ok(address) = u32::from_str_radix(address, 16) {
                places.insert(name.to_owned(), address as u16);
            }
        }
        Self {
            machine: Machine::new(&image, Options::RELAX),
            places,
            stack: stack.expect("the start of the stack"),
        }
    }

    fn place(&self, name: &str) -> u16 {
        *self
            .places
            .get(name)
            .unwrap_or_else(|| panic!("the map has no {name}"))
    }

    /// Calls a function with a byte, and more bytes that lie on the stack; gives what it returns.
    fn call(&mut self, name: &str, first: u8, others: &[u8]) -> u8 {
        let at = self.place(name);
        let cpu = self.machine.cpu_mut();
        let mut top = self.stack - 1;
        for byte in others.iter().chain(&RETURN.to_le_bytes()) {
            top += 1;
            cpu.ram_mut()[usize::from(top)] = *byte;
        }
        cpu.set_register(SP, top);
        cpu.set_register(DPL, first);
        cpu.set_pc(at);
        let end = self.machine.cycle() + CYCLES_MOST;
        while self.machine.cpu().pc() != RETURN {
            self.machine.step();
            assert!(self.machine.cycle() < end, "{name} does not return");
        }
        self.machine.cpu().dptr() as u8
    }

    fn xram(&self, name: &str, count: usize) -> Vec<u8> {
        let from = usize::from(self.place(name));
        self.machine.xram()[from..from + count].to_vec()
    }

    fn set_xram(&mut self, name: &str, bytes: &[u8]) {
        let from = usize::from(self.place(name));
        self.machine.xram_mut()[from..from + bytes.len()].copy_from_slice(bytes);
    }

    /// Packets in a stream, in the words of `host/verdicts.c`.
    fn frames(&mut self, session: u16, stream: &[u8]) -> String {
        let [low, high] = session.to_le_bytes();
        self.call("_cord_frame_start", 0, &[]);
        self.machine.cpu_mut().set_register(DPL + 1, high);
        self.call("_cord_frame_set_session", low, &[]);
        let mut out = String::new();
        for byte in stream {
            let framed = usize::from(self.call("_cord_frame_take", *byte, &[]));
            if framed == 0 {
                continue;
            }
            let length = self.xram("_cord_packet_length", 2);
            let has_bytes = (1..5).contains(&framed);
            let count = if has_bytes { number(&length) as usize } else { 0 };
            let packet = hex(&self.xram("_cord_packet", count));
            out += &format!(" {}:{packet}", FRAMED[framed]);
        }
        out
    }

    /// The verdict on a text.
    fn verdict(&mut self, form: u8, text: &[u8]) -> String {
        self.set_xram("_cord_packet", &[text, &[0]].concat());
        self.set_xram("_cord_packet_length", &(text.len() as u16).to_le_bytes());
        // In the memory that one instruction reaches.
        let bits = usize::from(self.place("_cord_packet_bits"));
        self.machine.cpu_mut().ram_mut()[bits] = 0x80;
        self.set_xram("_cord_command", &[0; 20]);
        let refusal = self.call("_cord_command_read", form, &TICK.to_le_bytes());
        let command = self.xram("_cord_command", 20);
        let stop = self.call("_cord_command_is_stop", 0, &[]);
        if refusal != 0 {
            let sequence = match self.call("_cord_command_number", 0, &[]) {
                0 => "-".to_owned(),
                _ => {
                    let at = usize::from(self.place("_cord_number"));
                    number(&self.machine.cpu().ram()[at..at + 4]).to_string()
                }
            };
            return format!("{stop} refused {refusal} {sequence}");
        }
        let long = |at: usize| number(&command[at..at + 4]);
        format!(
            "{stop} command {} {} {} {} {} {} {} {} {}",
            command[0],
            command[1],
            command[2],
            command[3],
            long(4) as i32,
            long(8) as i32,
            number(&command[12..14]),
            number(&command[14..16]),
            long(16)
        )
    }

    fn answer(&mut self, question: &Question) -> String {
        match question {
            Question::Stream(session, stream) => self.frames(*session, stream),
            Question::Text(form, text) => self.verdict((form % 3) as u8, text),
        }
    }
}

fn number(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |sum, byte| sum << 8 | u32::from(*byte))
}

/// Whether all packets fit into the chip.
fn fits((question, _): &Case) -> bool {
    match question {
        Question::Stream(_, bytes) => bytes
            .split(|byte| [0x1E, 0x1F].contains(byte))
            .all(|packet| packet.len() <= PACKET_MOST),
        Question::Text(_, bytes) => bytes.len() <= PACKET_MOST,
    }
}

#[test]
fn golden_vectors_mean_the_same_in_the_chip() {
    let Some(folder) = std::env::var_os("RVAC_RELAX") else {
        println!("skipped: RVAC_RELAX names no folder with the image of a Relax");
        return;
    };
    let mut chip = Chip::new(Path::new(&folder));
    let cases = golden();
    let all = cases.len();
    let cases: Vec<Case> = cases.into_iter().filter(fits).collect();
    for (question, expected) in &cases {
        assert_eq!(chip.answer(question), *expected, "{question:?}");
    }
    println!(
        "{} of {all} golden cases agree in the chip, the rest is longer than {PACKET_MOST} bytes",
        cases.len()
    );
    assert!(cases.len() * 100 > all * 95, "{} of {all}", cases.len());
    assert_eq!(chip.machine.misuses().len(), 0);
}
