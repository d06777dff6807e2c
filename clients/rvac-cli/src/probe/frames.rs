//! Finds the frames of an unknown module in its output at rest and during turns in both directions.

use std::fmt;

/// Longest frame that is searched for.
const LENGTH_MAX: usize = 64;
/// Frames that must be there before anything is believed.
const FRAMES_MIN: usize = 20;
/// Share of frames in which a byte of the head must be the same.
const CONSTANT: f64 = 0.98;
/// How many times its own noise a field must answer to a turn.
const ANSWERS: f64 = 8.0;

/// The bytes received in the three parts of a recording.
#[derive(Debug, Default)]
pub(super) struct Recording {
    /// While the robot was at rest.
    pub(super) rest: Vec<u8>,
    /// While it was turned counter-clockwise.
    pub(super) left: Vec<u8>,
    /// While it was turned clockwise.
    pub(super) right: Vec<u8>,
    /// Length of each turned part by the robot's clock, seconds.
    pub(super) part_s: f64,
}

/// By so much the robot is turned in each part, degrees.
const TURNED_DEGREES: f64 = 360.0;

/// The form of frames.
#[derive(Debug, PartialEq)]
pub(super) struct Frames {
    /// Bytes that begin each frame.
    pub(super) head: Vec<u8>,
    /// Length with the head.
    pub(super) length: usize,
    /// How the last byte is made, if that was found.
    pub(super) check: Option<Check>,
    /// Fields that answer to turns, best first.
    pub(super) fields: Vec<Field>,
}

/// A check value in the last byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Check {
    kind: CheckKind,
    /// First byte that goes into it.
    from: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CheckKind {
    Sum,
    NegatedSum,
    Xor,
}

/// A number in the frame that answers to turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Field {
    /// Its first byte.
    pub(super) offset: usize,
    /// How it is stored.
    pub(super) form: Form,
    /// Its meaning.
    pub(super) meaning: Meaning,
    /// Whether it grows counter-clockwise.
    pub(super) rises_left: bool,
    /// Steps of it for a degree, or for a degree a second.
    pub(super) steps: f64,
    /// Its answer in multiples of its noise.
    pub(super) clarity: f64,
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    I16Little,
    I16Big,
    I32Little,
    I32Big,
}

/// The meaning of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// Higher while it turns.
    Rate,
    /// Changes all the while it turns.
    Heading,
}

impl Frames {
    /// Looks for the shortest frame that explains the recording.
    pub(super) fn find(recording: &Recording) -> Option<Self> {
        let parts = [&recording.rest, &recording.left, &recording.right];
        let (length, head) = (2..=LENGTH_MAX).find_map(|length| head_of(&parts, length))?;
        let [rest, left, right] = parts.map(|bytes| split(bytes, &head, length));
        if rest.len() < FRAMES_MIN {
            return None;
        }
        let all: Vec<&[u8]> = [&rest, &left, &right].into_iter().flatten().copied().collect();
        let check = Check::find(&all);
        let end = length - usize::from(check.is_some());
        Some(Self {
            fields: fields([&rest, &left, &right], head.len()..end, recording.part_s),
            head,
            length,
            check,
        })
    }
}

/// The head of frames of this length, if there are such frames: two or three bytes that are in nearly all of them, in all
/// parts. What only seems constant because nothing moved is gone once the robot was turned; of what remains, bytes other
/// than 00 and FF are the likelier head, since those are also the upper halves of small numbers.
fn head_of(parts: &[&Vec<u8>; 3], length: usize) -> Option<(usize, Vec<u8>)> {
    let rest = parts[0];
    if rest.len() < length * FRAMES_MIN {
        return None;
    }
    let constants: Vec<Option<u8>> = (0..length).map(|place| constant(rest, place, length)).collect();
    if constants.iter().all(Option::is_some) && parts.iter().all(|part| *part == rest) {
        return None;
    }
    // The phase is that of the recording: a head may go around its end.
    let head_at = |start: usize, size: usize| -> Option<Vec<u8>> {
        (0..size.min(length))
            .map(|step| constants[(start + step) % length])
            .collect()
    };
    let believed = |head: &Vec<u8>| {
        let whole = |part: &Vec<u8>| split(part, head, length).len() * length * 10 >= part.len() * 8;
        parts.iter().all(|part| whole(part))
    };
    let telling = |head: &Vec<u8>| head.iter().filter(|byte| !matches!(byte, 0 | 0xFF)).count();
    (0..length)
        .flat_map(|start| [2, 3].map(|size| head_at(start, size)))
        .flatten()
        .filter(believed)
        .max_by_key(|head| (telling(head), std::cmp::Reverse(head.len())))
        .map(|head| (length, head))
}

/// The byte at `place` of nearly all pieces of `length`.
fn constant(bytes: &[u8], place: usize, length: usize) -> Option<u8> {
    let mut counts = [0_usize; 256];
    let column = bytes.iter().skip(place).step_by(length);
    let mut total = 0_usize;
    for byte in column {
        counts[usize::from(*byte)] += 1;
        total += 1;
    }
    let (byte, count) = (0_u8..=255).zip(counts).max_by_key(|(_, count)| *count)?;
    (count as f64 >= total as f64 * CONSTANT).then_some(byte)
}

/// The whole frames: each begins with the head and is followed by another head or the end.
fn split<'a>(bytes: &'a [u8], head: &[u8], length: usize) -> Vec<&'a [u8]> {
    let mut frames = Vec::new();
    let mut at = 0;
    while let Some(frame) = bytes.get(at..at + length) {
        let rest = &bytes[at + length..];
        let next = &head[..head.len().min(rest.len())];
        if frame.starts_with(head) && rest.starts_with(next) {
            frames.push(frame);
            at += length;
        } else {
            at += 1;
        }
    }
    frames
}

impl Check {
    const KINDS: [CheckKind; 3] = [CheckKind::Sum, CheckKind::NegatedSum, CheckKind::Xor];

    fn find(frames: &[&[u8]]) -> Option<Self> {
        let fits = |check: &Self| frames.iter().all(|frame| check.holds(frame));
        // A byte that never changes checks nothing.
        let lasts = frames.iter().filter_map(|frame| frame.last());
        if lasts.clone().min() == lasts.clone().max() {
            return None;
        }
        (0..4)
            .flat_map(|from| Self::KINDS.map(|kind| Self { kind, from }))
            .find(fits)
    }

    fn holds(&self, frame: &[u8]) -> bool {
        let Some((last, body)) = frame.split_last() else {
            return false;
        };
        let body = body.get(self.from..).unwrap_or_default();
        let sum = body.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        *last
            == match self.kind {
                CheckKind::Sum => sum,
                CheckKind::NegatedSum => sum.wrapping_neg(),
                CheckKind::Xor => body.iter().fold(0, |xor, byte| xor ^ byte),
            }
    }
}

impl Form {
    const ALL: [Self; 4] = [Self::I16Little, Self::I16Big, Self::I32Little, Self::I32Big];

    const fn size(self) -> usize {
        match self {
            Self::I16Little | Self::I16Big => 2,
            Self::I32Little | Self::I32Big => 4,
        }
    }

    fn read(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Self::I16Little => f64::from(i16::from_le_bytes(bytes.get(..2)?.try_into().ok()?)),
            Self::I16Big => f64::from(i16::from_be_bytes(bytes.get(..2)?.try_into().ok()?)),
            Self::I32Little => f64::from(i32::from_le_bytes(bytes.get(..4)?.try_into().ok()?)),
            Self::I32Big => f64::from(i32::from_be_bytes(bytes.get(..4)?.try_into().ok()?)),
        })
    }
}

/// What a byte of all frames does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    /// Always the same.
    Constant(u8),
    /// Counts frames, whether the robot turns or not.
    Counter,
    /// 00 and FF only: the upper bytes of a small number.
    Sign,
    /// Anything else.
    Free,
}

impl Column {
    fn of(parts: [&Vec<&[u8]>; 3], place: usize) -> Self {
        let [rest, ..] = parts;
        let at = |frame: &&[u8]| frame.get(place).copied();
        let seen: std::collections::BTreeSet<u8> = parts.into_iter().flatten().filter_map(at).collect();
        let resting: Vec<u8> = rest.iter().filter_map(at).collect();
        let step = |pair: &[u8]| pair[1].wrapping_sub(pair[0]);
        let first = resting.windows(2).next().map_or(0, step);
        let alike = resting.windows(2).filter(|pair| step(pair) == first).count();
        match (seen.first(), seen.len()) {
            (Some(byte), 1) => Self::Constant(*byte),
            _ if first != 0 && alike * 10 >= resting.len() * 9 => Self::Counter,
            _ if seen.iter().all(|byte| matches!(byte, 0 | 0xFF)) => Self::Sign,
            _ => Self::Free,
        }
    }
}

/// Whether these bytes can be a number that answers to turns: the lowest moves, and the highest is no status.
fn can_be_number(columns: &[Column], form: Form) -> bool {
    let (Some(first), Some(last)) = (columns.first(), columns.last()) else {
        return false;
    };
    let (lowest, highest) = match form {
        Form::I16Little | Form::I32Little => (first, last),
        Form::I16Big | Form::I32Big => (last, first),
    };
    *lowest == Column::Free
        && !columns.contains(&Column::Counter)
        && !matches!(highest, Column::Constant(1..=0xFE))
}

fn fields(parts: [&Vec<&[u8]>; 3], payload: std::ops::Range<usize>, part_s: f64) -> Vec<Field> {
    let columns: Vec<Column> = (0..payload.end).map(|place| Column::of(parts, place)).collect();
    let mut found: Vec<Field> = payload
        .flat_map(|offset| Form::ALL.map(|form| (offset, form)))
        .filter(|(offset, form)| {
            let bytes = columns.get(*offset..offset + form.size());
            bytes.is_some_and(|bytes| can_be_number(bytes, *form))
        })
        .filter_map(|(offset, form)| {
            let series = parts.map(|frames| series(frames, offset, form));
            Some(Field {
                offset,
                form,
                ..answer(&series, part_s)?
            })
        })
        .collect();
    found.sort_by(|one, other| other.clarity.total_cmp(&one.clarity));
    found
}

fn series(frames: &[&[u8]], offset: usize, form: Form) -> Vec<f64> {
    let read = |frame: &&[u8]| form.read(frame.get(offset..)?);
    frames.iter().filter_map(read).collect()
}

/// Whether a series responds to turns, oppositely to opposite turns.
fn answer([rest, left, right]: &[Vec<f64>; 3], part_s: f64) -> Option<Field> {
    if left.len() < FRAMES_MIN || right.len() < FRAMES_MIN {
        return None;
    }
    // The smallest step in the series is a lower bound of the noise: a constant number has noise, too.
    let least = [rest, left, right].into_iter().flat_map(|part| steps(part));
    let quantum = least.map(f64::abs).filter(|step| *step > 0.0).reduce(f64::min)?;
    let noise = deviation(&steps(rest)).max(quantum);
    let (rest_mean, left_mean, right_mean) = (mean(rest), mean(left), mean(right));
    let (up, down) = (left_mean - rest_mean, right_mean - rest_mean);
    let (left_drift, right_drift) = (mean(&steps(left)), mean(&steps(right)));
    let field = |meaning, one: f64, other: f64, clarity: f64| Field {
        offset: 0,
        form: Form::I16Little,
        meaning,
        rises_left: one > other,
        steps: (one - other).abs() / (2.0 * TURNED_DEGREES),
        clarity,
    };
    let drift = left_drift.abs().min(right_drift.abs()) * (left.len().min(right.len()) as f64) / noise;
    if left_drift * right_drift < 0.0
        && drift > ANSWERS
        && is_monotonic(left, noise)
        && is_monotonic(right, noise)
    {
        return Some(field(Meaning::Heading, total(left), total(right), drift));
    }
    let jump = up.abs().min(down.abs()) / noise.max(deviation(rest));
    let steady = deviation(&steps(left)).max(deviation(&steps(right))) < up.abs().max(down.abs());
    let (left_sum, right_sum) = (up * part_s, down * part_s);
    (up * down < 0.0 && jump > ANSWERS && steady).then(|| field(Meaning::Rate, left_sum, right_sum, jump))
}

/// Whether nearly all steps have the same sign, however unevenly a person turns.
fn is_monotonic(series: &[f64], noise: f64) -> bool {
    let way: f64 = steps(series).into_iter().map(f64::abs).sum();
    way <= 1.25 * total(series).abs() + 2.0 * noise * (series.len() as f64).sqrt()
}

fn total(series: &[f64]) -> f64 {
    steps(series).into_iter().sum()
}

fn mean(series: &[f64]) -> f64 {
    series.iter().sum::<f64>() / (series.len().max(1) as f64)
}

fn deviation(series: &[f64]) -> f64 {
    let middle = mean(series);
    let squares: Vec<f64> = series.iter().map(|value| (value - middle).powi(2)).collect();
    mean(&squares).sqrt()
}

fn steps(series: &[f64]) -> Vec<f64> {
    series.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

impl fmt::Display for Frames {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head: Vec<String> = self.head.iter().map(|byte| format!("{byte:02X}")).collect();
        writeln!(
            out,
            "frames of {} bytes that begin with {}",
            self.length,
            head.join(" ")
        )?;
        match self.check {
            Some(check) => writeln!(
                out,
                "last byte: {} of bytes {} to {}",
                match check.kind {
                    CheckKind::Sum => "sum",
                    CheckKind::NegatedSum => "negated sum",
                    CheckKind::Xor => "exclusive or",
                },
                check.from,
                self.length - 2
            )?,
            None => writeln!(out, "last byte: no check value that is known here")?,
        }
        if self.fields.is_empty() {
            writeln!(out, "no number in it answers to turns")?;
        }
        for field in self.fields.iter().take(5) {
            writeln!(
                out,
                "byte {}: {} as {:?}, {} counter-clockwise, {:.1} steps {}; {:.0} times its noise",
                field.offset,
                match field.meaning {
                    Meaning::Rate => "turn rate",
                    Meaning::Heading => "heading",
                },
                field.form,
                if field.rises_left { "rises" } else { "falls" },
                field.steps,
                match field.meaning {
                    Meaning::Rate => "for a degree a second",
                    Meaning::Heading => "for a degree",
                },
                field.clarity
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Check, CheckKind, Form, Frames, Meaning, Recording};

    /// Deterministic noise, -`span`..=`span`.
    struct Noise(u64);

    impl Noise {
        fn next(&mut self, span: i32) -> i32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((self.0 >> 33) % (2 * span as u64 + 1)) as i32 - span
        }
    }

    /// The simulator's frames, with noise: heading as i32, rate as i16, sum.
    fn simulated(rates: &[i16], noise: &mut Noise, heading: &mut i32) -> Vec<u8> {
        let mut bytes = Vec::new();
        for rate in rates {
            *heading += i32::from(*rate) / 10;
            let seen = rate + noise.next(3) as i16;
            let mut frame = vec![0xAA, 0x55];
            frame.extend(heading.to_le_bytes());
            frame.extend(seen.to_le_bytes());
            let sum = frame[2..].iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
            frame.push(sum);
            bytes.extend(frame);
        }
        bytes
    }

    #[test]
    fn the_simulators_frames_are_found_from_any_byte_on() {
        for cut in 0..9 {
            let (mut noise, mut heading) = (Noise(7), 1_000);
            let recording = Recording {
                rest: simulated(&[0; 300], &mut noise, &mut heading)[cut..].to_vec(),
                left: simulated(&[1_200; 300], &mut noise, &mut heading),
                right: simulated(&[-1_200; 300], &mut noise, &mut heading),
                part_s: 3.0,
            };
            let frames = Frames::find(&recording).expect("there are frames");
            assert_eq!(
                (frames.length, frames.head[..2].to_vec()),
                (9, vec![0xAA, 0x55]),
                "cut {cut}"
            );
            let check = Check {
                kind: CheckKind::Sum,
                from: 2,
            };
            assert_eq!(frames.check, Some(check));
            let has = |offset, form, meaning, steps: f64| {
                frames.fields.iter().any(|field| {
                    (field.offset, field.form, field.meaning) == (offset, form, meaning)
                        && field.rises_left
                        && (field.steps / steps - 1.0).abs() < 0.01
                })
            };
            assert!(has(6, Form::I16Little, Meaning::Rate, 10.0), "{frames}");
            assert!(has(2, Form::I32Little, Meaning::Heading, 100.0), "{frames}");
        }
    }

    #[test]
    fn a_big_endian_rate_that_falls_to_the_left_is_told_apart() {
        let mut noise = Noise(1);
        let mut part = |rate: i16| {
            let mut bytes = Vec::new();
            for _ in 0..200 {
                let seen = rate + noise.next(9) as i16;
                let mut frame = vec![0x05, 0x0A, noise.next(100) as u8];
                frame.extend(seen.to_be_bytes());
                frame.push(frame.iter().fold(0, |xor, byte| xor ^ byte));
                bytes.extend(frame);
            }
            bytes
        };
        let recording = Recording {
            rest: part(12),
            left: part(-900),
            right: part(900),
            part_s: 2.0,
        };
        let frames = Frames::find(&recording).expect("there are frames");
        assert_eq!(frames.length, 6);
        let best = frames.fields.first().expect("it answers");
        assert_eq!(
            (best.offset, best.form, best.meaning, best.rises_left),
            (3, Form::I16Big, Meaning::Rate, false)
        );
    }

    #[test]
    fn lost_bytes_cost_single_frames_only() {
        let (mut noise, mut heading) = (Noise(3), 0);
        let mut rest = simulated(&[0; 300], &mut noise, &mut heading);
        let mut left = simulated(&[300; 300], &mut noise, &mut heading);
        left.drain(500..507);
        left.drain(1700..1703);
        rest.truncate(2000);
        let recording = Recording {
            rest,
            left,
            right: simulated(&[-300; 300], &mut noise, &mut heading),
            part_s: 3.0,
        };
        assert_eq!(Frames::find(&recording).expect("still").length, 9);
    }

    #[test]
    fn noise_and_silence_are_no_frames() {
        let mut noise = Noise(5);
        let mut part = || (0..3000).map(|_| noise.next(127) as u8).collect::<Vec<u8>>();
        let recording = Recording {
            rest: part(),
            left: part(),
            right: part(),
            part_s: 8.0,
        };
        assert_eq!(Frames::find(&recording), None);
        assert_eq!(Frames::find(&Recording::default()), None);
    }
}
