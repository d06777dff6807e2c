//! SPI: clock edges of the four modes, both buffers, overrun, the slave, frames.

use crate::joined::{JoinedChips, back, forth};
use crate::program::{CLR, IFS0, IFS1, SET, bare, pin, run};
use pic32::machine::Machine;
use pic32::peripheral::Misuse;
use pic32::pins::Level;

const CON: u32 = 0xBF80_5800;
const STAT: u32 = 0xBF80_5810;
const BUF: u32 = 0xBF80_5820;
const BRG: u32 = 0xBF80_5830;
/// From SPI 1 to SPI 2.
const TWO: u32 = 0x200;
const AD1PCFG: u32 = 0xBF80_9060;

const ON: u32 = 1 << 15;
const MASTER: u32 = 1 << 5;
const CKP: u32 = 1 << 6;
const SSEN: u32 = 1 << 7;
const CKE: u32 = 1 << 8;
const SMP: u32 = 1 << 9;
const MODE16: u32 = 1 << 10;
const MODE32: u32 = 1 << 11;
const FRMEN: u32 = 1 << 31;
const FRMSYNC: u32 = 1 << 30;
const FRMPOL: u32 = 1 << 29;
const SPIFE: u32 = 1 << 17;

const FULL: u32 = 1;
const EMPTY: u32 = 8;
const OVERRUN: u32 = 0x40;
const BUSY: u32 = 0x800;

/// SPI 2 at 1 MHz: its half period is 40 cycles.
fn opened(control: u32) -> Machine {
    let mut machine = bare();
    machine.write_register(BRG + TWO, 39);
    machine.write_register(CON + TWO, control);
    machine.write_register(CON + TWO + SET, ON);
    machine
}

/// SPI 2 of one chip as master and of another as slave.
fn pair(master: u32, slave: u32) -> JoinedChips {
    let wires = vec![
        forth("RG6", "RG6"),
        forth("RG8", "RG7"),
        back("RG8", "RG7"),
        forth("RE0", "RG9"),
    ];
    let mut joined = JoinedChips::new(opened(master), opened(slave), wires);
    joined.first.write_register(0xBF88_6128, 1);
    joined.first.write_register(0xBF88_6104, 1);
    joined.run(100);
    joined
}

fn select(joined: &mut JoinedChips, low: bool) {
    joined
        .first
        .write_register(0xBF88_6120 + if low { CLR } else { SET }, 1);
    joined.run(20);
}

#[test]
fn the_four_modes_put_clock_and_data_where_they_belong() {
    // Mode, CKP and CKE; the idle level; data changes with the clock's edge of this number, the first being 1; 0: before it.
    for (mode, settings, idle, first_change) in [
        (0, CKE, Level::Low, 0),
        (1, 0, Level::Low, 1),
        (2, CKP | CKE, Level::High, 0),
        (3, CKP, Level::High, 1),
    ] {
        let mut machine = opened(MASTER | settings);
        machine.watch(pin("RG6"));
        machine.watch(pin("RG8"));
        assert_eq!(machine.level(pin("RG6")), idle, "mode {mode}");
        let begin = machine.cycle();
        machine.write_register(BUF + TWO, 0xA5);
        run(&mut machine, begin + 2_000);
        let clock: Vec<u64> = machine
            .take_edges(pin("RG6"))
            .iter()
            .map(|edge| edge.0 - begin)
            .collect();
        assert_eq!(
            clock,
            (1..=16).map(|half| half * 40).collect::<Vec<u64>>(),
            "mode {mode}"
        );
        // 1010 0101: it changes with each bit but the one in the middle.
        let data: Vec<u64> = machine
            .take_edges(pin("RG8"))
            .iter()
            .map(|edge| edge.0 - begin)
            .collect();
        let expected: Vec<u64> = [0, 1, 2, 3, 5, 6, 7]
            .map(|bit| (2 * bit + first_change) * 40)
            .to_vec();
        assert_eq!(data, expected, "mode {mode}");
        assert_eq!(machine.level(pin("RG6")), idle);
        assert_eq!(machine.misuses(), []);
    }
}

#[test]
fn input_is_taken_in_the_middle_of_a_bit_or_at_its_end() {
    // The line is high for one half period only: which bit is that, with each setting?
    for (settings, high_half, expected) in [
        // Taken with the leading edges, which end the halves 1, 3, 5 ..
        (CKE, 0, 0x80),
        (CKE, 2, 0x40),
        (CKE, 1, 0x00),
        // With the trailing edges.
        (0, 1, 0x80),
        (0, 15, 0x01),
        (0, 0, 0x00),
        // Half a period later.
        (CKE | SMP, 1, 0x80),
        (CKE | SMP, 15, 0x01),
        (SMP, 2, 0x80),
        (SMP, 16, 0x01),
    ] {
        let mut machine = opened(MASTER | settings);
        let begin = machine.cycle();
        machine.set_input(pin("RG7"), Level::Low);
        machine.schedule_input(begin + high_half * 40 + 1, pin("RG7"), Level::High);
        machine.schedule_input(begin + high_half * 40 + 41, pin("RG7"), Level::Low);
        machine.write_register(BUF + TWO, 0);
        run(&mut machine, begin + 2_000);
        assert_eq!(
            machine.read_register(BUF + TWO),
            expected,
            "{settings:#x} half {high_half}"
        );
    }
}

#[test]
fn words_of_three_lengths_follow_each_other_without_a_pause() {
    for (width, bits, words) in [
        (0, 8, [0x81_u32, 0x5A]),
        (MODE16, 16, [0x8001, 0x1234]),
        (MODE32, 32, [0x8000_0001, 0x1234_5678]),
        (MODE32 | MODE16, 32, [0xDEAD_BEEF, 1]),
    ] {
        let mut machine = opened(MASTER | CKE | width);
        machine.watch(pin("RG6"));
        let begin = machine.cycle();
        machine.write_register(BUF + TWO, words[0]);
        assert_eq!(machine.read_register(STAT + TWO) & (EMPTY | BUSY), EMPTY | BUSY);
        machine.write_register(BUF + TWO, words[1]);
        assert_eq!(
            machine.read_register(STAT + TWO) & EMPTY,
            0,
            "one is moving, one waits"
        );
        run(&mut machine, begin + bits * 80 - 1);
        assert_eq!(machine.read_register(STAT + TWO) & EMPTY, 0);
        run(&mut machine, begin + bits * 80);
        assert_eq!(machine.read_register(STAT + TWO) & (EMPTY | BUSY), EMPTY | BUSY);
        run(&mut machine, begin + bits * 160);
        assert_eq!(machine.read_register(STAT + TWO) & BUSY, 0);
        assert_eq!(machine.take_edges(pin("RG6")).len() as u64, bits * 4);
        assert_eq!(machine.misuses(), []);
        machine.write_register(BUF + TWO, 1);
        machine.write_register(BUF + TWO, 2);
        machine.write_register(BUF + TWO, 3);
        assert_eq!(machine.misuses()[0].misuse, Misuse::SpiBufferFull(2));
    }
}

#[test]
fn an_overrun_keeps_the_first_word_until_it_is_forgotten() {
    let mut machine = opened(MASTER | CKE);
    machine.set_input(pin("RG7"), Level::High);
    machine.write_register(BUF + TWO, 1);
    run(&mut machine, 1_000);
    assert_eq!(machine.read_register(STAT + TWO) & (FULL | OVERRUN), FULL);
    machine.set_input(pin("RG7"), Level::Low);
    machine.write_register(BUF + TWO, 2);
    run(&mut machine, 2_000);
    assert_eq!(
        machine.read_register(STAT + TWO) & (FULL | OVERRUN),
        FULL | OVERRUN
    );
    assert_eq!(machine.read_register(BUF + TWO), 0xFF, "the first");
    machine.write_register(BUF + TWO, 3);
    run(&mut machine, 3_000);
    assert_eq!(
        machine.read_register(STAT + TWO) & (FULL | OVERRUN),
        OVERRUN,
        "nothing more is received"
    );
    machine.write_register(STAT + TWO + CLR, OVERRUN);
    machine.write_register(BUF + TWO, 4);
    run(&mut machine, 4_000);
    assert_eq!(machine.read_register(STAT + TWO) & (FULL | OVERRUN), FULL);
    machine.write_register(CON + TWO + CLR, ON);
    assert_eq!(
        machine.read_register(STAT + TWO),
        EMPTY,
        "off empties both buffers"
    );
}

#[test]
fn master_and_slave_exchange_words_in_every_mode() {
    for settings in [CKE, 0, CKP | CKE, CKP, MODE16, MODE32 | CKE] {
        let mut joined = pair(MASTER | settings, SSEN | settings);
        let mask = match settings & (MODE16 | MODE32) {
            0 => 0xFF,
            MODE16 => 0xFFFF,
            _ => u32::MAX,
        };
        joined.second.write_register(BUF + TWO, 0x5AA5_C33C & mask);
        select(&mut joined, true);
        for round in 0..4_u32 {
            let sent = 0x9669_0FF0_u32.rotate_left(round) & mask;
            let answer = 0x5AA5_C33C_u32.rotate_left(round) & mask;
            let next = 0x5AA5_C33C_u32.rotate_left(round + 1) & mask;
            joined.first.write_register(BUF + TWO, sent);
            joined.run(100);
            joined.second.write_register(BUF + TWO, next);
            joined.run(32 * 80);
            assert_eq!(
                joined.second.read_register(STAT + TWO) & FULL,
                FULL,
                "{settings:#x}"
            );
            assert_eq!(
                joined.second.read_register(BUF + TWO),
                sent,
                "{settings:#x} round {round}"
            );
            assert_eq!(
                joined.first.read_register(BUF + TWO),
                answer,
                "{settings:#x} round {round}"
            );
        }
        assert_eq!(joined.first.misuses(), []);
        assert_eq!(joined.second.misuses(), []);
    }
}

#[test]
fn a_slave_that_is_not_selected_is_silent_and_a_word_cut_short_is_dropped() {
    let mut joined = pair(MASTER | CKE, SSEN | CKE);
    joined.second.write_register(BUF + TWO, 0x77);
    joined.first.write_register(BUF + TWO, 0x11);
    joined.run(1_000);
    assert_eq!(joined.second.read_register(STAT + TWO) & (FULL | BUSY), 0);
    assert_eq!(joined.second.output(pin("RG8")).level(), None);
    let _ = joined.first.read_register(BUF + TWO);
    select(&mut joined, true);
    assert_eq!(joined.second.output(pin("RG8")).level(), Some(Level::Low));
    joined.first.write_register(BUF + TWO, 0x22);
    joined.run(3 * 80 + 20);
    assert_eq!(joined.second.read_register(STAT + TWO) & BUSY, BUSY);
    select(&mut joined, false);
    joined.run(1_000);
    let _ = joined.first.read_register(BUF + TWO);
    assert_eq!(
        joined.second.read_register(STAT + TWO) & (FULL | BUSY),
        0,
        "dropped"
    );
    joined.second.write_register(BUF + TWO, 0x66);
    select(&mut joined, true);
    joined.first.write_register(BUF + TWO, 0x33);
    joined.run(1_000);
    assert_eq!(joined.second.read_register(BUF + TWO), 0x33, "whole again");
    assert_eq!(joined.first.read_register(BUF + TWO), 0x66);
}

#[test]
fn a_slave_that_was_not_loaded_sends_what_came_in_last() {
    let mut joined = pair(MASTER | CKE, SSEN | CKE);
    select(&mut joined, true);
    for (sent, answer) in [(0x5A, 0), (0xC3, 0x5A), (0, 0xC3)] {
        joined.first.write_register(BUF + TWO, sent);
        joined.run(1_000);
        assert_eq!(joined.second.read_register(BUF + TWO), sent);
        assert_eq!(joined.first.read_register(BUF + TWO), answer);
    }
}

#[test]
fn frames_carry_words_both_ways() {
    for (place, polarity) in [(0, 0), (0, FRMPOL), (SPIFE, 0), (SPIFE, FRMPOL)] {
        let framed = FRMEN | place | polarity;
        let wires = vec![
            forth("RG6", "RG6"),
            forth("RG8", "RG7"),
            back("RG8", "RG7"),
            forth("RG9", "RG9"),
        ];
        let first = opened(MASTER | framed);
        let second = opened(FRMSYNC | framed);
        let mut joined = JoinedChips::new(first, second, wires);
        joined.first.watch(pin("RG9"));
        joined.first.watch(pin("RG6"));
        joined.run(800);
        let clocks = joined.first.take_edges(pin("RG6")).len();
        assert!(
            (19..=21).contains(&clocks),
            "the clock runs without words: {clocks} edges"
        );
        assert_eq!(joined.first.take_edges(pin("RG9")), [], "and without pulses");
        for (sent, answer) in [(0xA5, 0x3C), (0x01, 0x80), (0xFF, 0x7E)] {
            joined.second.write_register(BUF + TWO, answer);
            joined.first.write_register(BUF + TWO, sent);
            joined.run(1_200);
            assert_eq!(joined.second.read_register(BUF + TWO), sent, "{framed:#x}");
            assert_eq!(joined.first.read_register(BUF + TWO), answer, "{framed:#x}");
            let pulse = joined.first.take_edges(pin("RG9"));
            assert_eq!(pulse.len(), 2, "one pulse a word");
            assert_eq!(pulse[1].0 - pulse[0].0, 80, "one clock long");
            assert_eq!(pulse[0].1.is_high(), polarity != 0);
        }
        assert_eq!(joined.second.misuses(), []);
    }
}

#[test]
fn interrupts_of_both_follow_their_buffers() {
    for (offset, flags, fault) in [(0, IFS0, 23), (TWO, IFS1, 5)] {
        let mut machine = bare();
        machine.write_register(AD1PCFG, 1 << 2);
        machine.write_register(BRG + offset, 39);
        machine.write_register(CON + offset, MASTER | CKE | ON);
        let raised = |machine: &mut Machine| machine.read_register(flags) >> fault & 7;
        assert_eq!(raised(&mut machine), 0b010, "room to send");
        machine.write_register(BUF + offset, 1);
        machine.write_register(BUF + offset, 2);
        machine.write_register(flags + CLR, 7 << fault);
        assert_eq!(raised(&mut machine), 0);
        run(&mut machine, 700);
        assert_eq!(raised(&mut machine), 0b110);
        run(&mut machine, 1_400);
        assert_eq!(raised(&mut machine), 0b111);
        machine.write_register(flags + CLR, 7 << fault);
        assert_eq!(raised(&mut machine), 0b111, "the causes are still there");
        let _ = machine.read_register(BUF + offset);
        machine.write_register(STAT + offset + CLR, OVERRUN);
        machine.write_register(flags + CLR, 7 << fault);
        assert_eq!(raised(&mut machine), 0b010);
    }
}

#[test]
fn settings_that_the_part_does_not_combine_are_told() {
    for (control, misuse) in [
        (MASTER | FRMEN | CKE, Misuse::SpiSettings(2)),
        (SMP, Misuse::SpiSettings(2)),
        (CKE, Misuse::SpiSettings(2)),
    ] {
        assert_eq!(opened(control).misuses()[0].misuse, misuse, "{control:#x}");
    }
    let mut machine = bare();
    machine.write_register(BRG, 0);
    machine.write_register(CON, MASTER | ON);
    assert_eq!(machine.misuses()[0].misuse, Misuse::SpiTooFast(1), "40 MHz");
}

#[test]
fn registers_hold_their_bits_and_no_others() {
    let mut machine = bare();
    machine.write_register(BRG, u32::MAX);
    assert_eq!(machine.read_register(BRG), 0x1FF);
    machine.write_register(CON, !ON);
    assert_eq!(machine.read_register(CON), 0xE002_3FE0);
    assert_eq!(machine.read_register(STAT), EMPTY);
    machine.write_register(CON, MASTER | 1 << 12 | ON);
    machine.write_register(BUF, 0xFF);
    assert_eq!(
        machine.output(pin("RF8")).level(),
        None,
        "DISSDO leaves the pin alone"
    );
    assert_eq!(machine.output(pin("RF6")).level(), Some(Level::Low));
}
