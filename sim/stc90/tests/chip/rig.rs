//! Programs from bytes.

use stc90::image::Image;
use stc90::machine::{Machine, Options};
use stc90::pins::{Edge, Level, Pin};

/// SJMP to itself.
pub(crate) const STAY: [u8; 2] = [0x80, 0xFE];

/// A chip whose program consists of these parts; elsewhere it is erased.
pub(crate) fn machine(parts: &[(u16, &[u8])]) -> Machine {
    with_options(parts, Options::RELAX)
}

/// The same with other options.
pub(crate) fn with_options(parts: &[(u16, &[u8])], options: Options) -> Machine {
    let mut image = Image::erased();
    for (address, bytes) in parts {
        assert!(
            image.write(u32::from(*address), bytes),
            "{address:#x} is in the flash"
        );
    }
    Machine::new(&image, options)
}

/// MOV direct, #constant for each pair.
pub(crate) fn set(pairs: &[(u8, u8)]) -> Vec<u8> {
    let moves = pairs
        .iter()
        .flat_map(|(register, value)| [0x75, *register, *value]);
    moves.collect()
}

/// A program that sets registers and then does the rest.
pub(crate) fn after(pairs: &[(u8, u8)], rest: &[u8]) -> Vec<u8> {
    let mut program = set(pairs);
    program.extend(rest);
    program
}

/// A pin by its name.
pub(crate) fn pin(name: &str) -> Pin {
    name.parse().expect("a pin")
}

/// A level that changes later.
pub(crate) fn edge(cycle: u64, name: &str, level: Level) -> Edge {
    Edge {
        cycle,
        pin: pin(name),
        level,
    }
}

/// A byte of internal RAM.
pub(crate) fn ram(machine: &Machine, address: u8) -> u8 {
    machine.cpu().ram()[usize::from(address)]
}
