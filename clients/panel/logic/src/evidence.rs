//! Sensor readings before the robot stopped, as rows of a table.

use rvac_api::{Evidence, EvidenceSample};

use crate::codes::explain;
use crate::words::Words;

/// Below this it counts as standing, m/s and rad/s.
const STANDS_M_PER_S: f64 = 0.02;
const STANDS_RAD_PER_S: f64 = 0.1;
/// Length of one sample, seconds.
const SAMPLE_S: f64 = 0.2;
/// Begin of the ten seconds that are shown.
const EARLIEST_S: f64 = -10.0;
/// The shortest period that times with one digit can show, seconds.
const SHOWN_S: f64 = 0.1;

/// A period in which sensor readings and motion stayed the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EvidenceRow {
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
    fn of(felt: &EvidenceSample) -> Self {
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
pub fn evidence_rows(words: &Words, evidence: &Evidence) -> Vec<EvidenceRow> {
    let alike = |one: &EvidenceSample, other: &EvidenceSample| {
        one.signs == other.signs && Motion::of(one) == Motion::of(other)
    };
    let mut before_s = EARLIEST_S;
    evidence
        .samples
        .chunk_by(alike)
        .map(|felt| {
            let row = row(words, felt, before_s);
            before_s = felt.last().map_or(before_s, |last| last.at_s);
            row
        })
        .collect()
}

/// The row of a period; the previous one ended at `before_s`. The newest sample may be shorter than the others.
fn row(words: &Words, felt: &[EvidenceSample], before_s: f64) -> EvidenceRow {
    let first = felt.first().cloned().unwrap_or_default();
    let to_s = felt.last().map_or(first.at_s, |last| last.at_s);
    let from_s = (first.at_s - SAMPLE_S).max(before_s).min(to_s - SHOWN_S);
    let mean =
        |value: fn(&EvidenceSample) -> f64| felt.iter().map(value).sum::<f64>() / felt.len().max(1) as f64;
    let (speed, turn) = (mean(|felt| felt.v), mean(|felt| felt.w));
    let texts = &words.evidence;
    let motion = match Motion::of(&first) {
        Motion::Ahead => texts.ahead.fill([&words.number(speed, 2)]),
        Motion::Back => texts.back.fill([&words.number(-speed, 2)]),
        Motion::Turning => texts.turning.fill([&words.number(turn.to_degrees(), 0)]),
        Motion::Standing => texts.standing.to_owned(),
    };
    let echo = felt.iter().filter_map(|felt| felt.echo).reduce(f32::max);
    let signs: Vec<String> = first.signs.iter().map(|sign| sign_text(words, sign)).collect();
    EvidenceRow {
        when: texts
            .span
            .fill([&words.number(tenths(from_s), 1), &words.number(tenths(to_s), 1)]),
        motion,
        echo: echo.map_or_else(String::new, |echo| {
            words.number(100.0 * f64::from(echo), 0) + "\u{a0}%"
        }),
        signs: if signs.is_empty() {
            texts.nothing.to_owned()
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
    let texts = &words.evidence;
    let known = match sign {
        "bumper-left" => texts.bumper_left,
        "bumper-right" => texts.bumper_right,
        "cliff-left" => texts.cliff_left,
        "cliff-front" => texts.cliff_front,
        "cliff-right" => texts.cliff_right,
        "wheel-drop" => texts.wheel_drop,
        "docked" => texts.docked,
        "link-lost" => texts.link_lost,
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
    use rvac_api::{Evidence, EvidenceSample};

    use super::{EvidenceRow, evidence_rows};
    use crate::words::Language;

    fn felt(at_s: f64, v: f64, signs: &[&str]) -> EvidenceSample {
        EvidenceSample {
            at_s,
            v,
            echo: Some(0.25),
            signs: signs.iter().map(|sign| (*sign).to_owned()).collect(),
            ..EvidenceSample::default()
        }
    }

    #[test]
    fn what_did_not_change_is_one_row() {
        let evidence = Evidence {
            samples: vec![
                felt(-0.8, 0.2, &[]),
                felt(-0.6, 0.3, &[]),
                felt(-0.4, 0.0, &["bumper-left"]),
                felt(-0.2, -0.1, &["bumper-left"]),
                felt(0.0, 0.0, &["bumper-left", "not-armed"]),
            ],
            tried: Vec::new(),
        };
        let rows = evidence_rows(Language::English.words(), &evidence);
        let row = |when: &str, motion: &str, signs: &str| EvidenceRow {
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
            samples: vec![felt(-0.04, 0.2, &[]), felt(0.0, 0.2, &["wheel-drop"])],
            tried: Vec::new(),
        };
        let rows = evidence_rows(Language::English.words(), &short);
        let times: Vec<&str> = rows.iter().map(|row| row.when.as_str()).collect();
        assert_eq!(times, ["-0.2 to 0.0\u{a0}s", "-0.1 to 0.0\u{a0}s"]);
        let estonian = evidence_rows(Language::Estonian.words(), &evidence);
        assert_eq!(estonian[0].when, "-1,0 kuni -0,6\u{a0}s");
    }
}
