//! Recent sensor readings, for clients that ask why the robot stands still.

use std::collections::VecDeque;

use brain::Observation;
use rvac_api::EvidenceSample;

use crate::edges::{Edges, Sign};

/// Length of a sample, and how many are kept: ten seconds.
const SAMPLE_US: u64 = 200_000;
const SAMPLES: usize = 50;

/// What the robot perceives in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Perceived<'a> {
    pub(crate) observation: &'a Observation,
    pub(crate) edges: &'a Edges,
    /// What its motors draw, as far as it measures that.
    pub(crate) currents_a: Option<[f32; 3]>,
}

impl Perceived<'_> {
    /// The names of the contacts and alarms at this moment.
    fn signs(&self) -> impl Iterator<Item = &'static str> {
        let inhibits = self.observation.inhibits.names();
        self.edges.present().map(Sign::name).chain(inhibits)
    }
}

/// The newest samples.
#[derive(Debug, Default)]
pub(crate) struct Sensations {
    samples: VecDeque<Sample>,
    open: Option<Open>,
}

/// A sample that is complete.
#[derive(Clone, Debug)]
struct Sample {
    since: MotionReference,
    end_us: u64,
    felt: EvidenceSample,
}

/// The sample that goes on.
#[derive(Debug)]
struct Open {
    since: MotionReference,
    newest: MotionReference,
    signs: Vec<&'static str>,
    echo: Option<f32>,
    currents_a: Option<[f32; 3]>,
}

/// The origin from which changes of distance and heading are counted.
#[derive(Clone, Copy, Debug)]
struct MotionReference {
    time_us: u64,
    left_m: f64,
    right_m: f64,
    heading_rad: Option<f64>,
}

impl MotionReference {
    const fn of(observation: &Observation) -> Self {
        Self {
            time_us: observation.time_us,
            left_m: observation.travel_left_m,
            right_m: observation.travel_right_m,
            heading_rad: observation.gyro_heading_rad,
        }
    }

    /// Speed and turn rate until `now`; the wheels give the heading of a robot without gyro.
    fn rates(self, now: Self, track_m: f64) -> (f64, f64) {
        let time_s = now.time_us.saturating_sub(self.time_us) as f64 * 1e-6;
        if time_s <= 0.0 {
            return (0.0, 0.0);
        }
        let (left_m, right_m) = (now.left_m - self.left_m, now.right_m - self.right_m);
        let by_wheels_rad = (right_m - left_m) / track_m;
        let turned_rad = match (self.heading_rad, now.heading_rad) {
            (Some(before_rad), Some(after_rad)) => after_rad - before_rad,
            _ => by_wheels_rad,
        };
        (0.5 * (left_m + right_m) / time_s, turned_rad / time_s)
    }
}

impl Sensations {
    /// Takes in a step.
    pub(crate) fn take(&mut self, perceived: &Perceived<'_>, track_m: f64) {
        let now = MotionReference::of(perceived.observation);
        let open = self.open.get_or_insert_with(|| Open::from(now));
        open.take(perceived);
        if now.time_us >= open.since.time_us + SAMPLE_US {
            let (since, felt) = (open.since, open.sample(open.since, track_m));
            self.open = Some(Open::from(now));
            if self.samples.len() == SAMPLES {
                self.samples.pop_front();
            }
            self.samples.push_back(Sample {
                since,
                end_us: now.time_us,
                felt,
            });
        }
    }

    /// The last ten seconds before `now_us`, oldest first, with the readings since the last sample.
    pub(crate) fn before(&self, now_us: u64, track_m: f64) -> Vec<EvidenceSample> {
        let earliest_us = now_us.saturating_sub(SAMPLES as u64 * SAMPLE_US);
        let at_s = |end_us: u64| -(now_us.saturating_sub(end_us) as f64) * 1e-6;
        let complete = self.samples.iter().filter(|sample| sample.end_us > earliest_us);
        let newest = self.open.as_ref().filter(|open| open.has_news());
        // Few counts of a wheel come in the time of a sample that has just begun, so its rates are those since the one before it began.
        let rates_since = |open: &Open| self.samples.back().map_or(open.since, |sample| sample.since);
        complete
            .map(|sample| EvidenceSample {
                at_s: rounded(at_s(sample.end_us)),
                ..sample.felt.clone()
            })
            .chain(newest.map(|open| open.sample(rates_since(open), track_m)))
            .collect()
    }
}

impl Open {
    const fn from(since: MotionReference) -> Self {
        Self {
            since,
            newest: since,
            signs: Vec::new(),
            echo: None,
            currents_a: None,
        }
    }

    fn has_news(&self) -> bool {
        !self.signs.is_empty()
    }

    fn take(&mut self, perceived: &Perceived<'_>) {
        let observation = perceived.observation;
        self.newest = MotionReference::of(observation);
        for sign in perceived.signs() {
            if !self.signs.contains(&sign) {
                self.signs.push(sign);
            }
        }
        let echoes = observation.proximity.iter().copied();
        self.echo = self.echo.into_iter().chain(echoes).reduce(f32::max);
        self.currents_a = match (self.currents_a, perceived.currents_a) {
            (Some(before), Some(now)) => Some([0, 1, 2].map(|motor| larger(before[motor], now[motor]))),
            (before, now) => now.or(before),
        };
    }

    /// The sample if it ends now, with the rates since a moment.
    fn sample(&self, rates_since: MotionReference, track_m: f64) -> EvidenceSample {
        let (v, w) = rates_since.rates(self.newest, track_m);
        EvidenceSample {
            at_s: 0.0,
            v: rounded(v),
            w: rounded(w),
            signs: self.signs.iter().map(|sign| (*sign).to_owned()).collect(),
            echo: self.echo,
            currents_a: self.currents_a,
        }
    }
}

/// That of the larger amount, with its sign.
fn larger(one: f32, other: f32) -> f32 {
    if other.abs() > one.abs() { other } else { one }
}

/// To a thousandth: more is not visible, and it is sent and stored.
fn rounded(value: f64) -> f64 {
    if value.is_finite() {
        (1e3 * value).round() / 1e3
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use brain::Observation;
    use brain::observation::Contacts;

    use super::{Edges, Perceived, Sensations};

    const TRACK_M: f64 = 0.25;

    fn take(evidence: &mut Sensations, observation: &Observation, currents_a: Option<[f32; 3]>) {
        let mut edges = Edges::default();
        edges.take(observation.time_us, observation);
        let perceived = Perceived {
            observation,
            edges: &edges,
            currents_a,
        };
        evidence.take(&perceived, TRACK_M);
    }

    /// Drives straight ahead with 0.2 m/s and 50 reports a second.
    fn drive(evidence: &mut Sensations, steps: std::ops::Range<u64>, change: impl Fn(&mut Observation)) {
        for step in steps {
            let distance_m = 0.004 * step as f64;
            let mut observation = Observation {
                time_us: step * 20_000,
                travel_left_m: distance_m,
                travel_right_m: distance_m,
                link_up: true,
                ..Observation::default()
            };
            change(&mut observation);
            take(evidence, &observation, Some([0.1, -0.3, 0.0]));
        }
    }

    #[test]
    fn ten_seconds_are_kept_with_speeds_and_no_more() {
        let mut evidence = Sensations::default();
        drive(&mut evidence, 0..2_001, |_| {});
        let felt = evidence.before(40_000_000, TRACK_M);
        assert_eq!(felt.len(), 50);
        assert!(felt[0].at_s > -10.0 && felt[49].at_s <= 0.0, "{felt:?}");
        assert!(
            felt.iter()
                .all(|felt| (felt.v - 0.2).abs() < 1e-3 && felt.w == 0.0)
        );
        assert_eq!(felt[7].currents_a, Some([0.1, -0.3, 0.0]));
    }

    #[test]
    fn a_contact_of_one_report_is_not_lost_and_what_just_came_is_reported_at_once() {
        let mut evidence = Sensations::default();
        let touch = |observation: &mut Observation| {
            let touches = matches!(observation.time_us, 2_020_000 | 4_040_000);
            observation.contacts = Contacts {
                left: touches,
                right: false,
            };
        };
        drive(&mut evidence, 0..203, touch);
        let felt = evidence.before(4_040_000, TRACK_M);
        let touched: Vec<f64> = felt
            .iter()
            .filter(|felt| felt.signs == ["bumper-left"])
            .map(|felt| felt.at_s)
            .collect();
        assert_eq!(touched.len(), 2, "{felt:?}");
        assert!(
            (-2.1..-1.8).contains(&touched[0]) && touched[1] == 0.0,
            "{touched:?}"
        );
        let newest = felt.last().expect("has just come");
        assert!((newest.v - 0.2).abs() < 1e-3, "it was driving: {newest:?}");
    }

    #[test]
    fn what_is_older_than_ten_seconds_does_not_explain_anything() {
        let mut evidence = Sensations::default();
        drive(&mut evidence, 0..101, |_| {});
        assert!(evidence.before(60_000_000, TRACK_M).is_empty());
    }

    #[test]
    fn a_turn_is_noticed_by_the_gyro_or_else_by_the_wheels() {
        let turned = |gyro: bool| {
            let mut evidence = Sensations::default();
            for step in 0..30_u64 {
                let turn_rad = 0.02 * step as f64;
                let observation = Observation {
                    time_us: step * 20_000,
                    travel_right_m: 0.5 * TRACK_M * turn_rad,
                    travel_left_m: -0.5 * TRACK_M * turn_rad,
                    gyro_heading_rad: gyro.then_some(0.5 * turn_rad),
                    ..Observation::default()
                };
                take(&mut evidence, &observation, None);
            }
            evidence.before(400_000, TRACK_M)[1].w
        };
        assert_eq!((turned(false), turned(true)), (1.0, 0.5));
    }
}
