//! A robot on the serial line, asked and answered one thing at a time, while a person reads and types.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow, bail};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Command, Inhibit, Inhibits, Led, LedPattern, Motor, MotorCommand, PROBE_LEASE_MS_MAX, Probe,
    ProbeTarget, Probed, ProbedContent, Refusal, Report, Sequence,
};
use rvac_protocol::session::{HostEvent, HostSession, SendError};
use rvac_units::{Ratio, Throttle, Tick};
use serial2::SerialPort;

use crate::lines;
use crate::listen::listen;

/// The robot must answer the handshake, and each question, within this time.
const PATIENCE: Duration = Duration::from_secs(5);
/// Longest pause between two polls of the session.
const LOOK: Duration = Duration::from_millis(10);
/// Life of a motor command, and the pause after which it is given again.
const LEASE_MS: u16 = 250;
const RENEW: Duration = Duration::from_millis(100);

/// Within this time the robot sends its state again.
const STATE: Duration = Duration::from_millis(100);
/// A robot that was put down counts as standing after a second (S10).
const STANDS: Duration = Duration::from_millis(2_500);

enum RobotEvent {
    Typed(String),
    InputEnded,
    Received(Vec<u8>),
    Lost(std::io::Error),
}

/// What has come in during a wait.
#[derive(Default)]
struct Reports {
    /// Number of lights, once the robot has described itself.
    lights: Option<u8>,
    probed: Vec<Probed>,
    answered: Option<(Sequence, Option<Refusal>)>,
    refused: Option<Refusal>,
    inhibits: Inhibits,
    unanswered: Option<Sequence>,
    typed: VecDeque<String>,
    input_ended: bool,
}

/// A motor that runs without its control loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpenLoop {
    pub(crate) motor: Motor,
    pub(crate) throttle: Throttle,
}

/// How long raw readings are taken.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Watch {
    /// So long.
    For(Duration),
    /// Until the person has typed a line, but no longer than this.
    UntilTyped(Duration),
}

/// What a target is, whichever port or rate.
fn kind_of(target: ProbeTarget) -> Kind {
    match target {
        ProbeTarget::Analog => Kind::Analog,
        ProbeTarget::Encoders => Kind::Encoders,
        ProbeTarget::Lines => Kind::Lines,
        ProbeTarget::Buttons => Kind::Buttons,
        ProbeTarget::Serial { .. } => Kind::Serial,
    }
}

/// What a reading is of.
fn target_of(content: &ProbedContent) -> Kind {
    match content {
        ProbedContent::Analog(_) => Kind::Analog,
        ProbedContent::Encoders(_) => Kind::Encoders,
        ProbedContent::Lines(_) => Kind::Lines,
        ProbedContent::Buttons(_) => Kind::Buttons,
        ProbedContent::Serial(_) => Kind::Serial,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Analog,
    Encoders,
    Lines,
    Buttons,
    Serial,
}

/// A session with a robot.
pub(crate) struct Robot {
    serial: Arc<SerialPort>,
    inbox: Receiver<RobotEvent>,
    start: Instant,
    session: HostSession,
    device: String,
    heard: Reports,
}

impl Robot {
    /// Opens the line and a session on it, and waits for the robot's description.
    pub(crate) fn open(port: &Path, baud: u32) -> anyhow::Result<Self> {
        let serial = SerialPort::open(port, baud)
            .with_context(|| format!("cannot open {} at {baud} baud", port.display()))?;
        let serial = Arc::new(serial);
        let (events, inbox) = channel();
        listen(
            Arc::clone(&serial),
            events.clone(),
            RobotEvent::Received,
            RobotEvent::Lost,
        );
        lines::read_input(events, RobotEvent::Typed, || RobotEvent::InputEnded);
        let mut robot = Self {
            serial,
            inbox,
            start: Instant::now(),
            session: HostSession::new(BinaryKinds::default(), Tick(0)),
            device: String::new(),
            heard: Reports::default(),
        };
        if robot.wait(PATIENCE, |heard| heard.lights.is_some())? {
            return Ok(robot);
        }
        bail!(
            "the robot does not answer the handshake: check power, cable, --port and --baud, and that vthal does not run"
        )
    }

    /// Name of the model.
    pub(crate) fn device(&self) -> &str {
        &self.device
    }

    /// The next line that the person types; `None` at the end of the input.
    pub(crate) fn next_line(&mut self) -> anyhow::Result<Option<String>> {
        loop {
            self.wait(Duration::from_secs(3600), |heard| {
                !heard.typed.is_empty() || heard.input_ended
            })?;
            if let Some(line) = self.heard.typed.pop_front() {
                return Ok(Some(line));
            }
            if self.heard.input_ended {
                return Ok(None);
            }
        }
    }

    /// Number of lights; the firmware numbers them from 0.
    pub(crate) fn lights(&self) -> u8 {
        self.heard.lights.unwrap_or(0)
    }

    /// Switches a light.
    pub(crate) fn light(&mut self, led: u8, on: bool) -> anyhow::Result<()> {
        self.send(Command::Led(Led {
            led,
            pattern: if on { LedPattern::On } else { LedPattern::Off },
            brightness: Ratio::ONE,
        }))
        .map(drop)
    }

    /// Lets time pass.
    pub(crate) fn pass(&mut self, span: Duration) -> anyhow::Result<()> {
        self.wait(span, |_| false).map(drop)
    }

    /// One raw reading.
    pub(crate) fn probe(&mut self, target: ProbeTarget) -> anyhow::Result<ProbedContent> {
        self.heard.probed.clear();
        self.command(Command::Probe(Probe {
            target,
            lease_ms: 0,
            sequence: Sequence(0),
        }))?;
        // A reading of something else may still come, of a lease that was given before.
        let asked_for = |probed: &Probed| target_of(&probed.content) == kind_of(target);
        self.wait(PATIENCE, |heard| heard.probed.iter().any(asked_for))?;
        match self.heard.probed.drain(..).find(asked_for) {
            Some(probed) => Ok(probed.content),
            None => bail!("the robot promised a raw reading and sent none"),
        }
    }

    /// Raw readings for `span`, or until the person has typed something if `until_typed`, as they come (each 50 ms), while
    /// `motors` run open loop; they are always stopped at the end. Motors need an armed robot; without any the
    /// robot need not be armed.
    pub(crate) fn watch(
        &mut self,
        target: ProbeTarget,
        motors: &[OpenLoop],
        span: Watch,
    ) -> anyhow::Result<Vec<Probed>> {
        self.heard.probed.clear();
        let watched = self.watch_running(target, motors, span);
        if !motors.is_empty() {
            self.stop()?;
        }
        watched
            .map(|()| std::mem::take(&mut self.heard.probed))
            .map(|probed| {
                probed
                    .into_iter()
                    .filter(|one| target_of(&one.content) == kind_of(target))
                    .collect()
            })
    }

    fn watch_running(&mut self, target: ProbeTarget, motors: &[OpenLoop], span: Watch) -> anyhow::Result<()> {
        let (Watch::For(longest) | Watch::UntilTyped(longest)) = span;
        let until_typed = matches!(span, Watch::UntilTyped(_));
        let end = Instant::now() + longest;
        let mut lease_until = Instant::now();
        let mut asked = false;
        loop {
            let now = Instant::now();
            if now >= end || (until_typed && (!self.heard.typed.is_empty() || self.heard.input_ended)) {
                return Ok(());
            }
            if now >= lease_until {
                self.command(Command::Probe(Probe {
                    target,
                    lease_ms: PROBE_LEASE_MS_MAX,
                    sequence: Sequence(0),
                }))?;
                if !std::mem::replace(&mut asked, true) {
                    // What came before the answer is of another rate, perhaps.
                    self.heard.probed.clear();
                }
                lease_until = now + Duration::from_millis(u64::from(PROBE_LEASE_MS_MAX) / 2);
            }
            self.run(motors)?;
            self.wait(RENEW.min(end - now), |heard| heard.refused.is_some())?;
            if let Some(refusal) = self.heard.refused.take() {
                return Err(self.refused("to run the motor", refusal));
            }
        }
    }

    /// Gives each motor its duty for the length of a lease.
    fn run(&mut self, motors: &[OpenLoop]) -> anyhow::Result<()> {
        for OpenLoop { motor, throttle } in motors.iter().copied() {
            self.send(Command::Motor(MotorCommand {
                motor,
                throttle,
                lease_ms: LEASE_MS,
                sequence: Sequence(0),
                seen_tick: Tick(0),
            }))?;
        }
        Ok(())
    }

    /// Allows motion, and waits until nothing else forbids it: a robot that was put down counts as lifted for a while.
    pub(crate) fn arm(&mut self) -> anyhow::Result<()> {
        self.command(Command::Arm {
            sequence: Sequence(0),
            undock: false,
        })?;
        if self.wait(STANDS, |heard| heard.inhibits.is_empty())? {
            return Ok(());
        }
        Err(self.refused("to move", Refusal::Inhibited))
    }

    /// Stops everything.
    pub(crate) fn stop(&mut self) -> anyhow::Result<()> {
        self.send(Command::Stop).map(drop)
    }

    /// Sends a command that must arrive and waits for its answer.
    fn command(&mut self, command: Command) -> anyhow::Result<()> {
        self.heard.answered = None;
        self.heard.refused = None;
        let Some(sent) = self.send(command)? else {
            return Ok(());
        };
        let answered = self.wait(PATIENCE, |heard| {
            heard.answered.is_some_and(|(sequence, _)| sequence == sent) || heard.unanswered == Some(sent)
        })?;
        match self.heard.answered.take() {
            Some((_, Some(refusal))) => Err(self.refused(command.name().name(), refusal)),
            Some((_, None)) if answered => Ok(()),
            _ => bail!("the robot did not answer {}", command.name().name()),
        }
    }

    /// A refusal in words, with what the robot says keeps it from moving.
    fn refused(&mut self, what: &str, refusal: Refusal) -> anyhow::Error {
        if refusal == Refusal::Inhibited {
            // The next state contains the present inhibits.
            self.pass(STATE).ok();
        }
        let reasons: Vec<&str> = self.heard.inhibits.iter().map(Inhibit::name).collect();
        if refusal != Refusal::Inhibited || reasons.is_empty() {
            return anyhow!("the robot refuses {what}: {}", refusal.name());
        }
        anyhow!("the robot refuses {what}: inhibited by {}", reasons.join(", "))
    }

    fn send(&mut self, command: Command) -> anyhow::Result<Option<Sequence>> {
        let mut buffer = PacketBuffer::new();
        match self.session.send(command, self.now(), &mut buffer) {
            Ok(sequence) => {
                self.transmit(buffer.as_bytes())?;
                Ok(sequence)
            }
            Err(SendError::NotOpen) => bail!("the robot has left the session: it was reset or lost power"),
            Err(SendError::Busy) => bail!("eight commands wait for their answers"),
            Err(SendError::Range | SendError::Reserved) => {
                bail!("{} cannot be sent to this robot", command.name().name())
            }
        }
    }

    /// Lets the session live for `span`, or until `until` is content; says whether it was.
    fn wait(&mut self, span: Duration, until: impl Fn(&Reports) -> bool) -> anyhow::Result<bool> {
        let end = Instant::now() + span;
        loop {
            self.keep_session()?;
            if until(&self.heard) {
                return Ok(true);
            }
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(false);
            }
            match self.inbox.recv_timeout(LOOK.min(left)) {
                Ok(RobotEvent::Typed(line)) => self.heard.typed.push_back(line),
                Ok(RobotEvent::InputEnded) => self.heard.input_ended = true,
                Ok(RobotEvent::Received(bytes)) => self.take_bytes(&bytes),
                Ok(RobotEvent::Lost(error)) => return Err(error).context("the serial line is gone"),
                Err(RecvTimeoutError::Disconnected) => bail!("both input and serial line have ended"),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    fn now(&self) -> Tick {
        // Wraps after 49 days, as ticks are meant to.
        Tick(self.start.elapsed().as_millis() as u32)
    }

    fn keep_session(&mut self) -> anyhow::Result<()> {
        let now = self.now();
        while let Some(event) = self.session.poll(now) {
            self.take_event(event);
        }
        let mut buffer = PacketBuffer::new();
        while self.session.next_packet(&mut buffer) {
            self.transmit(buffer.as_bytes())?;
        }
        Ok(())
    }

    fn take_bytes(&mut self, bytes: &[u8]) {
        let now = self.now();
        for byte in bytes {
            if let Some(event) = self.session.receive(*byte, now) {
                self.take_event(event);
            }
        }
    }

    fn take_event(&mut self, event: HostEvent) {
        match event {
            HostEvent::Opened(hello) => self.device = hello.device.as_str().to_owned(),
            HostEvent::Described(description) => self.heard.lights = Some(description.capabilities.leds),
            HostEvent::Report(Report::Probed(probed)) => self.heard.probed.push(probed),
            HostEvent::Report(Report::State(state)) => self.heard.inhibits = state.inhibits,
            HostEvent::Answered {
                sequence: Some(sequence),
                refusal,
            } => {
                self.heard.answered = Some((sequence, refusal));
                self.heard.refused = refusal.or(self.heard.refused);
            }
            HostEvent::Unanswered(sequence) => self.heard.unanswered = Some(sequence),
            HostEvent::Report(_)
            | HostEvent::Answered { .. }
            | HostEvent::EventsLost { .. }
            | HostEvent::Closed(_)
            | HostEvent::Silent
            | HostEvent::Incompatible { .. } => {}
        }
    }

    fn transmit(&self, bytes: &[u8]) -> anyhow::Result<()> {
        self.serial
            .write_all(bytes)
            .context("cannot write to the serial line")
    }
}
