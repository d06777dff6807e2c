//! The parallel port: phases and strobes of a master, the buffers of a slave.

use crate::program::{CLR, IFS1, SET, bare, pin, run};
use pic32::machine::Machine;
use pic32::peripheral::{Misuse, Unmodelled};
use pic32::pins::Level;

const PMCON: u32 = 0xBF80_7000;
const PMMODE: u32 = 0xBF80_7010;
const PMADDR: u32 = 0xBF80_7020;
const PMDOUT: u32 = 0xBF80_7030;
const PMDIN: u32 = 0xBF80_7040;
const PMAEN: u32 = 0xBF80_7050;
const PMSTAT: u32 = 0xBF80_7060;

const ON: u32 = 1 << 15;
const STROBES: u32 = 3 << 8;
const BUSY: u32 = 1 << 15;
const EVENT: u32 = 1 << 2;
const MASTER_2: u32 = 2 << 8;
const MASTER_1: u32 = 3 << 8;

const DATA: [&str; 16] = [
    "RE0", "RE1", "RE2", "RE3", "RE4", "RE5", "RE6", "RE7", "RG0", "RG1", "RF1", "RF0", "RD12", "RD13",
    "RD6", "RD7",
];
const ADDRESS: [&str; 16] = [
    "RB15", "RB14", "RG9", "RG8", "RG7", "RG6", "RA10", "RA9", "RF5", "RF4", "RB13", "RB12", "RB11", "RB10",
    "RD11", "RD10",
];

fn opened(control: u32, mode: u32) -> Machine {
    let mut machine = bare();
    // The core must be in WAIT, or its instructions are longer than the phases.
    pass(&mut machine, 200);
    machine.write_register(PMMODE, mode);
    machine.write_register(PMCON, control);
    machine.write_register(PMCON + SET, ON);
    machine
}

fn pass(machine: &mut Machine, cycles: u64) {
    let next = machine.cycle() + cycles;
    run(machine, next);
}

/// What is driven on lines; nothing when one of them is not.
fn lines(machine: &Machine, pins: &[&str]) -> Option<u16> {
    pins.iter().enumerate().try_fold(0, |sum, (line, name)| {
        let level = machine.output(pin(name)).level()?;
        Some(sum | u16::from(level.is_high()) << line)
    })
}

fn put(machine: &mut Machine, pins: &[&str], value: u16) {
    for (line, name) in pins.iter().enumerate() {
        machine.set_input(pin(name), Level::of(value >> line & 1 != 0));
    }
}

#[test]
fn registers_hold_their_bits_and_no_others() {
    let mut machine = bare();
    for (register, reset, all) in [
        (PMCON, 0, 0x3FFB),
        (PMMODE, 0, 0x7FFF),
        (PMADDR, 0, 0xFFFF),
        (PMDOUT, 0, u32::MAX),
        (PMDIN, 0, u32::MAX),
        (PMAEN, 0, 0xFFFF),
    ] {
        assert_eq!(machine.read_register(register), reset, "{register:#x}");
        machine.write_register(register, !ON | if register == PMCON { 0 } else { ON });
        assert_eq!(machine.read_register(register), all, "{register:#x}");
    }
    let mut machine = bare();
    assert_eq!(machine.read_register(PMSTAT), 0x8F);
    machine.write_register(PMCON, ON | 1 << 11);
    let expected = Misuse::NotModelled(Unmodelled::MultiplexedAddress);
    assert_eq!(machine.misuses()[0].misuse, expected);
}

/// Edges of a pin since `begin`.
fn edges(machine: &mut Machine, name: &str, begin: u64) -> Vec<(u64, bool)> {
    let edges = machine.take_edges(pin(name)).into_iter();
    edges
        .map(|(cycle, level)| (cycle - begin, level.is_high()))
        .collect()
}

#[test]
fn an_access_has_its_three_phases() {
    // WAITB, WAITM, WAITE; clocks of setup, strobe, hold of a writing, hold of a reading.
    for ((b, m, e), setup, strobe, write_hold, read_hold) in [
        ((0, 0, 0), 1, 1, 1, 0),
        ((3, 0, 3), 1, 1, 1, 0),
        ((0, 1, 0), 1, 2, 1, 0),
        ((3, 15, 3), 4, 16, 4, 3),
        ((1, 7, 2), 2, 8, 3, 2),
    ] {
        let mode = MASTER_2 | b << 6 | m << 2 | e | 1 << 13;
        let mut machine = opened(STROBES | 3, mode);
        for name in ["RD4", "RD5"] {
            machine.watch(pin(name));
        }
        let begin = machine.cycle();
        machine.write_register(PMDIN, 0xA5);
        assert_eq!(lines(&machine, &DATA[..8]), Some(0xA5));
        assert_eq!(machine.read_register(PMMODE) & BUSY, BUSY);
        let over = setup + strobe + write_hold;
        run(&mut machine, begin + over - 1);
        assert_eq!(machine.read_register(PMMODE) & BUSY, BUSY);
        assert_eq!(machine.read_register(IFS1) & EVENT, 0);
        run(&mut machine, begin + over);
        assert_eq!(machine.read_register(PMMODE) & BUSY, 0);
        assert_eq!(machine.read_register(IFS1) & EVENT, EVENT);
        assert_eq!(lines(&machine, &DATA[..1]), None, "let go of");
        let expected = vec![(setup, true), (setup + strobe, false)];
        assert_eq!(edges(&mut machine, "RD4", begin), expected);
        assert_eq!(edges(&mut machine, "RD5", begin), []);

        put(&mut machine, &DATA[..8], 0);
        let begin = machine.cycle();
        assert_eq!(machine.read_register(PMDIN), 0, "what was there before");
        run(&mut machine, begin + setup + strobe - 1);
        put(&mut machine, &DATA[..8], 0x3C);
        run(&mut machine, begin + setup + strobe);
        put(&mut machine, &DATA[..8], 0xFF);
        run(&mut machine, begin + setup + strobe + read_hold);
        assert_eq!(machine.read_register(PMMODE) & BUSY, 0);
        assert_eq!(
            machine.peek_register(PMDIN),
            Some(0x3C),
            "taken at the strobe's end"
        );
        assert_eq!(
            edges(&mut machine, "RD5", begin),
            vec![(setup, true), (setup + strobe, false)]
        );
        assert_eq!(edges(&mut machine, "RD4", begin), []);
        assert_eq!(machine.misuses(), []);
    }
}

#[test]
fn polarities_turn_the_strobes_over() {
    for control in 0..4_u32 {
        let mut machine = opened(STROBES | control, MASTER_2 | 3 << 2);
        let at_rest = |bit: u32| Some(Level::of(control & bit == 0));
        assert_eq!(machine.output(pin("RD5")).level(), at_rest(1));
        assert_eq!(machine.output(pin("RD4")).level(), at_rest(2));
        machine.write_register(PMDIN, 0);
        pass(&mut machine, 2);
        assert_eq!(machine.output(pin("RD5")).level(), at_rest(1));
        assert_ne!(machine.output(pin("RD4")).level(), at_rest(2));
    }
    let mut machine = opened(0, MASTER_2);
    machine.write_register(PMDIN, 0);
    pass(&mut machine, 2);
    assert_eq!(machine.output(pin("RD4")).level(), None, "not enabled");
}

#[test]
fn master_1_has_one_strobe_and_a_direction() {
    let mut machine = opened(STROBES | 3, MASTER_1 | 3 << 2);
    let levels = |machine: &Machine| ["RD5", "RD4"].map(|name| machine.level(pin(name)).is_high());
    machine.write_register(PMDIN, 0xFF);
    pass(&mut machine, 2);
    assert_eq!(levels(&machine), [false, true], "a writing");
    pass(&mut machine, 20);
    let _ = machine.read_register(PMDIN);
    assert_eq!(levels(&machine), [true, false], "the direction comes first");
    pass(&mut machine, 2);
    assert_eq!(levels(&machine), [true, true], "a reading");
    pass(&mut machine, 20);
    assert_eq!(levels(&machine), [false, false]);
}

#[test]
fn addresses_stand_on_their_lines_and_move_on() {
    for (line, name) in ADDRESS.iter().enumerate() {
        let mut machine = opened(0, MASTER_2);
        machine.write_register(0xBF80_9060, 0xFFFF);
        machine.write_register(PMADDR, 1 << line);
        assert_eq!(machine.output(pin(name)).level(), None, "not enabled");
        machine.write_register(PMAEN, 1 << line);
        assert_eq!(machine.output(pin(name)).level(), Some(Level::High), "{name}");
        machine.write_register(PMADDR, 0);
        assert_eq!(machine.output(pin(name)).level(), Some(Level::Low));
    }
    for (step, addresses) in [(0, [7, 7]), (1, [8, 9]), (2, [6, 5])] {
        let mut machine = opened(0, MASTER_2 | step << 11);
        machine.write_register(PMADDR, 7);
        machine.write_register(PMDIN, 0);
        pass(&mut machine, 20);
        assert_eq!(machine.read_register(PMADDR), addresses[0]);
        let _ = machine.read_register(PMDIN);
        pass(&mut machine, 20);
        assert_eq!(machine.read_register(PMADDR), addresses[1]);
    }
}

#[test]
fn selects_are_active_during_an_access_only() {
    // CSF; which of PMCS2 and PMCS1 are selects.
    for (function, selects) in [(0, [false, false]), (1, [true, false]), (2, [true, true])] {
        for high in [0, 3 << 3] {
            let mut machine = opened(function << 6 | high, MASTER_2 | 3 << 2);
            machine.write_register(PMAEN, 3 << 14);
            machine.write_register(PMADDR, 3 << 14);
            let levels = |machine: &Machine| ["RD10", "RD11"].map(|name| machine.level(pin(name)).is_high());
            let expected =
                |active: bool| selects.map(|select| if select { active == (high != 0) } else { true });
            assert_eq!(levels(&machine), expected(false), "CSF {function}");
            machine.write_register(PMDIN, 1);
            assert_eq!(levels(&machine), expected(true), "CSF {function}");
            pass(&mut machine, 20);
            assert_eq!(levels(&machine), expected(false), "CSF {function}");
        }
    }
}

#[test]
fn sixteen_bits_use_all_lines() {
    let mut machine = opened(STROBES, MASTER_2 | 1 << 10);
    machine.write_register(PMDIN, 0xBEEF);
    assert_eq!(lines(&machine, &DATA), Some(0xBEEF));
    machine.write_register(PMDIN, 1);
    assert_eq!(machine.misuses()[0].misuse, Misuse::ParallelPortBusy);
    pass(&mut machine, 20);
    put(&mut machine, &DATA, 0x1234);
    let _ = machine.read_register(PMDIN);
    pass(&mut machine, 20);
    assert_eq!(machine.peek_register(PMDIN), Some(0x1234));
}

/// The other machine: strobes are active high.
fn strobe(machine: &mut Machine, name: &str) {
    machine.set_input(pin(name), Level::High);
    pass(machine, 10);
    machine.set_input(pin(name), Level::Low);
    pass(machine, 10);
}

const ACTIVE_HIGH: u32 = STROBES | 1 << 3 | 3;

#[test]
fn a_slave_takes_and_gives_bytes() {
    let mut machine = opened(ACTIVE_HIGH, 1 << 13);
    put(&mut machine, &DATA[..8], 0x5A);
    strobe(&mut machine, "RD4");
    assert_eq!(machine.read_register(PMSTAT), 0x8F, "not selected");
    machine.set_input(pin("RD11"), Level::High);
    strobe(&mut machine, "RD4");
    assert_eq!(machine.read_register(PMSTAT), 0x818F);
    assert_eq!(machine.read_register(IFS1) & EVENT, EVENT);
    put(&mut machine, &DATA[..8], 0xA5);
    strobe(&mut machine, "RD4");
    assert_eq!(machine.read_register(PMSTAT), 0xC18F, "overflow");
    assert_eq!(machine.read_register(PMDIN), 0x5A, "the first");
    assert_eq!(machine.read_register(PMSTAT), 0x408F);
    machine.write_register(PMSTAT + CLR, 1 << 14);
    assert_eq!(machine.read_register(PMSTAT), 0x8F);

    for name in &DATA[..8] {
        machine.release_input(pin(name));
    }
    machine.write_register(PMDOUT, 0x96);
    assert_eq!(machine.read_register(PMSTAT), 0);
    machine.write_register(IFS1 + CLR, EVENT);
    machine.set_input(pin("RD5"), Level::High);
    assert_eq!(lines(&machine, &DATA[..8]), Some(0x96));
    assert_eq!(machine.read_register(IFS1) & EVENT, 0);
    machine.set_input(pin("RD5"), Level::Low);
    assert_eq!(lines(&machine, &DATA[..1]), None);
    assert_eq!(machine.read_register(IFS1) & EVENT, EVENT);
    assert_eq!(machine.read_register(PMSTAT), 0x81);
    strobe(&mut machine, "RD5");
    assert_eq!(machine.read_register(PMSTAT), 0xC1, "underflow");
    assert_eq!(machine.misuses(), []);
}

#[test]
fn four_buffers_are_used_in_turn_or_by_address() {
    // Mode bits; the order of buffers in which the other machine writes.
    for (mode, order) in [(3 << 11, [0, 1, 2, 3]), (1 << 8, [2, 0, 1, 3])] {
        let mut machine = opened(ACTIVE_HIGH, mode | 2 << 13);
        machine.write_register(0xBF80_9060, 3 << 14);
        machine.set_input(pin("RD11"), Level::High);
        for (count, buffer) in (1..).zip(order) {
            put(&mut machine, &ADDRESS[..2], buffer);
            put(&mut machine, &DATA[..8], 0x10 + buffer);
            strobe(&mut machine, "RD4");
            let status = machine.read_register(PMSTAT);
            assert_eq!((status >> 8 & 0xF).count_ones(), count);
            assert_eq!(status >> 15 & 1, count / 4, "all are full");
            let expected = if buffer == 3 { EVENT } else { 0 };
            assert_eq!(machine.read_register(IFS1) & EVENT, expected, "buffer {buffer}");
        }
        assert_eq!(machine.read_register(PMDIN), 0x1312_1110);
        for name in &DATA[..8] {
            machine.release_input(pin(name));
        }
        machine.write_register(PMDOUT, 0x2322_2120);
        for buffer in order {
            put(&mut machine, &ADDRESS[..2], buffer);
            machine.set_input(pin("RD5"), Level::High);
            assert_eq!(lines(&machine, &DATA[..8]), Some(0x20 + buffer));
            machine.set_input(pin("RD5"), Level::Low);
        }
        assert_eq!(machine.read_register(PMSTAT), 0x8F);
    }
}

#[test]
fn pins_of_others_are_left_alone() {
    let mut machine = bare();
    // SPI 2 has RG6 and RG8, which are PMA5 and PMA3.
    machine.write_register(0xBF80_5A00, ON | 1 << 5);
    machine.write_register(PMMODE, MASTER_2);
    machine.write_register(PMCON, ON);
    machine.write_register(PMDIN, 1);
    pass(&mut machine, 20);
    machine.write_register(PMCON, 0);
    assert_eq!(machine.output(pin("RG6")).level(), Some(Level::Low));
    assert_eq!(machine.output(pin("RG8")).level(), Some(Level::Low));
    assert_eq!(machine.output(pin("RE0")).level(), None);
}
