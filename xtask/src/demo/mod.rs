//! `cargo xtask demo`: the whole software around a simulated robot.
//!
//! Words: a *service* is one child process (`rvac-sim`, `vthal`, `panel-server`); the *stack* is all of them; the
//! *state folder* is a private folder with their sockets, logs and recordings.

mod headless;
mod preflight;
mod report;
mod service;
mod socket;
mod stack;
mod state;
mod trace;

use crate::{panel, process, workspace};
use stack::Stack;
use state::State;
use std::path::PathBuf;

/// The home of who names none.
const DEFAULT_HOME: &str = "homes/two-room-flat.toml";

/// Arguments of `cargo xtask demo`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Floor plan: a map_server YAML, a Valetudo map JSON, or a home of ours in TOML.
    #[arg(long, default_value = DEFAULT_HOME)]
    home: PathBuf,
    /// Robot, by the name of its robot.toml.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many times as fast as the clock on the wall. The page is meant for 1; without a page the default is 10.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=100))]
    speed: Option<u32>,
    /// Port of the panel on this machine.
    #[arg(long, default_value_t = 8080)]
    port: u16,
    /// Keep sockets, logs and recordings in this new folder instead of a temporary one.
    #[arg(long)]
    state: Option<PathBuf>,
    /// No browser: start cleaning at once and print one JSON object at the end.
    #[arg(long)]
    headless: bool,
    /// Simulated minutes to clean, with --headless.
    #[arg(long, default_value_t = 10.0, requires = "headless")]
    minutes: f64,
}

impl Arguments {
    fn speed(&self) -> u32 {
        self.speed.unwrap_or(if self.headless { 10 } else { 1 })
    }
}

/// Checks the input, builds, starts everything, and stays until it is told to stop.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    preflight::arguments(arguments)?;
    preflight::home(arguments)?;
    if arguments.headless {
        workspace::build(&["rvac-sim", "vthal"], workspace::Profile::Dev)?;
        return headless::run(arguments);
    }
    workspace::build(&["rvac-sim", "vthal", "panel-server"], workspace::Profile::Dev)?;
    let assets = panel::build()?;
    preflight::port(arguments.port)?;
    let state = State::create(arguments.state.as_deref())?;
    let mut stack = Stack::new(state)?;
    let outcome = serve(arguments, &assets, &mut stack);
    stack.stop();
    outcome
}

fn serve(arguments: &Arguments, assets: &std::path::Path, stack: &mut Stack) -> anyhow::Result<()> {
    stack.start_robot(arguments)?;
    let address = stack.start_panel(arguments.port, assets)?;
    process::say(
        "the robot stands in its home and waits. Open this page and press Start; Ctrl-C ends it all:",
    );
    process::print(&address);
    stack.wait()
}
