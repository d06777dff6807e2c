//! One relay with a robot at its one end and clients at the other.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::bail;
use rvac_protocol::message::BinaryKinds;

use crate::reader::{Reader, read_ready};
use vthal_bench::{Daemon, Scratch, SyntheticRobot};

/// Who relays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Relay {
    /// The daemon.
    Vthal,
    /// The plain one.
    Plain,
}

impl Relay {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Vthal => "vthal",
            Self::Plain => "plain",
        }
    }
}

/// A relay that runs, with all who use it.
pub(crate) struct Lane {
    pub(crate) relay: Relay,
    pub(crate) robot: SyntheticRobot,
    pub(crate) daemon: Daemon,
    pub(crate) readers: Vec<Reader>,
    /// When each counted telemetry packet went out.
    moments: Vec<Instant>,
    /// From the write to the terminal to the end of the read from the socket, over all clients.
    pub(crate) latencies_us: Vec<f64>,
    _scratch: Scratch,
}

impl Lane {
    /// Starts a relay and its robot, which sends text, as the one of 2016 did and as a person reads it. Clients connect
    /// when everybody has greeted.
    pub(crate) fn start(relay: Relay, clients: usize, vthal: &Path) -> anyhow::Result<Self> {
        let scratch = Scratch::new()?;
        let mut robot = SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::NONE, 1)?;
        let socket = scratch.join("vthal.sock");
        let (daemon, request) = match relay {
            Relay::Vthal => {
                let daemon = Daemon::start(vthal, &scratch, &["--seed", "1"])?;
                wait_for_session(&mut robot)?;
                (daemon, Some(r#"{"c":"watch","topics":["packets"]}"#))
            }
            Relay::Plain => (start_plain(&scratch)?, None),
        };
        let readers = (0..clients).map(|_| Reader::connect(&socket, request));
        let readers = readers.collect::<anyhow::Result<_>>()?;
        robot.live_until(Instant::now() + Duration::from_millis(300), |_| false)?;
        let mut lane = Self {
            relay,
            robot,
            daemon,
            readers,
            moments: Vec::new(),
            latencies_us: Vec::new(),
            _scratch: scratch,
        };
        lane.drain()?;
        Ok(lane)
    }

    /// Reads what is under way and counts from zero again.
    pub(crate) fn drain(&mut self) -> anyhow::Result<()> {
        while read_ready(
            &mut self.readers.iter_mut().collect::<Vec<_>>(),
            Duration::from_millis(50),
        )? {}
        for reader in &mut self.readers {
            reader.packets = 0;
        }
        self.moments.clear();
        Ok(())
    }

    /// Sends one telemetry packet.
    pub(crate) fn report(&mut self) -> anyhow::Result<()> {
        self.moments.push(self.robot.report()?);
        Ok(())
    }

    /// Packets that every client has.
    pub(crate) fn arrived(&self) -> u64 {
        self.readers
            .iter()
            .map(|reader| reader.packets)
            .min()
            .unwrap_or_default()
    }

    /// Whether a packet is under way.
    pub(crate) fn waits(&self) -> bool {
        self.arrived() < self.moments.len() as u64
    }
}

/// Reads what comes to anybody within `pause` and notes how long it took.
pub(crate) fn listen(lanes: &mut [Lane], pause: Duration) -> anyhow::Result<()> {
    let counts = |lanes: &[Lane]| -> Vec<u64> {
        let readers = lanes.iter().flat_map(|lane| &lane.readers);
        readers.map(|reader| reader.packets).collect()
    };
    let before = counts(lanes);
    let mut readers: Vec<&mut Reader> = lanes.iter_mut().flat_map(|lane| &mut lane.readers).collect();
    read_ready(&mut readers, pause)?;
    let now = Instant::now();
    let mut before = before.into_iter();
    for lane in lanes {
        for reader in &lane.readers {
            let came = before.next().unwrap_or_default() as usize..reader.packets as usize;
            let moments = lane.moments.get(came).unwrap_or_default().iter();
            let latencies_us = moments.map(|moment| now.duration_since(*moment).as_secs_f64() * 1e6);
            lane.latencies_us.extend(latencies_us);
        }
    }
    Ok(())
}

fn wait_for_session(robot: &mut SyntheticRobot) -> anyhow::Result<()> {
    let deadline = Instant::now() + Duration::from_secs(10);
    if !robot.live_until(deadline, SyntheticRobot::is_sealed)? {
        bail!("the daemon opened no session");
    }
    robot.live_until(Instant::now() + Duration::from_millis(500), |_| false)?;
    Ok(())
}

fn start_plain(scratch: &Scratch) -> anyhow::Result<Daemon> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("plain").arg("--serial").arg(scratch.join("tty"));
    command.arg("--socket").arg(scratch.join("vthal.sock"));
    Ok(Daemon::start_command(command)?)
}
