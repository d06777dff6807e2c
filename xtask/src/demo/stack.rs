//! All services together: started one after the other, ended so that the wheels stop first.

use super::service::{Event, Service};
use super::state::State;
use super::{DemoArguments, preflight};
use crate::codegen::robots;
use crate::process;
use crate::workspace::{self, Profile, program};
use anyhow::{Context, bail};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// How long a service may take to become ready.
const READY: Duration = Duration::from_secs(30);

/// The services and the events they cause.
#[derive(Debug)]
pub(crate) struct Stack {
    // Dropped in this order: services end before their folder goes.
    services: Vec<Service>,
    events: Receiver<Event>,
    sender: Sender<Event>,
    state: State,
}

impl Stack {
    /// No service yet; from now on signals become events.
    pub(crate) fn new(state: State) -> anyhow::Result<Self> {
        let (sender, events) = channel();
        let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP])?;
        let to = sender.clone();
        std::thread::spawn(move || {
            signals
                .forever()
                .for_each(|_| to.send(Event::Interrupted).unwrap_or(()))
        });
        Ok(Self {
            services: Vec::new(),
            events,
            sender,
            state,
        })
    }

    /// Starts the simulator, with this firmware in an emulated chip if there is one, then the daemon on its serial link.
    pub(crate) fn start_robot(
        &mut self,
        arguments: &DemoArguments,
        firmware: Option<&Path>,
    ) -> anyhow::Result<()> {
        let speed = arguments.speed().to_string();
        let mut simulator = Command::new(program("rvac-sim", Profile::Dev));
        simulator
            .arg("serve")
            .arg("--home")
            .arg(std::path::absolute(preflight::here(arguments))?);
        simulator.args([
            "--robot",
            &arguments.robot,
            "--seed",
            &arguments.seed.to_string(),
            "--speed",
            &speed,
        ]);
        simulator
            .arg("--link")
            .arg(self.link())
            .arg("--socket")
            .arg(self.simulator_socket());
        if let Some(firmware) = firmware {
            simulator.arg("--firmware").arg(firmware);
        }
        self.start("rvac-sim", &simulator)?;

        let mut daemon = Command::new(program("vthal", Profile::Dev));
        daemon
            .arg("--config")
            .arg(self.write_configuration(&arguments.robot)?)
            .arg("--serial")
            .arg(self.link())
            .arg("--socket")
            .arg(self.daemon_socket());
        daemon
            .arg("--state")
            .arg(self.state.path("vthal"))
            .args(["--speed", &speed]);
        self.start("vthal", &daemon)?;
        Ok(())
    }

    /// Tells the daemon where the robot's sensors sit, so that it maps what they see and not only what it touches.
    fn write_configuration(&self, robot: &str) -> anyhow::Result<PathBuf> {
        let description = robots::description(&workspace::root().join("robots"), robot)?
            .with_context(|| format!("robot {robot:?} is not described in robots/"))?;
        let description = toml::Value::String(description.display().to_string());
        let path = self.state.path("vthal.toml");
        std::fs::write(&path, format!("[robot]\ndescription = {description}\n"))
            .with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
    }

    /// Starts the panel server; gives the address of the page.
    pub(crate) fn start_panel(&mut self, port: u16, assets: &Path) -> anyhow::Result<String> {
        let mut server = Command::new(program("panel-server", Profile::Dev));
        server
            .arg("--vthal")
            .arg(self.daemon_socket())
            .arg("--simulator")
            .arg(self.simulator_socket());
        server
            .args(["--port", &port.to_string()])
            .arg("--assets")
            .arg(assets);
        self.start("panel-server", &server)
    }

    /// The socket of the daemon.
    pub(crate) fn daemon_socket(&self) -> PathBuf {
        self.state.path("vthal.sock")
    }

    /// The socket of the simulator.
    pub(crate) fn simulator_socket(&self) -> PathBuf {
        self.state.path("sim.sock")
    }

    fn link(&self) -> PathBuf {
        self.state.path("robot")
    }

    /// Where events can be sent to.
    pub(crate) fn sender(&self) -> Sender<Event> {
        self.sender.clone()
    }

    /// Starts a service and waits until it says that it is ready; gives what it said besides.
    fn start(&mut self, name: &'static str, command: &Command) -> anyhow::Result<String> {
        process::say(&format!("start {name}"));
        self.services.push(Service::start(name, command, &self.sender)?);
        let deadline = Instant::now() + READY;
        while let Some(event) = self.next(deadline)? {
            match event {
                Event::Ready(who, rest) if who == name => return Ok(rest),
                Event::Interrupted => bail!("interrupted while {name} was starting"),
                _ => {}
            }
        }
        bail!("{name} was not ready within {} s", READY.as_secs())
    }

    /// The next event; `None` at the deadline. A service that ends by itself is an error.
    pub(crate) fn next(&mut self, deadline: Instant) -> anyhow::Result<Option<Event>> {
        match self
            .events
            .recv_timeout(deadline.saturating_duration_since(Instant::now()))
        {
            Ok(Event::Closed(name)) => bail!("{}", self.obituary(name)),
            Ok(event) => Ok(Some(event)),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => Ok(None),
        }
    }

    fn obituary(&mut self, name: &str) -> String {
        match self.services.iter_mut().find(|service| service.name() == name) {
            Some(service) => service.obituary(),
            None => format!("{name} ended"),
        }
    }

    /// Runs until somebody asks to end; fails when a service ends by itself.
    pub(crate) fn wait(&mut self) -> anyhow::Result<()> {
        loop {
            match self.events.recv()? {
                Event::Interrupted => return Ok(()),
                Event::Closed(name) => bail!("{}", self.obituary(name)),
                _ => {}
            }
        }
    }

    /// Ends the daemon first, so that the wheels stop, then the rest from the last started to the first.
    pub(crate) fn stop(&mut self) {
        process::say("stop everything, the wheels first");
        let daemon = self.services.iter().position(|service| service.name() == "vthal");
        if let Some(daemon) = daemon {
            self.end(daemon);
        }
        while let Some(last) = self.services.len().checked_sub(1) {
            self.end(last);
        }
    }

    fn end(&mut self, index: usize) {
        let mut service = self.services.remove(index);
        if let Err(error) = service.stop() {
            process::complain(&format!("{} could not be stopped: {error}", service.name()));
        }
    }
}
