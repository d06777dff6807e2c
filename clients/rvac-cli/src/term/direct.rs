//! Straight on the serial line, with a session of our own or by hand without one.

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};
use rvac_protocol::PacketBuffer;
use rvac_protocol::crc::{Direction, packet_crc, to_hex};
use rvac_protocol::frame::SEPARATOR;
use rvac_protocol::message::{BinaryKinds, Command};
use rvac_protocol::session::{HostEvent, HostSession, SendError};
use rvac_protocol::text::{Form, is_stop, read_command};
use rvac_units::Tick;
use serial2::SerialPort;

use super::{print_packet, print_remark};
use crate::arguments::TermOptions;
use crate::lines;
use crate::listen::listen;
use crate::show::Viewer;

/// The robot must answer the handshake within this time.
const HANDSHAKE: Duration = Duration::from_secs(5);
/// Longest pause between two polls of the session.
const LOOK: Duration = Duration::from_millis(20);

enum DirectEvent {
    Typed(String),
    InputEnded,
    Received(Vec<u8>),
    Lost(std::io::Error),
}

pub(super) fn run(port: &Path, options: &TermOptions) -> anyhow::Result<ExitCode> {
    crate::robot::leave_to_daemon(port)?;
    let serial = SerialPort::open(port, options.baud)
        .with_context(|| format!("cannot open {} at {} baud", port.display(), options.baud))?;
    let serial = Arc::new(serial);
    let (events, inbox) = channel();
    listen(
        Arc::clone(&serial),
        events.clone(),
        DirectEvent::Received,
        DirectEvent::Lost,
    );
    lines::read_input(events, DirectEvent::Typed, || DirectEvent::InputEnded);
    let mut terminal = Terminal::new(&serial, options);
    terminal.converse(&inbox)?;
    Ok(ExitCode::SUCCESS)
}

struct Terminal<'a> {
    serial: &'a SerialPort,
    options: &'a TermOptions,
    start: Instant,
    /// `None` in hand mode.
    session: Option<HostSession>,
    inbound: Viewer,
    outbound: Viewer,
    /// Typed before the session was open.
    waiting: Vec<String>,
    ends_at: Option<Instant>,
}

impl<'a> Terminal<'a> {
    fn new(serial: &'a SerialPort, options: &'a TermOptions) -> Self {
        let kinds = BinaryKinds {
            state: true,
            drive: true,
        };
        Self {
            serial,
            options,
            start: Instant::now(),
            session: (!options.hand).then(|| HostSession::new(kinds, Tick(0))),
            inbound: Viewer::new(Direction::RobotToHost, 0),
            outbound: Viewer::new(Direction::HostToRobot, 0),
            waiting: Vec::new(),
            ends_at: None,
        }
    }

    fn converse(&mut self, inbox: &Receiver<DirectEvent>) -> anyhow::Result<()> {
        if self.options.hand {
            // Ten edges for a robot that measures the baud rate, and an end for whatever it had half received.
            self.transmit(&[b'U', SEPARATOR])?;
        }
        loop {
            self.keep_session()?;
            match inbox.recv_timeout(LOOK) {
                Ok(DirectEvent::Typed(line)) if line.is_empty() => {}
                Ok(DirectEvent::Typed(line)) => self.take_line(line)?,
                Ok(DirectEvent::InputEnded) => self.ends_at = Some(Instant::now()),
                Ok(DirectEvent::Received(bytes)) => self.take_bytes(&bytes)?,
                Ok(DirectEvent::Lost(error)) => return Err(error).context("the serial line is gone"),
                Err(RecvTimeoutError::Disconnected) => bail!("both input and serial line have ended"),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if self.is_over()? {
                return Ok(());
            }
        }
    }

    fn now(&self) -> Tick {
        // A terminal does not stay open for 49 days; if it does, ticks wrap as they are meant to.
        Tick(self.start.elapsed().as_millis() as u32)
    }

    fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// After the end of the input answers are shown for a while; what still waits for a session gets its time.
    fn is_over(&mut self) -> anyhow::Result<bool> {
        let unheard =
            self.session.as_ref().is_some_and(|session| !session.is_open()) && !self.waiting.is_empty();
        if unheard && self.start.elapsed() > HANDSHAKE {
            bail!(
                "the robot does not answer the handshake: check power, cable, --port and --baud, or try --hand ({} typed \
                 packets were not sent)",
                self.waiting.len()
            );
        }
        let linger = Duration::from_millis(self.options.linger);
        Ok(!unheard && self.ends_at.is_some_and(|end| end.elapsed() > linger))
    }

    /// Lets time pass in the session and sends its packets.
    fn keep_session(&mut self) -> anyhow::Result<()> {
        let now = self.now();
        while let Some(event) = self.session.as_mut().and_then(|session| session.poll(now)) {
            self.take_event(&event)?;
        }
        let mut buffer = PacketBuffer::new();
        while self
            .session
            .as_mut()
            .is_some_and(|session| session.next_packet(&mut buffer))
        {
            self.transmit(buffer.as_bytes())?;
        }
        Ok(())
    }

    fn take_bytes(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        let now = self.now();
        for byte in bytes {
            if let Some(shown) = self.inbound.push(*byte) {
                print_packet(self.seconds(), '<', &shown, self.options)?;
            }
            if let Some(event) = self
                .session
                .as_mut()
                .and_then(|session| session.receive(*byte, now))
            {
                self.take_event(&event)?;
            }
        }
        Ok(())
    }

    fn take_event(&mut self, event: &HostEvent) -> anyhow::Result<()> {
        let session = self.session.as_ref().map_or(0, HostSession::session);
        self.inbound.set_session(session);
        self.outbound.set_session(session);
        let remark = match event {
            HostEvent::Opened(hello) => format!("session {} with {} is open", hello.session, hello.device),
            HostEvent::Closed(_) => "the robot has left the session".to_owned(),
            HostEvent::Silent => "the robot is silent".to_owned(),
            HostEvent::Unanswered(sequence) => format!("number {} was not answered", sequence.0),
            HostEvent::EventsLost { count } => format!("{count} events were lost"),
            HostEvent::Incompatible {
                version_min,
                version_max,
            } => {
                format!(
                    "the robot speaks versions {} to {} of the protocol only",
                    version_min.0, version_max.0
                )
            }
            HostEvent::Described(_) | HostEvent::Report(_) | HostEvent::Answered { .. } => return Ok(()),
        };
        print_remark(self.seconds(), &remark)?;
        if matches!(event, HostEvent::Opened(_)) {
            for line in std::mem::take(&mut self.waiting) {
                self.send_line(&line)?;
            }
        }
        Ok(())
    }

    fn take_line(&mut self, line: String) -> anyhow::Result<()> {
        let closed = self.session.as_ref().is_some_and(|session| !session.is_open());
        if closed && !is_stop(line.as_bytes()) {
            self.waiting.push(line);
            return Ok(());
        }
        self.send_line(&line)
    }

    /// Sends a typed packet: numbered and with its CRC from the session where that is possible, else only with a CRC.
    fn send_line(&mut self, line: &str) -> anyhow::Result<()> {
        let now = self.now();
        let Some(session) = &mut self.session else {
            let mut bytes = line.as_bytes().to_vec();
            bytes.push(SEPARATOR);
            return self.transmit(&bytes);
        };
        let mut buffer = PacketBuffer::new();
        let sent = match to_command(line, session.robot_tick().map(|(tick, _)| tick)) {
            Some(command) => session.send(command, now, &mut buffer).map(drop),
            None => Err(SendError::Reserved),
        };
        match sent {
            Ok(()) => self.transmit(buffer.as_bytes()),
            Err(SendError::Busy) => Ok(print_remark(
                self.seconds(),
                "not sent: eight commands wait for their answers",
            )?),
            Err(SendError::NotOpen) => Ok(print_remark(self.seconds(), "not sent: no session is open")?),
            Err(SendError::Range | SendError::Reserved) => {
                let bytes = verbatim_with_crc(line, session.session());
                self.transmit(&bytes)
            }
        }
    }

    fn transmit(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.serial
            .write_all(bytes)
            .context("cannot write to the serial line")?;
        for byte in bytes {
            if let Some(shown) = self.outbound.push(*byte) {
                print_packet(self.seconds(), '>', &shown, self.options)?;
            }
        }
        Ok(())
    }
}

/// The typed packet as a command whose number and tick the session fills in. `None` if the person wrote either, or if it is
/// not a command that this program understands: then it is sent unchanged.
fn to_command(line: &str, robot_tick: Option<Tick>) -> Option<Command> {
    if is_stop(line.as_bytes()) {
        return Some(Command::Stop);
    }
    let object: serde_json::Map<String, serde_json::Value> = serde_json::from_str(line).ok()?;
    if object.contains_key("n") || object.contains_key("t") {
        return None;
    }
    let now = robot_tick.unwrap_or(Tick(0));
    read_command(line.as_bytes(), Form::Hand { now }).ok()
}

fn verbatim_with_crc(line: &str, session: u16) -> Vec<u8> {
    let mut bytes = line.as_bytes().to_vec();
    bytes.push(b'*');
    bytes.extend_from_slice(&to_hex(packet_crc(
        Direction::HostToRobot,
        session,
        line.as_bytes(),
    )));
    bytes.push(SEPARATOR);
    bytes
}
