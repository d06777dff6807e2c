//! A small program: it counts in a register and in RAM, calls a function each time, and fails when told to.

use pic32::image::Image;
use pic32::machine::Machine;

/// Where the loop begins.
pub(crate) const LOOP: u32 = 0x9D00_0000;
/// The function that it calls.
pub(crate) const FUNCTION: u32 = 0x9D00_0040;
/// The word of RAM that it counts in.
pub(crate) const COUNTER: u32 = 0x8000_0100;

pub(crate) fn machine() -> Machine {
    let boot = [
        0x3C1D_8000, // lui sp, 0x8000
        0x37BD_8000, // ori sp, sp, 0x8000
        0x3C03_8000, // lui v1, 0x8000
        0x3C19_9D00, // lui t9, 0x9d00
        0x0320_0008, // jr t9
        0x2402_0000, // li v0, 0
    ];
    let code = [
        0x2442_0001, // addiu v0, v0, 1
        0x0F40_0010, // jal FUNCTION
        0xAC62_0100, // sw v0, 0x100(v1)
        0x1000_FFFC, // b LOOP
        0x0000_0000, // nop
    ];
    // lw a0, 0(a1): fails when a1 is no address of memory; jr ra; nop
    let function = [0x8CA4_0000, 0x03E0_0008, 0x0000_0000];
    let mut image = Image::erased();
    let bytes = |words: &[u32]| -> Vec<u8> { words.iter().flat_map(|word| word.to_le_bytes()).collect() };
    image.write(0xBFC0_0000, &bytes(&boot)).expect("it is flash");
    image.write(LOOP, &bytes(&code)).expect("it is flash");
    image.write(FUNCTION, &bytes(&function)).expect("it is flash");
    let mut machine = Machine::new(&image);
    machine.cpu_mut().set_register(5, COUNTER);
    machine
}
