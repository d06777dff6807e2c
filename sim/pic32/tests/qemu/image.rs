//! A program as the file that Linux executes.

use crate::encode::{DATA, constant};
use crate::program::{CODE, Program};

/// Where a process has its data; [`DATA`] points to the middle of a page of them.
const PROCESS_DATA: u32 = 0x2000_0000;
const PAGE: u32 = 0x1000;
const HEADERS: u32 = 52 + 2 * 32;

/// The words of the program with its data at an address.
pub(crate) fn placed(program: &Program, data: u32) -> Vec<u8> {
    let start = constant(DATA, data);
    let words = start.iter().chain(&program.words[2..]);
    words.flat_map(|word| word.to_le_bytes()).collect()
}

/// An ELF with the program and a page of data.
pub(crate) fn process(program: &Program) -> Vec<u8> {
    let code = placed(program, PROCESS_DATA + PAGE / 2);
    let size = code.len() as u32;
    // Contents begin a page after the begin of the file, so that both are aligned alike.
    let segments: [[u32; 8]; 2] = [
        [1, PAGE, CODE, CODE, size, size, 5, PAGE],
        [1, 0, PROCESS_DATA, PROCESS_DATA, 0, PAGE, 6, PAGE],
    ];
    let mut file = vec![0x7F, b'E', b'L', b'F', 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let halves = |file: &mut Vec<u8>, values: &[u16]| {
        file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    };
    let words = |file: &mut Vec<u8>, values: &[u32]| {
        file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    };
    halves(&mut file, &[2, 8]);
    words(&mut file, &[1, CODE, 52, 0, 0x7000_1001]);
    halves(&mut file, &[52, 32, 2, 40, 0, 0]);
    segments.iter().for_each(|segment| words(&mut file, segment));
    assert_eq!(file.len() as u32, HEADERS);
    file.resize(PAGE as usize, 0);
    file.extend(code);
    file
}
