//! Kills the daemon at random moments while it writes what people entrusted to it, and looks whether anything of that is lost.
//!
//! Each life of the daemon takes some changes that are acknowledged, and one during which it is killed. The next life must know
//! all that was acknowledged; the last change is whole or not there at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use clap::Parser;
use rvac_protocol::message::BinaryKinds;

mod home;
mod mixes;
mod schedules;
mod store;

use home::Home;
use mixes::Mixes;
use schedules::Schedules;
use store::{Desk, Store, texts};
use vthal_bench::{Client, Daemon, Scratch, SyntheticRobot, built_beside, next_random};

/// Acknowledged changes of a life, at most.
const WHOLE_CHANGES_MAX: u64 = 3;
/// The kill comes within this many times the usual time of a change.
const KILL_WITHIN: u32 = 2;

#[derive(Parser)]
#[command(
    about = "Kills vthal with SIGKILL at random moments while it writes schedules, control mixes and maps"
)]
struct Arguments {
    /// Number of kills, shared by the kinds of files
    #[arg(long, default_value_t = 2000)]
    kills: u32,
    /// Seed of the moments
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Prints one JSON object instead of lines
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("bench-writes: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let vthal =
        built_beside("vthal")?.context("vthal is not built beside this program: cargo build -p vthal")?;
    let stores: [&dyn Store; 3] = [&Schedules, &Mixes, &Home];
    let mut all = Vec::new();
    for (index, store) in (0..).zip(stores) {
        let kills = (arguments.kills + index) / 3;
        let figures = try_store(store, &vthal, kills, arguments.seed)
            .with_context(|| format!("{} (seed {})", store.name(), arguments.seed))?;
        if !arguments.json {
            println!("{}", figures.sentence(store.name()));
        }
        all.push((store.name(), figures));
    }
    let bad: u32 = all
        .iter()
        .map(|(_, figures)| figures.corrupt + figures.lost)
        .sum();
    if arguments.json {
        println!("{}", json(&all));
    }
    Ok(if bad == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// What was seen of one kind.
#[derive(Debug, Default)]
struct Figures {
    kills: u32,
    acknowledged: u32,
    /// Kills before the acknowledgement, and how many of the changes that they cut off were there afterwards.
    cut_off: u32,
    cut_off_there: u32,
    corrupt: u32,
    lost: u32,
    ready_within: Duration,
}

impl Figures {
    fn sentence(&self, name: &str) -> String {
        format!(
            "{name}: {} kills, {} before an acknowledgement ({} of these changes were there, whole); {} changes acknowledged, {} lost; {} starts told of damage; ready within {:.2} s",
            self.kills,
            self.cut_off,
            self.cut_off_there,
            self.acknowledged,
            self.lost,
            self.corrupt,
            self.ready_within.as_secs_f64(),
        )
    }
}

fn json(all: &[(&str, Figures)]) -> serde_json::Value {
    let sum = |figure: fn(&Figures) -> u32| all.iter().map(|(_, figures)| figure(figures)).sum::<u32>();
    let kinds = all.iter().map(|(name, figures)| {
        serde_json::json!({
            "kind": name,
            "kills": figures.kills,
            "cut_off": figures.cut_off,
            "cut_off_there": figures.cut_off_there,
            "acknowledged": figures.acknowledged,
            "lost": figures.lost,
            "corrupt": figures.corrupt,
            "ready_within_s": figures.ready_within.as_secs_f64(),
        })
    });
    serde_json::json!({
        "kills": sum(|figures| figures.kills),
        "acknowledged": sum(|figures| figures.acknowledged),
        "acknowledged_and_lost": sum(|figures| figures.lost),
        "corrupt": sum(|figures| figures.corrupt),
        "kinds": kinds.collect::<Vec<_>>(),
    })
}

fn try_store(store: &dyn Store, vthal: &Path, kills: u32, seed: u64) -> anyhow::Result<Figures> {
    let scratch = Scratch::new()?;
    let maps = scratch.join("state/maps");
    fs::create_dir_all(&maps)?;
    fs::write(maps.join("000001.map"), Home::first_version())?;
    let _robot = Robot::switch_on(scratch.join("tty"))?;
    let mut trial = Trial {
        store,
        vthal,
        scratch: &scratch,
        random: seed,
        numbers: 0,
        usual: Duration::from_millis(10),
        figures: Figures::default(),
    };
    let mut possible = None;
    for kill in 1..=kills {
        possible = Some(
            trial
                .live_once(possible)
                .with_context(|| format!("life {kill} of the daemon"))?,
        );
    }
    Ok(trial.figures)
}

/// What the next life may find: what was acknowledged, or that and the change that was cut off.
struct Possible {
    acknowledged: Vec<String>,
    cut_off: Option<Vec<String>>,
}

struct Trial<'a> {
    store: &'a dyn Store,
    vthal: &'a Path,
    scratch: &'a Scratch,
    random: u64,
    /// Numbers given to changes.
    numbers: u64,
    /// Time of the last acknowledged change.
    usual: Duration,
    figures: Figures,
}

impl Trial<'_> {
    /// One life of the daemon, from its start to its kill.
    fn live_once(&mut self, possible: Option<Possible>) -> anyhow::Result<Possible> {
        let started = Instant::now();
        let daemon = Daemon::start(self.vthal, self.scratch, &["--seed", "1"])?;
        self.figures.ready_within = self.figures.ready_within.max(started.elapsed());
        let mut desk = Desk::new(Client::watching(&self.scratch.join("vthal.sock"), r#"["log"]"#)?);
        self.store.get_ready(&mut desk)?;
        self.compare(&mut desk, possible.as_ref())?;
        for _ in 0..next_random(&mut self.random) % (WHOLE_CHANGES_MAX + 1) {
            self.change_and_look(&mut desk)?;
        }
        self.kill_in_a_change(daemon, &mut desk)
    }

    fn compare(&mut self, desk: &mut Desk, possible: Option<&Possible>) -> anyhow::Result<()> {
        let found = texts(&self.store.read(desk)?);
        if !desk.errors.is_empty() {
            self.figures.corrupt += 1;
            eprintln!("damage: {}", desk.errors.join("; "));
        }
        let Some(possible) = possible else { return Ok(()) };
        if possible.cut_off.as_ref() == Some(&found) {
            self.figures.cut_off_there += 1;
        } else if possible.acknowledged != found {
            self.figures.lost += 1;
            eprintln!("acknowledged: {:#?}\nfound: {found:#?}", possible.acknowledged);
        }
        Ok(())
    }

    fn change_and_look(&mut self, desk: &mut Desk) -> anyhow::Result<()> {
        let kept = self.store.read(desk)?;
        let change = self.store.change(&kept, self.next_number());
        let started = Instant::now();
        desk.carry_out(9, change.request)?;
        self.usual = started.elapsed();
        self.figures.acknowledged += 1;
        let found = texts(&self.store.read(desk)?);
        if found != change.after {
            bail!(
                "after a change was done it keeps {found:#?} in place of {:#?}",
                change.after
            );
        }
        Ok(())
    }

    fn kill_in_a_change(&mut self, daemon: Daemon, desk: &mut Desk) -> anyhow::Result<Possible> {
        let kept = self.store.read(desk)?;
        let change = self.store.change(&kept, self.next_number());
        let within_us = u64::try_from((self.usual * KILL_WITHIN).as_micros()).unwrap_or(u64::MAX);
        let pause = Duration::from_micros(next_random(&mut self.random) % within_us.max(1));
        desk.send(9, change.request)?;
        thread::sleep(pause);
        daemon.kill()?;
        self.figures.kills += 1;
        if desk.was_acknowledged(9)? {
            self.figures.acknowledged += 1;
            return Ok(Possible {
                acknowledged: change.after,
                cut_off: None,
            });
        }
        self.figures.cut_off += 1;
        Ok(Possible {
            acknowledged: texts(&kept),
            cut_off: Some(change.after),
        })
    }

    fn next_number(&mut self) -> u64 {
        self.numbers += 1;
        self.numbers
    }
}

/// A robot on its dock, which outlives the daemons.
struct Robot {
    ends: Arc<AtomicBool>,
    life: Option<JoinHandle<()>>,
}

impl Robot {
    fn switch_on(link: PathBuf) -> anyhow::Result<Self> {
        let ends = Arc::new(AtomicBool::new(false));
        let mut robot = SyntheticRobot::switch_on(&link, BinaryKinds::ALL, 1)?;
        robot.dock();
        let told = Arc::clone(&ends);
        let life = thread::spawn(move || {
            while !told.load(Ordering::Relaxed) {
                let deadline = Instant::now() + Duration::from_millis(200);
                if let Err(error) = robot.live_until(deadline, |_| false) {
                    eprintln!("bench-writes: the robot: {error}");
                    return;
                }
            }
        });
        Ok(Self {
            ends,
            life: Some(life),
        })
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        if let Some(life) = self.life.take()
            && life.join().is_err()
        {
            eprintln!("bench-writes: the robot's thread panicked");
        }
    }
}
