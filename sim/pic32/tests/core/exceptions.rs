//! Which instruction raises what, and what the core notes about it.

use crate::bench::{
    BAD_ADDRESS, BEV, BRANCH, BREAK, Bench, CAUSE, DERET, EPC, ERET, ERL, ERROR_EPC, EXL, FLASH, NOP,
    SHADOW_CONTROL, STATUS, SYSCALL, immediate, special,
};
use pic32::cpu::ExceptionCode::{
    AddressLoad, AddressStore, Breakpoint, BusData, BusFetch, CoprocessorUnusable, Overflow, Reserved,
    Syscall, Trap,
};
use pic32::cpu::{CoreReset, Exception, ExceptionCode, Exit};

/// An instruction, what it raises, the address that it names, and the coprocessor that is missing. Register 1 holds
/// 0x8000_0001, register 2 is -1, register 3 is 0x7FFF_FFFF, register 4 is 0x8000_8000 (behind RAM), register 5 is KUSEG,
/// register 6 is flash, register 7 a register without an owner, register 8 KSEG2.
type Case = (&'static str, u32, ExceptionCode, Option<u32>, u32);

const SET: [u32; 8] = [
    0x8000_0001,
    u32::MAX,
    0x7FFF_FFFF,
    0x8000_8000,
    0x0040_0000,
    0x9D00_0000,
    0xBF80_0000,
    0xC000_0000,
];

/// What an instruction itself raises.
#[rustfmt::skip]
fn by_instruction() -> Vec<Case> {
    vec![
        ("syscall", SYSCALL, Syscall, None, 0),
        ("break", BREAK, Breakpoint, None, 0),
        ("add 3, 3", special(0x20, 9, 3, 3), Overflow, None, 0),
        ("addi 3, 1", immediate(8, 9, 3, 1), Overflow, None, 0),
        ("sub 1, 3", special(0x22, 9, 1, 3), Overflow, None, 0),
        ("teq 2, 2", special(0x34, 0, 2, 2), Trap, None, 0),
        ("tge 2, 1", special(0x30, 0, 2, 1), Trap, None, 0),
        ("tgeu 2, 1", special(0x31, 0, 2, 1), Trap, None, 0),
        ("tlt 2, 0", special(0x32, 0, 2, 0), Trap, None, 0),
        ("tltu 0, 2", special(0x33, 0, 0, 2), Trap, None, 0),
        ("tne 0, 2", special(0x36, 0, 0, 2), Trap, None, 0),
        ("tgei 2, -1", immediate(1, 8, 2, 0xFFFF), Trap, None, 0),
        ("tgeiu 2, -1", immediate(1, 9, 2, 0xFFFF), Trap, None, 0),
        ("tlti 2, 0", immediate(1, 10, 2, 0), Trap, None, 0),
        ("tltiu 3, -1", immediate(1, 11, 3, 0xFFFF), Trap, None, 0),
        ("teqi 2, -1", immediate(1, 12, 2, 0xFFFF), Trap, None, 0),
        ("tnei 2, 0", immediate(1, 14, 2, 0), Trap, None, 0),
        ("jalx", 0x1D << 26, Reserved, None, 0),
        ("opcode 3c", 0x3C << 26, Reserved, None, 0),
        ("special 3f", 0x3F, Reserved, None, 0),
        ("srl with rs 2", special(2, 9, 2, 9), Reserved, None, 0),
        ("ext too long", 0x7C00_FFC0, Reserved, None, 0),
        ("ext by one bit too long", 0x7C00_F840, Reserved, None, 0),
        ("ins of nothing", 0x7C00_0884, Reserved, None, 0),
        ("tlbwi", 0x4200_0002, Reserved, None, 0),
        ("deret outside of debug mode", DERET, Reserved, None, 0),
        ("lwc1", 0x31 << 26, CoprocessorUnusable, None, 1),
        ("add.s", 0x4600_0000, CoprocessorUnusable, None, 1),
        ("movf", 0x01, CoprocessorUnusable, None, 1),
        ("cop2", 0x12 << 26, CoprocessorUnusable, None, 2),
        ("sdc2", 0x3E << 26, CoprocessorUnusable, None, 2),
    ]
}

/// What an address raises.
#[rustfmt::skip]
fn by_address() -> Vec<Case> {
    vec![
        ("lw 1", immediate(0x23, 9, 1, 1), AddressLoad, Some(0x8000_0002), 0),
        ("lh 1", immediate(0x21, 9, 1, 0), AddressLoad, Some(0x8000_0001), 0),
        ("lhu 1", immediate(0x25, 9, 1, 2), AddressLoad, Some(0x8000_0003), 0),
        ("ll 1", immediate(0x30, 9, 1, 0), AddressLoad, Some(0x8000_0001), 0),
        ("sw 1", immediate(0x2B, 9, 1, 0), AddressStore, Some(0x8000_0001), 0),
        ("sh 1", immediate(0x29, 9, 1, 0), AddressStore, Some(0x8000_0001), 0),
        ("sc 1", immediate(0x38, 9, 1, 0), AddressStore, Some(0x8000_0001), 0),
        ("lw behind RAM", immediate(0x23, 9, 4, 0), BusData, Some(0x8000_8000), 0),
        ("sw behind RAM", immediate(0x2B, 9, 4, 0), BusData, Some(0x8000_8000), 0),
        ("lbu in KUSEG", immediate(0x24, 9, 5, 0), BusData, Some(0x0040_0000), 0),
        ("swl in KUSEG", immediate(0x2A, 9, 5, 3), BusData, Some(0x0040_0000), 0),
        ("sb to flash", immediate(0x28, 9, 6, 0), BusData, Some(0x9D00_0000), 0),
        ("lw of nothing", immediate(0x23, 9, 7, 0), BusData, Some(0xBF80_0000), 0),
        ("sw to nothing", immediate(0x2B, 9, 7, 4), BusData, Some(0xBF80_0004), 0),
        ("lw in KSEG2", immediate(0x23, 9, 8, 0), BusData, Some(0xC000_0000), 0),
    ]
}

fn cases() -> Vec<Case> {
    [by_instruction(), by_address()].concat()
}

fn prepared(words: &[u32]) -> Bench {
    let mut bench = Bench::new(words);
    for (number, value) in (1..).zip(SET) {
        bench.cpu.set_register(number, value);
    }
    bench
}

/// The first exception within a few cycles.
fn raised(bench: &mut Bench) -> Exception {
    match bench.run(20) {
        Exit::Exception(exception) => exception,
        other => panic!("{other:?}"),
    }
}

#[test]
fn each_cause_is_reported() {
    for (name, word, code, accessed, unit) in cases() {
        let mut bench = prepared(&[NOP, word]);
        let address = FLASH + 4;
        assert_eq!(
            raised(&mut bench),
            Exception {
                code,
                address,
                accessed
            },
            "{name}"
        );
        assert_eq!(bench.get(CAUSE), (code as u32) << 2 | unit << 28, "{name}");
        assert_eq!(bench.get(EPC), FLASH + 4, "{name}");
        assert_eq!(bench.get(STATUS), EXL, "{name}");
        assert_eq!(bench.cpu.pc(), 0x9D01_0180, "{name}");
        assert_eq!(bench.cpu.register(9), 0, "{name}: it had an effect");
        let is_address = matches!(code, AddressLoad | AddressStore);
        assert_eq!(
            bench.get(BAD_ADDRESS),
            accessed.filter(|_| is_address).unwrap_or(0),
            "{name}"
        );
    }
}

#[test]
fn in_a_delay_slot_the_branch_is_reported() {
    // Taken, not taken, likely, linking: all of them have a slot.
    for branch in [
        BRANCH,
        0x1400_0002,
        0x5000_0002,
        0x0410_0002,
        0x0411_0002,
        0x0F40_0004,
        0x0BC0_0000 | 0x40,
    ] {
        for (name, word, code, ..) in cases() {
            let mut bench = prepared(&[NOP, branch, word]);
            assert_eq!(raised(&mut bench).address, FLASH + 8, "{name} after {branch:x}");
            assert_eq!(
                bench.get(CAUSE) & 0x8000_007C,
                1 << 31 | (code as u32) << 2,
                "{name} after {branch:x}"
            );
            assert_eq!(bench.get(EPC), FLASH + 4, "{name} after {branch:x}");
        }
    }
}

#[test]
fn an_annulled_slot_raises_nothing() {
    let mut bench = prepared(&[0x5400_0002, SYSCALL, NOP, BREAK]);
    assert_eq!(raised(&mut bench).code, Breakpoint);
    assert_eq!(bench.get(CAUSE) >> 31, 0);
}

#[test]
fn vectors_depend_on_bev() {
    let mut bench = prepared(&[SYSCALL]);
    bench.set(STATUS, BEV);
    raised(&mut bench);
    assert_eq!(bench.cpu.pc(), 0xBFC0_0380);
}

#[test]
fn a_second_exception_keeps_the_first_return_address() {
    let mut bench = prepared(&[NOP, BRANCH, SYSCALL]);
    raised(&mut bench);
    // Erased flash is an instruction that does not exist.
    let second = raised(&mut bench);
    assert_eq!((second.code, second.address), (Reserved, 0x9D01_0180));
    assert_eq!(bench.get(EPC), FLASH + 4);
    assert_eq!(bench.get(CAUSE) >> 31, 1);
    assert_eq!(bench.cpu.pc(), 0x9D01_0180);
}

#[test]
fn fetches_from_nowhere_are_reported() {
    let cases = [
        (0x9D04_0000, BusFetch),
        (0xBFC0_3000, BusFetch),
        (0x8000_0000, BusFetch),
        (0x0000_1000, BusFetch),
        (0xC000_0000, BusFetch),
        (0xBF80_0600, BusFetch),
        (0x9D00_0002, AddressLoad),
        (0x9D00_0001, AddressLoad),
    ];
    for (target, code) in cases {
        let mut bench = prepared(&[special(8, 0, 10, 0), NOP]);
        bench.cpu.set_register(10, target);
        let accessed = Some(target);
        let address = target;
        assert_eq!(
            raised(&mut bench),
            Exception {
                code,
                address,
                accessed
            },
            "{target:x}"
        );
        assert_eq!(bench.get(EPC), target);
        assert_eq!(bench.get(CAUSE) >> 31, 0);
    }
}

#[test]
fn running_and_branching_over_an_end_of_flash_is_reported() {
    let last = 0x9D03_FFFC;
    let fell = raised(&mut Bench::at(last, &[NOP]));
    assert_eq!((fell.code, fell.address), (BusFetch, 0x9D04_0000));
    // A branch whose slot is behind the end.
    let mut bench = Bench::at(last, &[BRANCH]);
    let slot = raised(&mut bench);
    assert_eq!((slot.code, slot.address), (BusFetch, 0x9D04_0000));
    assert_eq!((bench.get(EPC), bench.get(CAUSE) >> 31), (last, 1));
    // Backwards over the begin.
    let before = raised(&mut Bench::new(&[0x1000_FFFD, NOP]));
    assert_eq!((before.code, before.address), (BusFetch, FLASH - 8));
}

#[test]
fn user_mode_may_not_name_the_kernels_segments() {
    let user = 1 << 4;
    let mut bench = prepared(&[NOP]);
    bench.set(STATUS, user);
    assert_eq!(raised(&mut bench).code, AddressLoad);
    let mut bench = prepared(&[NOP]);
    bench.set(STATUS, user);
    bench.cpu.set_pc(0x0040_0000);
    assert_eq!(raised(&mut bench).code, BusFetch);
    // A handler is not in user mode.
    let mut bench = prepared(&[NOP]);
    bench.set(STATUS, user | EXL);
    assert_eq!(bench.step(), Exit::Reached);
}

#[test]
fn eret_returns_from_either_level() {
    for (status, register, left) in [(EXL, EPC, 0), (ERL, ERROR_EPC, 0), (EXL | ERL, ERROR_EPC, EXL)] {
        let mut bench = prepared(&[ERET, SYSCALL]);
        bench.set(STATUS, status);
        bench.set(register, FLASH + 0x40);
        assert_eq!(bench.step(), Exit::Reached);
        assert_eq!((bench.cpu.pc(), bench.get(STATUS)), (FLASH + 0x40, left));
        assert_eq!(bench.bus.returned.len(), 1);
    }
}

#[test]
fn a_reset_starts_over_and_a_non_maskable_interrupt_tells_where_it_was() {
    for (reset, status) in [
        (CoreReset::Cold, BEV | ERL),
        (CoreReset::NonMaskable, BEV | ERL | 1 << 19 | 1),
    ] {
        let mut bench = prepared(&[NOP, BRANCH, NOP]);
        bench.set(STATUS, 1);
        bench.set(SHADOW_CONTROL, 0);
        // Up to between the branch and its slot.
        bench.run(2);
        assert_eq!(bench.cpu.pc(), FLASH + 8);
        bench.cpu.reset(reset);
        assert_eq!(bench.cpu.pc(), 0xBFC0_0000);
        assert_eq!(
            (bench.get(STATUS), bench.get(ERROR_EPC)),
            (status, FLASH + 4),
            "{reset:?}"
        );
        assert_eq!(bench.cpu.register(3), 0x7FFF_FFFF);
    }
}

#[test]
fn debug_mode_is_entered_and_left() {
    let mut bench = prepared(&[NOP, 0x7000_003F, NOP]);
    bench.memory.write(0x1FC0_0480, &DERET.to_le_bytes()).unwrap();
    bench.step();
    assert_eq!(bench.step(), Exit::Reached);
    assert_eq!(bench.cpu.pc(), 0xBFC0_0480);
    assert_eq!((bench.get((24, 0)), bench.get((23, 0))), (FLASH + 4, 0x4000_0002));
    bench.set((24, 0), FLASH + 8);
    bench.step();
    assert_eq!((bench.cpu.pc(), bench.get((23, 0))), (FLASH + 8, 0));
}
