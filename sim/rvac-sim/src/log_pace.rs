//! Hours or days of a robot in its home on the virtual clock: how many lines for people its log gets, and which of them come again
//! within a minute. What is written for developers (`debug`) does not count: it goes to nobody who did not ask for it.

use std::collections::{BTreeMap, HashMap};

use brain::BehaviorState;
use brain::command::StrategyName;
use rvac_api::{LogEntry, LogLevel, RequestBody};
use serde::Serialize;

use crate::daily::{MIDNIGHT_S, daily_job};
use crate::run::{RunSettings, household};
use crate::{Household, Scene};

/// A line may not come again within this time, seconds.
const AGAIN_S: f64 = 60.0;
const DAY_S: u64 = 24 * 3_600;
/// It has connected after this time.
const CONNECT_MS: u64 = 5_000;
/// Each night it cleans, early, so that few hours show all.
const WORK_AT: &str = "00:10";
/// At half past one the cable is out for twenty minutes.
const OUTAGE_AT_S: u64 = 90 * 60;
const OUTAGE_S: u64 = 20 * 60;

/// What the robot is at while a line is written.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Occupation {
    /// On its dock, or without a job.
    Rest,
    /// Anything else.
    Work,
    /// Cut off from its host.
    Outage,
}

impl Occupation {
    /// For tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rest => "at rest",
            Self::Work => "in work",
            Self::Outage => "in an outage",
        }
    }
}

/// Lines of one occupation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LogPace {
    /// Hours in it.
    pub hours: f64,
    /// Lines.
    pub lines: u64,
    /// As many a day, if it were at that for a whole day.
    pub lines_a_day: f64,
}

/// A line that came again within a minute.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Repetition {
    /// What it says.
    pub text: String,
    /// So often within a minute of the one before.
    pub times: u32,
}

/// The log of some hours.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LogFigures {
    /// Hours that passed.
    pub hours: u64,
    /// Jobs that ended.
    pub jobs: usize,
    /// Lines by what the robot was at.
    pub paces: BTreeMap<Occupation, LogPace>,
    /// Lines that came again too soon.
    pub again: Vec<Repetition>,
}

/// Lets so many hours pass, from midnight on, for a robot that cleans once and loses its cable once in each day.
#[must_use]
pub fn log_figures(scene: &Scene, hours: u64, seed: u64) -> LogFigures {
    let mut household = at_home(scene, seed);
    let start_s = household.now_us() / 1_000_000;
    let mut figures = LogFigures {
        hours,
        ..LogFigures::default()
    };
    let mut seconds: BTreeMap<Occupation, u64> = BTreeMap::new();
    let mut read = 0;
    for second in start_s..hours * 3_600 {
        if second % DAY_S == OUTAGE_AT_S {
            household.robot_mut().cut_line((OUTAGE_S * 1_000) as u32);
        }
        household.pass_ms(1_000);
        let occupation = occupation(&household, second);
        *seconds.entry(occupation).or_default() += 1;
        let log = household.host().map_or(&[][..], crate::Host::log);
        let new = log.iter().skip(read).filter(|entry| is_for_people(entry));
        figures.paces.entry(occupation).or_default().lines += new.count() as u64;
        read = log.len();
    }
    for (occupation, pace) in &mut figures.paces {
        let in_it_s = seconds.get(occupation).copied().unwrap_or_default() as f64;
        pace.hours = in_it_s / 3_600.0;
        pace.lines_a_day = pace.lines as f64 * DAY_S as f64 / in_it_s.max(1.0);
    }
    if let Some(host) = household.host() {
        figures.jobs = host.runs().len();
        figures.again = repetitions(host.log());
    }
    figures
}

/// A robot on its dock, whose host has a clock, a daily job and a log.
fn at_home(scene: &Scene, seed: u64) -> Household {
    let settings = RunSettings {
        strategy: StrategyName::Systematic,
        pattern: None,
        seed,
        duration_ms: 0,
    };
    let mut household = household(scene, &settings);
    if let Some(host) = household.host_mut() {
        host.keep_log();
    }
    household.pass_ms(CONNECT_MS);
    let now_us = household.now_us();
    if let Some(host) = household.host_mut() {
        host.set_wall(now_us, MIDNIGHT_S + (now_us / 1_000_000).cast_signed());
    }
    household.ask(RequestBody::AddSchedule(daily_job("Night", WORK_AT)));
    household
}

fn occupation(household: &Household, second: u64) -> Occupation {
    let of_day_s = second % DAY_S;
    if (OUTAGE_AT_S..OUTAGE_AT_S + OUTAGE_S).contains(&of_day_s) {
        return Occupation::Outage;
    }
    match household.host().and_then(crate::Host::state) {
        None | Some(BehaviorState::Idle | BehaviorState::Docked) => Occupation::Rest,
        Some(_) => Occupation::Work,
    }
}

fn is_for_people(entry: &LogEntry) -> bool {
    entry.level != LogLevel::Debug
}

/// Lines that come again within a minute, in the order in which they came first.
fn repetitions(log: &[LogEntry]) -> Vec<Repetition> {
    let mut last_s: HashMap<&str, f64> = HashMap::new();
    let mut again: Vec<Repetition> = Vec::new();
    for entry in log.iter().filter(|entry| is_for_people(entry)) {
        let before_s = last_s.insert(&entry.text, entry.t);
        if before_s.is_none_or(|before_s| entry.t - before_s >= AGAIN_S) {
            continue;
        }
        match again.iter_mut().find(|known| known.text == entry.text) {
            Some(known) => known.times += 1,
            None => again.push(Repetition {
                text: entry.text.clone(),
                times: 1,
            }),
        }
    }
    again
}
