//! Docks as they are in homes: dirty, dead, moved, turned, recessed, without power, and with a shoe before them. The robot docks, or it
//! gives up soon and says why.

use std::fmt;
use std::io::{self, Write};
use std::sync::Arc;

use anyhow::Context;
use brain::BehaviorState;
use brain::command::StrategyName;
use home::generate::GeneratedHome;
use home::{DockContacts, Home, Noise, Pcg, Pose, RobotModel};
use robot::RobotSettings;
use rvac_api::{LogEntry, RequestBody};
use rvac_sim::run::core_config;
use rvac_sim::{Host, Household, Scene, explain};
use serde::Serialize;

use crate::DockingHome;
use crate::place;

/// The end must come within so long, milliseconds.
const LONGEST_MS: u64 = 6 * 60_000;
/// After this time a trial is given up, milliseconds.
const ABANDONED_MS: u64 = 20 * 60_000;
/// Stream of the draws of this bench.
const STREAM: u64 = 78;
/// Share of the contacts of a dirty dock that carry no current.
const DIRTY: f64 = 0.2;
/// A turned dock, radians.
const TURNED_RAD: f64 = 0.087;

/// What is wrong with the dock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Wear {
    Dirty,
    Dead,
    Moved,
    Turned,
    Recessed,
    Unpowered,
    Shoe,
}

impl Wear {
    const ALL: [Self; 7] = [
        Self::Dirty,
        Self::Dead,
        Self::Moved,
        Self::Turned,
        Self::Recessed,
        Self::Unpowered,
        Self::Shoe,
    ];

    const fn name(self) -> &'static str {
        match self {
            Self::Dirty => "dirty",
            Self::Dead => "dead",
            Self::Moved => "moved",
            Self::Turned => "turned",
            Self::Recessed => "recessed",
            Self::Unpowered => "unpowered",
            Self::Shoe => "shoe",
        }
    }

    /// What the robot may say when it gives up.
    const fn right_reasons(self) -> &'static [&'static str] {
        match self {
            Self::Dirty => &["no-charge-current"],
            Self::Dead => &["dock-no-contact"],
            Self::Moved | Self::Turned | Self::Recessed => &[],
            Self::Unpowered => &["no-beam"],
            Self::Shoe => &["dock-obstructed", "way-blocked"],
        }
    }

    /// What stands around the dock, as further lines of a home TOML.
    fn furniture(self, dock: Pose, side: f64) -> String {
        match self {
            Self::Recessed => {
                block("Cabinet left of the dock", dock, [0.0, 0.2, 0.28, 0.5])
                    + &block("Cabinet right of the dock", dock, [0.0, 0.2, -0.5, -0.28])
            }
            Self::Shoe => {
                let aside_m = 0.12 * side;
                block("Shoe", dock, [0.5, 0.75, aside_m - 0.05, aside_m + 0.05])
            }
            _ => String::new(),
        }
    }

    fn apply(self, household: &mut Household, random: &mut Pcg) {
        let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let world = household.robot_mut().world_mut();
        match self {
            Self::Dirty => world.set_dock_contacts(DockContacts::Dirty(DIRTY)),
            Self::Dead => world.set_dock_contacts(DockContacts::Dead),
            Self::Moved => world.push_dock(side * (0.05 + 0.15 * random.unit()), 0.0),
            Self::Turned => world.push_dock(0.0, side * TURNED_RAD),
            Self::Unpowered => world.set_dock_power(false),
            Self::Recessed | Self::Shoe => {}
        }
    }
}

/// A box from two distances in front of the dock's back and two beside its middle, metres.
fn block(name: &str, dock: Pose, [near_m, far_m, right_m, left_m]: [f64; 4]) -> String {
    let corners = [
        (near_m, right_m),
        (far_m, right_m),
        (far_m, left_m),
        (near_m, left_m),
    ]
    .map(|(along_m, aside_m)| {
        let (x_m, y_m) = dock.point(along_m, aside_m);
        format!("[{x_m:.3}, {y_m:.3}]")
    });
    format!(
        "\n[[furniture]]\nname = \"{name}\"\npolygon = [{}]\n",
        corners.join(", ")
    )
}

/// One trial.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct WornTrial {
    wear: Wear,
    home: String,
    seed: u64,
    docked: bool,
    /// Docked, or gave up for the right reason, in time.
    right: bool,
    time_s: f64,
    /// Drives in to the dock and visits without its beams that failed, and the one that docked.
    tries: usize,
    reason: String,
    #[serde(skip)]
    log: Vec<LogEntry>,
}

impl WornTrial {
    /// The trial of this number, and so with this wear.
    pub(crate) fn of(number: u64, home: &DockingHome, model: &RobotModel) -> anyhow::Result<Self> {
        let index = usize::try_from(number)? % Wear::ALL.len();
        let wear = *Wear::ALL.get(index).context("a wear")?;
        let mut random = Pcg::new(number, STREAM);
        let home = worn_home(wear, home, model, &mut random)?;
        let there = place::draw(&home, model.body.radius_m, &mut random);
        let scene = Scene::new(Arc::new(home), model.clone(), Noise::nominal());
        let settings = RobotSettings {
            seed: number,
            ..RobotSettings::default()
        };
        let robot = scene.robot_at(Some(there), number, &settings);
        let mut host = Host::start(0, core_config(&scene, number, StrategyName::Systematic));
        host.keep_log();
        let mut household = Household::new(robot, host).with_known_map();
        household.robot_mut().world_mut().set_battery_charge(0.5);
        wear.apply(&mut household, &mut random);
        household.pass_ms(3_000);
        Ok(Self::home(&mut household, wear, number))
    }

    fn home(household: &mut Household, wear: Wear, seed: u64) -> Self {
        let begun_ms = household.robot().now_ms();
        household.ask(RequestBody::Dock);
        household.pass_ms(5_000);
        let rests = |household: &Household| {
            let state = household.host().and_then(Host::state);
            !matches!(state, Some(BehaviorState::Docking | BehaviorState::Starting))
        };
        while !rests(household) && household.robot().now_ms() < begun_ms + ABANDONED_MS {
            household.pass_ms(200);
        }
        let time_ms = household.robot().now_ms() - begun_ms;
        // A robot that slips off its contacts at once has not docked.
        household.pass_ms(3_000);
        let status = household.host().map(Host::status);
        let reason = status.map_or_else(String::new, |status| status.reason);
        let docked = household.robot().world().truth().docked && reason == "docked";
        let log = household.host().map_or_else(Vec::new, |host| host.log().to_vec());
        let tries = failed_tries(&log) + usize::from(docked);
        let is_in_time = time_ms <= LONGEST_MS;
        Self {
            wear,
            home: household.robot().world().home().name().to_owned(),
            seed,
            docked,
            right: is_in_time && (docked || wear.right_reasons().contains(&reason.as_str())),
            time_s: time_ms as f64 / 1000.0,
            tries,
            reason,
            log,
        }
    }

    /// Tells what the robot decided in a trial that does not count.
    pub(crate) fn explain(&self) -> anyhow::Result<()> {
        let mut out = io::stderr().lock();
        writeln!(
            out,
            "{} {} seed {}: {} after {:.0} s",
            self.wear.name(),
            self.home,
            self.seed,
            self.reason,
            self.time_s
        )?;
        Ok(explain(&self.log, &mut out)?)
    }
}

/// Decisions that end a try.
const FAILED: [&str; 3] = [
    "dock-retry (",
    "dock-search (dock-missed)",
    "dock-search (no-beam)",
];

fn failed_tries(log: &[LogEntry]) -> usize {
    log.iter()
        .filter(|entry| FAILED.iter().any(|failed| entry.text.starts_with(failed)))
        .count()
}

/// The home with what stands around its dock.
fn worn_home(wear: Wear, home: &DockingHome, model: &RobotModel, random: &mut Pcg) -> anyhow::Result<Home> {
    let (name, text) = match home {
        DockingHome::Generated(number) => {
            let generated = GeneratedHome::number(*number);
            (generated.to_string(), generated.floorplan(model)?)
        }
        DockingHome::File(path) => ((*path).to_owned(), std::fs::read_to_string(path)?),
    };
    let plain = Home::from_floorplan(&name, &text, model)?;
    let dock = plain.dock().context("a home with a dock")?;
    let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let more = wear.furniture(dock, side);
    Ok(Home::from_floorplan(&name, &(text + &more), model).unwrap_or(plain))
}

/// Figures of all trials.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct WornSummary {
    trials: usize,
    docked_or_right_reason: usize,
    share: f64,
    longest_s: f64,
    tries_max: usize,
    by_wear: Vec<WornRow>,
}

/// Figures of the trials with one wear.
#[derive(Clone, Debug, Serialize)]
struct WornRow {
    wear: Wear,
    trials: usize,
    docked: usize,
    right: usize,
    longest_s: f64,
}

fn longest_s<'a>(trials: impl Iterator<Item = &'a WornTrial>) -> f64 {
    trials.map(|trial| trial.time_s).fold(0.0, f64::max)
}

impl WornSummary {
    pub(crate) fn of(trials: &[WornTrial]) -> Self {
        let by_wear = Wear::ALL.map(|wear| {
            let of_wear = || trials.iter().filter(move |trial| trial.wear == wear);
            WornRow {
                wear,
                trials: of_wear().count(),
                docked: of_wear().filter(|trial| trial.docked).count(),
                right: of_wear().filter(|trial| trial.right).count(),
                longest_s: longest_s(of_wear()),
            }
        });
        let right = trials.iter().filter(|trial| trial.right).count();
        Self {
            trials: trials.len(),
            docked_or_right_reason: right,
            share: right as f64 / trials.len().max(1) as f64,
            longest_s: longest_s(trials.iter()),
            tries_max: trials.iter().map(|trial| trial.tries).max().unwrap_or(0),
            by_wear: by_wear.to_vec(),
        }
    }
}

impl fmt::Display for WornSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "{:<10} {:>6} {:>7} {:>22} {:>10}",
            "dock", "trials", "docked", "docked or right reason", "longest s"
        )?;
        for row in &self.by_wear {
            writeln!(
                formatter,
                "{:<10} {:>6} {:>7} {:>22} {:>10.0}",
                row.wear.name(),
                row.trials,
                row.docked,
                row.right,
                row.longest_s
            )?;
        }
        write!(
            formatter,
            "{} of {} docked or gave up for the right reason within 6 minutes, {:.0} s and {} tries at most",
            self.docked_or_right_reason, self.trials, self.longest_s, self.tries_max
        )
    }
}
