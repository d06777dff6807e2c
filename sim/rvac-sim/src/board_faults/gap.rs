//! Nobody listened to the robot for a while, and somebody carried it meanwhile: it may not move before it has announced itself and said that
//! it does not know its place, in whichever way the gap came about.

use std::f64::consts::TAU;

use brain::BehaviorState;
use brain::command::StrategyName;
use home::{Pcg, Pose};
use rvac_protocol::message::ResetCause;

use super::fault::BoardFault;
use super::trial::{BoardPassage, TOLD_MS};
use crate::line_faults::HostClock;
use crate::run::{RunSettings, household, start_cleaning};
use crate::{Host, Household, Scene};

/// It knows its place and works when the gap begins.
const WORKS_MS: u64 = 60_000;
/// Friction has ended all motion when somebody takes it, and again when it was put down.
const HOLD_MS: u64 = TOLD_MS / 2;
/// So far it is carried, and turned.
const CARRIED_M: f64 = 0.6;
const TURNED_RAD: f64 = 2.0;
/// A robot has room there.
const CLEARANCE_M: f64 = 0.2;
/// It is watched for so long until it moves, and then until it knows its place again.
const WATCH_MS: u64 = 60_000;
const SEARCH_MS: u64 = 240_000;
/// A motion of its own.
const MOVES_M: f64 = 0.01;
/// A robot that is further from where it believes to be cleans in the wrong place.
const ASTRAY_M: f64 = 0.5;

/// How a gap comes about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gap {
    /// The cable is out.
    Link,
    /// The microcontroller has no power, and then it has.
    Microcontroller,
    /// The Linux board sleeps; the daemon's clock counts that.
    Suspended,
}

/// A gap of some length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CarriedGap {
    /// How it comes about.
    pub gap: Gap,
    /// Its length, milliseconds.
    pub ms: u64,
}

/// How a robot went on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resumed {
    /// It moved by itself.
    pub moved: bool,
    /// It had announced itself before.
    pub announced: bool,
    /// It had said before that it does not know its place.
    pub doubted: bool,
    /// Minutes later it believes to know its place, and is wrong by so many metres.
    pub astray_m: Option<f64>,
    /// Rules of safety that were broken.
    pub violations: u32,
    /// Seconds from the beginning of the gap until the log said `link-lost`.
    pub told_s: Option<f64>,
}

impl Gap {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Link, Self::Microcontroller, Self::Suspended];
}

impl Resumed {
    /// Whether it believed its place, or moved without a word.
    #[must_use]
    pub const fn is_rash(&self) -> bool {
        self.moved && !(self.announced && self.doubted) || self.astray_m.is_some()
    }
}

impl CarriedGap {
    /// One that is drawn: from a little more than a minute to an hour.
    pub(super) fn drawn(random: &mut Pcg) -> Self {
        let place = (random.unit() * Gap::ALL.len() as f64) as usize % Gap::ALL.len();
        let minutes = (60.0_f64).powf(random.unit());
        Self {
            gap: Gap::ALL[place],
            ms: 61_000 + (60_000.0 * minutes) as u64,
        }
    }

    /// Whether somebody can tell of it while it lasts: a host that sleeps tells nothing.
    pub(super) const fn is_told(self) -> bool {
        !matches!(self.gap, Gap::Suspended)
    }

    /// A robot at work in a home whose map it has, such a gap, and what it does afterwards; none when it did not even begin.
    #[must_use]
    pub fn resume(self, scene: &Scene, seed: u64) -> Option<Resumed> {
        let mut household = at_work(scene, seed)?;
        let told_s = self.leave_alone(&mut household, seed);
        let mut resumed = watch(&mut household);
        if resumed.moved {
            household.pass_ms(SEARCH_MS);
        }
        let host = household.host()?;
        let is_sure = host.brain().is_some_and(|brain| !brain.estimate().lost);
        let believed = host.pose();
        let believed = Pose::new(believed.x, believed.y, believed.heading);
        let astray_m = believed.distance_m(household.truth_in_map());
        resumed.astray_m = (resumed.moved && is_sure && astray_m > ASTRAY_M).then_some(astray_m);
        resumed.violations = household.robot().monitor().count();
        resumed.told_s = told_s;
        Some(resumed)
    }

    /// Lets the gap pass; gives when `link-lost` was told, in seconds, if that was within [`TOLD_MS`].
    fn leave_alone(self, household: &mut Household, seed: u64) -> Option<f64> {
        let began_s = household.now_us() as f64 / 1e6;
        match self.gap {
            Gap::Link | Gap::Microcontroller => {
                let ms = u32::try_from(self.ms).unwrap_or(u32::MAX);
                household.robot_mut().cut_line(ms);
            }
            Gap::Suspended => household.suspend_host(self.ms, HostClock::Runs),
        }
        household.pass_ms(HOLD_MS);
        let there = carried(household, seed);
        household.robot_mut().world_mut().lift();
        household.pass_ms(HOLD_MS);
        household.robot_mut().world_mut().put_down_at(there);
        let told_s = household.host().and_then(|host| {
            let told = host.log().iter().find(|entry| entry.text.contains("link-lost"));
            told.map(|entry| entry.t - began_s)
        });
        household.pass_ms(self.ms.saturating_sub(2 * HOLD_MS));
        if self.gap == Gap::Microcontroller {
            household.robot_mut().reset(ResetCause::PowerOn);
        }
        told_s
    }
}

fn at_work(scene: &Scene, seed: u64) -> Option<Household> {
    let settings = RunSettings {
        strategy: StrategyName::Systematic,
        pattern: None,
        seed,
        duration_ms: 0,
    };
    let mut household = household(scene, &settings).with_known_map();
    if !start_cleaning(&mut household, settings.strategy) {
        return None;
    }
    household.pass_ms(WORKS_MS);
    household.host_mut()?.keep_log();
    (state(&household) == Some(BehaviorState::Cleaning)).then_some(household)
}

fn state(household: &Household) -> Option<BehaviorState> {
    household.host().and_then(Host::state)
}

/// A place beside the robot's where it fits, and another heading.
fn carried(household: &Household, seed: u64) -> Pose {
    let world = household.robot().world();
    let pose = world.truth().pose;
    let first_rad = TAU * Pcg::new(seed, 0x6A9).unit();
    let places = (0..16).map(|step| {
        let (sin, cos) = (first_rad + TAU * f64::from(step) / 16.0).sin_cos();
        (pose.x_m + CARRIED_M * cos, pose.y_m + CARRIED_M * sin)
    });
    let (x_m, y_m) = places
        .max_by(|a, b| {
            let room = |(x_m, y_m): (f64, f64)| world.home().clearance_m(x_m, y_m).min(CLEARANCE_M);
            room(*a).total_cmp(&room(*b))
        })
        .unwrap_or((pose.x_m, pose.y_m));
    Pose::new(x_m, y_m, pose.heading_rad + TURNED_RAD)
}

/// Until it moves.
fn watch(household: &mut Household) -> Resumed {
    let mut resumed = Resumed::default();
    let before_m = household.robot().world().truth().path_m;
    for _ in 0..WATCH_MS {
        household.tick();
        resumed.moved = household.robot().world().truth().path_m - before_m > MOVES_M;
        if resumed.moved {
            break;
        }
        resumed.announced |= state(household) == Some(BehaviorState::Starting);
        let brain = household.host().and_then(Host::brain);
        resumed.doubted |= brain.is_some_and(|brain| brain.estimate().lost);
    }
    resumed
}

/// The gap as a draw of the campaign.
pub(super) fn passage(scene: &Scene, gap: CarriedGap, seed: u64) -> BoardPassage {
    let kind = BoardFault::CarriedGap(gap).kind();
    let mut passed = BoardPassage::default();
    let Some(resumed) = gap.resume(scene, seed) else {
        passed.untold.push(kind);
        return passed;
    };
    passed.violations = resumed.violations + u32::from(resumed.is_rash());
    if let Some(told_s) = resumed.told_s {
        passed.told_s.insert(kind, told_s);
    } else if gap.is_told() {
        passed.untold.push(kind);
    }
    passed
}
