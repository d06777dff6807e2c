//! Timers, captures and the core timer.

use crate::program::{IEC0, IFS0, MS, bare, ic, interrupting, ipc, pin, run, timer, word};
use pic32::machine::Machine;
use pic32::pins::Level;

const TMR: u32 = 0x10;
const PR: u32 = 0x20;

fn counts(machine: &mut Machine, number: u32) -> u32 {
    machine.read_register(timer(number) + TMR)
}

#[test]
fn timer_3_with_3999_gives_20000_interrupts_a_second() {
    let registers = [
        (timer(3) + PR, 3999),
        (ipc(3), 4 << 2),
        (IEC0, 1 << 12),
        (timer(3), 0x8000),
    ];
    let mut machine = interrupting(&registers, &[(12, IFS0, 12)]).machine();
    run(&mut machine, MS);
    let begin = word(&machine, 48);
    run(&mut machine, MS + 80_000_000);
    assert_eq!(word(&machine, 48) - begin, 20_000);
    let account = machine.accounting().vector(12).expect("a vector");
    assert!(account.worst_latency_cycles < 40, "{account:?}");
    assert!(machine.accounting().idle_share(machine.cycle()) > 0.95);
    assert!(machine.misuses().is_empty());
}

#[test]
fn prescalers_of_timer_1_and_of_the_others() {
    let mut machine = bare();
    let table = [
        (1, 0, 1),
        (1, 1, 8),
        (1, 2, 64),
        (1, 3, 256),
        (2, 1, 2),
        (3, 5, 32),
        (4, 6, 64),
        (5, 7, 256),
    ];
    for (number, code, divider) in table {
        machine.write_register(timer(number) + TMR, 0);
        machine.write_register(timer(number), 0x8000 | code << 4);
        let begin = machine.cycle();
        run(&mut machine, begin + 100_000);
        let counted = counts(&mut machine, number);
        assert_eq!(counted, 100_000 / divider % 65_536, "timer {number}, code {code}");
        machine.write_register(timer(number), 0);
        run(&mut machine, begin + 200_000);
        assert_eq!(counts(&mut machine, number), counted, "stands still");
    }
}

#[test]
fn the_flag_comes_when_the_period_ends_and_without_an_enable_too() {
    let mut machine = bare();
    machine.write_register(timer(2) + PR, 999);
    machine.write_register(timer(2), 0x8000);
    run(&mut machine, 999);
    assert_eq!((machine.read_register(IFS0), counts(&mut machine, 2)), (0, 999));
    run(&mut machine, 1000);
    assert_eq!(
        (machine.read_register(IFS0), counts(&mut machine, 2)),
        (1 << 8, 0)
    );
    machine.write_register(IFS0 + 4, 1 << 8);
    run(&mut machine, 1999);
    assert_eq!(machine.read_register(IFS0), 0);
    run(&mut machine, 2000);
    assert_eq!(machine.read_register(IFS0), 1 << 8);
}

#[test]
fn a_pair_counts_32_bits_and_the_upper_one_interrupts() {
    let mut machine = bare();
    machine.write_register(timer(4), 1 << 3);
    machine.write_register(timer(4) + PR, 199_999);
    machine.write_register(timer(4), 0x8000 | 1 << 3);
    run(&mut machine, 199_999);
    assert_eq!(counts(&mut machine, 4), 199_999);
    assert_eq!(counts(&mut machine, 5), 199_999 >> 16);
    assert_eq!(machine.read_register(IFS0), 0);
    run(&mut machine, 200_000);
    assert_eq!(machine.read_register(IFS0), 1 << 20, "timer 5");
}

#[test]
fn the_peripheral_clock_is_divided() {
    // OSCCON.PBDIV says by 4.
    let program = crate::program::Program::new(&crate::program::WAIT_FOREVER);
    let mut machine = program.devcfg1(crate::program::DEVCFG1 | 2 << 12).machine();
    machine.write_register(timer(1), 0x8000);
    run(&mut machine, 4_000);
    assert_eq!(counts(&mut machine, 1), 1000);
}

#[test]
fn a_gate_and_an_external_clock() {
    let mut machine = bare();
    let gate = pin("RC14");
    machine.write_register(timer(1), 0x8000 | 1 << 7);
    machine.schedule_input(1_000, gate, Level::High);
    machine.schedule_input(3_500, gate, Level::Low);
    run(&mut machine, 10_000);
    assert_eq!(
        (counts(&mut machine, 1), machine.read_register(IFS0)),
        (2_500, 1 << 4)
    );
    let clock = pin("RC1");
    machine.write_register(timer(2) + PR, 9);
    machine.write_register(timer(2), 0x8002);
    for edge in 0..24 {
        machine.schedule_input(11_000 + 100 * edge, clock, Level::of(edge % 2 == 0));
    }
    run(&mut machine, 20_000);
    assert_eq!(
        (counts(&mut machine, 2), machine.read_register(IFS0) & 1 << 8),
        (2, 1 << 8)
    );
}

#[test]
fn captures_are_exact_to_the_count() {
    let mut machine = bare();
    machine.write_register(timer(3) + PR, 0xFFFF);
    machine.write_register(timer(3), 0x8000);
    machine.write_register(timer(2), 0x8000 | 6 << 4);
    machine.write_register(ic(1), 0x8001);
    machine.write_register(ic(2), 0x8003 | 1 << 7);
    for (cycle, level) in [(1_234, Level::High), (5_000, Level::Low), (70_000, Level::High)] {
        machine.schedule_input(cycle, pin("RD8"), level);
        machine.schedule_input(cycle, pin("RD9"), level);
    }
    run(&mut machine, 1_233);
    assert_eq!(machine.read_register(IFS0), 0);
    run(&mut machine, 1_234);
    assert_eq!(machine.read_register(IFS0), 1 << 5 | 1 << 9);
    run(&mut machine, 80_000);
    let taken: Vec<u32> = (0..3).map(|_| machine.read_register(ic(1) + 0x10)).collect();
    assert_eq!(taken, [1_234, 5_000, 70_000 - 65_536]);
    assert_eq!(machine.read_register(ic(1)) & 8, 0, "empty");
    let taken: Vec<u32> = (0..2).map(|_| machine.read_register(ic(2) + 0x10)).collect();
    assert_eq!(taken, [1_234 / 64, 70_000 / 64], "rising edges by timer 2");
}

#[test]
fn the_core_timer_interrupts_a_thousand_times_a_second() {
    use crate::program::{ERET, NOP, addiu, lui, lw, mfc0, mtc0, ori, sw};
    let registers = [(ipc(0), 2 << 2), (IEC0, 1)];
    // Compare += 40000, clear the flag, count.
    let handler = [
        mfc0(26, 11),
        ori(27, 0, 40_000),
        0x035B_D021, // addu k0, k0, k1
        mtc0(26, 11, 0),
        lui(26, 0xBF88),
        ori(27, 0, 1),
        sw(27, 0x1034, 26),
        lw(27, 0x1030, 26),
        lui(26, 0x8000),
        lw(27, 0, 26),
        NOP,
        addiu(27, 27, 1),
        sw(27, 0, 26),
        ERET,
    ];
    let program = interrupting(&registers, &[(0, IFS0, 0)]).at(0x1D00_1000, &handler);
    let mut machine = program.machine();
    // The first one is made by hand: where Compare stands after a reset is not known.
    machine.write_register(IFS0 + 8, 1);
    run(&mut machine, 10 * MS);
    let begin = word(&machine, 0);
    run(&mut machine, 1010 * MS);
    assert_eq!(word(&machine, 0) - begin, 1000);
}
