//! I2C: the master's steps and times, the slave's answers, stretching, collisions, two chips on one bus.

use crate::joined::{JoinedChips, open};
use crate::program::{CLR, IFS0, IFS1, SET, bare, pin, run};
use pic32::machine::Machine;
use pic32::peripheral::Misuse;
use pic32::pins::Level;

const CON: u32 = 0xBF80_5000;
const STAT: u32 = 0xBF80_5010;
const ADD: u32 = 0xBF80_5020;
const MSK: u32 = 0xBF80_5030;
const BRG: u32 = 0xBF80_5040;
const TRN: u32 = 0xBF80_5050;
const RCV: u32 = 0xBF80_5060;

const ON: u32 = 1 << 15;
const SCLREL: u32 = 1 << 12;
const STRICT: u32 = 1 << 11;
const A10M: u32 = 1 << 10;
const GCEN: u32 = 1 << 7;
const STREN: u32 = 1 << 6;
const ACKDT: u32 = 1 << 5;
const ACKEN: u32 = 1 << 4;
const RCEN: u32 = 1 << 3;
const PEN: u32 = 1 << 2;
const RSEN: u32 = 1 << 1;
const SEN: u32 = 1;

const ACKSTAT: u32 = 1 << 15;
const TRSTAT: u32 = 1 << 14;
const BCL: u32 = 1 << 10;
const GCSTAT: u32 = 1 << 9;
const ADD10: u32 = 1 << 8;
const IWCOL: u32 = 1 << 7;
const I2COV: u32 = 1 << 6;
const D_A: u32 = 1 << 5;
const P: u32 = 1 << 4;
const S: u32 = 1 << 3;
const R_W: u32 = 1 << 2;
const RBF: u32 = 1 << 1;
const TBF: u32 = 1;

const COLLISION: u32 = 1 << 29;
const SLAVE: u32 = 1 << 30;
const MASTER: u32 = 1 << 31;

/// 100 kHz.
fn opened(control: u32) -> Machine {
    let mut machine = bare();
    machine.write_register(BRG, 390);
    machine.write_register(CON, SCLREL | control);
    machine.write_register(CON + SET, ON);
    machine
}

/// A master alone with two resistors.
fn alone() -> Machine {
    let mut machine = bare();
    machine.pull_up(pin("RG2"));
    machine.pull_up(pin("RG3"));
    machine.write_register(BRG, 390);
    machine.write_register(CON, SCLREL | ON);
    machine
}

/// A master and a slave of this address.
fn pair(address: u32, control: u32) -> JoinedChips {
    let mut slave = opened(control);
    slave.write_register(ADD, address);
    let wires = vec![open("RG2", "RG2"), open("RG3", "RG3")];
    let mut joined = JoinedChips::new(opened(0), slave, wires);
    joined.run(1_000);
    joined.second.write_register(IFS0, 0);
    joined
}

/// Both run until this holds of the master.
fn until(joined: &mut JoinedChips, mut done: impl FnMut(&mut Machine) -> bool) {
    const PATIENCE_CYCLES: u64 = 20_000;
    let end = joined.first.cycle() + PATIENCE_CYCLES;
    while !done(&mut joined.first) {
        assert!(joined.first.cycle() < end, "nothing came of it");
        joined.run(5);
    }
}

/// One step of the master, to its end.
fn step(joined: &mut JoinedChips, bit: u32) {
    joined.first.write_register(CON + SET, bit);
    until(joined, |master| master.read_register(CON) & 0x1F == 0);
}

/// A byte goes out; whether it was acknowledged.
fn send(joined: &mut JoinedChips, byte: u32) -> bool {
    joined.first.write_register(TRN, byte);
    until(joined, |master| master.read_register(STAT) & TRSTAT == 0);
    joined.first.read_register(STAT) & ACKSTAT == 0
}

/// A byte comes in, and is acknowledged or not.
fn receive(joined: &mut JoinedChips, more: bool) -> u32 {
    step(joined, RCEN);
    let byte = joined.first.read_register(RCV);
    joined
        .first
        .write_register(CON + if more { CLR } else { SET }, ACKDT);
    step(joined, ACKEN);
    byte
}

/// What the slave was told since: its byte, D_A and R_W.
fn told(slave: &mut Machine) -> Option<(u32, bool, bool)> {
    if slave.read_register(IFS0) & SLAVE == 0 {
        return None;
    }
    slave.write_register(IFS0 + CLR, SLAVE);
    let status = slave.read_register(STAT);
    Some((slave.read_register(RCV), status & D_A != 0, status & R_W != 0))
}

#[test]
fn the_clock_has_the_period_of_the_divider() {
    for (divider, period) in [(390, 800), (90, 200), (30, 80)] {
        let mut machine = alone();
        machine.write_register(BRG, divider);
        machine.write_register(CON + SET, SEN);
        run(&mut machine, 5_000);
        assert_eq!(machine.read_register(CON) & SEN, 0);
        assert_eq!(machine.read_register(STAT) & (S | P | BCL), S);
        machine.watch(pin("RG2"));
        machine.write_register(TRN, 0x55 << 1);
        run(&mut machine, 20_000);
        let edges = machine.take_edges(pin("RG2"));
        assert_eq!(edges.len(), 18, "nine pulses");
        for pulse in edges.chunks(2).collect::<Vec<_>>().windows(2) {
            assert_eq!(pulse[1][0].0 - pulse[0][0].0, period, "BRG {divider}");
        }
        assert_eq!(
            machine.read_register(STAT) & (ACKSTAT | TBF | TRSTAT),
            ACKSTAT,
            "nobody is there"
        );
        assert_eq!(machine.read_register(IFS0) & (MASTER | COLLISION), MASTER);
        assert_eq!(machine.misuses(), []);
    }
}

#[test]
fn a_start_and_a_stop_are_data_that_changes_while_the_clock_is_high() {
    let mut machine = alone();
    let (data, clock) = (pin("RG3"), pin("RG2"));
    machine.watch(data);
    machine.watch(clock);
    machine.write_register(CON + SET, SEN);
    run(&mut machine, 2_000);
    assert_eq!(machine.take_edges(data), [(400, Level::Low)]);
    assert_eq!(machine.take_edges(clock), [(800, Level::Low)]);
    machine.write_register(CON + SET, PEN);
    run(&mut machine, 5_000);
    assert_eq!(machine.take_edges(clock), [(2_400, Level::High)]);
    assert_eq!(machine.take_edges(data), [(2_800, Level::High)]);
    assert_eq!(machine.read_register(STAT) & (S | P), P);
    assert_eq!(machine.read_register(CON) & PEN, 0);
}

#[test]
fn bytes_reach_the_slave_one_by_one() {
    let mut joined = pair(0x42, 0);
    step(&mut joined, SEN);
    assert!(send(&mut joined, 0x42 << 1));
    assert_eq!(told(&mut joined.second), Some((0x84, false, false)));
    for byte in [0x00, 0xFF, 0xA5] {
        assert!(send(&mut joined, byte));
        assert_eq!(told(&mut joined.second), Some((byte, true, false)));
        assert_eq!(joined.second.read_register(STAT) & RBF, 0);
    }
    step(&mut joined, PEN);
    joined.run(100);
    assert_eq!(joined.second.read_register(STAT) & (S | P), P);
    assert_eq!(told(&mut joined.second), None, "a stop is no interrupt");
    assert_eq!(
        (joined.first.misuses(), joined.second.misuses()),
        (&[][..], &[][..])
    );
}

#[test]
fn the_slave_holds_the_clock_until_it_has_a_byte() {
    let mut joined = pair(0x42, 0);
    step(&mut joined, SEN);
    assert!(send(&mut joined, 0x42 << 1 | 1));
    assert_eq!(told(&mut joined.second), Some((0x85, false, true)));
    joined.first.write_register(CON + SET, RCEN);
    joined.run(50_000);
    assert_eq!(joined.first.read_register(CON) & RCEN, RCEN, "without limit");
    assert_eq!(joined.second.read_register(CON) & SCLREL, 0);
    joined.second.write_register(TRN, 0xC5);
    assert_eq!(joined.second.read_register(STAT) & TBF, TBF);
    joined.second.write_register(CON + SET, SCLREL);
    until(&mut joined, |master| master.read_register(CON) & RCEN == 0);
    assert_eq!(joined.first.read_register(RCV), 0xC5);
    step(&mut joined, ACKEN);
    assert_eq!(
        told(&mut joined.second),
        Some((0x85, true, true)),
        "acknowledged: the next byte"
    );
    joined.second.write_register(TRN, 0x3A);
    joined.second.write_register(CON + SET, SCLREL);
    assert_eq!(receive(&mut joined, false), 0x3A);
    joined.run(100);
    assert_eq!(joined.second.read_register(STAT) & ACKSTAT, ACKSTAT);
    assert_eq!(told(&mut joined.second), None, "not acknowledged: the end");
    step(&mut joined, PEN);
}

#[test]
fn a_repeated_start_turns_the_transfer_round() {
    let mut joined = pair(0x10, STREN);
    step(&mut joined, SEN);
    for (number, byte) in [0x20, 0x07].into_iter().enumerate() {
        assert!(send(&mut joined, byte), "byte {number}");
        assert_eq!(told(&mut joined.second), Some((byte, number > 0, false)));
        assert_eq!(
            joined.second.read_register(CON) & SCLREL,
            0,
            "held after each byte"
        );
        joined.second.write_register(CON + SET, SCLREL);
        joined.run(100);
    }
    step(&mut joined, RSEN);
    assert!(send(&mut joined, 0x21));
    assert_eq!(told(&mut joined.second), Some((0x21, false, true)));
    joined.second.write_register(TRN, 0x99);
    joined.second.write_register(CON + SET, SCLREL);
    assert_eq!(receive(&mut joined, false), 0x99);
    step(&mut joined, PEN);
    assert_eq!(joined.first.read_register(STAT) & BCL, 0);
}

#[test]
fn a_byte_that_is_not_fetched_costs_the_next_one() {
    let mut joined = pair(0x42, 0);
    step(&mut joined, SEN);
    assert!(send(&mut joined, 0x84));
    assert!(!send(&mut joined, 0x01), "the address is still there");
    assert_eq!(joined.second.read_register(STAT) & I2COV, I2COV);
    joined.second.write_register(STAT + CLR, I2COV);
    assert_eq!(joined.second.read_register(STAT) & I2COV, 0);
}

#[test]
fn addresses_are_answered_by_their_rules() {
    // Address, mask, control; the address byte on the bus; whether it is answered.
    for (address, mask, control, byte, answered) in [
        (0x42, 0, 0, 0x43 << 1, false),
        (0x42, 1, 0, 0x43 << 1, true),
        (0x42, 0x7E, 0, 0x3C << 1, true),
        (0x42, 0x7E, 0, 0x3D << 1, false),
        (0x42, 0x3E, 0, 0x02 << 1, false),
        (0x04, 0, 0, 0x04 << 1, true),
        (0x04, 0, STRICT, 0x04 << 1, false),
        (0x7A, 0, STRICT, 0x7A << 1, false),
        (0x42, 0, 0, 0, false),
        (0x42, 0, GCEN, 0, true),
    ] {
        let mut joined = pair(address, control);
        joined.second.write_register(MSK, mask);
        step(&mut joined, SEN);
        assert_eq!(
            send(&mut joined, byte),
            answered,
            "{byte:#x} at {address:#x}, mask {mask:#x}"
        );
        let call = joined.second.read_register(STAT) & GCSTAT;
        assert_eq!(call != 0, answered && byte == 0);
        step(&mut joined, PEN);
        joined.run(100);
        assert_eq!(joined.second.read_register(STAT) & GCSTAT, 0);
    }
}

#[test]
fn ten_bits_take_two_bytes_and_reading_takes_a_match_before() {
    let mut joined = pair(0x2A5, A10M);
    step(&mut joined, SEN);
    assert!(!send(&mut joined, 0xF5), "reading without a match");
    step(&mut joined, PEN);
    step(&mut joined, SEN);
    assert!(send(&mut joined, 0xF4));
    assert!(told(&mut joined.second).is_some());
    assert!(send(&mut joined, 0xA5));
    assert_eq!(joined.second.read_register(STAT) & (ADD10 | D_A), ADD10);
    assert!(told(&mut joined.second).is_some());
    assert!(send(&mut joined, 0x11));
    assert_eq!(told(&mut joined.second), Some((0x11, true, false)));
    step(&mut joined, RSEN);
    assert!(send(&mut joined, 0xF5));
    assert_eq!(told(&mut joined.second), Some((0xF5, false, true)));
    joined.second.write_register(TRN, 0x42);
    joined.second.write_register(CON + SET, SCLREL);
    assert_eq!(receive(&mut joined, false), 0x42);
    step(&mut joined, PEN);
    joined.run(100);
    assert_eq!(joined.second.read_register(STAT) & ADD10, 0);
}

#[test]
fn what_comes_at_the_wrong_time_is_refused() {
    let mut machine = alone();
    machine.write_register(TRN, 1);
    assert_eq!(machine.read_register(STAT) & IWCOL, IWCOL, "no start");
    machine.write_register(STAT + CLR, IWCOL);
    machine.write_register(CON + SET, SEN);
    machine.write_register(CON + SET, PEN);
    assert_eq!(machine.misuses()[0].misuse, Misuse::I2cStepIgnored(1));
    run(&mut machine, 2_000);
    machine.write_register(TRN, 1);
    machine.write_register(TRN, 2);
    assert_eq!(machine.read_register(STAT) & IWCOL, IWCOL, "busy");
    let mut machine = bare();
    machine.write_register(BRG, 1);
    machine.write_register(CON, ON);
    assert_eq!(machine.misuses()[0].misuse, Misuse::I2cDivider(1));
}

#[test]
fn a_line_that_somebody_holds_is_a_collision() {
    // At the start, and within a byte.
    for late in [false, true] {
        let mut machine = alone();
        if late {
            machine.write_register(CON + SET, SEN);
            run(&mut machine, 2_000);
            machine.set_input(pin("RG3"), Level::Low);
            machine.write_register(TRN, 0xFF);
        } else {
            machine.set_input(pin("RG3"), Level::Low);
            machine.write_register(CON + SET, SEN);
        }
        run(&mut machine, 20_000);
        assert_eq!(machine.read_register(STAT) & BCL, BCL, "late: {late}");
        assert_eq!(machine.read_register(CON) & 0x1F, 0);
        assert_eq!(machine.read_register(IFS0) & COLLISION, COLLISION);
        assert_eq!(machine.level(pin("RG2")), Level::High, "let go");
        machine.write_register(STAT + CLR, BCL);
        assert_eq!(machine.read_register(STAT) & BCL, 0);
    }
}

#[test]
fn off_lets_go_of_the_bus_in_the_midst_of_a_byte() {
    let mut machine = alone();
    machine.write_register(CON + SET, SEN);
    run(&mut machine, 2_000);
    machine.write_register(TRN, 0);
    run(&mut machine, 3_000);
    assert_eq!(machine.level(pin("RG3")), Level::Low);
    machine.write_register(CON + CLR, ON);
    assert_eq!(machine.level(pin("RG3")), Level::High);
    assert_eq!(machine.level(pin("RG2")), Level::High);
    assert_eq!(machine.read_register(STAT) & (S | TRSTAT | TBF), 0);
    assert_eq!(machine.misuses(), []);
}

#[test]
fn the_second_one_has_its_own_pins_and_interrupts() {
    let mut machine = bare();
    machine.pull_up(pin("RA2"));
    machine.pull_up(pin("RA3"));
    machine.write_register(BRG + 0x200, 90);
    machine.write_register(CON + 0x200, SCLREL | ON);
    machine.write_register(CON + 0x200 + SET, SEN);
    run(&mut machine, 1_000);
    assert_eq!(machine.level(pin("RA3")), Level::Low);
    assert_eq!(machine.level(pin("RA2")), Level::Low);
    assert_eq!(machine.read_register(IFS1) & (7 << 11), 1 << 13);
    assert_eq!(machine.read_register(STAT) & S, 0, "not the first");
}

#[test]
fn registers_hold_their_bits_and_no_others() {
    let mut machine = bare();
    assert_eq!(machine.read_register(CON), SCLREL);
    for (register, bits) in [(ADD, 0x3FF), (MSK, 0x3FF), (BRG, 0xFFF)] {
        machine.write_register(register, u32::MAX);
        assert_eq!(machine.read_register(register), bits);
    }
    machine.write_register(CON, !ON);
    assert_eq!(machine.read_register(CON), 0x3FE0, "no steps while it is off");
    machine.write_register(RCV, 1);
    assert_eq!(machine.read_register(RCV), 0);
}
