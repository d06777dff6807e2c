//! What programs write out, compared.

use crate::block::WINDOW;
use crate::program::{CODE, DUMP_BYTES, Program};
use std::fmt::Write;

const SIZE: usize = DUMP_BYTES as usize;

/// All dumps must be equal; the first that is not is told with the block before it.
pub(crate) fn assert_equal(program: &Program, seed: u64, (found, expected): (&[u8], &[u8])) {
    let mut dumps = found.chunks(SIZE).zip(expected.chunks(SIZE));
    if let Some(number) = dumps.position(|(found, expected)| found != expected) {
        panic!("{}", difference(program, (seed, number), (found, expected)));
    }
    assert_eq!(
        found.len(),
        expected.len(),
        "seed {seed}: one of them ended early"
    );
    assert_eq!(
        found.len(),
        program.blocks.len() * SIZE,
        "seed {seed}: blocks were left out"
    );
}

/// The block's instructions, and each word of the dump that is not equal, with its value before.
fn difference(program: &Program, (seed, number): (u64, usize), (found, expected): (&[u8], &[u8])) -> String {
    let mut text = format!("seed {seed}, block {number}:\n");
    let begin = program.blocks[number];
    let end = program.blocks.get(number + 1).copied().unwrap_or(begin + 32);
    for index in begin..end {
        let word = program.words[index];
        writeln!(text, "  {:08x}: {word:08x}", CODE + 4 * index as u32).expect("text grows");
    }
    let dump = |bytes: &[u8], number: usize| bytes[number * SIZE..(number + 1) * SIZE].to_vec();
    let before = number
        .checked_sub(1)
        .map_or(vec![0; SIZE], |number| dump(expected, number));
    let (found, expected) = (dump(found, number), dump(expected, number));
    for place in (0..SIZE).step_by(4) {
        let word = |bytes: &[u8]| u32::from_le_bytes(bytes[place..place + 4].try_into().expect("four bytes"));
        let (before, found, expected) = (word(&before), word(&found), word(&expected));
        if found != expected {
            let name = name_of(place as u32);
            writeln!(
                text,
                "  {name}: {before:08x} became {found:08x}, in qemu {expected:08x}"
            )
            .expect("text grows");
        }
    }
    text
}

fn name_of(place: u32) -> String {
    match place.checked_sub(WINDOW) {
        None => format!("window {:+}", i64::from(place) - i64::from(WINDOW / 2)),
        Some(124) => "hi".to_owned(),
        Some(128) => "lo".to_owned(),
        Some(register) => format!("${}", register / 4 + 1),
    }
}
