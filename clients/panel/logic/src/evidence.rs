//! What the robot felt before it stood still, as rows of a table.

use rvac_api::{Evidence, Felt};

use crate::codes::explain;
use crate::words::Words;

/// Slower than this it stands, m/s and rad/s.
const STANDS_M_PER_S: f64 = 0.02;
const STANDS_RAD_PER_S: f64 = 0.1;
/// Length of what is felt at once, seconds.
const SAMPLE_S: f64 = 0.2;
/// Begin of the ten seconds that are told.
const EARLIEST_S: f64 = -10.0;
/// The shortest stretch that times with one digit can show, seconds.
const SHOWN_S: f64 = 0.1;

/// A stretch of time in which the robot felt and did the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FeltRow {
    pub when: String,
    pub motion: String,
    /// Strongest echo in percent; empty for robots without such sensors.
    pub echo: String,
    pub signs: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Motion {
    Ahead,
    Back,
    Turning,
    Standing,
}

impl Motion {
    fn of(felt: &Felt) -> Self {
        if felt.v > STANDS_M_PER_S {
            Self::Ahead
        } else if felt.v < -STANDS_M_PER_S {
            Self::Back
        } else if felt.w.abs() > STANDS_RAD_PER_S {
            Self::Turning
        } else {
            Self::Standing
        }
    }
}

/// Rows, oldest first.
#[must_use]
pub fn felt_rows(words: &Words, evidence: &Evidence) -> Vec<FeltRow> {
    let alike = |one: &Felt, other: &Felt| one.signs == other.signs && Motion::of(one) == Motion::of(other);
    let mut before_s = EARLIEST_S;
    evidence
        .felt
        .chunk_by(alike)
        .map(|felt| {
            let row = row(words, felt, before_s);
            before_s = felt.last().map_or(before_s, |last| last.at_s);
            row
        })
        .collect()
}

/// The row of a stretch; another one ended at `before_s`. The newest sample may be shorter than the others.
fn row(words: &Words, felt: &[Felt], before_s: f64) -> FeltRow {
    let first = felt.first().cloned().unwrap_or_default();
    let to_s = felt.last().map_or(first.at_s, |last| last.at_s);
    let from_s = (first.at_s - SAMPLE_S).max(before_s).min(to_s - SHOWN_S);
    let mean = |value: fn(&Felt) -> f64| felt.iter().map(value).sum::<f64>() / felt.len().max(1) as f64;
    let (speed, turn) = (mean(|felt| felt.v), mean(|felt| felt.w));
    let told = &words.evidence;
    let motion = match Motion::of(&first) {
        Motion::Ahead => told.ahead.fill([&words.number(speed, 2)]),
        Motion::Back => told.back.fill([&words.number(-speed, 2)]),
        Motion::Turning => told.turning.fill([&words.number(turn.to_degrees(), 0)]),
        Motion::Standing => told.standing.to_owned(),
    };
    let echo = felt.iter().filter_map(|felt| felt.echo).reduce(f32::max);
    let signs: Vec<String> = first.signs.iter().map(|sign| sign_text(words, sign)).collect();
    FeltRow {
        when: told
            .span
            .fill([&words.number(tenths(from_s), 1), &words.number(tenths(to_s), 1)]),
        motion,
        echo: echo.map_or_else(String::new, |echo| {
            words.number(100.0 * f64::from(echo), 0) + "\u{a0}%"
        }),
        signs: if signs.is_empty() {
            told.nothing.to_owned()
        } else {
            signs.join(", ")
        },
    }
}

/// Rounded to a tenth; no zero has a sign.
fn tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0 + 0.0
}

/// A sign in words; what kept the firmware from moving has an explanation.
fn sign_text(words: &Words, sign: &str) -> String {
    let told = &words.evidence;
    let known = match sign {
        "bumper-left" => told.bumper_left,
        "bumper-right" => told.bumper_right,
        "cliff-left" => told.cliff_left,
        "cliff-front" => told.cliff_front,
        "cliff-right" => told.cliff_right,
        "wheel-drop" => told.wheel_drop,
        "docked" => told.docked,
        "link-lost" => told.link_lost,
        other => {
            let explained = explain(words, other).map(|explanation| in_a_list(explanation.cause));
            return explained.unwrap_or_else(|| other.to_owned());
        }
    };
    known.to_owned()
}

/// A sentence as one of the things in a list.
fn in_a_list(sentence: &str) -> String {
    let mut letters = sentence.trim_end_matches('.').chars();
    let first = letters.next().into_iter().flat_map(char::to_lowercase);
    first.chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use rvac_api::{Evidence, Felt};

    use super::{FeltRow, felt_rows};
    use crate::words::Language;

    fn felt(at_s: f64, v: f64, signs: &[&str]) -> Felt {
        Felt {
            at_s,
            v,
            echo: Some(0.25),
            signs: signs.iter().map(|sign| (*sign).to_owned()).collect(),
            ..Felt::default()
        }
    }

    #[test]
    fn what_did_not_change_is_one_row() {
        let evidence = Evidence {
            felt: vec![
                felt(-0.8, 0.2, &[]),
                felt(-0.6, 0.3, &[]),
                felt(-0.4, 0.0, &["bumper-left"]),
                felt(-0.2, -0.1, &["bumper-left"]),
                felt(0.0, 0.0, &["bumper-left", "not-armed"]),
            ],
            tried: Vec::new(),
        };
        let rows = felt_rows(Language::English.words(), &evidence);
        let row = |when: &str, motion: &str, signs: &str| FeltRow {
            when: when.to_owned(),
            motion: motion.to_owned(),
            echo: "25\u{a0}%".to_owned(),
            signs: signs.to_owned(),
        };
        assert_eq!(
            rows,
            [
                row("-1.0 to -0.6\u{a0}s", "ahead, 0.25\u{a0}m/s", "nothing"),
                row("-0.6 to -0.4\u{a0}s", "standing", "bumper on the left"),
                row("-0.4 to -0.2\u{a0}s", "back, 0.10\u{a0}m/s", "bumper on the left"),
                row(
                    "-0.2 to 0.0\u{a0}s",
                    "standing",
                    "bumper on the left, the robot has not been released to move since it started, stopped or reconnected"
                ),
            ]
        );
        let short = Evidence {
            felt: vec![felt(-0.04, 0.2, &[]), felt(0.0, 0.2, &["wheel-drop"])],
            tried: Vec::new(),
        };
        let rows = felt_rows(Language::English.words(), &short);
        let times: Vec<&str> = rows.iter().map(|row| row.when.as_str()).collect();
        assert_eq!(times, ["-0.2 to 0.0\u{a0}s", "-0.1 to 0.0\u{a0}s"]);
        let estonian = felt_rows(Language::Estonian.words(), &evidence);
        assert_eq!(estonian[0].when, "-1,0 kuni -0,6\u{a0}s");
    }
}
