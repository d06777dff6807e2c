//! The rate: found from `U`, found again after a restart of either side, kept when there is noise.

use crate::line::{CLEAN, COUNTS_PER_S, Faults, Line, Random, bit_counts, good, hear};
use soft_uart::{Baud, BitTime, Level, RateTrust, Received, Receiver};

/// What a host sends until it is answered, and what follows.
const GREETING: &[u8] = b"U\nhello 3 17 a9c2\n";

fn automatic() -> Receiver {
    Receiver::automatic(COUNTS_PER_S)
}

fn ends_with(heard: &[Received], bytes: &[u8]) -> bool {
    heard.ends_with(&good(bytes))
}

#[test]
fn one_letter_gives_the_rate_and_everything_after_it_arrives() {
    for baud in Baud::ALL {
        for clock_error in [-0.025, 0.0, 0.025] {
            let mut line = Line::new(
                Faults {
                    clock_error,
                    late_bits: 0.05,
                },
                5,
            );
            line.bytes(baud, GREETING);
            let mut receiver = automatic();
            let heard = hear(&line, &mut receiver, u32::MAX - 105_000);
            assert_eq!(receiver.trust(), RateTrust::Locked(baud), "{clock_error}");
            assert_eq!(heard, good(&GREETING[1..]), "{baud:?} {clock_error}");
        }
    }
}

/// Edges up to a quarter of a bit late, the clock up to 2.5 % off: of the first letters nearly all are enough, and with the
/// third repeat all are. A rate that is not the sender's is never taken.
#[test]
fn late_edges_cost_a_repeat_at_most_now_and_then() {
    let mut random = Random::new(11);
    let (mut first, mut all) = (0_u32, 0_u32);
    for seed in 0..2_000 {
        let baud = Baud::ALL[random.below(6) as usize];
        let faults = Faults {
            clock_error: 0.05 * (random.share() - 0.5),
            late_bits: 0.25,
        };
        let mut line = Line::new(faults, seed);
        let mut receiver = automatic();
        let mut found = None;
        for repeat in 0..4 {
            line.edges.clear();
            line.bytes(baud, GREETING);
            line.pause_ms(5.0);
            hear(&line, &mut receiver, seed as u32);
            if receiver.rate().is_some() && found.is_none() {
                found = Some(repeat);
            }
        }
        assert_eq!(receiver.rate(), Some(baud), "{faults:?} seed {seed}");
        all += 1;
        first += u32::from(found == Some(0));
    }
    assert!(first * 100 >= all * 97, "{first} of {all} at the first letter");
}

#[test]
fn data_without_the_letter_gives_no_rate() {
    for baud in Baud::ALL {
        let mut line = Line::new(CLEAN, 1);
        line.bytes(
            baud,
            b"state 1 2 3 -4 5\nlog something happened\n\0\xFF\x0F\xF0\x33\xCC",
        );
        let mut receiver = automatic();
        assert_eq!(hear(&line, &mut receiver, 0), []);
        assert_eq!(receiver.trust(), RateTrust::Listening, "{baud:?}");
    }
}

/// Ten edges at a pace that no machine uses, and at a known pace but uneven.
#[test]
fn implausible_letters_are_refused() {
    for (pace, uneven) in [(0.9, 0.0), (1.1, 0.0), (0.5, 0.0), (1.0, 0.45)] {
        let mut line = Line::new(CLEAN, 1);
        let bit = bit_counts(Baud::B9600) * pace;
        let mut level = Level::Low;
        for edge in 0..10 {
            let shift = if edge == 4 { uneven } else { 0.0 };
            line.edges
                .push((200_000.0 + bit * (f64::from(edge) + shift), level));
            level = level.inverted();
        }
        line.time = 300_000.0;
        let mut receiver = automatic();
        hear(&line, &mut receiver, 0);
        let expected = if pace == 0.5 { Some(Baud::B19200) } else { None };
        assert_eq!(receiver.rate(), expected, "pace {pace} uneven {uneven}");
    }
}

/// The host comes back with another rate: it greets every 250 ms. Two greetings are enough for each pair of rates, also
/// with inexact clocks, and what follows arrives whole.
#[test]
fn a_host_that_restarts_at_another_rate_is_understood_again() {
    for before in Baud::ALL {
        for after in Baud::ALL {
            for clock_error in [-0.02, 0.02] {
                let mut line = Line::new(
                    Faults {
                        clock_error,
                        late_bits: 0.1,
                    },
                    9,
                );
                line.bytes(before, GREETING);
                line.bytes(before, b"lease 500\nmotor 1 0\n");
                line.pause_ms(50.0);
                for _ in 0..2 {
                    line.bytes(after, GREETING);
                    line.pause_ms(250.0);
                }
                line.bytes(after, b"lease 500\n");
                let mut receiver = automatic();
                let heard = hear(&line, &mut receiver, 77);
                assert_eq!(
                    receiver.rate(),
                    Some(after),
                    "{before:?} -> {after:?} {clock_error}"
                );
                assert!(
                    ends_with(&heard, b"lease 500\n"),
                    "{before:?} -> {after:?}: {heard:?}"
                );
                let wrong = heard
                    .iter()
                    .filter(|one| !matches!(one, Received::Byte(_)))
                    .count();
                assert!(before != after || wrong == 0);
            }
        }
    }
}

/// At a third of the rate the letter itself looks like data. The damaged bytes after it show what it was, without a second
/// greeting.
#[test]
fn one_letter_at_a_third_of_the_rate_is_remembered() {
    for (before, after) in [(Baud::B115200, Baud::B38400), (Baud::B57600, Baud::B19200)] {
        let mut line = Line::new(CLEAN, 1);
        line.bytes(before, GREETING);
        line.pause_ms(50.0);
        line.byte(after, b'U');
        line.pause_ms(2.0);
        let mut receiver = automatic();
        hear(&line, &mut receiver, 0);
        assert_eq!(
            receiver.trust(),
            RateTrust::Locked(before),
            "nothing was wrong yet"
        );
        line.edges.clear();
        line.bytes(after, b"\nhello 3 17 a9c2\n");
        line.pause_ms(2.0);
        line.bytes(after, b"lease 500\n");
        let heard = hear(&line, &mut receiver, 0);
        assert_eq!(receiver.rate(), Some(after));
        assert!(ends_with(&heard, b"lease 500\n"), "{heard:?}");
    }
}

/// What looked like a slower letter is forgotten after enough good bytes: errors then do not lead to its rate.
#[test]
fn a_remembered_rate_is_forgotten() {
    let baud = Baud::B115200;
    for (good_bytes, expected) in [(4, Baud::B38400), (40, baud)] {
        let mut line = Line::new(CLEAN, 1);
        for _ in 0..4 {
            line.byte(baud, 0x1C);
            line.pause_bits(baud, 2.0);
        }
        line.bytes(baud, &vec![b'x'; good_bytes]);
        line.frame(baud, 0x41, Level::Low);
        line.pause_bits(baud, 3.0);
        line.frame(baud, 0x41, Level::Low);
        line.pause_bits(baud, 3.0);
        let mut receiver = Receiver::starting_at(baud, COUNTS_PER_S);
        hear(&line, &mut receiver, 0);
        assert_eq!(receiver.rate(), Some(expected), "after {good_bytes} good bytes");
    }
}

/// The robot restarts in the midst of data: it listens, and the next greeting is enough.
#[test]
fn a_receiver_that_restarts_within_data_waits_for_a_greeting() {
    let mut line = Line::new(CLEAN, 1);
    line.bytes(Baud::B230400, b"nd of a packet\nstate 5\n");
    line.pause_ms(3.0);
    line.bytes(Baud::B230400, GREETING);
    let heard = hear(&line, &mut automatic(), 0);
    assert_eq!(heard, good(&GREETING[1..]));
}

/// Noise of every kind while bytes come: some are damaged, the rate stays, and after it all arrives.
#[test]
fn noise_never_loses_a_working_rate() {
    for seed in 0..300 {
        let mut random = Random::new(seed);
        let baud = Baud::ALL[random.below(6) as usize];
        let bit = bit_counts(baud);
        let mut line = Line::new(CLEAN, seed);
        line.bytes(baud, GREETING);
        let begin = line.time;
        for _ in 0..40 {
            line.byte(baud, random.byte());
        }
        let end = line.time;
        for _ in 0..1 + random.below(30) {
            let at = begin + random.share() * (end - begin);
            line.noise(at, bit * 1.5 * random.share());
        }
        line.pause_ms(2.0);
        line.bytes(baud, b"after the noise\n");
        let mut receiver = automatic();
        let heard = hear(&line, &mut receiver, 0);
        assert_eq!(receiver.rate(), Some(baud), "seed {seed}");
        assert!(ends_with(&heard, b"after the noise\n"), "seed {seed} {baud:?}");
    }
}

/// Data that looks like the letter at a third of the rate: 0x1C with pauses of two bits is three bits low, three high ..
#[test]
fn data_that_looks_like_a_slower_letter_is_data() {
    let mut line = Line::new(CLEAN, 1);
    line.bytes(Baud::B115200, GREETING);
    for _ in 0..4 {
        line.byte(Baud::B115200, 0x1C);
        line.pause_bits(Baud::B115200, 2.0);
    }
    line.bytes(Baud::B115200, b"more\n");
    let mut receiver = automatic();
    let heard = hear(&line, &mut receiver, 0);
    assert_eq!(receiver.trust(), RateTrust::Locked(Baud::B115200));
    let mut expected = GREETING[1..].to_vec();
    expected.extend([0x1C; 4]);
    expected.extend(b"more\n");
    assert_eq!(heard, good(&expected));
}

#[test]
fn many_framing_errors_make_the_rate_doubtful_and_good_bytes_mend_it() {
    let mut line = Line::new(CLEAN, 1);
    for _ in 0..6 {
        line.frame(Baud::B57600, 0x41, Level::Low);
        line.pause_bits(Baud::B57600, 3.0);
    }
    let mut receiver = Receiver::starting_at(Baud::B57600, COUNTS_PER_S);
    hear(&line, &mut receiver, 0);
    assert_eq!(receiver.trust(), RateTrust::Doubtful(Baud::B57600));
    let mut line = Line::new(CLEAN, 1);
    line.bytes(Baud::B57600, b"0123456789");
    hear(&line, &mut receiver, 0);
    assert_eq!(receiver.trust(), RateTrust::Locked(Baud::B57600));
}

#[test]
fn rates_are_parsed_exactly() {
    assert_eq!(Baud::from_bits_per_second(57_600), Some(Baud::B57600));
    assert_eq!(Baud::from_bits_per_second(57_601), None);
    assert_eq!(BitTime::new(Baud::B230400, 80_000_000).counts(), 347);
    assert_eq!(BitTime::new(Baud::B9600, 0).parts().get(), 1);
}
