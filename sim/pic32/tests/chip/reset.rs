//! Resets and their causes, the lock, the watchdog.

use crate::program::{
    DEVCFG1, FOREVER, IEC0, MS, NOP, Program, SET, T0, T1, T2, WAIT_FOREVER, WDTCON, bare, branch, li, lui,
    lw, mfc0, mtc0, ori, pin, run, store, sw, timer, word,
};
use pic32::machine::{Machine, ResetSource};
use pic32::peripheral::Misuse;
use pic32::pins::PinDriver;

const SYSKEY: u32 = 0xBF80_F230;
const RCON: u32 = 0xBF80_F600;
const RSWRST: u32 = 0xBF80_F610;

/// Counts its starts at RAM 0, notes RCON at RAM 4, and then does this.
fn counting(then: &[u32]) -> Program {
    let head = [
        lui(T0, 0x8000),
        lw(T1, 0, T0),
        NOP,
        0x2529_0001,
        sw(T1, 0, T0),
        lui(T1, 0xBF81),
        lw(T2, -0xA00, T1),
        sw(T2, 4, T0),
    ];
    Program::new(&[head.as_slice(), then].concat())
}

fn starts(machine: &Machine) -> u32 {
    word(machine, 0)
}

#[test]
fn after_power_on() {
    let mut machine = counting(&FOREVER).machine();
    run(&mut machine, MS);
    assert_eq!((starts(&machine), word(&machine, 4)), (1, 3));
    let defaults = [
        (0xBF88_4000, 7),
        (0xBF88_2000, 0x001F_0041),
        (0xBF80_F200, 8),
        (timer(1) + 0x20, 0xFFFF),
        (0xBF80_6010, 0x110),
    ];
    for (address, value) in defaults {
        assert_eq!(machine.read_register(address), value, "{address:#x}");
    }
    assert_eq!(
        machine.read_register(0xBF80_F220) & 0x0FFF_FFFF,
        0x093_4053,
        "DEVID"
    );
    for (address, value) in [
        (0xBF88_2040, 0x8000),
        (0xBF88_2060, 0x4_0000),
        (0xBF88_2070, 0x3000),
    ] {
        assert_eq!(machine.read_register(address), value, "{address:#x}");
    }
}

#[test]
fn the_watchdog_resets_after_its_period_and_says_so() {
    // WDTPS = 7: 128 ms.
    let mut machine = counting(&[store(WDTCON + SET, 0x8000).as_slice(), &FOREVER].concat()).machine();
    run(&mut machine, 128 * MS - 1);
    assert_eq!((starts(&machine), machine.resets().len()), (1, 0));
    run(&mut machine, 128 * MS + 2_000);
    assert_eq!((starts(&machine), word(&machine, 4)), (2, 3 | 1 << 4));
    assert_eq!(machine.take_resets(), [ResetSource::Watchdog]);
    assert_eq!(machine.take_resets(), []);
    let at = machine.resets()[0].cycle;
    assert!((128 * MS..128 * MS + 1_000).contains(&at), "{at}");
}

#[test]
fn a_watchdog_that_is_fed_stays_quiet_and_one_by_fuse_cannot_be_stopped() {
    let feed = [
        store(WDTCON + SET, 0x8000).as_slice(),
        &li(T0, WDTCON),
        &[ori(T1, 0, 1)],
        &[sw(T1, 8, T0), branch(-2), NOP],
    ]
    .concat();
    let mut machine = counting(&feed).machine();
    run(&mut machine, 1000 * MS);
    assert_eq!(starts(&machine), 1);
    let stop = [store(WDTCON + 4, 0x8000).as_slice(), &FOREVER].concat();
    let mut machine = counting(&stop).devcfg1(DEVCFG1 | 1 << 23).machine();
    run(&mut machine, 300 * MS);
    assert_eq!(starts(&machine), 3);
    assert_eq!(machine.read_register(WDTCON), 0x8000 | 7 << 2);
}

#[test]
fn a_watchdog_in_idle_is_a_non_maskable_interrupt_and_pins_stay_as_they_are() {
    let mut code = store(0xBF88_6104, 1);
    code.extend(store(0xBF88_6128, 1));
    code.extend(store(WDTCON + SET, 0x8000));
    code.extend([mfc0(T2, 12), lui(T0, 0x8000), sw(T2, 8, T0)]);
    code.extend(WAIT_FOREVER);
    let mut machine = counting(&code).machine();
    run(&mut machine, 130 * MS);
    assert_eq!(starts(&machine), 2);
    assert!(machine.resets().is_empty(), "no reset");
    assert_eq!(
        machine.output(pin("RE0")),
        PinDriver::High,
        "outputs were not reset"
    );
    assert_eq!(word(&machine, 8) >> 19 & 1, 1, "Status.NMI");
    assert_eq!(word(&machine, 4) & 0x14, 0x14, "RCON.WDTO and RCON.IDLE");
}

#[test]
fn software_reset_needs_the_right_keys_in_the_right_order() {
    let table: [(&[u32], bool); 6] = [
        (&[0, 0xAA99_6655, 0x5566_99AA], true),
        (&[0xAA99_6655, 0x5566_99AA], true),
        (&[0x5566_99AA, 0xAA99_6655], false),
        (&[0xAA99_6655, 0, 0x5566_99AA], false),
        (&[0xAA99_6655, 0x5566_99AA, 0x3333_3333], false),
        (&[], false),
    ];
    for (keys, opens) in table {
        let mut machine = bare();
        run(&mut machine, 100);
        for &key in keys {
            machine.write_register(SYSKEY, key);
        }
        machine.write_register(RSWRST, 1);
        run(&mut machine, 200);
        assert!(machine.resets().is_empty(), "writing alone does not reset");
        machine.read_register(RSWRST);
        run(&mut machine, 300);
        assert_eq!(machine.take_resets().len(), usize::from(opens), "{keys:x?}");
        assert_eq!(machine.reset_causes() & 1 << 6 != 0, opens);
        let locked = machine
            .misuses()
            .iter()
            .any(|record| record.misuse == Misuse::Locked);
        assert_eq!(locked, !opens);
    }
}

#[test]
fn a_program_resets_itself() {
    let code = [
        store(SYSKEY, 0),
        store(SYSKEY, 0xAA99_6655),
        store(SYSKEY, 0x5566_99AA),
        store(RSWRST + SET, 1),
        li(T0, RSWRST).to_vec(),
        vec![lw(T1, 0, T0)],
        FOREVER.to_vec(),
    ]
    .concat();
    let mut machine = counting(&code).machine();
    run(&mut machine, MS);
    assert!(starts(&machine) > 10);
    assert_eq!(word(&machine, 4), 3 | 1 << 6);
    assert!(machine.reset_count() > 10);
}

#[test]
fn causes_add_up_until_they_are_cleared() {
    let mut machine = counting(&FOREVER).machine();
    run(&mut machine, MS);
    machine.reset(ResetSource::MasterClear);
    assert_eq!(machine.read_register(RCON), 3 | 1 << 7);
    machine.brown_out();
    assert_eq!(machine.read_register(RCON), 3 | 1 << 7);
    machine.write_register(RCON, 0);
    machine.brown_out();
    assert_eq!(machine.read_register(RCON), 1 << 1);
    machine.reset(ResetSource::PowerOn);
    assert_eq!(machine.read_register(RCON), 3);
    assert_eq!(machine.take_resets().len(), 4);
}

#[test]
fn a_reset_lets_go_of_all_pins_and_keeps_ram() {
    let mut machine = bare();
    let (rd0, re0) = (pin("RD0"), pin("RE0"));
    machine.watch(rd0);
    machine.watch(re0);
    machine.write_register(0xBF88_6104, 1);
    machine.write_register(0xBF88_6120, 1);
    for (address, value) in [
        (0xBF80_3020, 4000),
        (0xBF80_3000, 0x800E),
        (timer(3) + 0x20, 3999),
        (timer(3), 0x8000),
    ] {
        machine.write_register(address, value);
    }
    machine.write_register(IEC0, 1);
    machine.memory_mut().write(100, &[1, 2, 3]).expect("RAM");
    run(&mut machine, 10_000);
    assert!(machine.output(rd0).is_high() && machine.output(re0).is_high());
    machine.reset(ResetSource::MasterClear);
    assert_eq!(
        (machine.output(rd0), machine.output(re0)),
        (PinDriver::Floating, PinDriver::Floating)
    );
    let high = (machine.high_cycles(rd0), machine.high_cycles(re0));
    assert_eq!(high, (6_000, 10_000));
    run(&mut machine, 20_000);
    assert_eq!(high, (machine.high_cycles(rd0), machine.high_cycles(re0)));
    assert_eq!(
        machine
            .take_edges(rd0)
            .last()
            .map(|edge| (edge.0, edge.1.is_high())),
        Some((10_000, false))
    );
    assert_eq!(machine.read_register(IEC0), 0);
    assert_eq!(word(&machine, 100) & 0xFF_FFFF, 0x03_0201);
}

#[test]
fn status_of_the_first_start_has_no_interrupt_flag() {
    let mut machine = counting(&[
        mfc0(T2, 12),
        lui(T0, 0x8000),
        sw(T2, 8, T0),
        mtc0(0, 13, 0),
        branch(-1),
        NOP,
    ])
    .machine();
    run(&mut machine, MS);
    assert_eq!(word(&machine, 8) >> 19 & 1, 0);
}
