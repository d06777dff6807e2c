//! Many charges, added up.

use std::collections::BTreeMap;

use cordlib::charge::{AllStops, Stops};
use rvac_protocol::message::ChargeEnd;

use super::conditions::Conditions;
use super::outcome::{ChargeOutcome, run};

/// Which charges are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChargeTrial {
    /// All stops, every kind of pack, weather and trouble.
    Everything,
    /// Only this stop, on sound packs without trouble: does it suffice alone?
    Only(ChargeEnd),
    /// All stops, sound packs between frost and heat, with or without the owner's calibration of the thermistor.
    Weather {
        /// The owner has measured it.
        calibrated: bool,
    },
}

/// The one stop that applies.
#[derive(Clone, Copy, Debug)]
struct Only(ChargeEnd);

impl Stops for Only {
    fn applies(&self, end: ChargeEnd) -> bool {
        self.0 == end
    }
}

impl ChargeTrial {
    /// The conditions of one seed.
    #[must_use]
    pub fn conditions(self, seed: u64) -> Conditions {
        match self {
            Self::Everything => Conditions::drawn(seed),
            Self::Only(_) => Conditions::healthy(seed),
            Self::Weather { calibrated } => Conditions::weather(seed, calibrated),
        }
    }

    /// The outcome of one seed.
    #[must_use]
    pub fn run(self, seed: u64) -> ChargeOutcome {
        match self {
            Self::Only(end) => run(&self.conditions(seed), Only(end)),
            Self::Everything | Self::Weather { .. } => run(&self.conditions(seed), AllStops),
        }
    }
}

/// The sum of many outcomes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChargeTally {
    /// Charges.
    pub charges: u32,
    /// Charges of sound packs without trouble.
    pub healthy: u32,
    /// Of those, how many ended below 85 % or not at all.
    pub healthy_short: u32,
    /// Least charge of a sound pack at its end.
    pub healthy_least: f64,
    /// Charges in which a cell reached 55 degrees.
    pub too_hot: u32,
    /// Hottest cell of all, degrees Celsius, and its seed.
    pub hottest: (f64, u64),
    /// Longest time in which the switch was driven in one charge, hours, and its seed.
    pub longest: (f64, u64),
    /// Charges with current into a pack that was truly below 0 degrees.
    pub frozen: u32,
    /// Highest mean current of a minute into a pack that was truly below 5 degrees, ampere, and its seed.
    pub cool: (f64, u64),
    /// Coldest pack in which a charge began, degrees Celsius, and its seed.
    pub coldest_start: Option<(f64, u64)>,
    /// Breaches of the rules, and the first seed with one.
    pub violations: u32,
    /// Seed of the first breach.
    pub first_violation: Option<u64>,
    /// How charges ended, by name: an end, a fault, or `never began`, `not ended`.
    pub ends: BTreeMap<&'static str, u32>,
    /// Sum of the errors of the estimate at the end of sound packs.
    estimate_error: f64,
}

impl ChargeTally {
    /// Adds one outcome.
    pub fn add(&mut self, outcome: &ChargeOutcome, healthy: bool) {
        self.charges += 1;
        let name = match (outcome.fault, outcome.end) {
            (Some(fault), _) => fault.name(),
            (None, Some(end)) => end.name(),
            (None, None) if outcome.driven_h == 0.0 => "never began",
            (None, None) => "not ended",
        };
        *self.ends.entry(name).or_default() += 1;
        if healthy {
            if self.healthy == 0 {
                self.healthy_least = outcome.charge;
            }
            self.healthy += 1;
            let short = outcome.charge < 0.85 || outcome.end.is_none();
            self.healthy_short += u32::from(short);
            self.healthy_least = self.healthy_least.min(outcome.charge);
            self.estimate_error += (outcome.estimate - outcome.charge.min(1.0)).abs();
        }
        self.too_hot += u32::from(outcome.hottest_c >= 55.0);
        if outcome.hottest_c > self.hottest.0 {
            self.hottest = (outcome.hottest_c, outcome.seed);
        }
        if outcome.driven_h > self.longest.0 {
            self.longest = (outcome.driven_h, outcome.seed);
        }
        self.frozen += u32::from(outcome.frozen_a > 0.0);
        if outcome.cool_a > self.cool.0 {
            self.cool = (outcome.cool_a, outcome.seed);
        }
        let began = outcome.began_c.map(|celsius| (celsius, outcome.seed));
        self.coldest_start = colder(self.coldest_start, began);
        self.violations += outcome.violations;
        if outcome.violations > 0 && self.first_violation.is_none_or(|seed| outcome.seed < seed) {
            self.first_violation = Some(outcome.seed);
        }
    }

    /// Adds another tally.
    pub fn merge(&mut self, other: &Self) {
        let least = match (self.healthy, other.healthy) {
            (0, _) => other.healthy_least,
            (_, 0) => self.healthy_least,
            _ => self.healthy_least.min(other.healthy_least),
        };
        self.charges += other.charges;
        self.healthy += other.healthy;
        self.healthy_short += other.healthy_short;
        self.healthy_least = least;
        self.too_hot += other.too_hot;
        for (mine, theirs) in [
            (&mut self.hottest, other.hottest),
            (&mut self.longest, other.longest),
            (&mut self.cool, other.cool),
        ] {
            if theirs.0 > mine.0 {
                *mine = theirs;
            }
        }
        self.frozen += other.frozen;
        self.coldest_start = colder(self.coldest_start, other.coldest_start);
        self.violations += other.violations;
        self.first_violation = self
            .first_violation
            .into_iter()
            .chain(other.first_violation)
            .min();
        for (name, count) in &other.ends {
            *self.ends.entry(name).or_default() += count;
        }
        self.estimate_error += other.estimate_error;
    }

    /// Share of sound packs that ended at 85 % or more.
    #[must_use]
    pub fn healthy_share(&self) -> f64 {
        1.0 - f64::from(self.healthy_short) / f64::from(self.healthy.max(1))
    }

    /// Mean error of the firmware's estimate of the charge, half an hour after the end, sound packs.
    #[must_use]
    pub fn estimate_error(&self) -> f64 {
        self.estimate_error / f64::from(self.healthy.max(1))
    }
}

/// The colder of two starts.
fn colder(one: Option<(f64, u64)>, other: Option<(f64, u64)>) -> Option<(f64, u64)> {
    match (one, other) {
        (Some(one), Some(other)) => Some(if other.0 < one.0 { other } else { one }),
        (one, other) => one.or(other),
    }
}
