//! System registers: what can be written, what is fixed, what reads as what.

use crate::bench::{
    Bench, CAUSE, EPC, ERROR_EPC, EXCEPTION_BASE, INTERRUPT_CONTROL, NOP, SHADOW_CONTROL, STATUS, mfc0, mtc0,
};
use pic32::cpu::Exit;

#[test]
fn fields_that_cannot_be_written_stay() {
    let cases = [
        ("Status", STATUS, 0x1A40_FC17, 0),
        ("IntCtl", INTERRUPT_CONTROL, 0x3E0, 0),
        ("SRSCtl", SHADOW_CONTROL, 0x0400_1040, 0x0400_0000),
        ("Cause", CAUSE, 0x0880_0300, 0),
        ("EPC", EPC, u32::MAX, 0),
        ("PRId", (15, 0), 0x0001_8765, 0x0001_8765),
        ("EBase", EXCEPTION_BASE, 0xBFFF_F000, 0x8000_0000),
        ("Config", (16, 0), 0xA421_0587, 0xA421_0580),
        ("Config1", (16, 1), 0x8000_0006, 0x8000_0006),
        ("Config2", (16, 2), 0x8000_0000, 0x8000_0000),
        ("Config3", (16, 3), 0x60, 0x60),
        ("DEPC", (24, 0), u32::MAX, 0),
        ("ErrorEPC", ERROR_EPC, u32::MAX, 0),
        ("DESAVE", (31, 0), u32::MAX, 0),
        ("BadVAddr", (8, 0), 0, 0),
        ("nothing", (5, 0), 0, 0),
    ];
    for (name, register, after_ones, after_zeros) in cases {
        for (value, expected) in [(u32::MAX, after_ones), (0, after_zeros)] {
            let mut bench = Bench::new(&[mtc0(register, 2), mfc0(register, 3)]);
            bench.cpu.set_register(2, value);
            bench.cpu.step(&mut bench.memory, &mut bench.bus);
            // What it reads, apart from what writing all ones to Status does to the rest of the program.
            assert_eq!(bench.get(register), expected, "{name} after {value:x}");
        }
    }
}

#[test]
fn system_registers_are_read_into_general_ones() {
    let mut bench = Bench::new(&[mfc0((15, 0), 3), mfc0((16, 1), 4), mfc0((15, 0), 0)]);
    bench.run(3);
    assert_eq!(
        [3, 4, 0].map(|number| bench.cpu.register(number)),
        [0x0001_8765, 0x8000_0006, 0]
    );
}

#[test]
fn software_interrupts_are_told_to_the_controller() {
    let mut bench = Bench::new(&[mtc0(CAUSE, 2), mtc0(CAUSE, 2), mtc0(CAUSE, 0), NOP]);
    bench.cpu.set_register(2, 0x200);
    assert_eq!(bench.run(10), Exit::SoftwareRequests(2));
    assert_eq!(bench.cpu.cycle(), 1);
    assert_eq!(bench.run(10), Exit::SoftwareRequests(0));
    assert_eq!(bench.cpu.cycle(), 3);
}

#[test]
fn interrupts_are_switched_by_one_instruction() {
    // di $2; ei $3; ei
    let mut bench = Bench::new(&[0x4162_6000, 0x4163_6020, 0x4160_6020]);
    bench.set(STATUS, 1 << 10 | 1);
    bench.run(1);
    assert_eq!((bench.get(STATUS), bench.cpu.register(2)), (1 << 10, 1 << 10 | 1));
    bench.run(2);
    assert_eq!((bench.get(STATUS), bench.cpu.register(3)), (1 << 10 | 1, 1 << 10));
}

#[test]
fn a_return_from_an_exception_breaks_the_link() {
    let (ll, sc) = (0xC000_0000 | 2 << 16 | 1 << 21, 0xE000_0000 | 3 << 16 | 1 << 21);
    for (between, expected) in [(NOP, 1), (crate::bench::ERET, 0)] {
        let mut bench = Bench::new(&[ll, between, sc]);
        bench.set(EPC, crate::bench::FLASH + 8);
        bench.cpu.set_register(1, crate::bench::RAM);
        bench.cpu.set_register(3, 77);
        bench.run(8);
        assert_eq!(bench.cpu.register(3), expected);
        assert_eq!(bench.memory.ram()[0], if expected == 1 { 77 } else { 0 });
    }
}

#[test]
fn hardware_registers_are_read() {
    let rdhwr = |register: u32, rt: u32| 0x7C00_003B | rt << 16 | register << 11;
    let mut bench = Bench::new(&[NOP, NOP, rdhwr(0, 2), rdhwr(2, 3), rdhwr(3, 4)]);
    bench.run(5);
    assert_eq!([2, 3, 4].map(|number| bench.cpu.register(number)), [0, 1, 2]);
}

#[test]
fn register_zero_stays_zero() {
    // addiu $0, $0, 5; lui $0, 1; lw $0, 0($1); mul $0, $2, $2; jalr $0, $3
    let words = [
        0x2400_0005,
        0x3C00_0001,
        0x8C20_0000,
        0x7042_0002,
        0x0060_0009,
        0x0000_0010,
    ];
    let mut bench = Bench::new(&words);
    for (number, value) in [(1, crate::bench::RAM), (2, 9), (3, crate::bench::FLASH)] {
        bench.cpu.set_register(number, value);
    }
    bench.memory.ram_mut()[0] = 1;
    bench.cpu.set_register(0, 7);
    bench.run(10);
    assert_eq!(bench.cpu.register(0), 0);
}
