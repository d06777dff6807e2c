//! The analog converter: times, scans, triggers, and what it sees.

use crate::program::{CLR, IFS1, SET, bare, pin, timer};
use pic32::machine::{Halt, Machine, Outputs, Surroundings};
use pic32::peripheral::Misuse;
use pic32::pins::Level;

const CON1: u32 = 0xBF80_9000;
const CON2: u32 = 0xBF80_9010;
const CON3: u32 = 0xBF80_9020;
const CHS: u32 = 0xBF80_9040;
const CSSL: u32 = 0xBF80_9050;
const PCFG: u32 = 0xBF80_9060;
const DONE: u32 = 1;
const SAMP: u32 = 2;
const ASAM: u32 = 4;

/// Channel n reads 60 n; when and what was asked is noted.
#[derive(Default)]
struct Ladder {
    asked: Vec<(u64, u8)>,
}

impl Surroundings for Ladder {
    fn analog(&mut self, channel: u8, cycle: u64, _: &Outputs<'_>) -> u16 {
        self.asked.push((cycle, channel));
        60 * u16::from(channel)
    }
}

fn run(machine: &mut Machine, cycle: u64, ladder: &mut Ladder) {
    assert_eq!(machine.run_until(cycle, ladder), Halt::Reached);
}

fn result(machine: &mut Machine, place: u32) -> u32 {
    machine.read_register(0xBF80_9070 + 16 * place)
}

/// A scan of these channels, ended by the hardware after one turn, TAD 400 ns, 31 TAD of sampling.
fn scanning(channels: u32) -> Machine {
    let mut machine = bare();
    machine.write_register(CON3, 31 << 8 | 15);
    machine.write_register(CSSL, channels);
    machine.write_register(CON2, 1 << 10 | (channels.count_ones() - 1) << 2);
    machine.write_register(CON1, 0x8000 | 7 << 5 | 1 << 4);
    machine
}

#[test]
fn a_scan_of_ten_channels_takes_its_172_us_and_stops() {
    let channels = [0, 2, 3, 4, 8, 10, 11, 12, 13, 14];
    let mut machine = scanning(channels.iter().fold(0, |mask, channel| mask | 1 << channel));
    let mut ladder = Ladder::default();
    machine.write_register(CON1 + SET, ASAM);
    let tad = 32;
    let end = 10 * (31 + 12) * tad;
    run(&mut machine, end - 1, &mut ladder);
    assert_eq!(machine.read_register(IFS1) & 2, 0);
    run(&mut machine, end, &mut ladder);
    assert_eq!(machine.read_register(IFS1) & 2, 2);
    let sampled: Vec<(u64, u8)> = (0..)
        .zip(channels)
        .map(|(turn, channel)| (turn * 43 * tad + 31 * tad, channel))
        .collect();
    assert_eq!(ladder.asked, sampled);
    for (place, channel) in (0..).zip(channels) {
        assert_eq!(result(&mut machine, place), 60 * u32::from(channel));
    }
    assert_eq!(
        machine.read_register(CON1) & (DONE | SAMP | ASAM),
        DONE,
        "CLRASAM"
    );
    run(&mut machine, 80_000, &mut ladder);
    assert_eq!(ladder.asked.len(), 10);
    // The next turn begins with the lowest channel again.
    machine.write_register(CON1 + SET, ASAM);
    run(&mut machine, 160_000, &mut ladder);
    assert_eq!((ladder.asked.len(), ladder.asked[10].1), (20, 0));
    assert!(machine.misuses().is_empty());
}

#[test]
fn without_stopping_halves_are_filled_in_turn() {
    let mut machine = bare();
    machine.write_register(CON3, 1 << 8 | 2);
    machine.write_register(CSSL, 0b11100);
    machine.write_register(CON2, 1 << 10 | 2 << 2 | 2);
    machine.write_register(CON1, 0x8000 | 7 << 5 | ASAM);
    let mut ladder = Ladder::default();
    // TAD is 75 ns: 13 TAD a conversion.
    let turn = 3 * 13 * 6;
    run(&mut machine, turn - 1, &mut ladder);
    assert_eq!(machine.read_register(CON2) & 1 << 7, 0, "fills 0-7");
    run(&mut machine, turn, &mut ladder);
    assert_eq!(machine.read_register(CON2) & 1 << 7, 1 << 7, "fills 8-F");
    assert_eq!(
        (0..3)
            .map(|place| result(&mut machine, place))
            .collect::<Vec<_>>(),
        [120, 180, 240]
    );
    assert_eq!(result(&mut machine, 8), 0);
    run(&mut machine, 2 * turn, &mut ladder);
    assert_eq!(
        (8..11)
            .map(|place| result(&mut machine, place))
            .collect::<Vec<_>>(),
        [120, 180, 240]
    );
    assert_eq!(machine.read_register(CON2) & 1 << 7, 0);
    assert!(machine.misuses().is_empty(), "75 ns are allowed");
}

#[test]
fn by_hand_and_by_timer_3() {
    let mut machine = bare();
    let mut ladder = Ladder::default();
    machine.write_register(CHS, 5 << 16);
    machine.write_register(CON3, 15);
    machine.write_register(CON1, 0x8000);
    machine.write_register(CON1 + SET, SAMP);
    run(&mut machine, 1_000, &mut ladder);
    assert!(ladder.asked.is_empty());
    machine.write_register(CON1 + CLR, SAMP);
    run(&mut machine, 1_000 + 12 * 32, &mut ladder);
    assert_eq!(ladder.asked, [(1_000, 5)]);
    assert_eq!(
        (machine.read_register(CON1) & DONE, result(&mut machine, 0)),
        (DONE, 300)
    );

    machine.write_register(CON1, 0);
    machine.write_register(CON1, 0x8000 | 2 << 5 | ASAM);
    machine.write_register(timer(3) + 0x20, 3_999);
    machine.write_register(timer(3), 0x8000);
    let begin = machine.cycle();
    run(&mut machine, begin + 12_100, &mut ladder);
    let expected: Vec<(u64, u8)> = (1..=3).map(|period| (begin + 4_000 * period, 5)).collect();
    assert_eq!(ladder.asked[1..], expected);
}

#[test]
fn int0_ends_a_sample_and_two_inputs_alternate() {
    let mut machine = bare();
    let mut ladder = Ladder::default();
    machine.write_register(CHS, 9 << 24 | 2 << 16);
    machine.write_register(CON3, 15);
    machine.write_register(CON2, 1 | 1 << 2);
    machine.write_register(CON1, 0x8000 | 1 << 5 | ASAM);
    machine.set_input(pin("RF6"), Level::High);
    for (cycle, level) in [(500, Level::Low), (600, Level::High), (2_000, Level::Low)] {
        machine.schedule_input(cycle, pin("RF6"), level);
    }
    run(&mut machine, 3_000, &mut ladder);
    assert_eq!(ladder.asked, [(500, 2), (2_000, 9)], "falling edges");
}

#[test]
fn forms_of_the_result() {
    let table = [
        (0, 60),
        (1, 0xFE3C),
        (2, 60 << 6),
        (3, 0x8F00),
        (4, 60),
        (5, 0xFFFF_FE3C),
        (6, 60 << 22),
        (7, 0x8F00_0000),
    ];
    for (form, expected) in table {
        let mut machine = bare();
        let mut ladder = Ladder::default();
        machine.write_register(CHS, 1 << 16);
        machine.write_register(CON3, 1 << 8 | 15);
        machine.write_register(CON1, 0x8000 | 7 << 5 | form << 8);
        machine.write_register(CON1 + SET, SAMP);
        run(&mut machine, 1_000, &mut ladder);
        assert_eq!(result(&mut machine, 0), expected, "FORM {form}");
    }
}

#[test]
fn pins_that_are_not_analog_inputs_are_named() {
    let mut machine = scanning(1 << 12 | 1 << 5);
    let mut ladder = Ladder::default();
    machine.write_register(PCFG, 1 << 5);
    // RB12 driven high.
    machine.write_register(0xBF88_6044, 1 << 12);
    machine.write_register(0xBF88_6068, 1 << 12);
    machine.write_register(CON1 + SET, ASAM);
    run(&mut machine, 80_000, &mut ladder);
    assert!(ladder.asked.is_empty());
    assert_eq!((result(&mut machine, 0), result(&mut machine, 1)), (0, 1023));
    let named: Vec<Misuse> = machine.misuses().iter().map(|record| record.misuse).collect();
    assert_eq!(
        named,
        [
            Misuse::AnalogPinIsDigital(pin("RB5")),
            Misuse::AnalogPinIsOutput(pin("RB12"))
        ]
    );
}

#[test]
fn what_the_chip_drives_at_the_moment_of_the_sample_is_seen() {
    struct Emitter;
    impl Surroundings for Emitter {
        fn analog(&mut self, _: u8, _: u64, outputs: &Outputs<'_>) -> u16 {
            if outputs.is_high(pin("RD12")) { 700 } else { 40 }
        }
    }
    let mut machine = bare();
    machine.write_register(0xBF88_60C4, 1 << 12);
    machine.write_register(CHS, 12 << 16);
    machine.write_register(CON3, 31 << 8 | 15);
    machine.write_register(CON1, 0x8000 | 7 << 5);
    for (lit, expected) in [(0, 40), (1, 700), (0, 40)] {
        machine.write_register(0xBF88_60E0, lit << 12);
        machine.write_register(CON1 + SET, SAMP);
        let sampled = machine.cycle() + 31 * 32;
        machine.run_until(sampled, &mut Emitter);
        // Too late for this sample.
        machine.write_register(0xBF88_60E0, (1 - lit) << 12);
        machine.run_until(sampled + 12 * 32, &mut Emitter);
        assert_eq!(result(&mut machine, 0), expected);
    }
}

#[test]
fn a_clock_that_is_too_fast_is_named() {
    let mut machine = bare();
    machine.write_register(CON3, 1 << 8 | 1);
    machine.write_register(CON1, 0x8000);
    assert_eq!(machine.misuses()[0].misuse, Misuse::AnalogTooFast);
}
