//! A robot at the other end of a link, asked and answered one thing at a time, while a person reads and types.

use std::collections::VecDeque;
use std::fmt;
use std::io::{self, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use crate::error::CalibrationError;
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Command, Inhibit, Inhibits, Led, LedPattern, Motor, MotorCommand, PROBE_LEASE_MS_MAX, Probe,
    ProbeTarget, Probed, ProbedContent, Refusal, Report, Sequence,
};
use rvac_protocol::session::{HostEvent, HostSession, SendError};
use rvac_units::{Ratio, Throttle, Tick};

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
/// Within this time a person holds the button that was asked for.
const HOLD_WAIT: Duration = Duration::from_secs(60);
/// Life of [`RobotEvent::Held`].
const HOLD_LEASE: Duration = Duration::from_millis(500);

/// What happens while a robot is calibrated.
#[derive(Debug)]
pub enum RobotEvent {
    /// A line of the person.
    Typed(String),
    /// The person types nothing any more.
    InputEnded,
    /// The person holds the motors on; this lives for half a second.
    Held,
    /// The person lets go.
    LetGo,
    /// Everything ends at once.
    Quit,
    /// Bytes of the robot.
    Received(Vec<u8>),
    /// The link is lost.
    Lost(io::Error),
}

/// Whether a person must hold something down for motors to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// No: who starts them is at a keyboard beside the robot.
    NotAsked,
    /// Yes, because the person is at the other end of a network.
    Asked,
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
    held_until: Option<Instant>,
    quit: bool,
}

impl Reports {
    fn is_held(&self, now: Instant) -> bool {
        self.held_until.is_some_and(|until| now < until)
    }
}

/// A motor that runs without its control loop.
#[derive(Clone, Copy, Debug)]
pub struct OpenLoop {
    /// Which.
    pub motor: Motor,
    /// Its duty.
    pub throttle: Throttle,
}

/// How long raw readings are taken.
#[derive(Clone, Copy, Debug)]
pub enum Watch {
    /// So long.
    For(Duration),
    /// Until the person has typed a line or let go, but no longer than this.
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
pub struct Robot {
    to_robot: Box<dyn Write + Send>,
    inbox: Receiver<RobotEvent>,
    hold: Hold,
    start: Instant,
    session: HostSession,
    device: String,
    heard: Reports,
}

impl fmt::Debug for Robot {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Robot")
            .field("device", &self.device)
            .field("hold", &self.hold)
            .finish_non_exhaustive()
    }
}

impl Robot {
    /// Opens a session over a link that is open, and waits for the robot's description.
    ///
    /// # Errors
    /// Nothing answers.
    pub fn open(
        to_robot: Box<dyn Write + Send>,
        inbox: Receiver<RobotEvent>,
        hold: Hold,
    ) -> Result<Self, CalibrationError> {
        let mut robot = Self {
            to_robot,
            inbox,
            hold,
            start: Instant::now(),
            session: HostSession::new(BinaryKinds::default(), Tick(0)),
            device: String::new(),
            heard: Reports::default(),
        };
        if robot.wait(PATIENCE, |heard| heard.lights.is_some())? {
            return Ok(robot);
        }
        Err(CalibrationError::NoHandshake)
    }

    /// Name of the model.
    #[must_use]
    pub fn device(&self) -> &str {
        &self.device
    }

    /// Whether a line of the person waits, or none will come.
    pub(crate) fn has_line(&self) -> bool {
        !self.heard.typed.is_empty() || self.heard.input_ended
    }

    /// Whether motors may run as far as the person is concerned.
    pub(crate) fn is_held(&self) -> bool {
        self.hold == Hold::NotAsked || self.heard.is_held(Instant::now())
    }

    /// Waits until the person holds the motors on.
    pub(crate) fn await_hold(&mut self) -> Result<(), CalibrationError> {
        match self.wait(HOLD_WAIT, |heard| heard.is_held(Instant::now()))? {
            true => Ok(()),
            false => Err(CalibrationError::LetGo),
        }
    }

    /// The next line that the person types; `None` at the end of the input.
    ///
    /// # Errors
    /// The link is lost.
    pub fn next_line(&mut self) -> Result<Option<String>, CalibrationError> {
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
    pub(crate) fn light(&mut self, led: u8, on: bool) -> Result<(), CalibrationError> {
        self.send(Command::Led(Led {
            led,
            pattern: if on { LedPattern::On } else { LedPattern::Off },
            brightness: Ratio::ONE,
        }))
        .map(drop)
    }

    /// Lets time pass.
    pub(crate) fn pass(&mut self, span: Duration) -> Result<(), CalibrationError> {
        self.wait(span, |_| false).map(drop)
    }

    /// One raw reading.
    ///
    /// # Errors
    /// None comes.
    pub fn probe(&mut self, target: ProbeTarget) -> Result<ProbedContent, CalibrationError> {
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
            None => Err(CalibrationError::NoReading),
        }
    }

    /// Raw readings for `span`, or until the person has typed something if `until_typed`, as they come (each 50 ms), while
    /// `motors` run open loop; they are always stopped at the end. Motors need an armed robot; without any the
    /// robot need not be armed.
    ///
    /// # Errors
    /// The robot refuses, or is gone.
    pub fn watch(
        &mut self,
        target: ProbeTarget,
        motors: &[OpenLoop],
        span: Watch,
    ) -> Result<Vec<Probed>, CalibrationError> {
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

    fn watch_running(
        &mut self,
        target: ProbeTarget,
        motors: &[OpenLoop],
        span: Watch,
    ) -> Result<(), CalibrationError> {
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
            let must_be_held = self.hold == Hold::Asked && !motors.is_empty();
            if must_be_held && !self.heard.is_held(now) {
                return if until_typed {
                    Ok(())
                } else {
                    Err(CalibrationError::LetGo)
                };
            }
            self.run(motors)?;
            self.wait(RENEW.min(end - now), |heard| {
                heard.refused.is_some() || (must_be_held && !heard.is_held(Instant::now()))
            })?;
            if let Some(refusal) = self.heard.refused.take() {
                return Err(self.refused("to run the motor", refusal));
            }
        }
    }

    /// Gives each motor its duty for the length of a lease.
    fn run(&mut self, motors: &[OpenLoop]) -> Result<(), CalibrationError> {
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
    pub(crate) fn arm(&mut self) -> Result<(), CalibrationError> {
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
    ///
    /// # Errors
    /// The link is lost.
    pub fn stop(&mut self) -> Result<(), CalibrationError> {
        self.send(Command::Stop).map(drop)
    }

    /// Sends a command that must arrive and waits for its answer.
    fn command(&mut self, command: Command) -> Result<(), CalibrationError> {
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
            _ => Err(CalibrationError::Unanswered(command.name().name())),
        }
    }

    /// A refusal in words, with what the robot says keeps it from moving.
    fn refused(&mut self, what: &'static str, refusal: Refusal) -> CalibrationError {
        if refusal == Refusal::Inhibited {
            // The next state contains the present inhibits.
            self.pass(STATE).ok();
        }
        let reasons: Vec<&str> = self.heard.inhibits.iter().map(Inhibit::name).collect();
        let why = if refusal != Refusal::Inhibited || reasons.is_empty() {
            refusal.name().to_owned()
        } else {
            format!("inhibited by {}", reasons.join(", "))
        };
        CalibrationError::Refused { what, why }
    }

    fn send(&mut self, command: Command) -> Result<Option<Sequence>, CalibrationError> {
        let mut buffer = PacketBuffer::new();
        match self.session.send(command, self.now(), &mut buffer) {
            Ok(sequence) => {
                self.transmit(buffer.as_bytes())?;
                Ok(sequence)
            }
            Err(SendError::NotOpen) => Err(CalibrationError::SessionLost),
            Err(SendError::Busy) => Err(CalibrationError::Busy),
            Err(SendError::Range | SendError::Reserved) => {
                Err(CalibrationError::Unsendable(command.name().name()))
            }
        }
    }

    /// Lets the session live for `span`, or until `until` is content; says whether it was.
    fn wait(&mut self, span: Duration, until: impl Fn(&Reports) -> bool) -> Result<bool, CalibrationError> {
        let end = Instant::now() + span;
        loop {
            self.keep_session()?;
            if std::mem::take(&mut self.heard.quit) {
                return Err(CalibrationError::Quit);
            }
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
                Ok(RobotEvent::Held) => self.heard.held_until = Some(Instant::now() + HOLD_LEASE),
                Ok(RobotEvent::LetGo) => self.heard.held_until = None,
                Ok(RobotEvent::Quit) => self.heard.quit = true,
                Ok(RobotEvent::Lost(error)) => return Err(CalibrationError::LinkLost(error)),
                Err(RecvTimeoutError::Disconnected) => return Err(CalibrationError::NobodyLeft),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    fn now(&self) -> Tick {
        // Wraps after 49 days, as ticks are meant to.
        Tick(self.start.elapsed().as_millis() as u32)
    }

    fn keep_session(&mut self) -> Result<(), CalibrationError> {
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

    fn transmit(&mut self, bytes: &[u8]) -> Result<(), CalibrationError> {
        self.to_robot
            .write_all(bytes)
            .map_err(CalibrationError::LinkBroken)
    }
}
