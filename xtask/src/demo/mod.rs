//! `cargo xtask demo`: the whole software around a simulated robot.
//!
//! Words: a *service* is one child process (`rvac-sim`, `vthal`, `panel-server`); the *stack* is all of them; the
//! *state folder* is a private folder with their sockets, logs and recordings.

mod forecast;
mod headless;
mod preflight;
mod report;
mod service;
mod socket;
mod stack;
mod state;
mod trace;

use crate::firmware::RobotFirmware;
use crate::panel::{self, Ahead, Page};
use crate::{process, workspace};
use stack::Stack;
use state::State;
use std::path::{Path, PathBuf};

/// The home of who names none.
const DEFAULT_HOME: &str = "homes/two-room-flat.toml";

/// Arguments of `cargo xtask demo`.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct DemoArguments {
    /// Floor plan: a map_server YAML, a Valetudo map JSON, or a home of ours in TOML.
    #[arg(long, default_value = DEFAULT_HOME)]
    home: PathBuf,
    /// Robot, by the name of its robot.toml.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many times as fast as the clock on the wall. The page and an emulated chip are meant for 1; otherwise the
    /// default without a page is 10.
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
    /// The robot's real firmware in an emulated chip, instead of the same logic built for this machine.
    #[arg(long)]
    emulated: bool,
    /// With --emulated: a robot on which only what stands in this file was measured.
    #[arg(long, value_name = "FILE", requires = "emulated")]
    calibration: Option<PathBuf>,
    /// Simulated minutes to clean, with --headless.
    #[arg(long, default_value_t = 10.0, requires = "headless")]
    minutes: f64,
}

impl DemoArguments {
    fn speed(&self) -> u32 {
        let usual = if self.headless && !self.emulated { 10 } else { 1 };
        self.speed.unwrap_or(usual)
    }

    /// Builds the firmware that the emulated chip runs; `None` when there is no such chip.
    fn firmware(&self) -> anyhow::Result<Option<PathBuf>> {
        if !self.emulated {
            return Ok(None);
        }
        let firmware = RobotFirmware::of(&self.robot)?;
        firmware.image(self.calibration.as_deref()).map(Some)
    }
}

/// Checks the input, builds, starts everything, and stays until it is told to stop.
pub(crate) fn run(arguments: &DemoArguments) -> anyhow::Result<()> {
    preflight::arguments(arguments)?;
    forecast::tell(arguments);
    if arguments.headless {
        preflight::home(arguments)?;
        let firmware = arguments.firmware()?;
        workspace::build(&["rvac-sim", "vthal"], workspace::Profile::Dev)?;
        return headless::run(arguments, firmware.as_deref());
    }
    let page = Ahead::begin(Page::Demo)?;
    preflight::home(arguments)?;
    let firmware = arguments.firmware()?;
    workspace::build(&["rvac-sim", "vthal", "panel-server"], workspace::Profile::Dev)?;
    page.finish()?;
    let assets = panel::build(Page::Demo)?;
    preflight::port(arguments.port)?;
    let state = State::create(arguments.state.as_deref())?;
    let mut stack = Stack::new(state)?;
    let outcome = stack
        .start_robot(arguments, firmware.as_deref())
        .and_then(|()| serve(arguments.port, &assets, &mut stack));
    stack.stop();
    outcome
}

fn serve(port: u16, assets: &Path, stack: &mut Stack) -> anyhow::Result<()> {
    let address = stack.start_panel(port, assets)?;
    process::say(
        "the robot stands in its home and waits. Open this page and press Start; Ctrl-C ends it all:",
    );
    process::print(&address);
    process::say("rvac and scripts reach it after");
    process::print(&format!(
        "export RVAC_SOCKET={} RVAC_SIMULATOR={}",
        stack.daemon_socket().display(),
        stack.simulator_socket().display()
    ));
    stack.wait()
}
