//! `bench-navigation`: how fast and how surely the robot covers homes, against the lower bound and against bounce.
//! `cargo xtask bench navigation` builds and runs it.
#![forbid(unsafe_code)]

mod ground;
mod lost;
mod memory;
mod mode;
#[path = "../../progress.rs"]
mod progress;
mod run;
mod shared_progress;
mod table;
mod traps;

use std::io::{self, Write};
use std::thread;

use anyhow::Context;
use clap::Parser;
use clap::builder::ArgPredicate;
use home::traps::{Trap, TrapKind};
use home::{LongRanges, RobotModel};
use rvac_sim::bench::{NamedHome, in_order};

use ground::{GyroFitting, HomeWithHistory, Radio, Setup};
use mode::{CleaningMode, SeededMode};
use run::{Ground, Length, NavigationRun, rounds};
use shared_progress::SharedProgress;
use table::NavigationTable;
use traps::{TrapRun, TrapTable};

/// Homes that are measured when none is named.
const USUAL: &str = "homes/furnished-room.toml,homes/two-room-flat.toml,generated:2..10";
/// Homes, and modes, of a robot that hears radio beacons.
const RADIO: &str = "generated:1..10";
const RADIO_MODES: &str = "bounce,beacon-bounce,known-map,first-run";
/// Ranges of `--beacons`: this share is too long, by so much, metres.
const LONG_RANGES: LongRanges = LongRanges::Share {
    share: 0.1,
    least_m: 0.3,
    most_m: 1.0,
};
/// When the last beacon of `--beacon-fails` falls silent, milliseconds.
const FAILS_AFTER_MS: u64 = 20 * 60_000;
/// The large floors.
const LARGE: &str = "homes/empty-halls.toml";

/// Measures coverage and localization in simulated homes.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes, separated by commas: `tuning` and `report` (odd and even numbers of the published set), `published` (both),
    /// `generated:A..B` with B, `generated:N`, `trap:KIND/SEED`, or files.
    #[arg(long, default_value_if("large", "true", LARGE), default_value_if("first", "true", "report"), default_value_if("beacons", ArgPredicate::IsPresent, RADIO), default_value = USUAL)]
    homes: String,
    /// First runs beside known maps, in the homes of `report`: with `--large`, in the large ones.
    #[arg(long)]
    first: bool,
    /// Large floors with empty halls.
    #[arg(long)]
    large: bool,
    /// Measure in drawn traps of every kind instead of homes: whether the robot comes free, and whether it ends. Takes --seeds,
    /// --noise, --modes, --robot, --board-gyro and --threads.
    #[arg(long)]
    traps: bool,
    /// Seeds of each home: 1 to this.
    #[arg(
        long,
        default_value_if("beacons", ArgPredicate::IsPresent, "5"),
        default_value = "2"
    )]
    seeds: u64,
    /// Noise class: ideal, good, nominal or bad; parts of it can differ, as in `nominal,gyro=0,wheel-scale=2`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// What is compared, separated by commas: `bounce` (which hears no beacons), `beacon-bounce`, `known-map` (systematic with a perfect map),
    /// `old-map` (the same with the map of the first day of a home like generated:7/2+people), `first-run` (systematic
    /// without), `learnt-map` (a first run, a second and a third, each with the map that the one before saved),
    /// `perfect-pose` (with perfect map and pose: what the planner can do).
    #[arg(
        long,
        default_value_if("first", "true", "known-map,first-run"),
        default_value_if("large", "true", "known-map"),
        default_value_if("beacons", ArgPredicate::IsPresent, RADIO_MODES),
        default_value = "bounce,known-map,first-run"
    )]
    modes: String,
    /// Robot by name.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// A gyro on the Linux board, for a robot whose own board has none.
    #[arg(long)]
    board_gyro: bool,
    /// So many radio beacons at the edges of each home, of which the robot knows no place: deviation 0.2 m, and around a tenth of all
    /// places 0.3 to 1 m too long.
    #[arg(long, value_name = "COUNT")]
    beacons: Option<usize>,
    /// Ranges to them are too long behind walls instead, up to 0.6 m, and one in fifty comes by a detour.
    #[arg(long, requires = "beacons")]
    behind_walls: bool,
    /// The last of them falls silent in mid-run: after twenty minutes.
    #[arg(long, requires = "beacons")]
    beacon_fails: bool,
    /// Most T0 that a run may take.
    #[arg(long, default_value_t = 10.0)]
    longest: f64,
    /// Let each run last so many minutes of work instead: as soon as a job is over, the robot is asked for the next where it
    /// is. Figures of covering are those of the first job then.
    #[arg(long, value_name = "MINUTES", conflicts_with = "longest")]
    work_minutes: Option<f64>,
    /// Runs at a time; as many as there are cores, if it is not said.
    #[arg(long)]
    threads: Option<usize>,
    /// Print one JSON object, with the figures of each run.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    fn setup(&self) -> anyhow::Result<Setup> {
        Ok(Setup {
            model: RobotModel::by_name(&self.robot)?,
            noise: self.noise.parse()?,
            board_gyro: if self.board_gyro {
                GyroFitting::Fitted
            } else {
                GyroFitting::Absent
            },
            radio: self.beacons.map(|beacons| Radio {
                beacons,
                long: if self.behind_walls {
                    LongRanges::BehindWalls
                } else {
                    LONG_RANGES
                },
                fails_after_ms: self.beacon_fails.then_some(FAILS_AFTER_MS),
            }),
        })
    }

    const fn length(&self) -> Length {
        match self.work_minutes {
            Some(minutes) => Length::Work { minutes },
            None => Length::OneJob {
                longest_over_t0: self.longest,
            },
        }
    }

    fn threads(&self) -> usize {
        let cores = || thread::available_parallelism().map_or(1, usize::from);
        self.threads.unwrap_or_else(cores).max(1)
    }

    /// What each thing is measured with: modes and seeds, in the order of the output.
    fn ways(&self, modes: &[CleaningMode]) -> Vec<SeededMode> {
        let seeds = |mode: &CleaningMode| {
            let mode = *mode;
            (1..=self.seeds).map(move |seed| SeededMode { mode, seed })
        };
        modes.iter().flat_map(seeds).collect()
    }
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let setup = arguments.setup()?;
    let modes = CleaningMode::list(&arguments.modes)?;
    if arguments.traps {
        return measure_traps(&arguments, &setup, &modes);
    }
    let places = NamedHome::list(&arguments.homes)?;
    let runs = runs_in(&places, &arguments, &setup, &arguments.ways(&modes))?;
    print(&arguments, &places, &modes, &runs)
}

/// What a thread has before it: the home that it was in last, with its number.
type WorkerHome = Option<(usize, HomeWithHistory)>;

fn runs_in(
    places: &[NamedHome],
    arguments: &Arguments,
    setup: &Setup,
    ways: &[SeededMode],
) -> anyhow::Result<Vec<NavigationRun>> {
    let count = places.len() * ways.len();
    let progress = SharedProgress::new("navigation", count);
    let runs = in_order(count, arguments.threads(), |desk: &mut WorkerHome, number| {
        let (place, way) = (number / ways.len(), number % ways.len());
        if desk.as_ref().is_none_or(|(other, _)| *other != place) {
            *desk = Some((place, HomeWithHistory::of(&places[place], setup)?));
        }
        let (_, home) = desk.as_ref().context("a home was put there")?;
        let ground = Ground { home, setup };
        let piece = progress.piece();
        Ok(rounds(&ground, ways[way], arguments.length(), piece))
    });
    progress.clear();
    Ok(runs?.concat())
}

fn print(
    arguments: &Arguments,
    places: &[NamedHome],
    modes: &[CleaningMode],
    runs: &[NavigationRun],
) -> anyhow::Result<()> {
    let table = NavigationTable::of(runs, modes);
    let peak_mib = memory::peak_mib();
    let mut out = io::stdout().lock();
    if arguments.json {
        let object = serde_json::json!({
            "homes": arguments.homes,
            "seeds": arguments.seeds,
            "noise": arguments.noise,
            "robot": arguments.robot,
            "board_gyro": arguments.board_gyro,
            "beacons": arguments.beacons,
            "beacon_fails": arguments.beacon_fails,
            "longest_over_t0": arguments.longest,
            "work_minutes": arguments.work_minutes,
            "peak_memory_mib": peak_mib,
            "modes": table,
            "runs": runs,
        });
        writeln!(out, "{object}")?;
        return Ok(());
    }
    writeln!(
        out,
        "{}, {} homes, {} seeds, noise {}: median (90th percentile)\n{table}",
        arguments.robot,
        places.len(),
        arguments.seeds,
        arguments.noise
    )?;
    if let Some(peak_mib) = peak_mib {
        let threads = arguments.threads();
        writeln!(
            out,
            "this process held {peak_mib:.0} MiB at most, with {threads} runs at a time"
        )?;
    }
    Ok(())
}

fn measure_traps(arguments: &Arguments, setup: &Setup, modes: &[CleaningMode]) -> anyhow::Result<()> {
    let ways = arguments.ways(modes);
    let count = TrapKind::ALL.len() * ways.len();
    let progress = SharedProgress::new("traps", count);
    let runs = in_order(count, arguments.threads(), |_: &mut (), number| {
        let SeededMode { mode, seed } = ways[number % ways.len()];
        let trap = Trap {
            kind: TrapKind::ALL[number / ways.len()],
            seed: u32::try_from(seed)?,
        };
        let run = TrapRun::of(trap, setup, mode)?;
        progress.piece()(1.0);
        Ok(run)
    });
    progress.clear();
    let runs = runs?;
    let table = TrapTable::of(&runs, modes);
    let mut out = io::stdout().lock();
    if arguments.json {
        let object = serde_json::json!({
            "seeds": arguments.seeds,
            "noise": arguments.noise,
            "traps": table.json(),
            "runs": runs,
        });
        writeln!(out, "{object}")?;
    } else {
        writeln!(
            out,
            "{} kinds of traps, {} seeds, noise {}\n{table}",
            TrapKind::ALL.len(),
            arguments.seeds,
            arguments.noise
        )?;
    }
    Ok(())
}
