//! Self-programming, and that flash is read-only otherwise.

use crate::program::{
    CLR, FOREVER, IFS1, MS, NOP, Program, SET, T0, T1, US, bare, branch, li, lui, run, store, sw, word,
};
use pic32::cpu::ExceptionCode;
use pic32::machine::Machine;
use pic32::peripheral::Misuse;

const NVMCON: u32 = 0xBF80_F400;
const NVMKEY: u32 = 0xBF80_F410;
const NVMADDR: u32 = 0xBF80_F420;
const NVMDATA: u32 = 0xBF80_F430;
const NVMSRCADDR: u32 = 0xBF80_F440;
const BUSY: u32 = 1 << 15;
const FAILED: u32 = 1 << 13;

fn begin(machine: &mut Machine, operation: u32, keys: &[u32]) {
    machine.write_register(NVMCON, 0x4000 | operation);
    let settled = machine.cycle() + 7 * US;
    run(machine, settled);
    for &key in keys {
        machine.write_register(NVMKEY, key);
    }
    machine.write_register(NVMCON + SET, BUSY);
}

const KEYS: [u32; 2] = [0xAA99_6655, 0x5566_99AA];

/// Does it and returns how long it took.
fn operate(machine: &mut Machine, operation: u32) -> u64 {
    begin(machine, operation, &KEYS);
    let begun = machine.cycle();
    while machine.read_register(NVMCON) & BUSY != 0 {
        let next = machine.cycle() + US;
        run(machine, next);
    }
    machine.write_register(NVMCON + CLR, 0x4000);
    machine.cycle() - begun
}

#[test]
fn word_row_and_page() {
    let mut machine = bare();
    machine.write_register(NVMADDR, 0x1D03_F004);
    machine.write_register(NVMDATA, 0x1234_5678);
    assert_eq!(operate(&mut machine, 1), 40 * US);
    assert_eq!(word(&machine, 0x1D03_F004), 0x1234_5678);
    machine.write_register(NVMDATA, 0xFFFF_0000);
    operate(&mut machine, 1);
    assert_eq!(
        word(&machine, 0x1D03_F004),
        0x1234_0000,
        "only an erasure sets bits"
    );
    assert_eq!(machine.read_register(IFS1) & 1 << 24, 1 << 24);

    let row: Vec<u8> = (0..512u32).map(|byte| byte as u8).collect();
    machine.memory_mut().write(0x400, &row).expect("RAM");
    machine.write_register(NVMADDR, 0x1D03_F200);
    machine.write_register(NVMSRCADDR, 0x400);
    assert_eq!(operate(&mut machine, 3), 4_500 * US);
    let mut found = vec![0; 512];
    machine.memory().read(0x1D03_F200, &mut found).expect("flash");
    assert_eq!(found, row);

    machine.write_register(NVMADDR, 0x1D03_F123);
    assert_eq!(operate(&mut machine, 4), 20 * MS);
    assert_eq!(word(&machine, 0x1D03_F004), u32::MAX);
    assert_eq!(word(&machine, 0x1D03_F200), u32::MAX);
    assert!(machine.misuses().is_empty());
}

#[test]
fn nothing_without_keys_nothing_outside_and_nothing_protected() {
    for keys in [&[][..], &KEYS[..1], &[KEYS[1], KEYS[0]], &[KEYS[0], 5, KEYS[1]]] {
        let mut machine = bare();
        machine.write_register(NVMADDR, 0x1D00_0000);
        machine.write_register(NVMDATA, 0);
        begin(&mut machine, 1, keys);
        run(&mut machine, 10 * MS);
        assert_eq!(word(&machine, 0x1D00_0000), u32::MAX, "{keys:x?}");
        assert_eq!(machine.misuses()[0].misuse, Misuse::FlashWithoutKeys);
    }
    let mut machine = bare();
    machine.write_register(NVMADDR, 0x1D04_0000);
    begin(&mut machine, 4, &KEYS);
    assert_eq!(machine.read_register(NVMCON) & (BUSY | FAILED), FAILED);
    // DEVCFG0.BWP = 0: boot flash is protected; PWP: two pages of program flash are.
    let program = Program::new(&FOREVER).at(0x1FC0_2FFC, &[0x7FFF_FFFF & !(1 << 24) & !(2 << 12)]);
    for (address, refused) in [(0x1FC0_1000, true), (0x1D00_1000, true), (0x1D00_2000, false)] {
        let mut machine = program.machine();
        machine.write_register(NVMADDR, address);
        begin(&mut machine, 4, &KEYS);
        assert_eq!(
            machine.read_register(NVMCON) & FAILED != 0,
            refused,
            "{address:#x}"
        );
    }
}

#[test]
fn haste_is_named() {
    let mut machine = bare();
    machine.write_register(NVMADDR, 0x1D00_0000);
    machine.write_register(NVMCON, 0x4001);
    for key in KEYS {
        machine.write_register(NVMKEY, key);
    }
    machine.write_register(NVMCON + SET, BUSY);
    assert_eq!(machine.misuses()[0].misuse, Misuse::FlashTooSoon);
}

#[test]
fn the_core_stands_still_while_its_flash_is_busy() {
    let mut code = store(NVMADDR, 0x1D03_F000);
    code.extend(store(NVMCON, 0x4004));
    code.extend([lui(T0, 0), 0x2508_0400, 0x1500_FFFF, 0x2508_FFFF]); // waits 7 us and more
    code.extend(store(NVMKEY, KEYS[0]));
    code.extend(store(NVMKEY, KEYS[1]));
    code.extend(store(NVMCON + SET, BUSY));
    code.extend([lui(T0, 0x8000), 0x2529_0001, sw(T1, 0, T0), branch(-3), NOP]);
    let mut machine = Program::new(&code).machine();
    while machine
        .peek_register(NVMCON)
        .is_some_and(|control| control & BUSY == 0)
    {
        let next = machine.cycle() + US;
        run(&mut machine, next);
    }
    let begun = machine.cycle();
    run(&mut machine, begun + 19 * MS);
    assert_eq!(word(&machine, 0), 0);
    run(&mut machine, begun + 21 * MS);
    assert_ne!(word(&machine, 0), 0);
}

#[test]
fn a_store_to_flash_is_a_bus_error() {
    let code = [li(T0, 0xBD00_0000).as_slice(), &[sw(T0, 0, T0)], &FOREVER].concat();
    let mut machine = Program::new(&code).machine();
    run(&mut machine, 1000);
    assert_eq!(machine.exceptions()[0].exception.code, ExceptionCode::BusData);
    assert_eq!(word(&machine, 0x1D00_0000), u32::MAX);
}

#[test]
fn clones_have_flash_of_their_own() {
    let mut machine = bare();
    let mut clone = machine.clone();
    clone.flip_flash_bit(0x9D00_0100, 3).expect("flash");
    clone.flip_ram_bit(0xA000_0010, 7).expect("RAM");
    assert_eq!(
        (word(&clone, 0x1D00_0100), word(&clone, 0x10)),
        (0xFFFF_FFF7, 0x80)
    );
    assert_eq!((word(&machine, 0x1D00_0100), word(&machine, 0x10)), (u32::MAX, 0));
    assert!(clone.flip_ram_bit(0x9D00_0000, 0).is_err() && clone.flip_flash_bit(0x8000_0000, 0).is_err());
    assert!(clone.flip_flash_bit(0x9D04_0000, 0).is_err());
    run(&mut machine, 1000);
}
