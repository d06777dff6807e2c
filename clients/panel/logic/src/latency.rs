//! Latency from a stick to the wheels, as a person sees it.
//!
//! It begins with the browser's time of the input that moved a robot at rest, and ends when the first pose arrives that shows
//! it moving. It includes the transmission in both directions, the robot's own start, and up to 50 ms until the next
//! pose.

use mixer::{MixState, Mixed};
use rvac_api::Pose;
use std::collections::VecDeque;

use crate::words::Words;

/// A robot that sent no other pose for so long stands: five were due.
const STANDS_MS: f64 = 250.0;
/// A robot that has not moved by now will not move because of that input.
const PATIENCE_MS: f64 = 2_000.0;
/// Measurements that are kept.
const KEPT: usize = 9;
/// Poses closer than this are the same.
const STILL_M: f64 = 0.001;
const STILL_RAD: f64 = 0.002;

/// Measures at each start from rest.
#[derive(Clone, Debug, Default)]
pub struct LatencyMeter {
    /// The pose of the robot, and since when it is there.
    stood: Option<(f64, Pose)>,
    held: bool,
    since_ms: Option<f64>,
    spans_ms: VecDeque<f64>,
}

impl LatencyMeter {
    /// What the mix made of the inputs, of which the newest is of `input_ms`. It counts if the robot stands.
    pub fn on_mixed(&mut self, mixed: &Mixed, input_ms: f64) {
        let held = mixed.held && mixed.state == MixState::Live;
        if held == self.held {
            return;
        }
        self.held = held;
        let stands = self
            .stood
            .is_some_and(|(since_ms, _)| input_ms - since_ms >= STANDS_MS);
        self.since_ms = (held && stands).then_some(input_ms);
    }

    /// A pose arrived at `now_ms`.
    pub fn on_pose(&mut self, now_ms: f64, pose: Pose) {
        if self.stood.is_some_and(|(_, stood)| same(stood, pose)) {
            return;
        }
        self.stood = Some((now_ms, pose));
        let span_ms = self.since_ms.take().map(|since_ms| now_ms - since_ms);
        if let Some(span_ms) = span_ms.filter(|span_ms| (0.0..PATIENCE_MS).contains(span_ms)) {
            self.spans_ms.push_back(span_ms);
            if self.spans_ms.len() > KEPT {
                self.spans_ms.pop_front();
            }
        }
    }

    /// The last measurement, the median, and how many there are.
    #[must_use]
    pub fn text(&self, words: &Words) -> Option<String> {
        let last = self.spans_ms.back()?;
        let mut sorted: Vec<f64> = self.spans_ms.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let median = sorted.get(sorted.len() / 2)?;
        let (last, median) = (words.number(*last, 0), words.number(*median, 0));
        Some(words.drive.latency.fill([&last, &sorted.len(), &median]))
    }
}

fn same(one: Pose, other: Pose) -> bool {
    (one.x - other.x).hypot(one.y - other.y) < STILL_M && (one.heading - other.heading).abs() < STILL_RAD
}

#[cfg(test)]
mod tests {
    use super::LatencyMeter;
    use crate::words::{Language, Words};
    use mixer::{MixState, Mixed};
    use rvac_api::Pose;

    const ENGLISH: &Words = Language::English.words();

    fn mixed(held: bool) -> Mixed {
        Mixed {
            pushed: [].into(),
            away: Vec::new(),
            state: MixState::Live,
            held,
            outputs: Vec::new(),
            switches: Vec::new(),
            mode: None,
            trims: Vec::new(),
            fired: Vec::new(),
        }
    }

    /// A new hold begins.
    fn hold(meter: &mut LatencyMeter, input_ms: f64) {
        meter.on_mixed(&mixed(false), input_ms);
        meter.on_mixed(&mixed(true), input_ms);
    }

    fn at(x: f64) -> Pose {
        Pose { x, ..Pose::default() }
    }

    #[test]
    fn measures_from_the_input_to_the_first_pose_that_moved() {
        let mut meter = LatencyMeter::default();
        meter.on_pose(0.0, at(0.0));
        hold(&mut meter, 1000.0);
        meter.on_pose(1050.0, at(0.0005));
        assert_eq!(meter.text(ENGLISH), None, "that is noise");
        meter.on_pose(1180.0, at(0.01));
        meter.on_pose(1230.0, at(0.03));
        assert_eq!(
            meter.text(ENGLISH).as_deref(),
            Some("From stick to wheels: 180\u{a0}ms, median of 1: 180\u{a0}ms")
        );
        for (start, span) in [(3000.0, 100.0), (5000.0, 140.0)] {
            hold(&mut meter, start);
            meter.on_pose(start + span, at(start));
        }
        assert_eq!(
            meter.text(ENGLISH).as_deref(),
            Some("From stick to wheels: 140\u{a0}ms, median of 3: 140\u{a0}ms")
        );
    }

    #[test]
    fn counts_only_starts_from_rest_that_come_of_the_input() {
        let mut meter = LatencyMeter::default();
        hold(&mut meter, 0.0);
        meter.on_pose(100.0, at(1.0));
        assert_eq!(meter.text(ENGLISH), None, "where it stood is unknown");
        hold(&mut meter, 200.0);
        meter.on_pose(250.0, at(2.0));
        assert_eq!(meter.text(ENGLISH), None, "it moved already");
        hold(&mut meter, 1000.0);
        meter.on_pose(4000.0, at(3.0));
        assert_eq!(meter.text(ENGLISH), None, "that was something else");
        hold(&mut meter, 6000.0);
        meter.on_mixed(&mixed(false), 6050.0);
        meter.on_pose(6100.0, at(4.0));
        assert_eq!(meter.text(ENGLISH), None, "it was let go before");
    }
}
