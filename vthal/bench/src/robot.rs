//! A robot that greets, describes itself, answers what is asked, and drives as it is told, without wheels.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use rvac_protocol::PacketBuffer;
use rvac_protocol::crc::{Direction, packet_crc};
use rvac_protocol::message::{
    BinaryKinds, Capabilities, Command, Description, Event, Inhibit, Limits, MotionPhase, MotorGaps, Name,
    Report, ResetCause, State,
};
use rvac_protocol::session::{Mode, RobotEvent, RobotIdentity, RobotSession};
use rvac_units::{AngularSpeed, Length, Speed, Tick};

use crate::Pty;

/// Pause between telemetry reports.
const REPORT_EVERY: Duration = Duration::from_millis(20);

/// The robot's end of the wire.
#[derive(Debug)]
pub struct SyntheticRobot {
    pty: Pty,
    session: RobotSession,
    buffer: PacketBuffer,
    started: Instant,
    reported: Instant,
    state: State,
    /// Speed in micrometres per second and the end of its lease.
    drive: Option<(i32, Instant)>,
    /// What was commanded, in order.
    pub commands: Vec<Command>,
}

impl SyntheticRobot {
    /// A robot that has just been switched on. `boot_count` tells one life from another.
    pub fn switch_on(link: &Path, binary: BinaryKinds, boot_count: u32) -> io::Result<Self> {
        Ok(Self {
            pty: Pty::open(link)?,
            session: RobotSession::new(identity(binary, boot_count), Tick(0)),
            buffer: PacketBuffer::new(),
            started: Instant::now(),
            reported: Instant::now(),
            state: State {
                dust_box: Some(true),
                ..State::default()
            },
            drive: None,
            commands: Vec::new(),
        })
    }

    /// When its clock, which its reports tell in milliseconds, was 0.
    pub fn started(&self) -> Instant {
        self.started
    }

    /// Whether a daemon has opened a session.
    pub fn is_sealed(&self) -> bool {
        self.session.mode() == Mode::Checked
    }

    /// Whether it is told to move now.
    pub fn moves(&self) -> bool {
        self.drive
            .is_some_and(|(speed, until)| speed != 0 && Instant::now() < until)
    }

    /// Stands on its dock from now on.
    pub fn dock(&mut self) {
        self.state.docked = true;
    }

    /// Presses or lets go of a button.
    pub fn button(&mut self, button: u8, pressed: bool) {
        self.session
            .queue_event(Event::Button { button, pressed }, self.now());
    }

    /// Lives until `deadline` or until `done` says so, with telemetry at 50 Hz. Gives whether `done` said so.
    pub fn live_until(&mut self, deadline: Instant, mut done: impl FnMut(&Self) -> bool) -> io::Result<bool> {
        while Instant::now() < deadline {
            if done(self) {
                return Ok(true);
            }
            self.listen((self.reported + REPORT_EVERY).min(deadline))?;
            if self.reported.elapsed() >= REPORT_EVERY {
                self.report()?;
            }
        }
        Ok(done(self))
    }

    /// Listens until `deadline` or until something came, and answers.
    pub fn listen(&mut self, deadline: Instant) -> io::Result<()> {
        self.pty.wait(deadline)?;
        let mut bytes = [0; 4096];
        let count = self.pty.read(&mut bytes)?;
        let now = self.now();
        for byte in bytes.iter().take(count) {
            if let Some(event) = self.session.receive(*byte, now) {
                self.take(event);
            }
        }
        if let Some(event) = self.session.poll(now) {
            self.take(event);
        }
        while self.session.next_packet(&mut self.buffer) {
            self.pty.write_all(self.buffer.as_bytes())?;
        }
        Ok(())
    }

    /// Sends telemetry; gives the moment just before the bytes went out.
    pub fn report(&mut self) -> io::Result<Instant> {
        let since = self.reported.elapsed();
        self.reported = Instant::now();
        self.roll(since);
        self.state.tick = self.now();
        let report = Report::State(self.state);
        self.session
            .encode(&report, &mut self.buffer)
            .map_err(|error| io::Error::other(format!("{error:?}")))?;
        let moment = Instant::now();
        self.pty.write_all(self.buffer.as_bytes())?;
        Ok(moment)
    }

    /// Sends the text of a packet, whatever it says, with the seal of the session. A greeting has none.
    pub fn say_text(&mut self, text: &str) -> io::Result<()> {
        let is_greeting = text.contains(r#""c":"hello""#);
        let session = if is_greeting { 0 } else { self.session.session() };
        let crc = packet_crc(Direction::RobotToHost, session, text.as_bytes());
        self.pty.write_all(format!("{text}*{crc:08X}\u{1f}").as_bytes())
    }

    /// Sends bytes that no session has sealed.
    pub fn blurt(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.pty.write_all(bytes)
    }

    /// Moves the encoders as the lease tells.
    fn roll(&mut self, since: Duration) {
        if self.drive.is_some_and(|(_, until)| Instant::now() >= until) {
            self.drive = None;
        }
        let speed_um_per_s = self.drive.map_or(0, |(speed, _)| speed);
        let counts = (f64::from(speed_um_per_s) * since.as_secs_f64() / 1000.0) as i32;
        self.state.count_left = self.state.count_left.wrapping_add(counts);
        self.state.count_right = self.state.count_right.wrapping_add(counts);
        self.state.motion = if speed_um_per_s == 0 {
            MotionPhase::Idle
        } else {
            MotionPhase::Drive
        };
    }

    fn take(&mut self, event: RobotEvent) {
        let RobotEvent::Command(command) = event else {
            self.drive = None;
            return;
        };
        match command {
            Command::Drive(drive) => {
                let lease = Duration::from_millis(u64::from(drive.lease_ms));
                self.drive = Some((drive.speed.0, Instant::now() + lease));
            }
            Command::Stop => {
                self.drive = None;
                self.state.inhibits.insert(Inhibit::Stopped);
            }
            Command::Arm { .. } => self.state.inhibits.remove(Inhibit::Stopped),
            _ => {}
        }
        if command.must_arrive()
            && let Some(sequence) = command.sequence()
        {
            self.session.answer(sequence, None);
        }
        self.commands.push(command);
    }

    fn now(&self) -> Tick {
        // Truncation is the wrap of the millisecond clock.
        Tick(self.started.elapsed().as_millis() as u32)
    }
}

fn identity(binary: BinaryKinds, boot_count: u32) -> RobotIdentity {
    RobotIdentity {
        device: Name::try_from("synthetic").unwrap_or_default(),
        firmware: Name::try_from("1").unwrap_or_default(),
        boot_count,
        reset_cause: ResetCause::PowerOn,
        session_seed: boot_count.wrapping_mul(77),
        binary,
        description: Description {
            capabilities: Capabilities {
                encoders: true,
                bumpers: 2,
                cliffs: 3,
                wheel_drops: 2,
                dock_receivers: 3,
                buttons: 1,
                beeper: true,
                brush_main: true,
                ..Capabilities::default()
            },
            limits: Limits {
                speed_max: Speed::from_m_per_s(0.35),
                turn_max: AngularSpeed::from_rad_per_s(1.5),
                track: Length::from_m(0.23),
                count_nm: 1_000_000,
                radius: Length::from_m(0.175),
                swath: Length::from_m(0.30),
            },
            motors: MotorGaps::default(),
        },
    }
}
