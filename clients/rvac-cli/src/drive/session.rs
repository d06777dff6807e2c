//! One drive: readings come in, requests go out under a lease.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use anyhow::bail;
use mixer::{
    BumpWatch, ClientInputs, Device, Mixer, Pilot, Profile, Readings, Remarks, STEP_EVERY_US, Source,
    TopSpeeds,
};
use rvac_api::{Request, RequestBody, RobotDescription, Status, Topic, Update};

use super::DriveEvent;
use super::shaker::Shaker;
use crate::socket::Connection;

/// Period at which the mixer reads the inputs.
const TICK: Duration = Duration::from_micros(STEP_EVERY_US);
/// Number of the drive requests, so that a refusal of one is known as such.
const DRIVE_ID: u32 = 1;
/// Number of all other requests.
const PRESS_ID: u32 = 2;

/// A person who drives.
pub(super) struct Session {
    connection: Connection,
    top: TopSpeeds,
    pilot: Pilot,
    readings: Readings,
    /// Inputs of other clients.
    client_inputs: ClientInputs,
    /// Pads that can shake, by their numbers.
    shakers: BTreeMap<u8, Shaker>,
    bumps: BumpWatch,
    start: Instant,
    remarks: Remarks,
}

fn top(robot: &RobotDescription) -> TopSpeeds {
    TopSpeeds {
        forward_m_per_s: robot.speed_max_m_per_s,
        turn_rad_per_s: robot.turn_max_rad_per_s,
    }
}

/// Hears the daemon on a thread of its own.
pub(super) fn hear(mut connection: Connection, events: Sender<DriveEvent>) {
    std::thread::spawn(move || {
        loop {
            let event = match connection.receive() {
                Ok(message) => message.update.map(|update| DriveEvent::Daemon(Box::new(update))),
                Err(error) => Some(DriveEvent::Lost(error)),
            };
            let is_over = matches!(event, Some(DriveEvent::Lost(_)));
            if event.is_some_and(|event| events.send(event).is_err()) || is_over {
                return;
            }
        }
    });
}

impl Session {
    pub(super) fn new(
        mut connection: Connection,
        profile: Profile,
        robot: &RobotDescription,
    ) -> anyhow::Result<Self> {
        connection.watch(vec![Topic::Inputs, Topic::Status])?;
        Ok(Self {
            connection,
            top: top(robot),
            pilot: Pilot::new(Mixer::new(profile)?),
            readings: Readings::default(),
            client_inputs: ClientInputs::default(),
            shakers: BTreeMap::new(),
            bumps: BumpWatch::default(),
            start: Instant::now(),
            remarks: Remarks::default(),
        })
    }

    /// Drives until the inputs end or the daemon goes.
    pub(super) fn run(&mut self, inbox: &Receiver<DriveEvent>) -> anyhow::Result<ExitCode> {
        remark(&format!("drives by the mix {}", self.pilot.profile().name))?;
        let mut tick = Instant::now();
        loop {
            let left = tick.saturating_duration_since(Instant::now());
            // First of all: however much comes in, the lease is renewed.
            if left.is_zero() {
                self.step()?;
                tick = Instant::now() + TICK;
            }
            match inbox.recv_timeout(left) {
                Ok(event) => {
                    if self.take(event)? {
                        self.readings = Readings::default();
                        self.step()?;
                        return Ok(ExitCode::SUCCESS);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => bail!("all inputs have ended"),
            }
        }
    }

    /// Whether it is over.
    fn take(&mut self, event: DriveEvent) -> anyhow::Result<bool> {
        match event {
            DriveEvent::Moved(source, value) => {
                self.readings.set(&source, value);
            }
            DriveEvent::Plugged(pad, reading) => {
                self.readings.pads.insert(pad, reading);
            }
            DriveEvent::Heard(pad) => self.readings.note_word(pad),
            DriveEvent::Gone(device) => self.lose(&device)?,
            DriveEvent::CanShake(pad, shaker) => {
                self.shakers.insert(pad, shaker);
            }
            DriveEvent::Remark(text) if text.is_empty() => {}
            DriveEvent::Remark(text) => remark(&text)?,
            DriveEvent::Ended => return Ok(true),
            DriveEvent::Wrong(error) => return Err(error.into()),
            DriveEvent::Daemon(update) => self.hear(*update)?,
            DriveEvent::Lost(error) => return Err(error),
        }
        Ok(false)
    }

    /// The mixer sees at once that a device is gone: another one may take its number before the next step.
    fn lose(&mut self, device: &Device) -> anyhow::Result<()> {
        self.readings.remove(device);
        if let Device::Pad(pad) = device {
            self.shakers.remove(pad);
        }
        remark(&format!("{device} is gone: the wheels stand"))?;
        self.step()
    }

    fn hear(&mut self, update: Update) -> anyhow::Result<()> {
        match update {
            Update::Failed(failure) => {
                if failure.id == Some(DRIVE_ID) {
                    self.pilot.refuse();
                }
                remark(&format!("refused ({}): {}", failure.reason, failure.text))?;
            }
            Update::Hello {
                robot: Some(robot), ..
            } => self.top = top(&robot),
            Update::Status(status) => self.feel(&status),
            Update::Inputs { inputs } => self.client_inputs.replace(self.now_us(), &inputs),
            _ => {}
        }
        Ok(())
    }

    fn step(&mut self) -> anyhow::Result<()> {
        let now_us = self.now_us();
        self.take_client_inputs(now_us)?;
        let steered = self.pilot.step(now_us, &self.readings, self.top);
        for line in self.remarks.on(now_us, &steered) {
            remark(&line.to_string())?;
        }
        for body in steered.presses {
            self.send(PRESS_ID, body)?;
        }
        steered.seat.map_or(Ok(()), |body| self.send(DRIVE_ID, body))
    }

    /// All pads rumble at a bump.
    fn feel(&mut self, status: &Status) {
        if !self.bumps.look(status) {
            return;
        }
        for shaker in self.shakers.values_mut() {
            shaker.shake().ok(); // The reader of a pad reports that it is gone.
        }
    }

    fn now_us(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX)
    }

    /// Takes the inputs of other clients at this moment.
    fn take_client_inputs(&mut self, now_us: u64) -> anyhow::Result<()> {
        let now = self.client_inputs.at(now_us);
        let before = std::mem::replace(&mut self.readings.clients, now);
        let gone = before
            .into_keys()
            .filter(|name| !self.readings.clients.contains_key(name));
        for source in gone.map(Source::Client) {
            if self.pilot.profile().sources().any(|named| *named == source) {
                remark(&format!("{source} is gone: the wheels stand"))?;
            }
        }
        Ok(())
    }

    fn send(&mut self, id: u32, body: RequestBody) -> anyhow::Result<()> {
        self.connection.send(&Request { id: Some(id), body })
    }
}

/// Prints a line for the person. The terminal may be raw, where a line needs its carriage return.
fn remark(text: &str) -> anyhow::Result<()> {
    let mut output = std::io::stdout().lock();
    write!(output, "{text}\r\n")?;
    Ok(output.flush()?)
}
