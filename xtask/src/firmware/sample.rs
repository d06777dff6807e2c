//! Small programs for tests, put together by hand.

use super::elf::{Elf, Section, Symbol};

/// Functions and their instructions.
pub(super) type Functions<'a> = &'a [(&'a str, &'a [u32])];

/// Where they begin.
pub(super) const BASE: u32 = 0x9D00_0000;

/// A program of sections with functions and their instructions, one behind the other, and constants.
pub(super) fn linked(sections: &[(&str, Functions<'_>)], constants: &[u32]) -> Elf {
    let mut elf = Elf::default();
    let mut address = BASE;
    for (name, functions) in sections {
        let mut bytes = Vec::new();
        for (function, words) in *functions {
            elf.symbols.push(Symbol {
                name: (*function).to_owned(),
                address: address + bytes.len() as u32,
                size: words.len() as u32 * 4,
                code: true,
                function: true,
            });
            words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
        }
        let size = bytes.len() as u32;
        elf.sections.push(section(name, address, (true, bytes)));
        address += size;
    }
    let constants = constants.iter().flat_map(|word| word.to_le_bytes()).collect();
    elf.sections
        .push(section(".rodata", 0x9D01_0000, (false, constants)));
    elf
}

fn section(name: &str, address: u32, (executable, bytes): (bool, Vec<u8>)) -> Section {
    Section {
        name: name.to_owned(),
        address,
        size: bytes.len() as u32,
        executable,
        bytes: Some(bytes),
    }
}
