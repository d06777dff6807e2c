//! Kills programs at random moments while they write what people entrusted to them, and looks whether anything of that is lost.
//!
//! Each life of a program takes some changes that are acknowledged, and one during which it is killed. The next life must know
//! all that was acknowledged; the last change is whole or not there at all.
//!
//! With `--faults` nothing is killed in a change: each change that the daemon makes on its disk fails once, in each manner.

use std::process::ExitCode;
use std::thread::{self, ScopedJoinHandle};

use anyhow::Context;
use clap::Parser;
use vthal_bench::needed_beside;

mod daemon;
mod devices;
mod failing_disk;
mod faults;
mod figures;
mod floors;
mod home;
mod life;
mod mixes;
mod rooms;
mod schedules;
mod store;
mod trial;

use daemon::AtDaemon;
use devices::AtServer;
use figures::{Figures, json};
use floors::Floors;
use home::Home;
use life::Keeper;
use mixes::Mixes;
use rooms::Rooms;
use schedules::Schedules;
use store::Store;

/// What the daemon keeps.
const OF_DAEMON: [&(dyn Store + Sync); 5] = [&Schedules, &Mixes, &Home, &Rooms, &Floors];

#[derive(Parser)]
#[command(
    about = "Kills vthal and panel-server with SIGKILL at random moments while they write schedules, control mixes, maps, \
             settings of rooms, floors and paired devices"
)]
struct Arguments {
    /// Number of kills, shared by the kinds of files
    #[arg(long, default_value_t = 2000)]
    kills: u32,
    /// Seed of the moments
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Lets each change of the daemon's disk fail instead
    #[arg(long, conflicts_with = "kills")]
    faults: bool,
    /// Prints one JSON object instead of lines
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = if arguments.faults {
        run_faults(&arguments)
    } else {
        run(&arguments)
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            eprintln!("bench-writes: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let (vthal, server) = (needed_beside("vthal")?, needed_beside("panel-server")?);
    let at_daemon = |store| measure(arguments, &AtDaemon::new(store, &vthal)?);
    let at_server = || measure(arguments, &AtServer::new(server)?);
    // A life is mostly waiting for the disk and for each other's starts: the kinds take it side by side.
    let all = thread::scope(|scope| {
        let of_daemon = OF_DAEMON.map(|store| scope.spawn(move || at_daemon(store)));
        let of_server = scope.spawn(at_server);
        let ended = of_daemon
            .into_iter()
            .chain([of_server])
            .map(ScopedJoinHandle::join);
        ended.collect::<Vec<_>>()
    });
    let all = all
        .into_iter()
        .map(|ended| ended.map_err(|_| anyhow::anyhow!("a trial panicked"))?)
        .collect::<anyhow::Result<Vec<_>>>()?;
    if arguments.json {
        println!("{}", json(&all));
    }
    for (name, figures) in all.iter().filter(|_| !arguments.json) {
        println!("{}", figures.sentence(name));
    }
    Ok(if all.iter().all(|(_, figures)| figures.is_good()) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Lets the disk fail under each kind that the daemon keeps.
fn run_faults(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let vthal = needed_beside("vthal")?;
    let mut all = Vec::new();
    for store in OF_DAEMON {
        let figures = faults::try_faults(store, &vthal).with_context(|| store.name())?;
        if !arguments.json {
            println!("{}", figures.sentence(store.name()));
        }
        all.push((store.name(), figures));
    }
    if arguments.json {
        let kinds = all.iter().map(|(name, figures)| figures.json(name));
        println!("{}", serde_json::json!({ "kinds": kinds.collect::<Vec<_>>() }));
    }
    Ok(if all.iter().all(|(_, figures)| figures.is_good()) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Kills the keeper of one kind as often as is its share.
fn measure(arguments: &Arguments, keeper: &dyn Keeper) -> anyhow::Result<(&'static str, Figures)> {
    let kinds = u32::try_from(OF_DAEMON.len() + 1)?;
    let figures = trial::try_keeper(keeper, arguments.kills.div_ceil(kinds), arguments.seed)
        .with_context(|| format!("{} (seed {})", keeper.name(), arguments.seed))?;
    Ok((keeper.name(), figures))
}
