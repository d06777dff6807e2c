//! Bytes from edges: every byte at every rate, inexact clocks, late interrupts, gaps, noise, broken frames.

use crate::line::{CLEAN, COUNTS_PER_S, Faults, Line, Random, bit_counts, good, hear};
use proptest::prelude::{Just, Strategy, any, prop, prop_oneof, proptest};
use soft_uart::{Baud, BitTime, Decoder, Edge, EdgeRing, Level, Queued, RateTrust, Received, Receiver};

const LATE: f64 = 0.25;
const ERROR: f64 = 0.025;

fn receiver(baud: Baud) -> Receiver {
    Receiver::starting_at(baud, COUNTS_PER_S)
}

#[test]
fn every_byte_arrives_at_every_rate_with_inexact_clocks_and_late_edges() {
    let all: Vec<u8> = (0..=255).collect();
    for baud in Baud::ALL {
        for clock_error in [-ERROR, 0.0, ERROR] {
            for late_bits in [0.0, LATE] {
                for pause in [0.0, 0.3, 7.0] {
                    let faults = Faults {
                        clock_error,
                        late_bits,
                    };
                    let mut line = Line::new(faults, 7);
                    for byte in &all {
                        line.byte(baud, *byte);
                        line.pause_bits(baud, pause);
                    }
                    let heard = hear(&line, &mut receiver(baud), u32::MAX - 3_000_000);
                    assert_eq!(heard, good(&all), "{baud:?} {faults:?} pause {pause}");
                }
            }
        }
    }
}

fn bauds() -> impl Strategy<Value = Baud> {
    prop::sample::select(&Baud::ALL[..])
}

/// How long a pulse of noise beside an edge is at most, in bits, if every second edge has one, and if all have, with clocks
/// that are `SLOW` apart at most.
const TOUCH_ONE: f64 = 0.19;
const TOUCH_ALL: f64 = 0.09;
const SLOW: f64 = 0.01;

/// A pulse that begins or ends nearer to an edge than it is long.
#[derive(Clone, Copy, Debug)]
struct Touch {
    is_before: bool,
    /// Its length, as a share of the longest.
    length: f64,
    /// Its distance from the edge, as a share of its length.
    distance: f64,
}

fn touches() -> impl Strategy<Value = Vec<Touch>> {
    let share = || prop_oneof![Just(1.0), 0.05..1.0];
    let touch = (any::<bool>(), share(), share()).prop_map(|(is_before, length, distance)| Touch {
        is_before,
        length,
        distance,
    });
    prop::collection::vec(touch, 400)
}

/// Puts one pulse of at most `longest` counts beside each edge for which `is_touched` holds.
fn touch_edges(line: &mut Line, longest: f64, touches: &[Touch], is_touched: impl Fn(usize) -> bool) {
    let edges = line.edges.clone();
    for (number, ((edge, _), touch)) in edges.iter().zip(touches).enumerate() {
        if is_touched(number) {
            let length = longest * touch.length;
            let distance = length * touch.distance;
            let begins = if touch.is_before {
                edge - distance - length
            } else {
                edge + distance
            };
            line.noise(begins, length);
        }
    }
}

proptest! {
    #[test]
    fn random_bytes_with_random_gaps_arrive(
        baud in bauds(),
        bytes in prop::collection::vec((any::<u8>(), prop_oneof![Just(0.0), 0.0..40.0]), 1..60),
        clock_error in -ERROR..ERROR,
        late_bits in 0.0..LATE,
        (seed, offset) in any::<(u64, u32)>(),
    ) {
        let mut line = Line::new(Faults { clock_error, late_bits }, seed);
        for (byte, pause) in &bytes {
            line.byte(baud, *byte);
            line.pause_bits(baud, *pause);
        }
        let sent: Vec<u8> = bytes.iter().map(|(byte, _)| *byte).collect();
        let mut receiver = receiver(baud);
        assert_eq!(hear(&line, &mut receiver, offset), good(&sent));
        assert_eq!(receiver.trust(), RateTrust::Locked(baud));
    }

    /// Pulses that are farther from all else than they are long, as many as find room.
    #[test]
    fn pulses_apart_change_nothing(
        baud in bauds(),
        bytes in prop::collection::vec(any::<u8>(), 1..40),
        clock_error in -ERROR..ERROR,
        late_bits in 0.0..LATE,
        (seed, offset) in any::<(u64, u32)>(),
    ) {
        let mut line = Line::new(Faults { clock_error, late_bits }, seed);
        let mut random = Random::new(seed);
        send_with_pauses(&mut line, baud, &bytes, &mut random);
        let bit = bit_counts(baud);
        let (start, length) = (50_000.0, line.time - 50_000.0);
        for _ in 0..6 * bytes.len() {
            line.noise_apart(start + random.share() * length, (0.01 + 0.37 * random.share()) * bit);
        }
        let mut receiver = receiver(baud);
        assert_eq!(hear(&line, &mut receiver, offset), good(&bytes));
        assert_eq!(receiver.rate(), Some(baud));
    }

    /// A pulse beside every second edge, before it or behind it.
    #[test]
    fn a_pulse_of_a_fifth_of_a_bit_beside_an_edge_changes_nothing(
        baud in bauds(),
        bytes in prop::collection::vec(any::<u8>(), 1..40),
        clock_error in -SLOW..SLOW,
        touches in touches(),
        first in 0_usize..2,
        (seed, offset) in any::<(u64, u32)>(),
    ) {
        let mut line = Line::new(Faults { clock_error, late_bits: 0.0 }, seed);
        send_with_pauses(&mut line, baud, &bytes, &mut Random::new(seed));
        touch_edges(&mut line, TOUCH_ONE * bit_counts(baud), &touches, |number| number % 2 == first);
        assert_eq!(hear(&line, &mut receiver(baud), offset), good(&bytes));
    }

    #[test]
    fn pulses_of_a_tenth_of_a_bit_beside_every_edge_change_nothing(
        baud in bauds(),
        bytes in prop::collection::vec(any::<u8>(), 1..40),
        clock_error in -SLOW..SLOW,
        touches in touches(),
        (seed, offset) in any::<(u64, u32)>(),
    ) {
        let mut line = Line::new(Faults { clock_error, late_bits: 0.0 }, seed);
        send_with_pauses(&mut line, baud, &bytes, &mut Random::new(seed));
        touch_edges(&mut line, TOUCH_ALL * bit_counts(baud), &touches, |_| true);
        assert_eq!(hear(&line, &mut receiver(baud), offset), good(&bytes));
    }
}

fn send_with_pauses(line: &mut Line, baud: Baud, bytes: &[u8], random: &mut Random) {
    for byte in bytes {
        line.byte(baud, *byte);
        line.pause_bits(baud, 3.0 * random.share());
    }
}

/// A pulse of 0.15 bits, 0.14 bits before the start bit, lets that one seem to begin 0.29 bits early, and one of 0.19 bits
/// behind the next edge lets this one seem to come 0.25 bits late: half a bit too much between them. A UART that looks at the
/// middle of each bit sees the same early start, and its first look at data falls into the second pulse.
#[test]
fn two_pulses_that_pull_two_edges_apart_spoil_a_byte_and_not_the_next() {
    let baud = Baud::B9600;
    let bit = bit_counts(baud);
    let mut line = Line::new(CLEAN, 1);
    let start = line.time;
    line.byte(baud, b'1');
    line.pause_bits(baud, 1.0);
    line.byte(baud, b'2');
    line.noise(start - 0.29 * bit, 0.15 * bit);
    line.noise(start + 1.06 * bit, 0.19 * bit);
    let heard = hear(&line, &mut receiver(baud), 0);
    assert_eq!(heard, [Received::FramingError, Received::Byte(b'2')]);
}

#[test]
fn noise_on_an_idle_line_is_no_byte() {
    let mut line = Line::new(CLEAN, 3);
    line.pause_ms(20.0);
    let bit = bit_counts(Baud::B115200);
    for number in 0..50 {
        line.noise(120_000.0 + f64::from(number) * 9_000.0, 0.35 * bit);
    }
    assert_eq!(line.edges.len(), 100);
    assert_eq!(hear(&line, &mut receiver(Baud::B115200), 0), []);
}

/// Pulses of almost half a bit in the midst of equal bits, and on an idle line.
#[test]
fn pulses_up_to_half_a_bit_between_other_edges_change_nothing() {
    let baud = Baud::B38400;
    let bit = bit_counts(baud);
    for byte in [0x00, 0xFF, 0x0F] {
        for share in [0.41, 0.45, 0.49] {
            for position in [2.6, 3.3, 6.7, 7.2] {
                let mut line = Line::new(CLEAN, 1);
                let start = line.time;
                line.byte(baud, byte);
                line.pause_bits(baud, 8.0);
                line.noise(start + position * bit, share * bit);
                line.noise(line.time - 4.0 * bit, share * bit);
                let heard = hear(&line, &mut receiver(baud), 0);
                assert_eq!(heard, good(&[byte]), "{byte:#x} {share} at {position}");
            }
        }
    }
}

/// The byte is there in the middle of the stop bit and not before, without any edge after it.
#[test]
fn a_byte_ends_by_time() {
    for byte in [0x00, 0x55, 0x7F, 0x80, 0xFF] {
        let mut line = Line::new(CLEAN, 1);
        let start = line.time;
        line.byte(Baud::B38400, byte);
        let bit = bit_counts(Baud::B38400);
        let mut decoder = Decoder::new(BitTime::new(Baud::B38400, COUNTS_PER_S));
        let mut heard = Vec::new();
        for (time, level) in &line.edges {
            let edge = Edge {
                at: *time as u32,
                level: *level,
            };
            decoder.edge(edge, &mut |received| heard.push(received));
        }
        decoder.poll((start + 9.45 * bit) as u32, &mut |received| heard.push(received));
        assert_eq!(heard, [], "{byte:#x}");
        decoder.poll((start + 9.55 * bit) as u32, &mut |received| heard.push(received));
        assert_eq!(heard, [Received::Byte(byte)], "{byte:#x}");
    }
}

#[test]
fn a_low_stop_bit_is_a_framing_error_and_the_next_byte_is_well() {
    let mut line = Line::new(CLEAN, 1);
    line.byte(Baud::B57600, b'a');
    line.frame(Baud::B57600, b'b', Level::Low);
    line.pause_bits(Baud::B57600, 2.0);
    line.byte(Baud::B57600, b'c');
    let heard = hear(&line, &mut receiver(Baud::B57600), 0);
    let expected = [Received::Byte(b'a'), Received::FramingError, Received::Byte(b'c')];
    assert_eq!(heard, expected);
}

#[test]
fn a_break_is_told_once_however_long_it_is() {
    for bits in [11.0, 3_000.0] {
        let mut line = Line::new(CLEAN, 1);
        line.byte(Baud::B57600, b'a');
        line.hold(Level::Low, Baud::B57600, bits);
        line.pause_bits(Baud::B57600, 1.0);
        line.byte(Baud::B57600, b'b');
        let heard = hear(&line, &mut receiver(Baud::B57600), 0);
        assert_eq!(
            heard,
            [Received::Byte(b'a'), Received::Break, Received::Byte(b'b')]
        );
    }
}

/// A handler that is late sees two changes as none: the level is what it was.
#[test]
fn an_edge_to_the_same_level_changes_nothing() {
    let mut line = Line::new(CLEAN, 1);
    line.bytes(Baud::B19200, b"xyz");
    let doubled: Vec<_> = line.edges.iter().flat_map(|edge| [*edge, *edge]).collect();
    line.edges = doubled;
    assert_eq!(hear(&line, &mut receiver(Baud::B19200), 0), good(b"xyz"));
}

/// A queue of 32 edges that nobody empties while five bytes come, then is emptied before the sixth.
#[test]
fn a_full_queue_is_an_overrun_at_its_place() {
    let ring: EdgeRing<32> = EdgeRing::new();
    let mut line = Line::new(CLEAN, 1);
    line.bytes(Baud::B115200, b"UUUUU");
    let burst_ends = line.time;
    line.pause_ms(2.0);
    line.byte(Baud::B115200, b'k');
    let mut receiver = receiver(Baud::B115200);
    let mut heard = Vec::new();
    let mut empty = |now: f64, ring: &EdgeRing<32>| {
        let mut sink = |received| heard.push(received);
        while let Some(queued) = ring.pop() {
            match queued {
                Queued::Edge(edge) => receiver.edge(edge, &mut sink),
                Queued::Overrun => receiver.overrun(&mut sink),
            }
        }
        receiver.poll(now as u32, &mut sink);
    };
    for (time, level) in &line.edges {
        if *time > burst_ends {
            empty(*time - 100.0, &ring);
        }
        ring.push(Edge {
            at: *time as u32,
            level: *level,
        });
    }
    empty(line.time + 1_000.0, &ring);
    let mut expected = good(b"UUU");
    expected.extend([Received::Overrun, Received::Byte(b'k')]);
    assert_eq!(heard, expected);
}
