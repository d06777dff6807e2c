//! Robots that run our own firmware: the device model on the wire protocol of cordlib. The firmware has reflexes, a dead
//! man and an emergency stop of its own, so the host leaves them to it.

mod encoders;
mod events;
mod momentary;
mod tap;
mod to_model;

use brain::Inhibit;
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    self, Beep, BinaryKinds, Capabilities, Command, Led, LedPattern, Motor, MotorCommand, MotorSet,
    RobotHello, Sequence,
};
use rvac_protocol::session::{HostSession, SendError};
use rvac_protocol::text::{self, Form};
use rvac_units::{AngularSpeed, Frequency, Ratio, Speed, Tick};

use self::encoders::Encoders;
use self::events::LastStart;
use self::momentary::MomentaryLevels;
use self::tap::Tap;
use super::supervisor::CLEANER_REPEAT_US;
use super::{
    CleanerDrive, CleanerPower, CommandError, Description, Device, DeviceIo, Drive, LeaveDock, Level, Light,
    LightPattern, LinkQuality, Make, Opening, Tone,
};
use crate::Direction;

/// Lease of motion commands on the wire. Shorter than the firmware's default of 250 ms, so that braking too is over 300 ms
/// after the host's death (S1).
const LEASE_MS: u16 = 120;
/// Lease of brushes and suction on the wire: the longest allowed. The robot ends it to the millisecond, and it is renewed
/// three times in it, so that two lost packets do not stop and start them.
const CLEANER_LEASE_MS: u16 = 1000;
const _: () = assert!(3 * CLEANER_REPEAT_US <= CLEANER_LEASE_MS as u64 * 1000);

/// Robots that run our own firmware.
pub const MAKE: Make = Make {
    name: "cordlib",
    opening: Opening {
        rates_baud: &[230_400],
        answer_within_ms: 5_000,
        wake_pulse_ms: 0,
        settle_ms: 0,
    },
    connect: || Box::new(Cordlib::new()),
};

/// The host's end of one robot.
#[derive(Debug)]
struct Cordlib {
    session: HostSession,
    buffer: PacketBuffer,
    tap: Tap,
    hello: Option<RobotHello>,
    description: Option<Description>,
    capabilities: Capabilities,
    /// Motors whose current it does not measure.
    unmeasured: MotorSet,
    last_start: Option<LastStart>,
    encoders: Encoders,
    momentary: MomentaryLevels,
    /// Jumps of the robot's clock that are known here.
    clock_jumps: u32,
}

fn tick(now_us: u64) -> Tick {
    // Truncation is the wrap of the millisecond clock.
    Tick((now_us / 1000) as u32)
}

impl Cordlib {
    fn new() -> Self {
        Self {
            session: HostSession::new(BinaryKinds::ALL, Tick(0)),
            buffer: PacketBuffer::new(),
            tap: Tap::default(),
            hello: None,
            description: None,
            capabilities: Capabilities::default(),
            unmeasured: MotorSet::default(),
            last_start: None,
            encoders: Encoders::default(),
            momentary: MomentaryLevels::default(),
            clock_jumps: 0,
        }
    }

    /// Number of the session for the CRC; 0 while none is open.
    fn session_number(&self) -> u16 {
        self.hello.as_ref().map_or(0, |hello| hello.session)
    }

    /// Sends a command, numbered by the session.
    fn send(&mut self, command: Command, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        match self.session.send(command, tick(io.now_us), &mut self.buffer) {
            Ok(_) => {
                io.link.extend_from_slice(self.buffer.as_bytes());
                self.pump(io.link);
                Ok(())
            }
            Err(SendError::NotOpen) => Err(CommandError::NotAttached),
            Err(SendError::Busy) => Err(CommandError::Busy),
            Err(SendError::Range | SendError::Reserved) => Err(CommandError::Range),
        }
    }

    fn pump(&mut self, link: &mut Vec<u8>) {
        while self.session.next_packet(&mut self.buffer) {
            link.extend_from_slice(self.buffer.as_bytes());
        }
    }
}

impl Device for Cordlib {
    fn open(&mut self, io: &mut DeviceIo<'_>) {
        self.session = HostSession::new(BinaryKinds::ALL, tick(io.now_us));
        self.tap = Tap::default();
        self.hello = None;
        self.description = None;
        self.capabilities = Capabilities::default();
        self.unmeasured = MotorSet::default();
        self.encoders.forget_speeds();
        self.momentary = MomentaryLevels::default();
        self.clock_jumps = 0;
    }

    fn description(&self) -> Option<&Description> {
        self.description.as_ref()
    }

    fn is_attached(&self) -> bool {
        self.description.is_some() && self.session.is_open()
    }

    fn link_quality(&self) -> LinkQuality {
        let is_binary = self.hello.as_ref().is_some_and(|hello| hello.binary.state);
        LinkQuality {
            is_binary,
            ..to_model::link_quality(self.session.quality(), self.session.arrivals())
        }
    }

    fn receive(&mut self, bytes: &[u8], io: &mut DeviceIo<'_>) {
        let now = tick(io.now_us);
        for byte in bytes {
            if let Some(event) = self.session.receive(*byte, now) {
                self.take(event, io.events);
            }
        }
        self.pump(io.link);
    }

    fn poll(&mut self, io: &mut DeviceIo<'_>) {
        while let Some(event) = self.session.poll(tick(io.now_us)) {
            self.take(event, io.events);
        }
        self.pump(io.link);
    }

    fn next_wake_us(&self, now_us: u64) -> u64 {
        let (now, next) = (tick(now_us), self.session.next_poll());
        let pause_ms = if now.reached(next) { 0 } else { next.since(now) };
        now_us + u64::from(pause_ms.max(1)) * 1000
    }

    /// The firmware gives motion to whoever has armed it.
    fn acquire(&mut self, _level: Level, _io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        Ok(())
    }

    /// Leases end by themselves, and a robot that nobody commands sleeps and charges.
    /// Nobody may move it until it is armed again: what turns its wheels then is a hand, and no fault (S12).
    fn release(&mut self, io: &mut DeviceIo<'_>) {
        if self.session.is_open() {
            self.stop(io);
        }
    }

    fn drive(&mut self, drive: Drive, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let drive = message::Drive {
            speed: Speed::from_m_per_s(drive.speed_m_per_s),
            turn: AngularSpeed::from_rad_per_s(drive.turn_rad_per_s),
            lease_ms: LEASE_MS,
            sequence: Sequence(0),
            seen_tick: Tick(0),
        };
        self.send(Command::Drive(drive), io)
    }

    fn stop(&mut self, io: &mut DeviceIo<'_>) {
        // Cannot fail: `stop` needs no session and has no numbers.
        self.send(Command::Stop, io).ok();
    }

    fn cleaners(&mut self, drive: CleanerDrive, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let power = match drive {
            CleanerDrive::On(power) => power,
            CleanerDrive::Off => CleanerPower::NONE,
        };
        let has = self.capabilities;
        let parts = [
            (Motor::BrushMain, has.brush_main, power.brush_main),
            (Motor::BrushSides, has.brush_sides, power.brush_sides),
            (Motor::Vacuum, has.vacuum, power.vacuum),
        ];
        for (motor, present, throttle) in parts {
            if present {
                let command = MotorCommand {
                    motor,
                    throttle,
                    lease_ms: CLEANER_LEASE_MS,
                    sequence: Sequence(0),
                    seen_tick: Tick(0),
                };
                self.send(Command::Motor(command), io)?;
            }
        }
        Ok(())
    }

    fn arm(&mut self, leave_dock: LeaveDock, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let arm = Command::Arm {
            sequence: Sequence(0),
            undock: leave_dock == LeaveDock::Leave,
        };
        self.send(arm, io)
    }

    fn clear(&mut self, inhibit: Inhibit, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let clear = Command::Clear {
            sequence: Sequence(0),
            inhibit: to_model::inhibit_of_wire(inhibit).ok_or(CommandError::Absent)?,
        };
        self.send(clear, io)
    }

    /// Plays a tone at half volume.
    fn tone(&mut self, tone: Tone, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let pitch = Frequency(i32::try_from(tone.pitch_hz).map_err(|_| CommandError::Range)?);
        if !self.capabilities.beeper {
            return Err(CommandError::Absent);
        }
        let beep = Beep {
            pitch,
            duration_ms: tone.duration_ms,
            volume: Ratio::from_millionths(500_000).unwrap_or_default(),
        };
        self.send(Command::Beep(beep), io)
    }

    fn light(&mut self, light: Light, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        if light.number >= self.capabilities.leds {
            return Err(CommandError::Absent);
        }
        let led = Led {
            led: light.number,
            pattern: match light.pattern {
                LightPattern::Off => LedPattern::Off,
                LightPattern::On => LedPattern::On,
                LightPattern::Blink => LedPattern::Blink,
            },
            brightness: Ratio::ONE,
        };
        self.send(Command::Led(led), io)
    }

    /// Takes what hand mode takes; the session numbers it and adds the CRC.
    fn raw(&mut self, text: &str, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let command = text::read_command(text.as_bytes(), Form::Hand { now: Tick(0) })
            .map_err(|_| CommandError::Syntax)?;
        self.send(command, io)
    }

    fn tap(&mut self, direction: Direction, bytes: &[u8], packets: &mut Vec<(Direction, String)>) {
        let session = self.session_number();
        match direction {
            Direction::FromRobot => self.tap.take_received(session, bytes, packets),
            Direction::ToRobot => self.tap.take_sent(session, bytes, packets),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CommandError, Device as _, DeviceIo};
    use super::Cordlib;

    #[test]
    fn an_expert_may_type_what_hand_mode_takes_and_nothing_else() {
        let mut robot = Cordlib::new();
        let (mut link, mut events) = (Vec::new(), Vec::new());
        let mut io = DeviceIo {
            now_us: 0,
            link: &mut link,
            events: &mut events,
        };
        for text in [r#"{"c":"stop"}"#, r#"{"c":"info"}"#] {
            assert_eq!(robot.raw(text, &mut io), Ok(()), "{text}");
        }
        for text in [r#"{"c":"motor","motor":"w","throttle":1}"#, "{"] {
            assert_eq!(robot.raw(text, &mut io), Err(CommandError::Syntax), "{text}");
        }
    }
}
