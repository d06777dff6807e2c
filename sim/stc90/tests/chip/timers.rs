//! Timers 0, 1 and 2 with their pins.

use crate::rig::{STAY, after, edge, machine, pin};
use stc90::machine::Machine;
use stc90::pins::Level;

const TCON: u8 = 0x88;
const TMOD: u8 = 0x89;
const TL0: u8 = 0x8A;
const TL1: u8 = 0x8B;
const TH0: u8 = 0x8C;
const TH1: u8 = 0x8D;
const T2CON: u8 = 0xC8;
const RCAP2L: u8 = 0xCA;
const RCAP2H: u8 = 0xCB;
const TL2: u8 = 0xCC;
const TH2: u8 = 0xCD;

fn word(machine: &Machine, low: u8, high: u8) -> u16 {
    u16::from_le_bytes([machine.register(low), machine.register(high)])
}

fn pulse(machine: &mut Machine, name: &str, from: u64) {
    machine.schedule_input(edge(from, name, Level::Low));
    machine.schedule_input(edge(from + 3, name, Level::High));
}

/// The reload value of the reference for a millisecond in 6T mode at 30 MHz: 5,000 counts.
#[test]
fn a_millisecond_is_5000_counts() {
    let program = after(&[(TMOD, 1), (TL0, 0x78), (TH0, 0xEC), (TCON, 0x10)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    // Started at the end of the first cycle of the fourth move.
    let started = 7;
    machine.run_until(started + 4998);
    assert_eq!(machine.register(TCON) & 0x20, 0);
    machine.run_until(started + 5000);
    assert_eq!(machine.register(TCON) & 0x20, 0x20);
}

#[test]
fn falling_edges_are_counted() {
    // T0 and T1 count their pins, 8 bits with reload; timer 2 counts its own.
    let program = after(
        &[
            (TMOD, 0x66),
            (TL0, 0xFE),
            (TH0, 0xF0),
            (TCON, 0x50),
            (T2CON, 0x06),
        ],
        &STAY,
    );
    let mut machine = machine(&[(0, &program)]);
    for number in 0..3 {
        pulse(&mut machine, "P3.4", 100 + 10 * number);
    }
    pulse(&mut machine, "P3.5", 105);
    pulse(&mut machine, "P1.0", 105);
    machine.run_until(107);
    assert_eq!(machine.register(TL0), 0xFF);
    machine.run_until(200);
    assert_eq!([machine.register(TL0), machine.register(TL1)], [0xF1, 1]);
    assert_eq!(machine.register(TCON), 0x50 | 0x20);
    assert_eq!(word(&machine, TL2, TH2), 1);
}

/// A gate lets the timer count while the pin is high: that measures a pulse.
#[test]
fn a_gate_measures_a_pulse() {
    let program = after(&[(TMOD, 0x99), (TCON, 0x50)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    machine.set_input(pin("P3.2"), Level::Low);
    machine.set_input(pin("P3.3"), Level::Low);
    machine.schedule_input(edge(1000, "P3.2", Level::High));
    machine.schedule_input(edge(1777, "P3.2", Level::Low));
    machine.run_until(3000);
    assert_eq!(word(&machine, TL0, TH0), 777);
    assert_eq!(word(&machine, TL1, TH1), 0);
}

/// In mode 3 timer 0 is two counters; the upper one has the start bit and the flag of timer 1, which runs on.
#[test]
fn timer_0_can_be_two() {
    let program = after(&[(TMOD, 0x13), (TCON, 0x50)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    let timer_1_began = machine.register(TL1);
    machine.run_until(301);
    let flags = machine.register(TCON);
    assert_eq!(flags & 0xA0, 0xA0);
    let counted = 302 - 3;
    assert_eq!(u64::from(machine.register(TL0)), counted % 256);
    assert_eq!(machine.register(TH0), machine.register(TL0));
    assert_eq!(timer_1_began, 0);
    // Since TMOD was written, two cycles before TCON.
    assert_eq!(u64::from(word(&machine, TL1, TH1)), counted + 2);
}

#[test]
fn timer_2_captures_at_its_trigger() {
    let program = after(&[(T2CON, 0x0D)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    pulse(&mut machine, "P1.1", 0x1235);
    machine.run_until(0x2000);
    assert_eq!(word(&machine, RCAP2L, RCAP2H), 0x1234);
    assert_eq!(machine.register(T2CON), 0x0D | 0x40);
}

/// A timer that nobody looks at costs nothing and is still right.
#[test]
fn long_times_are_counted_exactly() {
    let program = after(&[(TMOD, 0x21), (TH1, 0xFD), (TL1, 0xFD), (TCON, 0x50)], &STAY);
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(50_000_000);
    let counted = machine.cycle() - 7;
    assert_eq!(u64::from(word(&machine, TL0, TH0)), counted % 0x1_0000);
    assert_eq!(u64::from(machine.register(TL1)), 0xFD + counted % 3);
}
