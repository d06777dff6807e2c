//! A simulated robot in a home that it knows, and the real daemon with it.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::process::{Scratch, Server, ask, ask_for, beside};
use crate::program::wait_for;
use anyhow::ensure;

/// An answer comes within this time.
const PATIENCE: Duration = Duration::from_secs(5);

/// All of it; gone when it is dropped.
#[derive(Debug)]
pub(crate) struct Home {
    pub(crate) scratch: Scratch,
    daemon: Option<Server>,
    _simulator: Server,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

impl Home {
    pub(crate) fn start() -> anyhow::Result<Self> {
        let scratch = Scratch::new()?;
        let maps = scratch.join("state/maps");
        std::fs::create_dir_all(&maps)?;
        let simulator = |first: &str| -> anyhow::Result<Command> {
            let mut command = Command::new(beside("rvac-sim")?);
            command.current_dir(root()).arg(first);
            command.args([
                "--robot",
                "sr8730",
                "--seed",
                "7",
                "--home",
                "homes/two-room-flat.toml",
            ]);
            Ok(command)
        };
        let mut keep = simulator("run")?;
        keep.args([
            "--known-map",
            "--minutes",
            "1",
            "--strategy",
            "systematic",
            "--save-map",
        ]);
        keep.arg(maps.join("000001.map")).stdout(Stdio::null());
        ensure!(keep.status()?.success(), "the simulator makes no map");
        let mut serve = simulator("serve")?;
        serve.arg("--link").arg(scratch.join("tty"));
        serve.arg("--socket").arg(scratch.join("simulator.sock"));
        let simulator = Server::start(serve)?;
        let description = root().join("robots/samsung-sr8730/robot.toml");
        let configuration = format!("[robot]\ndescription = {:?}\n", description.display().to_string());
        std::fs::write(scratch.join("vthal.toml"), configuration)?;
        let mut home = Self {
            scratch,
            daemon: None,
            _simulator: simulator,
        };
        home.start_daemon()?;
        home.wait_for_robot()?;
        Ok(home)
    }

    /// The daemon is ready before its robot answers.
    fn wait_for_robot(&self) -> anyhow::Result<()> {
        wait_for("the robot answers the daemon", Duration::from_secs(20), || {
            let status = self.told("status")?;
            Ok((!status.contains(r#""state":"disconnected""#)).then_some(()))
        })
    }

    /// What the daemon says first to whoever follows a topic.
    pub(crate) fn told(&self, topic: &str) -> anyhow::Result<String> {
        let watch = format!(r#"{{"c":"watch","topics":["{topic}"]}}"#);
        ask(&self.socket(), &watch, PATIENCE)
    }

    pub(crate) fn socket(&self) -> PathBuf {
        self.scratch.join("vthal.sock")
    }

    pub(crate) fn start_daemon(&mut self) -> anyhow::Result<()> {
        let mut command = Command::new(beside("vthal")?);
        command.arg("--config").arg(self.scratch.join("vthal.toml"));
        command.arg("--serial").arg(self.scratch.join("tty"));
        command.arg("--socket").arg(self.socket());
        command.arg("--state").arg(self.scratch.join("state"));
        let daemon = Server::start(command)?;
        self.daemon = Some(daemon);
        Ok(())
    }

    /// Ends the daemon as a power failure would.
    pub(crate) fn kill_daemon(&mut self) {
        self.daemon = None;
    }

    /// Says something to the daemon itself, and waits until it is done.
    pub(crate) fn order(&self, request: &str) -> anyhow::Result<()> {
        let answer = ask(&self.socket(), &request.replacen('{', r#"{"id":1,"#, 1), PATIENCE)?;
        ensure!(answer == r#"{"e":"done","id":1}"#, "{request}: {answer}");
        Ok(())
    }

    /// Does what the hand of a person does, at the simulator.
    pub(crate) fn hand(&self, request: &str) -> anyhow::Result<()> {
        let socket = self.scratch.join("simulator.sock");
        // It tells everybody the plan of its home first.
        let answer = ask_for(&socket, (request, PATIENCE), |line| {
            !line.contains("simulated-plan")
        })?;
        ensure!(
            answer == r#"{"e":"done"}"#,
            "the simulator does not do {request}: {answer}"
        );
        Ok(())
    }
}
