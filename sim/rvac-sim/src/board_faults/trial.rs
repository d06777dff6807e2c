//! One or two faults in the middle of a job, and many of them.

use std::collections::BTreeMap;

use brain::command::StrategyName;
use rayon::prelude::*;
use rvac_api::{RequestBody, ScheduleEntry};
use serde::Serialize;

use super::fault::{BoardFault, BoardFaults};
use super::{gap, pad, zone};
use crate::daily::{MIDNIGHT_S, daily_job};
use crate::run::{RunSettings, core_config, household, start_cleaning};
use crate::{Host, Household, Scene, TICK_US};
use home::SensorId;

/// A fault is told within this time, milliseconds.
pub const TOLD_MS: u64 = 10_000;
const TOLD_S: f64 = TOLD_MS as f64 / 1e3;
/// It works for so long before.
const BEFORE_MS: u64 = 12_000;
/// A fault that shows only in a turn is watched for so long until the robot turns.
const TURN_MAX_MS: u64 = 60_000;
/// A turn in which a gyro's fault shows, radians.
const TURN_RAD: f64 = 1.6;
/// The clock on the wall at the start: noon UTC.
pub(super) const WALL_S: i64 = MIDNIGHT_S + 12 * 3_600;

/// How a draw passed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BoardPassage {
    /// Number of the draw.
    pub seed: u64,
    /// Seconds until people were told, since it showed, by kind of fault.
    pub told_s: BTreeMap<&'static str, f64>,
    /// What had to be told and was not.
    pub untold: Vec<&'static str>,
    /// Names of other faults that people read.
    pub wrong_causes: Vec<&'static str>,
    /// Changes that were acknowledged and are not kept.
    pub lost_changes: u32,
    /// Rules of safety that were broken.
    pub violations: u32,
}

/// Figures of a campaign.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BoardFigures {
    /// Draws of one or two faults.
    pub seeds: u64,
    /// Faults that nobody was told of in time.
    pub untold_faults: u32,
    /// Other causes that were told.
    pub wrong_causes: u32,
    /// Acknowledged changes that are not kept.
    pub lost_changes: u32,
    /// Rules of safety that were broken.
    pub violations: u32,
    /// Longest time until people were told, by kind, seconds.
    pub told_s_max: BTreeMap<&'static str, f64>,
    /// The passages that were not as they should be.
    pub bad: Vec<BoardPassage>,
}

/// The faults of these numbers.
#[must_use]
pub fn campaign(scene: &Scene, seeds: u64) -> BoardFigures {
    let numbers: Vec<u64> = (0..seeds).collect();
    let passages: Vec<BoardPassage> = numbers.par_iter().map(|seed| passage(scene, *seed)).collect();
    let mut figures = BoardFigures {
        seeds,
        ..BoardFigures::default()
    };
    for passage in passages {
        let wrong = u32::try_from(passage.wrong_causes.len()).unwrap_or(u32::MAX);
        let untold = u32::try_from(passage.untold.len()).unwrap_or(u32::MAX);
        figures.untold_faults += untold;
        figures.wrong_causes += wrong;
        figures.lost_changes += passage.lost_changes;
        figures.violations += passage.violations;
        for (fault, told_s) in &passage.told_s {
            let longest = figures.told_s_max.entry(fault).or_default();
            *longest = longest.max(*told_s);
        }
        if untold + wrong + passage.lost_changes + passage.violations > 0 {
            figures.bad.push(passage);
        }
    }
    figures
}

/// The draw of this number.
#[must_use]
pub fn passage(scene: &Scene, seed: u64) -> BoardPassage {
    let faults = BoardFaults::drawn(seed);
    let passed = match faults.lone() {
        Some(BoardFault::Zone(fault)) => zone::passage(scene, fault, seed),
        Some(BoardFault::Pad(fault)) => pad::passage(scene, fault, seed),
        Some(BoardFault::CarriedGap(gap)) => gap::passage(scene, gap, seed),
        Some(fault) => strange_line(scene, fault, seed),
        None => Trial::new(scene, faults, seed).run(),
    };
    BoardPassage { seed, ..passed }
}

/// A host on whose line no robot speaks.
fn strange_line(scene: &Scene, fault: BoardFault, seed: u64) -> BoardPassage {
    let mut host = Host::start(0, core_config(scene, seed, StrategyName::Bounce));
    host.keep_log();
    let mut random = home::Pcg::new(seed, 0x0F_F5E7);
    let prompt = b"\r\nDebian GNU/Linux 13 robot ttyS0\r\n\r\nrobot login: ";
    let mut passed = BoardPassage::default();
    for ms in 1..=TOLD_MS {
        let bytes: Vec<u8> = match fault {
            BoardFault::Console if ms % 500 == 0 => prompt.to_vec(),
            BoardFault::Console => Vec::new(),
            _ => (0..2 + ms % 2).map(|_| (256.0 * random.unit()) as u8).collect(),
        };
        host.step(ms * TICK_US, &bytes);
        note(&mut passed, fault, host.log(), ms);
    }
    let is_named = fault.told_as().contains(&host.status().reason.as_str());
    if passed.told_s.is_empty() || !is_named {
        passed.untold.push(fault.kind());
    }
    passed
}

/// Notes when the fault is told first.
fn note(passed: &mut BoardPassage, fault: BoardFault, log: &[rvac_api::LogEntry], since_ms: u64) {
    if !passed.told_s.contains_key(fault.kind()) && log.iter().any(|entry| fault.is_told_in(&entry.text)) {
        passed.told_s.insert(fault.kind(), since_ms as f64 / 1e3);
    }
}

struct Trial {
    household: Household,
    faults: BoardFaults,
    acknowledged: usize,
}

impl Trial {
    fn new(scene: &Scene, faults: BoardFaults, seed: u64) -> Self {
        let settings = RunSettings {
            strategy: StrategyName::Bounce,
            pattern: None,
            seed,
            duration_ms: 0,
        };
        let mut household = household(scene, &settings);
        if faults.iter().any(|fault| fault == BoardFault::BoardGyroSilent) {
            household = household.with_board_gyro(scene.board_gyro(seed));
        }
        if let Some(host) = household.host_mut() {
            host.set_wall(0, WALL_S);
        }
        let mut trial = Self {
            household,
            faults,
            acknowledged: 0,
        };
        if start_cleaning(&mut trial.household, settings.strategy) {
            trial.add_schedule("before");
        }
        trial.household.pass_ms(BEFORE_MS);
        trial
    }

    /// Asks for a schedule; it counts as acknowledged unless it is refused.
    fn add_schedule(&mut self, name: &str) {
        let body = RequestBody::AddSchedule(ScheduleEntry {
            enabled: false,
            ..daily_job(name, "03:00")
        });
        let now_us = self.household.now_us();
        let Some(host) = self.household.host_mut() else {
            return;
        };
        let refused = host.ask_as(now_us, vthal_core::ClientId(1), body);
        self.acknowledged += usize::from(refused.is_none());
    }

    fn run(mut self) -> BoardPassage {
        if let Some(host) = self.household.host_mut() {
            host.keep_log();
        }
        for fault in self.faults.clone().iter() {
            self.begin(fault);
        }
        let mut passed = BoardPassage::default();
        let shows_in_turns = self
            .faults
            .iter()
            .any(|fault| matches!(fault, BoardFault::Gyro(_)));
        let (mut shown_ms, mut turned_rad) = (0, 0.0);
        let mut last_rad = self.heading_rad();
        for ms in 1..=TURN_MAX_MS + TOLD_MS {
            self.household.tick();
            let now_rad = self.heading_rad();
            turned_rad += home::wrap_angle(now_rad - last_rad).abs();
            last_rad = now_rad;
            let shows = !shows_in_turns || turned_rad >= TURN_RAD;
            shown_ms += u64::from(shows);
            let log = self.household.host().map_or(&[][..], Host::log);
            if ms % 100 == 0 {
                for fault in self.faults.iter() {
                    let shows_later = matches!(fault, BoardFault::Gyro(_));
                    note(&mut passed, fault, log, if shows_later { shown_ms } else { ms });
                }
            }
            if shown_ms >= TOLD_MS {
                break;
            }
        }
        if shown_ms >= TOLD_MS {
            let must_be_told = self.faults.iter().filter(|fault| !fault.told_as().is_empty());
            let kinds = must_be_told.map(BoardFault::kind);
            passed.untold = kinds
                .filter(|kind| passed.told_s.get(kind).is_none_or(|told_s| *told_s > TOLD_S))
                .collect();
        }
        let log = self.household.host().map_or(&[][..], Host::log);
        passed.wrong_causes = log
            .iter()
            .flat_map(|entry| self.faults.wrong_causes(&entry.text))
            .collect();
        passed.violations = self.household.robot().monitor().count();
        passed.lost_changes = self.lost_changes();
        passed
    }

    fn begin(&mut self, fault: BoardFault) {
        let now_us = self.household.now_us();
        match fault {
            BoardFault::Gyro(fault) => {
                let world = self.household.robot_mut().world_mut();
                world.set_fault(SensorId::Gyro, Some(fault));
            }
            BoardFault::BoardGyroSilent => self.household.silence_board_gyro(),
            BoardFault::LineCut { ms } => self.household.robot_mut().cut_line(ms),
            BoardFault::DiskRefuses(words) => {
                if let Some(host) = self.household.host_mut() {
                    host.refuse_writes(words);
                }
                self.add_schedule("after");
            }
            BoardFault::ClockJump { by_s } => {
                if let Some(host) = self.household.host_mut() {
                    host.set_wall(now_us, WALL_S + (now_us / 1_000_000).cast_signed() + by_s);
                }
            }
            // These have trials of their own.
            BoardFault::WrongSpeed
            | BoardFault::Console
            | BoardFault::CarriedGap(_)
            | BoardFault::Zone(_)
            | BoardFault::Pad(_) => {}
        }
    }

    fn heading_rad(&self) -> f64 {
        self.household.robot().world().truth().pose.heading_rad
    }

    /// Schedules that a daemon after this one would miss.
    fn lost_changes(&self) -> u32 {
        let kept = self.household.host().map_or(0, Host::kept_schedule_count);
        u32::try_from(self.acknowledged.saturating_sub(kept)).unwrap_or(u32::MAX)
    }
}
