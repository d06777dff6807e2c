//! The daemon, with a robot on its dock and a client.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, Daemon, LivingRobot, Scratch, SyntheticRobot};

use crate::home;
use crate::life::{Keeper, Kept, Life};
use crate::store::{Desk, Store};

/// The request that is a change.
const CHANGE_ID: u32 = 9;

/// The daemon as the keeper of one kind.
pub(crate) struct AtDaemon<'a> {
    store: &'a dyn Store,
    vthal: &'a Path,
    scratch: Scratch,
    _robot: LivingRobot,
}

impl<'a> AtDaemon<'a> {
    /// On a folder of its own, in which the daemon finds the map of a home.
    pub(crate) fn new(store: &'a dyn Store, vthal: &'a Path) -> anyhow::Result<Self> {
        let scratch = Scratch::new()?;
        let maps = scratch.join("state/maps");
        fs::create_dir_all(&maps)?;
        fs::write(maps.join("000001.map"), home::first_version())?;
        let mut robot = SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1)?;
        robot.dock();
        Ok(Self {
            store,
            vthal,
            _robot: LivingRobot::new(robot),
            scratch,
        })
    }
}

impl AtDaemon<'_> {
    /// The daemon's program.
    pub(crate) fn vthal(&self) -> &Path {
        self.vthal
    }

    /// The folder in which everything is kept.
    pub(crate) fn state(&self) -> PathBuf {
        self.scratch.join("state")
    }

    /// The socket for clients.
    pub(crate) fn socket(&self) -> PathBuf {
        self.scratch.join("vthal.sock")
    }

    /// Starts the daemon by a command that becomes it.
    pub(crate) fn start_as(&self, command: Command) -> anyhow::Result<Box<OfDaemon<'_>>> {
        let daemon = Daemon::start_as(command, &self.scratch, &["--seed", "1"])?;
        let client = Client::watching(&self.socket(), r#"["log"]"#)?;
        Ok(Box::new(OfDaemon {
            store: self.store,
            daemon,
            desk: Desk::new(client),
        }))
    }
}

impl Keeper for AtDaemon<'_> {
    fn name(&self) -> &'static str {
        self.store.name()
    }

    fn start(&self) -> anyhow::Result<Box<dyn Life + '_>> {
        let life = self.start_as(Command::new(self.vthal))?;
        Ok(life)
    }
}

/// The daemon while it runs.
pub(crate) struct OfDaemon<'a> {
    store: &'a dyn Store,
    daemon: Daemon,
    desk: Desk,
}

impl OfDaemon<'_> {
    /// Waits until the change is acknowledged or refused; whether it was acknowledged.
    pub(crate) fn wait_for_answer(&mut self) -> anyhow::Result<bool> {
        self.desk.wait_for_answer(CHANGE_ID)
    }
}

impl Life for OfDaemon<'_> {
    fn get_ready(&mut self) -> anyhow::Result<()> {
        self.store.get_ready(&mut self.desk)
    }

    fn read(&mut self) -> anyhow::Result<Kept> {
        self.store.read(&mut self.desk)
    }

    fn begin_change(&mut self, kept: &Kept, number: u64) -> anyhow::Result<Vec<String>> {
        let change = self.store.change(kept, number);
        self.desk.send(CHANGE_ID, change.request)?;
        Ok(change.after)
    }

    fn finish_change(&mut self) -> anyhow::Result<()> {
        self.desk.wait_for_acknowledgement(CHANGE_ID)
    }

    fn kill(self: Box<Self>) -> anyhow::Result<bool> {
        let Self { daemon, mut desk, .. } = *self;
        daemon.kill()?;
        desk.was_acknowledged(CHANGE_ID)
    }

    fn damage(&self) -> &[String] {
        &self.desk.errors
    }
}
