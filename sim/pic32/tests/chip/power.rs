//! Idle and Sleep: what stops, what wakes, how long that takes, and what RCON says after.

use crate::program::{
    DEVCFG1, IEC0, IEC1, IFS0, MS, SET, US, WDTCON, bare, interrupting, ipc, pin, run, timer, word,
};
use pic32::machine::Machine;
use pic32::pins::Level;

const OSCCON: u32 = 0xBF80_F000;
const SYSKEY: u32 = 0xBF80_F230;
const RCON: u32 = 0xBF80_F600;
const SLPEN: u32 = 1 << 4;
const SLEPT: u32 = 1 << 3;
const IDLED: u32 = 1 << 2;
/// 10 us, 1024 cycles of the crystal, 2 ms for the PLL.
const WAKE: u64 = (10 + 128 + 2_000) * US;

/// Sleeps, and counts interrupts of INT1 (RE8, rising) at its level in RAM 28.
fn sleeper(level: u32) -> Machine {
    interrupting(
        &[
            (0xBF88_1008, 2),
            (ipc(1), level << 26),
            (IEC0, 1 << 7),
            (SYSKEY, 0),
            (SYSKEY, 0xAA99_6655),
            (SYSKEY, 0x5566_99AA),
            (OSCCON + SET, SLPEN),
            (SYSKEY, 0x3333_3333),
        ],
        &[(7, IFS0, 7)],
    )
    .machine()
}

#[test]
fn a_pin_wakes_the_core_when_crystal_and_pll_run_again() {
    let mut machine = sleeper(2);
    machine.set_input(pin("RE8"), Level::Low);
    run(&mut machine, MS);
    assert_eq!(machine.read_register(RCON) & (SLEPT | IDLED), SLEPT);
    assert!(!machine.is_clock_dead(), "it is only asleep");
    machine.write_register(timer(2), 0x8000);
    let begin = machine.cycle();
    machine.schedule_input(begin + 100 * MS, pin("RE8"), Level::High);
    run(&mut machine, begin + 100 * MS + WAKE - US);
    assert_eq!(machine.read_register(timer(2) + 16), 0, "nothing counts");
    assert_eq!(word(&machine, 28), 0);
    run(&mut machine, begin + 100 * MS + WAKE + 2 * US);
    assert_eq!(word(&machine, 28), 1, "the handler has run");
    assert!(
        (1..=160).contains(&machine.read_register(timer(2) + 16)),
        "and time goes on"
    );
    run(&mut machine, begin + 150 * MS);
    assert!(
        machine.read_register(timer(2) + 16) < 200,
        "it went to sleep again"
    );
    assert_eq!(machine.misuses(), []);
}

#[test]
fn idle_lets_the_peripherals_run() {
    let mut machine = bare();
    machine.write_register(RCON, 0);
    machine.write_register(timer(2), 0x8000);
    run(&mut machine, 10_000);
    assert_eq!(machine.read_register(RCON), IDLED);
    assert!(machine.read_register(timer(2) + 16) > 9_000);
}

#[test]
fn a_source_without_a_level_never_wakes() {
    let mut machine = sleeper(0);
    machine.set_input(pin("RE8"), Level::Low);
    run(&mut machine, MS);
    machine.set_input(pin("RE8"), Level::High);
    run(&mut machine, 200 * MS);
    assert_eq!(machine.read_register(IFS0) & 1 << 7, 1 << 7);
    assert_eq!(word(&machine, 28), 0);
    machine.write_register(timer(2), 0x8000);
    run(&mut machine, 201 * MS);
    assert_eq!(machine.read_register(timer(2) + 16), 0, "still asleep");
}

#[test]
fn a_change_wakes_too_and_so_does_the_watchdog() {
    let mut machine = sleeper(0);
    machine.write_register(ipc(6), 1 << 18);
    machine.write_register(IEC1, 1);
    machine.write_register(0xBF88_61D0, 1 << 11);
    machine.write_register(0xBF88_61C0, 0x8000);
    run(&mut machine, MS);
    machine.write_register(timer(2), 0x8000);
    machine.set_input(pin("RG9"), Level::High);
    run(&mut machine, MS + WAKE + US);
    assert!(machine.read_register(timer(2) + 16) > 0, "change notice");

    let mut machine = sleeper(0);
    machine.write_register(WDTCON, 0x8000);
    run(&mut machine, 300 * MS);
    assert_eq!(machine.reset_count(), 0, "no reset but a non-maskable interrupt");
    assert_eq!(machine.reset_causes() & (1 << 4 | SLEPT), 1 << 4 | SLEPT);
    assert_eq!(DEVCFG1 >> 16 & 31, 7, "128 ms");
}
