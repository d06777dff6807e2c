//! Kills the daemon at random moments while a simulated robot drives, and looks whether it stands in time.
//!
//! What the robot does is taken from the simulator's own truth, over the simulator's socket: the daemon is dead then.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use clap::Parser;
use rvac_api::{Pose, SimulatedTruth, Update};

use vthal_bench::{Client, Daemon, Scratch, needed_beside, next_random};

/// The robot must stand this long after the daemon's end (S1).
const STAND_WITHIN_S: f64 = 0.3;
/// Two poses within this way are the same place.
const SAME_PLACE_M: f64 = 0.001;
/// How long the robot is watched after a kill, in simulated seconds.
const WATCHED_S: f64 = 0.8;
/// Pause between two looks at the robot after a kill.
const LOOKS_EVERY: Duration = Duration::from_millis(3);
/// Radius of the robot.
const RADIUS_M: f64 = 0.175;
/// Longest wait for the robot to drive (again), announcement and hand shake included.
const DRIVES_WITHIN: Duration = Duration::from_secs(30);

#[derive(Parser)]
#[command(about = "Kills vthal with SIGKILL at random moments while a simulated robot drives")]
struct Arguments {
    /// Number of kills
    #[arg(long, default_value_t = 10)]
    kills: u32,
    /// Robots that share the kills, each with a daemon and a home of its own; they all keep to the clock on the wall
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    robots: u32,
    /// Seed of the moments
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Home for the simulator
    #[arg(long)]
    home: PathBuf,
    /// Prints one JSON object instead of lines
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("bench-kill: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let lives = thread::scope(|scope| {
        let lives: Vec<_> = (0..arguments.robots)
            .map(|robot| scope.spawn(move || live(arguments, robot)))
            .collect();
        lives
            .into_iter()
            .map(|life| life.join().unwrap_or_else(|_| bail!("a robot's thread panicked")))
            .collect::<anyhow::Result<Vec<Life>>>()
    })?;
    let kills: u32 = lives.iter().map(|life| life.kills).sum();
    let late: u32 = lives.iter().map(|life| life.late).sum();
    let worst_s = lives.iter().map(|life| life.worst_s).fold(0.0, f64::max);
    if arguments.json {
        println!(
            "{}",
            serde_json::json!({"kills": kills, "late": late, "stood_within_s": worst_s, "went_on": kills})
        );
    } else {
        println!("{kills} kills, {late} late, stood within {worst_s:.2} s, went on each time");
    }
    Ok(if late == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// What one robot went through.
#[derive(Debug, Default)]
struct Life {
    kills: u32,
    /// Kills after which it drove for too long.
    late: u32,
    worst_s: f64,
}

/// The robot of this number with its share of the kills.
fn live(arguments: &Arguments, robot: u32) -> anyhow::Result<Life> {
    let (vthal, simulator) = (needed_beside("vthal")?, needed_beside("rvac-sim")?);
    let scratch = Scratch::new()?;
    let seed = arguments.seed + u64::from(robot);
    let _simulator = start_simulator(&simulator, &scratch, &arguments.home, seed)?;
    let mut truth = Truth {
        client: Client::connect(&scratch.join("sim.sock"))?,
    };
    let mut random = seed;
    let mut daemon = Daemon::start(&vthal, &scratch, &[])?;
    start_cleaning(&scratch)?;
    let mut life = Life::default();
    for kill in (0..arguments.kills)
        .skip(robot as usize)
        .step_by(arguments.robots as usize)
    {
        truth
            .wait_until_it_drives()
            .with_context(|| format!("before kill {}", kill + 1))?;
        truth.pass(Duration::from_micros(next_random(&mut random) % 1_500_000))?;
        let killed_s = truth.now()?.sim_s;
        daemon.kill()?;
        let stood_s = truth.seconds_until_it_stands(killed_s)?;
        life.kills += 1;
        life.worst_s = life.worst_s.max(stood_s);
        life.late += u32::from(stood_s > STAND_WITHIN_S);
        daemon = Daemon::start(&vthal, &scratch, &[])?;
        if !arguments.json {
            println!("kill {}: stood after at most {stood_s:.2} s", kill + 1);
        }
    }
    truth.wait_until_it_drives().context("after the last kill")?;
    Ok(life)
}

fn start_simulator(program: &Path, scratch: &Scratch, home: &Path, seed: u64) -> anyhow::Result<Daemon> {
    let mut command = Command::new(program);
    command.arg("serve").arg("--home").arg(home);
    command.arg("--seed").arg(seed.to_string());
    command
        .arg("--link")
        .arg(scratch.join("tty"))
        .arg("--socket")
        .arg(scratch.join("sim.sock"));
    Daemon::start_command(command).context("rvac-sim serve")
}

fn start_cleaning(scratch: &Scratch) -> anyhow::Result<()> {
    let mut client = Client::watching(&scratch.join("vthal.sock"), r#"["status"]"#)?;
    let deadline = Instant::now() + Duration::from_secs(10);
    let ready = |update: &Update| matches!(update, Update::Status(status) if status.state == "idle" || status.state == "docked");
    if client.wait_for(deadline, ready)?.is_none() {
        bail!("the daemon found no robot within 10 s");
    }
    client.send(r#"{"c":"start","id":1}"#)?;
    match client.wait_for(deadline, |update| {
        matches!(update, Update::Done { id: 1 } | Update::Failed(_))
    })? {
        Some(Update::Done { .. }) => Ok(()),
        other => bail!("the start was refused: {other:?}"),
    }
}

/// The simulator's word on where the robot is.
struct Truth {
    client: Client,
}

impl Truth {
    /// Where the robot is now, give or take a millisecond.
    fn now(&mut self) -> anyhow::Result<SimulatedTruth> {
        self.client.send(r#"{"c":"truth"}"#)?;
        let deadline = Instant::now() + Duration::from_secs(5);
        let mut newest = None;
        // The words which come unasked may stand before the answer.
        while let Some(update) = self.client.wait_for(
            if newest.is_none() {
                deadline
            } else {
                Instant::now()
            },
            |update| matches!(update, Update::SimulatedTruth(_)),
        )? {
            if let Update::SimulatedTruth(truth) = update {
                newest = Some(truth);
            }
        }
        newest.context("the simulator is silent")
    }

    fn wait_until_it_drives(&mut self) -> anyhow::Result<()> {
        let deadline = Instant::now() + DRIVES_WITHIN;
        let mut before = self.now()?;
        while Instant::now() < deadline {
            thread::sleep(Duration::from_millis(100));
            let now = self.now()?;
            if moved(before.pose, now.pose) {
                return Ok(());
            }
            before = now;
        }
        bail!("the robot did not drive within {} s", DRIVES_WITHIN.as_secs())
    }

    /// Lets the robot drive for `pause`, and longer if it stands at its end.
    fn pass(&mut self, pause: Duration) -> anyhow::Result<()> {
        thread::sleep(pause);
        self.wait_until_it_drives()
    }

    /// Simulated seconds between `killed_s` and the first look from which the robot stays where it is.
    fn seconds_until_it_stands(&mut self, killed_s: f64) -> anyhow::Result<f64> {
        let mut looks = vec![self.now()?];
        let mut last = looks[0];
        while last.sim_s < killed_s + WATCHED_S {
            thread::sleep(LOOKS_EVERY);
            last = self.now()?;
            looks.push(last);
        }
        let stood = looks
            .iter()
            .rposition(|look| moved(look.pose, last.pose))
            .map_or(0, |moving| moving + 1);
        Ok(looks.get(stood).map_or(WATCHED_S, |look| look.sim_s - killed_s))
    }
}

/// Way of a point on the rim of the robot, so that turning on the spot counts too.
fn distance(from: Pose, to: Pose) -> f64 {
    let turn_rad = (to.heading - from.heading)
        .sin()
        .atan2((to.heading - from.heading).cos());
    (to.x - from.x).hypot(to.y - from.y) + RADIUS_M * turn_rad.abs()
}

fn moved(from: Pose, to: Pose) -> bool {
    distance(from, to) > SAME_PLACE_M
}
