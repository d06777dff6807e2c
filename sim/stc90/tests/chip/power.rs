//! Idle and power-down.

use crate::rig::{STAY, after, edge, machine, ram};
use stc90::pins::Level;

const PCON: u8 = 0x87;
const TCON: u8 = 0x88;
const TMOD: u8 = 0x89;
const TL0: u8 = 0x8A;
const IE: u8 = 0xA8;

/// Sleep, then count; an interrupt wakes the core, and the program goes on behind the sleep.
#[test]
fn an_interrupt_ends_idle() {
    let handler = [0x05, 0x30, 0x32];
    // ORL PCON, #1; INC 0x31; SJMP back
    let main = after(
        &[(TMOD, 2), (TCON, 0x10), (IE, 0x82)],
        &[0x43, PCON, 1, 0x05, 0x31, 0x80, 0xF9],
    );
    let mut machine = machine(&[(0, &[0x80, 0x3E]), (0x0B, &handler), (0x40, &main)]);
    machine.run_until(256 * 20 + 100);
    assert_eq!([ram(&machine, 0x30), ram(&machine, 0x31)], [20, 20]);
    assert_eq!(machine.register(PCON), 0x10 | 1);
    let idle = machine.account().idle_cycles();
    assert!((240 * 20..256 * 20 + 100).contains(&idle), "{idle}");
}

/// Without a clock nothing counts; a low pin of an enabled interrupt starts it again.
#[test]
fn a_pin_ends_power_down() {
    let handler = [0x75, IE, 0, 0x32];
    let main = after(
        &[(TMOD, 1), (IE, 0x81), (TCON, 0x10), (PCON, 2)],
        &[0x05, 0x31, 0x80, 0xFE],
    );
    let mut machine = machine(&[(0, &[0x80, 0x3E]), (3, &handler), (0x40, &main)]);
    machine.schedule_input(edge(100_000, "P3.2", Level::Low));
    machine.run_until(99_999);
    assert_eq!(machine.register(TL0), 2);
    assert_eq!(ram(&machine, 0x31), 0);
    machine.run_until(100_100);
    assert_eq!(ram(&machine, 0x31), 1);
    let counted = machine.register(TL0);
    assert!((95..110).contains(&counted), "{counted}");
}

#[test]
fn a_sleep_without_end_costs_no_time() {
    let main = after(&[(PCON, 1)], &STAY);
    let mut machine = machine(&[(0, &main)]);
    machine.run_until(u64::MAX / 2);
    assert_eq!(machine.cycle(), u64::MAX / 2);
}
