//! Sending, both directions at once, sampling, and the queues.

use crate::line::{CLEAN, COUNTS_PER_S, Faults, Line, Random, bit_counts, good, hear};
use soft_uart::{
    Baud, BitTime, ByteRing, Due, Edge, EdgeRing, Level, Queued, Received, Receiver, Sampler, Transmitter,
};

/// Counts of the sending timer a second.
const TIMER_PER_S: u32 = 80_000_000;

/// Plays the timer's interrupt until nothing is left; gives the changes of the pin in counts of the timer, and the end.
fn play(transmitter: &mut Transmitter, bytes: &ByteRing<256>) -> (Vec<(u64, Level)>, u64) {
    let (mut time, mut pin, mut edges) = (0_u64, Level::High, Vec::new());
    transmitter.prepare(|| bytes.pop());
    while let Due::Run { level, counts } = transmitter.due() {
        if level != pin {
            edges.push((time, level));
            pin = level;
        }
        time += u64::from(counts);
        transmitter.prepare(|| bytes.pop());
    }
    assert_eq!(pin, Level::High, "a line that nobody sends on is high");
    (edges, time)
}

#[test]
fn what_is_sent_is_received_at_every_rate() {
    for baud in Baud::ALL {
        let bytes = ByteRing::new();
        let all: Vec<u8> = (0..=255).collect();
        assert_eq!(bytes.push(&all), 256);
        let mut transmitter = Transmitter::new(BitTime::new(baud, TIMER_PER_S));
        let (edges, end) = play(&mut transmitter, &bytes);
        // 256 frames of 10 bits without a gap, exact to a count over all of them.
        let exact = 2_560.0 * f64::from(TIMER_PER_S) / f64::from(baud.bits_per_second());
        assert!(
            (end as f64 - exact).abs() < 6.0,
            "{baud:?}: {end} instead of {exact}"
        );
        let mut line = Line::new(CLEAN, 1);
        line.edges = edges
            .iter()
            .map(|(time, level)| (*time as f64 / 2.0, *level))
            .collect();
        line.time = end as f64 / 2.0;
        let mut receiver = Receiver::starting_at(baud, COUNTS_PER_S);
        assert_eq!(hear(&line, &mut receiver, 0), good(&all));
    }
}

/// The interrupt comes once for each change: 0x00 and 0xFF need three visits, 0x55 ten.
#[test]
fn equal_bits_are_one_wait() {
    let runs = |byte: u8| {
        let bytes = ByteRing::<256>::new();
        bytes.push(&[byte]);
        let mut transmitter = Transmitter::new(BitTime::new(Baud::B115200, TIMER_PER_S));
        let mut lengths = Vec::new();
        transmitter.prepare(|| bytes.pop());
        while let Due::Run { level, counts } = transmitter.due() {
            lengths.push((level, (f64::from(counts) / 694.4).round() as u32));
            transmitter.prepare(|| bytes.pop());
        }
        lengths
    };
    assert_eq!(runs(0xFF), [(Level::Low, 1), (Level::High, 9)]);
    assert_eq!(runs(0x00), [(Level::Low, 9), (Level::High, 1)]);
    assert_eq!(runs(0x55).len(), 10);
    assert_eq!(runs(0xF0), [(Level::Low, 5), (Level::High, 5)]);
}

/// At 9600 baud a whole byte would not fit into a timer of 16 bits at 80 MHz: the run is cut, the pin is set to the level that
/// it has.
#[test]
fn long_runs_fit_into_sixteen_bits() {
    let bytes = ByteRing::<256>::new();
    bytes.push(&[0xFF, 0x00]);
    let mut transmitter = Transmitter::new(BitTime::new(Baud::B9600, TIMER_PER_S));
    let (mut total, mut longest) = (0, 0);
    transmitter.prepare(|| bytes.pop());
    while let Due::Run { counts, .. } = transmitter.due() {
        total += counts;
        longest = longest.max(counts);
        transmitter.prepare(|| bytes.pop());
    }
    assert!(longest <= 0xFFFF, "{longest}");
    assert_eq!((total + 5) / 10, 16_667);
}

/// Both directions at once, each at full speed, the interrupts of both in the order of time. Neither changes the other.
#[test]
fn both_directions_at_once_are_byte_exact() {
    let baud = Baud::B230400;
    let mut random = Random::new(21);
    let incoming: Vec<u8> = (0..2_000).map(|_| random.byte()).collect();
    let outgoing: Vec<u8> = (0..2_000).map(|_| random.byte()).collect();
    let mut line = Line::new(
        Faults {
            clock_error: 0.01,
            late_bits: 0.2,
        },
        2,
    );
    line.bytes(baud, &incoming);

    let (edges, bytes) = (EdgeRing::<256>::new(), ByteRing::<64>::new());
    let mut transmitter = Transmitter::new(BitTime::new(baud, TIMER_PER_S));
    let mut receiver = Receiver::starting_at(baud, COUNTS_PER_S);
    let mut listener = Receiver::starting_at(baud, COUNTS_PER_S);
    let (mut heard, mut sent) = (Vec::new(), Vec::new());
    let (mut queued, mut pin, mut timer) = (0, Level::High, None::<f64>);
    let mut arriving = line.edges.iter().peekable();
    let mut look = 0.0;
    while look < line.time + 400_000.0 {
        look += 40_000.0;
        loop {
            let edge = arriving.peek().map_or(f64::MAX, |(time, _)| *time);
            let due = timer.unwrap_or(f64::MAX);
            if edge.min(due) >= look {
                break;
            }
            if edge <= due {
                let (time, level) = arriving.next().expect("it was there");
                edges.push(Edge {
                    at: *time as u32,
                    level: *level,
                });
                continue;
            }
            timer = match transmitter.due() {
                Due::Run { level, counts } => {
                    if level != pin {
                        let at = due as u32;
                        listener.edge(Edge { at, level }, &mut |received| sent.push(received));
                        pin = level;
                    }
                    transmitter.prepare(|| bytes.pop());
                    Some(due + f64::from(counts) / 2.0)
                }
                Due::Idle => None,
            };
        }
        while let Some(Queued::Edge(edge)) = edges.pop() {
            receiver.edge(edge, &mut |received| heard.push(received));
        }
        receiver.poll(look as u32, &mut |received| heard.push(received));
        queued += bytes.push(&outgoing[queued..]);
        if timer.is_none() && !bytes.is_empty() {
            transmitter.prepare(|| bytes.pop());
            timer = Some(look);
        }
    }
    listener.poll(look as u32, &mut |received| sent.push(received));
    assert_eq!(heard, good(&incoming));
    assert_eq!(sent, good(&outgoing));
}

#[test]
fn samples_at_three_times_the_rate_give_every_byte() {
    let baud = Baud::B57600;
    for clock_error in [-0.025, 0.0, 0.025] {
        for phase in 0..10 {
            let mut line = Line::new(
                Faults {
                    clock_error,
                    late_bits: 0.0,
                },
                1,
            );
            let mut random = Random::new(phase);
            let all: Vec<u8> = (0..=255).collect();
            for byte in &all {
                line.byte(baud, *byte);
                line.pause_bits(baud, if phase % 2 == 0 { 0.0 } else { 5.0 * random.share() });
            }
            line.pause_bits(baud, 4.0);
            assert_eq!(
                sample(&line, baud, phase),
                good(&all),
                "{clock_error} phase {phase}"
            );
        }
    }
}

fn sample(line: &Line, baud: Baud, phase: u64) -> Vec<Received> {
    let mut sampler = Sampler::new();
    let step = bit_counts(baud) / f64::from(Sampler::SAMPLES_PER_BIT);
    let mut time = step * phase as f64 / 10.0;
    let (mut level, mut edges, mut heard) = (Level::High, line.edges.iter().peekable(), Vec::new());
    while time < line.time {
        while let Some((_, after)) = edges.next_if(|(at, _)| *at <= time) {
            level = *after;
        }
        heard.extend(sampler.sample(level));
        time += step;
    }
    heard
}

#[test]
fn samples_show_framing_errors_breaks_and_no_noise() {
    let baud = Baud::B9600;
    let mut line = Line::new(CLEAN, 1);
    line.byte(baud, b'a');
    line.frame(baud, b'b', Level::Low);
    line.pause_bits(baud, 2.0);
    line.hold(Level::Low, baud, 30.0);
    line.pause_bits(baud, 2.0);
    let quiet = line.time;
    line.pause_bits(baud, 4.0);
    line.byte(baud, b'c');
    line.pause_bits(baud, 4.0);
    line.noise(quiet + 0.5 * bit_counts(baud), 0.3 * bit_counts(baud));
    let expected = [
        Received::Byte(b'a'),
        Received::FramingError,
        Received::Break,
        Received::Byte(b'c'),
    ];
    assert_eq!(sample(&line, baud, 3), expected);
}

/// After a loss nothing is taken until the loss was told, even when there is room: else the mark would have no place.
#[test]
fn a_gap_has_one_place() {
    let ring: EdgeRing<4> = EdgeRing::new();
    let edge = |at| Edge {
        at,
        level: Level::High,
    };
    (0..6).for_each(|number| ring.push(edge(2 * number)));
    assert_eq!(ring.pop(), Some(Queued::Edge(edge(0))));
    ring.push(edge(100));
    for at in [2, 4, 6] {
        assert_eq!(ring.pop(), Some(Queued::Edge(edge(at))));
    }
    assert_eq!(ring.pop(), Some(Queued::Overrun));
    ring.push(edge(200));
    assert_eq!(ring.pop(), Some(Queued::Edge(edge(200))));
    assert_eq!(ring.pop(), None);
}

/// One thread pushes, the other takes: nothing is lost, doubled or out of order, and at the place of a loss there is a mark. An
/// interrupt runs to its end before the main loop goes on; a thread may lose an edge while the other one takes the mark of
/// those before, so here two marks may follow each other, each for an edge of its own.
#[test]
fn queues_hold_between_two_threads() {
    static EDGES: EdgeRing<16> = EdgeRing::new();
    const COUNT: u32 = 200_000;
    let producer = std::thread::spawn(|| {
        for number in 0..COUNT {
            EDGES.push(Edge {
                at: number * 2,
                level: Level::of_bit(number),
            });
            if number % 64 == 0 {
                std::thread::yield_now();
            }
        }
    });
    let mut next = 0;
    let (mut taken, mut gaps) = (0_u32, 0_u32);
    let mut after_gap = false;
    loop {
        let finished = producer.is_finished();
        match EDGES.pop() {
            Some(Queued::Edge(edge)) => {
                let number = edge.at / 2;
                assert_eq!(edge.level, Level::of_bit(number));
                assert!(
                    if after_gap { number > next } else { number == next },
                    "{number} after {next}"
                );
                (next, after_gap) = (number + 1, false);
                taken += 1;
            }
            Some(Queued::Overrun) => {
                after_gap = true;
                gaps += 1;
            }
            None if finished => break,
            None => std::thread::yield_now(),
        }
    }
    producer.join().expect("the producer ends well");
    assert!(
        taken > 0 && taken + gaps <= COUNT && (gaps > 0 || taken == COUNT),
        "{taken} taken, {gaps} gaps"
    );
}

#[test]
fn a_full_byte_queue_takes_what_fits() {
    let ring: ByteRing<8> = ByteRing::new();
    assert_eq!(ring.push(b"abcdef"), 6);
    assert_eq!(ring.push(b"ghijkl"), 2);
    assert_eq!(ring.push(b"m"), 0);
    assert_eq!(ring.len(), 8);
    let taken: Vec<u8> = std::iter::from_fn(|| ring.pop()).collect();
    assert_eq!(taken, b"abcdefgh");
    assert!(ring.is_empty());
}
