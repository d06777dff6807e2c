//! The interrupt controller with the core: levels, nesting, latency, accounting.

use crate::program::{
    EI, ERET, IEC0, IEC1, IFS0, IFS1, MS, NOP, Program, WAIT, branch, interrupting, ipc, lui, lw, mtc0, ori,
    pin, run, sw, timer, word,
};
use pic32::pins::Level;

/// Status: IPL = 2, EXL = 0, IE = 1; then 1000 turns of two instructions; then EXL again and IPL = 0, EPC was kept in T3. K0 and
/// K1 belong to the other handler in between.
fn slow_handler() -> Vec<u32> {
    vec![
        0x401B_7000, // mfc0 k1, EPC
        0x0360_5825, // or t3, k1, zero
        lui(26, 0),
        ori(26, 26, 2 << 10 | 1),
        mtc0(26, 12, 0),
        ori(8, 0, 1000),
        0x1500_FFFF, // bne t0, zero, itself
        0x2508_FFFF, // addiu t0, t0, -1
        ori(9, 0, 3),
        mtc0(9, 12, 0),
        mtc0(11, 14, 0),
        lui(26, 0xBF88),
        ori(27, 0, 1 << 4),
        sw(27, 0x1034, 26),
        lw(27, 0x1030, 26),
        ERET,
    ]
}

/// Reads PORTC, clears the flag, counts.
fn quick_handler() -> Vec<u32> {
    vec![
        lui(26, 0xBF88),
        lw(27, 0x6090, 26),
        ori(27, 0, 1),
        sw(27, 0x1044, 26),
        lw(27, 0x1040, 26),
        lui(26, 0x8000),
        lw(27, 104, 26),
        NOP,
        0x277B_0001,
        sw(27, 104, 26),
        ERET,
    ]
}

#[test]
fn a_higher_level_interrupts_a_lower_one_and_time_is_charged_to_each() {
    // Timer 1 at level 2 stays long and allows nesting; change notice at level 6 comes in between.
    let registers = [
        (0xBF88_4000, 0x32),
        (timer(1) + 0x20, 7_999),
        (ipc(1), 2 << 2),
        (ipc(6), 6 << 18),
        (IEC0, 1 << 4),
        (IEC1, 1),
        (0xBF88_61C0, 0x8000),
        (0xBF88_61D0, 1 << 1),
        (timer(1), 0x8000),
    ];
    let program = interrupting(&registers, &[(4, IFS0, 4), (26, IFS1, 0)])
        .at(0x1D00_1000 + 4 * 64, &slow_handler())
        .at(0x1D00_1000 + 26 * 64, &quick_handler());
    let mut machine = program.machine();
    run(&mut machine, MS);
    let before = word(&machine, 104);
    machine.restart_accounting();
    // 500 cycles into the handler of timer 1, which is entered every 8000 cycles.
    let begin = machine.cycle();
    for edge in 0..100 {
        machine.schedule_input(
            begin + 8_000 * edge + 3_500 + 13 * edge % 97,
            pin("RC13"),
            Level::of(edge % 2 == 0),
        );
    }
    run(&mut machine, begin + 800_000);
    assert_eq!(word(&machine, 104) - before, 100);
    let account = |vector| machine.accounting().vector(vector).expect("a vector");
    let (slow, quick) = (account(4), account(26));
    assert_eq!((slow.entries, quick.entries), (100, 100));
    assert!((2_000..3_000).contains(&slow.longest_cycles), "{slow:?}");
    assert!(
        quick.longest_cycles < 60 && quick.worst_latency_cycles < 20,
        "{quick:?}"
    );
    let accounting = machine.accounting();
    assert_eq!(accounting.level_cycles(2), slow.cycles);
    assert_eq!(accounting.level_cycles(6), quick.cycles);
    let sum: u64 = (0..8).map(|level| accounting.level_cycles(level)).sum();
    assert_eq!(sum, accounting.total_cycles(machine.cycle()));
    assert!(accounting.idle_cycles() <= accounting.level_cycles(0));
}

#[test]
fn without_many_vectors_all_go_to_the_first() {
    let registers = [
        (0xBF88_1000, 0),
        (timer(2) + 0x20, 999),
        (ipc(2), 3 << 2),
        (IEC0, 1 << 8),
        (timer(2), 0x8000),
    ];
    let program = interrupting(&registers, &[(0, IFS0, 8)]);
    let mut machine = program.machine();
    run(&mut machine, MS);
    let counted = word(&machine, 0);
    assert!((75..=80).contains(&counted), "{counted}");
    assert_eq!(
        machine.accounting().vector(8).map(|account| account.entries),
        Some(u64::from(counted))
    );
}

#[test]
fn wait_ends_with_interrupts_off_and_the_handler_runs_after_they_are_on() {
    // The main program waits with IE = 0, notes that it goes on, then allows interrupts.
    let mut code = Vec::new();
    for (value, register, select) in [
        (0x0040_0000, 12, 0),
        (0x9D00_0000, 15, 1),
        (0x20, 12, 1),
        (0x0080_0000, 13, 0),
    ] {
        code.extend(crate::program::li(8, value));
        code.extend([mtc0(8, register, select), crate::program::EHB]);
    }
    code.push(mtc0(0, 12, 0));
    for (address, value) in [
        (0xBF88_1008, 0x1000),
        (ipc(1), 3 << 2),
        (IEC0, 1 << 4),
        (timer(1) + 0x20, 9_999),
        (timer(1), 0x8000),
    ] {
        code.extend(crate::program::store(address, value));
    }
    code.extend([
        WAIT,
        lui(8, 0x8000),
        lw(9, 0, 8),
        NOP,
        0x2529_0001,
        sw(9, 0, 8),
        EI,
        branch(-1),
        NOP,
    ]);
    let handler = [
        lui(26, 0xBF80),
        sw(0, 0x0600, 26),
        lui(26, 0x8000),
        lw(27, 0, 26),
        NOP,
        sw(27, 4, 26),
        lui(26, 0xBF88),
        ori(27, 0, 16),
        sw(27, 0x1034, 26),
        lw(27, 0x1030, 26),
        ERET,
    ];
    let mut machine = Program::new(&code)
        .at(0x1D00_0280, &[0x0B40_0400, NOP])
        .at(0x1D00_1000, &handler)
        .machine();
    run(&mut machine, MS);
    assert_eq!(word(&machine, 0), 1, "the main program went on once");
    assert_eq!(word(&machine, 4), 1, "before the handler saw it");
    assert!(machine.accounting().idle_cycles() > 8_000);
    assert_eq!(machine.reset_causes() & 1 << 2, 1 << 2, "RCON.IDLE");
}
