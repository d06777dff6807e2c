//! The UART with both of its rates.

use crate::rig::{STAY, after, machine, ram};
use stc90::machine::Machine;
use stc90::peripheral::{LineFrame, Misuse, TICKS_PER_CYCLE};

const PCON: u8 = 0x87;
const SCON: u8 = 0x98;
const SBUF: u8 = 0x99;
const SADDR: u8 = 0xA9;
const SADEN: u8 = 0xB9;

/// Timer 2 as the reference sets it for 38,400 at 30 MHz and 6T, and the UART with 8 bits, receiving.
const SETUP: [(u8, u8); 4] = [(0xCB, 0xFF), (0xCA, 0xCF), (0xC8, 0x34), (SCON, 0x50)];
/// Ticks of its bit: 16 x 49.
const BIT: u64 = 784;

/// A byte a long time after the last one.
fn hear(machine: &mut Machine, byte: u8) {
    machine.hear(LineFrame::byte(machine.cycle() + 10, BIT, byte));
    machine.run_until(machine.cycle() + 10 + 11 * BIT / TICKS_PER_CYCLE);
}

fn listening(pairs: &[(u8, u8)]) -> Machine {
    let mut setup = SETUP.to_vec();
    setup.extend(pairs);
    let mut machine = machine(&[(0, &after(&setup, &STAY))]);
    machine.run_until(40);
    machine
}

/// What it reads as, and whether there is something new; takes it.
fn take(machine: &mut Machine) -> (u8, u8) {
    (machine.register(SBUF), machine.register(SCON))
}

#[test]
fn timer_2_makes_the_rate_of_the_reference() {
    let machine = listening(&[]);
    assert_eq!(machine.bit_ticks(), Some(BIT));
    let rate = machine.cycles_per_s() * TICKS_PER_CYCLE as f64 / BIT as f64;
    assert_eq!(rate.round(), 38_265.0);
}

#[test]
fn timer_1_makes_the_rate_of_the_reference() {
    for (pcon, reload) in [(0, 0xFC), (0x80, 0xF8)] {
        let setup = [
            (PCON, pcon),
            (0x89, 0x20),
            (0x8D, reload),
            (0x88, 0x40),
            (SCON, 0x50),
        ];
        let mut machine = machine(&[(0, &after(&setup, &STAY))]);
        machine.run_until(40);
        let bit = machine.bit_ticks().expect("a rate");
        let rate = machine.cycles_per_s() * TICKS_PER_CYCLE as f64 / bit as f64;
        assert_eq!((rate / 1.0).round(), 39_063.0, "{pcon}");
    }
}

/// A program that waits for TI sends without gaps: TI comes with the stop bit, and the next start bit right after it.
#[test]
fn bytes_follow_each_other_at_once() {
    // INC A; MOV SBUF, A; JNB TI, self; CLR TI; SJMP back
    let sending = [0x04, 0xF5, SBUF, 0x30, 0x99, 0xFD, 0xC2, 0x99, 0x80, 0xF6];
    let mut machine = machine(&[(0, &after(&SETUP, &sending))]);
    machine.run_until(200_000);
    let sent = machine.take_sent();
    assert!(sent.len() > 140, "{}", sent.len());
    for (number, pair) in sent.windows(2).enumerate() {
        assert_eq!(usize::from(pair[0].byte), (number + 1) % 256);
        let gap = pair[1].cycle - pair[0].cycle;
        // 10 bits of 130 2/3 cycles, each begin rounded up.
        assert!((1306..=1308).contains(&gap), "{gap}");
        assert!(pair[0].line_is_free && pair[0].ninth.is_none());
    }
    assert_eq!(machine.misuses(), []);
}

#[test]
fn a_byte_that_is_cut_off_is_misuse() {
    let mut machine = machine(&[(0, &after(&SETUP, &[0xF5, SBUF, 0xF5, SBUF, 0x80, 0xFE]))]);
    machine.run_until(5_000);
    assert_eq!(machine.misuses()[0].misuse, Misuse::SentTooEarly);
    // TI comes once, at the end of the second.
    assert_eq!(machine.register(SCON), 0x52);
}

#[test]
fn nothing_is_sent_without_a_rate() {
    // The UART first, its timer 1,000 cycles later.
    let mut program = after(
        &[(SCON, 0x50), (SBUF, 0x41)],
        &[0x7F, 0xFA, 0xDF, 0xFE, 0xDF, 0xFE],
    );
    program.extend(after(&SETUP[..3], &STAY));
    let mut machine = machine(&[(0, &program)]);
    machine.run_until(1_000);
    assert_eq!(machine.take_sent(), []);
    machine.run_until(5_000);
    assert_eq!(machine.take_sent().len(), 1);
}

#[test]
fn every_byte_is_heard() {
    let mut machine = listening(&[]);
    for byte in 0..=255 {
        hear(&mut machine, byte);
        assert_eq!(take(&mut machine), (byte, 0x55));
        // The next is lost unless RI is cleared.
        machine = listening(&[]);
    }
}

/// RI is still set: the new byte is lost and the old one stays.
#[test]
fn a_byte_that_nobody_takes_stays_alone() {
    let mut machine = listening(&[]);
    hear(&mut machine, 0x11);
    hear(&mut machine, 0x22);
    assert_eq!(take(&mut machine).0, 0x11);
    assert_eq!((machine.overruns(), machine.unheard()), (1, 0));
}

/// Back to back at the same rate nothing is lost when the program takes each in time.
#[test]
fn a_stream_is_heard_whole() {
    // JNB RI, self; CLR RI; MOV @R0, SBUF; INC R0; SJMP back, with R0 from 0x80 on
    let taking = [0x30, 0x98, 0xFD, 0xC2, 0x98, 0xA6, SBUF, 0x08, 0x80, 0xF6];
    let mut program = vec![0x78, 0x80];
    program.extend(after(&SETUP, &taking));
    let mut machine = machine(&[(0, &program)]);
    for number in 0..100 {
        let cycle = (100 * TICKS_PER_CYCLE + number * 10 * BIT) / TICKS_PER_CYCLE;
        machine.hear(LineFrame::byte(cycle, BIT, number as u8));
    }
    machine.run_until(140_000);
    let heard: Vec<u8> = (0x80..0xE4).map(|address| ram(&machine, address)).collect();
    assert_eq!(heard, (0..100).collect::<Vec<u8>>());
    assert_eq!((machine.overruns(), machine.unheard()), (0, 0));
}

/// A wrong stop bit shows in SCON.7 when PCON says so, and until the program clears it.
#[test]
fn framing_errors_are_shown() {
    for (pcon, shown) in [(0x40, 0x80), (0, 0)] {
        let mut machine = listening(&[(PCON, pcon)]);
        let frame = LineFrame::byte(100, BIT, 0x5A).with_framing_error();
        machine.hear(frame);
        machine.run_until(2_000);
        let (byte, control) = take(&mut machine);
        assert_eq!((byte, control), (0x5A, 0x51 | shown));
    }
}

#[test]
fn a_break_is_a_zero_with_a_framing_error() {
    let mut machine = listening(&[(PCON, 0x40)]);
    machine.hear(LineFrame::long_break(100, BIT));
    machine.run_until(3_000);
    assert_eq!(take(&mut machine), (0, 0xD1));
}

/// The receiver samples by its own rate: 3 % off is heard, 10 % is not.
#[test]
fn a_wrong_rate_is_misread() {
    for (percent, is_right) in [(97, true), (100, true), (103, true), (90, false), (110, false)] {
        let mut right = 0;
        for byte in [0x00, 0x55, 0x5A, 0xA5, 0xFE, 0x80] {
            let mut machine = listening(&[(PCON, 0x40)]);
            machine.hear(LineFrame::byte(100, BIT * percent / 100, byte));
            machine.run_until(2_000);
            let (found, control) = take(&mut machine);
            right += u32::from(found == byte && control & 0x81 == 1);
        }
        assert_eq!(right == 6, is_right, "{percent}: {right}");
    }
}

/// Nine bits, and the address of one among many.
#[test]
fn a_chip_among_many_hears_its_address() {
    let many = [(SCON, 0xF0), (SADDR, 0xC5), (SADEN, 0xFD)];
    for (data, heard) in [
        (0x1C5, true),
        (0x1C7, true),
        (0x1FF, true),
        (0x1C4, false),
        (0x0C5, false),
    ] {
        let mut machine = listening(&many);
        machine.hear(LineFrame::nine_bits(100, BIT, data));
        machine.run_until(3_000);
        assert_eq!(machine.register(SCON) & 1 != 0, heard, "{data:#x}");
    }
}

#[test]
fn a_ninth_bit_is_sent() {
    let mut machine = listening(&[(SCON, 0xD8), (SBUF, 0x41)]);
    machine.run_until(5_000);
    let sent = machine.take_sent();
    assert_eq!((sent[0].byte, sent[0].ninth), (0x41, Some(true)));
}

/// P3.1 at 0 holds the line low.
#[test]
fn a_latch_can_hold_the_line() {
    let mut machine = listening(&[(0xB0, 0xFD), (SBUF, 0x41)]);
    machine.run_until(5_000);
    assert!(!machine.take_sent()[0].line_is_free);
}

/// Without REN, and without a rate, frames pass by.
#[test]
fn a_deaf_receiver_counts_what_it_misses() {
    let mut machine = listening(&[(SCON, 0x40)]);
    hear(&mut machine, 1);
    assert_eq!((take(&mut machine).1, machine.unheard()), (0x40, 1));
}
