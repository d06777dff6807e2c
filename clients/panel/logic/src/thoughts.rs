//! The robot's estimates, planned path and decisions, in words.

use std::collections::VecDeque;

use rvac_api::{Decision, Estimate, PlannedPath};

use crate::codes::explain;
use crate::figures::percent_text;
use crate::words::Words;

/// Decisions that are kept.
const KEPT: usize = 100;
/// Most corners of a planned path that are drawn.
const CORNERS_MAX: usize = 4_000;
/// Most dashes of a planned path.
const DASHES_MAX: usize = 20_000;

/// The newest decisions, each once.
#[derive(Clone, Debug, Default)]
pub struct DecisionBook {
    entries: VecDeque<Decision>,
}

impl DecisionBook {
    /// Takes a decision. A number that is known already is a repetition after a reconnect.
    pub fn push(&mut self, entry: Decision) {
        let known = self
            .entries
            .back()
            .is_some_and(|last| entry.number <= last.number);
        if known {
            return;
        }
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(entry);
    }

    /// Forgets everything, for a daemon that starts counting again.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Newest first.
    pub fn newest_first(&self) -> impl Iterator<Item = &Decision> {
        self.entries.iter().rev()
    }
}

/// How sure the robot is of its place, as a figure.
#[must_use]
pub fn place_text(words: &Words, estimate: &Estimate) -> String {
    let span = if estimate.lost {
        return words.status.lost.to_owned();
    } else if estimate.sigma_m < 0.995 {
        let whole = words.number((100.0 * estimate.sigma_m).max(1.0), 0);
        words.unit.centimetres.fill([&whole])
    } else {
        words.unit.metres.fill([&words.number(estimate.sigma_m, 1)])
    };
    words.status.within.fill([&span])
}

/// The robot's estimates of position and coverage, a sentence each.
#[must_use]
pub fn estimate_sentences(words: &Words, estimate: &Estimate) -> Vec<String> {
    let texts = &words.status;
    let mut sentences = vec![if estimate.lost {
        texts.is_lost.to_owned()
    } else {
        let heading = words.number(estimate.sigma_rad.to_degrees().max(1.0), 0);
        texts.believes.fill([&place_text(words, estimate), &heading])
    }];
    if let Some(agreement) = estimate.agreement {
        sentences.push(texts.agreement.fill([&percent_text(words, agreement)]));
    }
    if let Some(covered) = estimate.covered {
        let covered = percent_text(words, covered);
        sentences.push(match estimate.covered_low {
            Some(low) => texts.covered_at_least.fill([&covered, &percent_text(words, low)]),
            None => texts.covered.fill([&covered]),
        });
    }
    if let Some(doubt) = estimate.map_doubt {
        let told = explain(words, doubt.code());
        sentences.push(
            texts
                .map_doubted
                .fill([&told.map(|told| told.text()).unwrap_or_default()]),
        );
    }
    sentences
}

/// The planned path as dashes `[x0,y0,x1,y1,...]` in metres, each `dash_m` long with as much between them.
#[must_use]
pub fn path_dashes(path: &PlannedPath, dash_m: f64) -> Vec<f32> {
    let corners: Vec<[f64; 2]> = path
        .points_mm
        .chunks_exact(2)
        .take(CORNERS_MAX)
        .filter_map(|point| match point {
            [x, y] => Some([f64::from(*x) / 1000.0, f64::from(*y) / 1000.0]),
            _ => None,
        })
        .collect();
    let dash_m = if dash_m.is_finite() {
        dash_m.max(0.01)
    } else {
        return Vec::new();
    };
    let mut dashes = Vec::new();
    // Distance since the last dash began.
    let mut phase_m = 0.0;
    for pair in corners.windows(2) {
        let &[from, to] = pair else { continue };
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length_m = dx.hypot(dy);
        let mut at_m = 0.0;
        while at_m < length_m && dashes.len() < 4 * DASHES_MAX {
            let is_dash = phase_m < dash_m;
            let until_m = if is_dash { dash_m } else { 2.0 * dash_m };
            let end_m = (at_m + until_m - phase_m).min(length_m);
            if is_dash {
                let place = |way_m: f64| {
                    let share = way_m / length_m;
                    [(from[0] + share * dx) as f32, (from[1] + share * dy) as f32]
                };
                dashes.extend(place(at_m));
                dashes.extend(place(end_m));
            }
            phase_m += end_m - at_m;
            if phase_m >= 2.0 * dash_m - 1e-9 {
                phase_m = 0.0;
            } else if (phase_m - dash_m).abs() < 1e-9 {
                phase_m = dash_m;
            }
            at_m = end_m;
        }
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::{DecisionBook, KEPT, estimate_sentences, path_dashes, place_text};
    use crate::words::{Language, Words};
    use rvac_api::{Decision, Estimate, MapDoubt, PlannedPath};

    const ENGLISH: &Words = Language::English.words();
    const ESTONIAN: &Words = Language::Estonian.words();

    fn decision(number: u64) -> Decision {
        Decision {
            number,
            t: 0.0,
            what: "back-off".to_owned(),
            reason: "bump-left".to_owned(),
            value: 0.0,
            text: "Backed off.".to_owned(),
        }
    }

    #[test]
    fn decisions_are_kept_once_and_the_newest_come_first() {
        let mut book = DecisionBook::default();
        for number in [1, 2, 2, 1] {
            book.push(decision(number));
        }
        let numbers: Vec<u64> = book.newest_first().map(|entry| entry.number).collect();
        assert_eq!(numbers, [2, 1]);
        for number in 3..300 {
            book.push(decision(number));
        }
        assert_eq!(book.newest_first().count(), KEPT);
        book.clear();
        book.push(decision(1));
        assert_eq!(book.newest_first().count(), 1);
    }

    #[test]
    fn only_what_is_known_is_shown() {
        let sure = Estimate {
            sigma_m: 0.043,
            sigma_rad: 0.02,
            ..Estimate::default()
        };
        assert_eq!(place_text(ENGLISH, &sure), "± 4\u{a0}cm");
        assert_eq!(estimate_sentences(ENGLISH, &sure).len(), 1);
        let lost = Estimate {
            lost: true,
            agreement: Some(0.31),
            covered: Some(0.5),
            ..sure
        };
        let told = estimate_sentences(ENGLISH, &lost);
        assert!(
            told[0].starts_with("The robot does not know")
                && told[1].contains("31\u{a0}%")
                && told[2].contains("50\u{a0}%")
        );
        let low = Estimate {
            covered_low: Some(0.44),
            ..lost
        };
        assert!(
            estimate_sentences(ENGLISH, &low)[2]
                .contains("50\u{a0}% of the reachable floor, at least 44\u{a0}%")
        );
        let doubting = Estimate {
            map_doubt: Some(MapDoubt::MappedNotMet),
            ..sure
        };
        for (words, says) in [
            (
                ENGLISH,
                "Many walls or pieces of furniture on its map are not there",
            ),
            (ESTONIAN, "ei ole kohal"),
        ] {
            let told = estimate_sentences(words, &doubting);
            assert!(
                told[1].contains(says) && told[1].contains("rvac map restore"),
                "{told:?}"
            );
        }
        assert_eq!(
            place_text(
                ENGLISH,
                &Estimate {
                    sigma_m: 1.26,
                    ..sure
                }
            ),
            "± 1.3\u{a0}m"
        );
    }

    #[test]
    fn a_way_becomes_dashes_that_go_on_round_corners() {
        let path = PlannedPath {
            points_mm: vec![0, 0, 1500, 0, 1500, 1500],
            beyond_mm: 0,
        };
        let dashes = path_dashes(&path, 1.0);
        assert_eq!(
            dashes,
            [0.0, 0.0, 1.0, 0.0, 1.5, 0.5, 1.5, 1.5].map(|metres: f64| metres as f32)
        );
    }

    #[test]
    fn strange_ways_do_no_harm() {
        for points_mm in [vec![], vec![5], vec![1, 2, 3], vec![7; 4]] {
            assert!(
                path_dashes(
                    &PlannedPath {
                        points_mm,
                        beyond_mm: 0
                    },
                    0.1
                )
                .is_empty()
            );
        }
        let endless = PlannedPath {
            points_mm: (0..40_000)
                .map(|at| if at % 4 < 2 { i32::MIN } else { i32::MAX })
                .collect(),
            beyond_mm: 0,
        };
        assert!(path_dashes(&endless, 0.0).len() <= 80_000);
        assert!(path_dashes(&endless, f64::NAN).is_empty());
    }
}
