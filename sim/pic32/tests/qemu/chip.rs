//! A program in the emulator, whose system calls are answered here.

use crate::image::placed;
use crate::program::{CODE, DUMP_BYTES, Program};
use pic32::cpu::{Access, Bus, BusFault, Cpu, ExceptionCode, Exit};
use pic32::image::Image;
use pic32::memory::Memory;

/// The middle of the program's window, in RAM.
const DATA: u32 = 0x4800;
const WRITE: u32 = 4004;
const RESULT: u8 = 2;
const ADDRESS: u8 = 5;
const LENGTH: u8 = 6;

/// Through which segment the program sees its data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DataPlace {
    Cached,
    Uncached,
    Physical,
}

impl DataPlace {
    pub(crate) const fn address(self) -> u32 {
        match self {
            Self::Cached => 0x8000_0000 | DATA,
            Self::Uncached => 0xA000_0000 | DATA,
            Self::Physical => DATA,
        }
    }
}

/// A chip without peripherals.
#[derive(Debug)]
pub(crate) struct Bare;

impl Bus for Bare {
    fn load(&mut self, _: Access) -> Result<u32, BusFault> {
        Err(BusFault)
    }

    fn store(&mut self, _: Access, _: u32) -> Result<(), BusFault> {
        Err(BusFault)
    }

    fn horizon(&self) -> u64 {
        u64::MAX
    }
}

/// Runs the program to its end and gives what it writes; the core is asked to run for `stride()` cycles again and again.
pub(crate) fn run(program: &Program, place: DataPlace, mut stride: impl FnMut() -> u64) -> Vec<u8> {
    let mut image = Image::erased();
    let code = placed(program, place.address());
    image.write(CODE, &code).expect("the program fits into flash");
    let mut memory = Memory::new(&image);
    let mut cpu = Cpu::new();
    cpu.set_pc(CODE);
    let mut output = Vec::new();
    loop {
        let until = cpu.cycle() + stride();
        let exception = match cpu.run(&mut memory, &mut Bare, until) {
            Exit::Reached => continue,
            Exit::Exception(exception) => exception,
            other => panic!("the program ended with {other:x?}"),
        };
        let context = || format!("{exception:x?} after {} bytes", output.len());
        assert_eq!(exception.code, ExceptionCode::Syscall, "{}", context());
        if cpu.register(RESULT) != WRITE {
            return output;
        }
        assert_eq!(cpu.register(LENGTH), DUMP_BYTES, "{}", context());
        output.extend(written(&cpu, &memory));
        cpu.set_pc(exception.address + 4);
    }
}

/// The bytes that a `write` names.
pub(crate) fn written(cpu: &Cpu, memory: &Memory) -> Vec<u8> {
    let mut bytes = vec![0; cpu.register(LENGTH) as usize];
    memory
        .read(cpu.register(ADDRESS) & 0x1FFF_FFFF, &mut bytes)
        .expect("the program writes from its memory");
    bytes
}
