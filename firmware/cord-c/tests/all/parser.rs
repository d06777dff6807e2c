//! Framing and commands: what the C cord says of a packet is what Rust says.

use crate::compiled::{answers, program};
use crate::expected::{Case, Question, TICK, golden, stream_case, text_case, vectors};
use crate::random::Random;
use cord_c::host::hex;
use rvac_protocol::crc::{Direction, packet_crc, to_hex};

/// Packets of the comparison, and with `RVAC_LONG=1`.
const PACKETS: usize = 4_000;
const PACKETS_LONG: usize = 1_000_000;
/// Packets that go to the program at a time.
const BATCH: usize = 20_000;
/// Most bytes of a packet.
const LENGTH_MAX: usize = 256;

pub(crate) fn packets() -> usize {
    if std::env::var_os("RVAC_LONG").is_some() {
        PACKETS_LONG
    } else {
        PACKETS
    }
}

/// A question as a line for the program.
fn line(question: &Question) -> String {
    match question {
        Question::Stream(session, bytes) => format!("F{session} {}", hex(bytes)),
        Question::Text(number, bytes) => format!("R{} {TICK} {}", number % 3, hex(bytes)),
    }
}

fn agree(cases: &[Case]) {
    let program = program("verdicts");
    for batch in cases.chunks(BATCH) {
        let lines: Vec<String> = batch
            .iter()
            .map(|(question, _)| format!("{}\n", line(question)))
            .collect();
        let found = answers(&program, &lines);
        for ((question, expected), found) in batch.iter().zip(&found) {
            assert_eq!(found, expected, "{}", line(question));
        }
    }
}

#[test]
fn golden_packets_mean_the_same() {
    agree(&golden());
}

/// Texts to begin with.
fn seeds() -> Vec<Vec<u8>> {
    let of_lines = vectors("commands").into_iter().map(|vector| {
        let line = vector["line"].as_str().expect("a line").to_owned();
        line.rsplit_once('*').expect("a CRC").0.as_bytes().to_vec()
    });
    let of_texts = vectors("refused").into_iter().chain(vectors("tolerated"));
    let of_texts = of_texts.map(|vector| vector["text"].as_str().expect("a text").as_bytes().to_vec());
    of_lines.chain(of_texts).collect()
}

/// Pieces that matter to a parser.
const PIECES: [&[u8]; 24] = [
    b"\"",
    b"{",
    b"}",
    b"[",
    b"]",
    b",",
    b":",
    b"\\",
    b"\\u00e9",
    b"-",
    b"0",
    b"9",
    b".5",
    b"e1",
    b"E-3",
    b"true",
    b"null",
    b" ",
    b"\"c\":\"stop\",",
    b"\"n\":7,",
    b"\"later\":[1,{\"a\":[]}],",
    b"\xC3\xA9",
    b"\xFF",
    b"4294967295",
];

/// A packet that is damaged in up to four places; one in eight stays as it is.
fn mutated(random: &mut Random, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut text = seeds[random.below(seeds.len())].clone();
    for _ in 0..random.below(5).saturating_sub(random.below(2)) {
        let at = random.below(text.len() + 1);
        match random.below(7) {
            0 if at < text.len() => text[at] ^= 1 << random.below(8),
            1 if at < text.len() => drop(text.remove(at)),
            2 => text.truncate(at),
            3 => {
                let other = &seeds[random.below(seeds.len())];
                text.truncate(at);
                text.extend(&other[random.below(other.len())..]);
            }
            4 if at < text.len() => text[at] = random.next() as u8,
            _ => drop(text.splice(at..at, PIECES[random.below(PIECES.len())].iter().copied())),
        }
    }
    text.truncate(LENGTH_MAX);
    text
}

#[test]
fn valid_and_broken_commands_get_the_same_verdict() {
    let (mut random, seeds) = (Random::new(33), seeds());
    let cases: Vec<_> = (0..packets())
        .map(|number| text_case(&mutated(&mut random, &seeds), number))
        .collect();
    let accepted = cases
        .iter()
        .filter(|(_, verdict)| verdict.contains("command"))
        .count();
    assert!(
        accepted > cases.len() / 10 && accepted < cases.len() * 9 / 10,
        "{accepted} accepted"
    );
    agree(&cases);
}

/// A stream of some packets: text and binary, sealed and not, with damage.
fn stream(random: &mut Random, seeds: &[Vec<u8>], session: u16) -> Vec<u8> {
    let mut out = Vec::new();
    for _ in 0..1 + random.below(3) {
        let mut packet = if random.below(4) == 0 {
            let length = random.below(30);
            std::iter::once(0x80 | random.next() as u8)
                .chain((0..length).map(|_| random.next() as u8))
                .collect()
        } else {
            mutated(random, seeds)
        };
        let crc = packet_crc(Direction::HostToRobot, session, &packet);
        if packet.first().is_some_and(|kind| *kind >= 0x80) {
            packet.extend(crc.to_le_bytes());
            let kind = packet.remove(0);
            out.push(kind);
            for byte in packet {
                match byte {
                    0x1D..=0x1F => out.extend([0x1D, byte ^ 0x20]),
                    _ => out.push(byte),
                }
            }
        } else {
            out.extend(&packet);
            if random.below(4) > 0 {
                out.push(b'*');
                out.extend(to_hex(crc));
            }
        }
        if random.below(4) == 0 && !out.is_empty() {
            let at = random.below(out.len());
            out[at] ^= 1 << random.below(8);
        }
        out.push(if random.below(9) == 0 { 0x1E } else { 0x1F });
    }
    out
}

#[test]
fn streams_fall_into_the_same_packets() {
    let (mut random, seeds) = (Random::new(34), seeds());
    let cases: Vec<_> = (0..packets() / 2)
        .map(|_| {
            let session = random.next() as u16;
            stream_case(&stream(&mut random, &seeds, session), session)
        })
        .collect();
    agree(&cases);
}
