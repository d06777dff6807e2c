//! Executes the host's commands. The session has checked their form, CRC and freshness. Here the machine's limits and the
//! inhibits apply.

use rvac_protocol::message::{
    Beep, Command, Drive, Inhibit, Led, LogLevel, Motor, MotorCommand, Move, MoveEnd, Parameter, Probe,
    Refusal,
};
use rvac_protocol::session::{HAND_SPEED_MAX, HAND_TURN_MAX, Mode, RobotEvent, SessionEnd};
use rvac_units::Tick;

use crate::arming::{ArmingEvent, Holder};
use crate::board::Parts;
use crate::cord::Cord;
use crate::motion::{Ending, MoveLimits, Path, WheelSide, suits_drive, suits_path};
use crate::parameters::HandMode;
use crate::permit::MotionPermit;

/// Largest turn of one `move`, in radians: ten turns.
const MOVE_TURN_MAX: i32 = 63;
/// Speed of a `move` that a person types.
const HAND_PACE: MoveLimits = MoveLimits {
    speed_um_per_s: HAND_SPEED_MAX.0,
    turn_urad_per_s: HAND_TURN_MAX.0,
};

type CommandResult = Result<(), Refusal>;

impl<P: Parts> Cord<P> {
    /// Carries out one event of the session.
    pub(crate) fn dispatch(&mut self, event: &RobotEvent, now: Tick) {
        match event {
            RobotEvent::Command(command) => self.obey(command, now),
            RobotEvent::SessionOpened => {
                self.void_permissions(now);
                self.journal.note(LogLevel::Info, "session opened", "");
                self.tell_unguarded_motors();
            }
            RobotEvent::SessionClosed(end) => {
                self.void_permissions(now);
                let why = match end {
                    SessionEnd::Hand => "by hand",
                    SessionEnd::Silence => "by silence",
                };
                self.journal.note(LogLevel::Warn, "session closed", why);
            }
        }
    }

    /// Leases and arming of another session are void.
    fn void_permissions(&mut self, now: Tick) {
        if self.motion.is_active() {
            self.reflexes.arming.lose_link();
        }
        self.reflexes.arming.take(ArmingEvent::SessionChange, now);
        self.stop_all(MoveEnd::Inhibited);
        self.probing.end(&mut self.board.probe);
    }

    /// Executes a command of the host and answers it as the protocol requires.
    fn obey(&mut self, command: &Command, now: Tick) {
        let by = self.holder_or(Holder::Typist);
        let answer = self.carry_out(command, by, now);
        let Some(sequence) = command.sequence() else {
            return;
        };
        // Motion that is repeated many times a second is answered only when it is refused.
        if command.must_arrive() || answer.is_err() {
            self.session.answer(sequence, answer.err());
        }
    }

    /// Executes a command of the board's own firmware, for example of a button that starts spot cleaning. The same limits
    /// and the same permit apply as for a command from the wire, and the newest motion wins (S27).
    ///
    /// # Errors
    /// The reason why it is refused. `Hello`, `Hand`, `Describe`, `Ping` and `Seen` belong to the wire:
    /// `Unknown`.
    pub fn request(&mut self, command: &Command) -> Result<(), Refusal> {
        let now = self.senses.now;
        let by = self.holder_or(Holder::Board);
        self.carry_out(command, by, now)
    }

    /// The host of the open session, whose permission the board's own firmware shares, or who commands without one.
    fn holder_or(&self, without: Holder) -> Holder {
        match self.session.mode() {
            Mode::Checked => Holder::Session(self.session.session()),
            Mode::Hand => without,
        }
    }

    pub(crate) fn carry_out(&mut self, command: &Command, by: Holder, now: Tick) -> CommandResult {
        match command {
            Command::Info => self.reporter.want_info(),
            Command::State => self.reporter.want_state(),
            Command::Drive(drive) => return self.drive(drive, by, now),
            Command::Motor(motor) => return self.motor(motor, by, now),
            Command::Move(movement) => return self.follow(movement, by, now),
            Command::Stop => self.stop(now),
            Command::Beep(beep) => return self.beep(*beep),
            Command::Led(led) => return self.light(led),
            Command::Arm { undock: true, .. } => return self.undock(by, now),
            Command::Arm { undock: false, .. } => return self.arm(by, now),
            Command::Clear { inhibit, .. } => return self.clear(*inhibit),
            Command::Set { parameter, value, .. } => return self.set(*parameter, *value, now),
            Command::Charge { wanted, .. } => return self.charge(*wanted),
            Command::Probe(probe) => return self.probe(probe, now),
            Command::Hello(_)
            | Command::Hand
            | Command::Describe { .. }
            | Command::Ping { .. }
            | Command::Seen { .. } => return Err(Refusal::Unknown),
        }
        Ok(())
    }

    /// What a fresh motion command meets: it is the sign of life that ends `link-lost`.
    fn permit_for_command(&self, by: Holder) -> MotionPermit {
        let mut permit = self.motion_permit();
        permit.armed = self.reflexes.arming.lets_move(by);
        permit.inhibits.remove(Inhibit::LinkLost);
        permit
    }

    fn drive(&mut self, drive: &Drive, by: Holder, now: Tick) -> CommandResult {
        if !self.fitted.encoders {
            return Err(Refusal::Absent);
        }
        let limits = &self.parameters.limits;
        if drive.speed.magnitude() > limits.speed_max.0 || drive.turn.magnitude() > limits.turn_max.0 {
            return Err(Refusal::Range);
        }
        let permit = self.permit_for_command(by);
        if !permit.armed || !suits_drive(drive, &permit, &self.parameters) {
            return Err(Refusal::Inhibited);
        }
        self.reflexes.arming.hear(now);
        let ending = self.motion.drive(drive, now);
        self.end(ending);
        Ok(())
    }

    fn motor(&mut self, command: &MotorCommand, by: Holder, now: Tick) -> CommandResult {
        let side = match command.motor {
            Motor::WheelLeft => WheelSide::Left,
            Motor::WheelRight => WheelSide::Right,
            _ => return self.cleaner(command, by, now),
        };
        let permit = self.permit_for_command(by);
        let sign = command.throttle.millionths();
        let (left, right) = match side {
            WheelSide::Left => (sign, 0),
            WheelSide::Right => (0, sign),
        };
        if !permit.armed || !permit.allows_direction(left, right) {
            return Err(Refusal::Inhibited);
        }
        self.reflexes.arming.hear(now);
        let lease_end = now.after(u32::from(command.lease_ms));
        let ending = self.motion.direct(side, command.throttle, lease_end);
        self.end(ending);
        Ok(())
    }

    fn cleaner(&mut self, command: &MotorCommand, by: Holder, now: Tick) -> CommandResult {
        let is_fitted = match command.motor {
            Motor::BrushMain => self.fitted.brush_main,
            Motor::BrushSides => self.fitted.brush_sides,
            Motor::Vacuum => self.fitted.vacuum,
            Motor::WheelLeft | Motor::WheelRight | Motor::BrushLeft | Motor::BrushRight => false,
        };
        if !is_fitted {
            return Err(Refusal::Absent);
        }
        let permit = self.permit_for_command(by);
        self.cleaning.command(command, &permit, now)?;
        self.reflexes.arming.renew(now);
        Ok(())
    }

    fn follow(&mut self, movement: &Move, by: Holder, now: Tick) -> CommandResult {
        if !self.fitted.encoders {
            return Err(Refusal::Absent);
        }
        let tightest_um = movement.length.magnitude() / MOVE_TURN_MAX;
        if movement
            .radius
            .is_some_and(|radius| radius.0 != 0 && radius.magnitude() < tightest_um)
        {
            return Err(Refusal::Range);
        }
        let motion = &self.parameters.motion;
        let pace = if by == Holder::Typist {
            HAND_PACE
        } else {
            MoveLimits {
                speed_um_per_s: motion.move_speed.0,
                turn_urad_per_s: motion.move_turn.0,
            }
        };
        let permit = self.permit_for_command(by);
        if !permit.armed {
            return Err(Refusal::Inhibited);
        }
        let start = (now, self.senses.gyro);
        let Some(path) = Path::plan(movement, pace, &self.parameters, start) else {
            let replaced = self.motion.halt(MoveEnd::Replaced);
            self.end(replaced);
            self.end(Some(Ending::Move(MoveEnd::Done)));
            return Ok(());
        };
        if !suits_path(&path, &permit) {
            return Err(Refusal::Inhibited);
        }
        self.reflexes.arming.hear(now);
        self.heard = now;
        let replaced = self.motion.follow(path);
        self.end(replaced);
        Ok(())
    }

    fn stop(&mut self, now: Tick) {
        self.reflexes.arming.take(ArmingEvent::Stop, now);
        self.stop_all(MoveEnd::Inhibited);
    }

    fn beep(&mut self, beep: Beep) -> CommandResult {
        if !self.fitted.beeper {
            return Err(Refusal::Absent);
        }
        if self.sound.queue(beep) {
            return Ok(());
        }
        self.journal.note(LogLevel::Warn, "beep dropped,", "queue full");
        Err(Refusal::Busy)
    }

    fn light(&mut self, led: &Led) -> CommandResult {
        let is_there = led.led < self.fitted.leds && self.lights.set(&mut self.board.lights, led);
        if is_there { Ok(()) } else { Err(Refusal::Absent) }
    }

    fn arm(&mut self, by: Holder, now: Tick) -> CommandResult {
        if self.reflexes.dock.is_docked() {
            return Err(Refusal::Inhibited);
        }
        self.arm_anew(ArmingEvent::Arm(by), by, now)
    }

    /// A robot that does not stand on its dock has none to leave: closing contacts are then an arrival from the first one on.
    fn undock(&mut self, by: Holder, now: Tick) -> CommandResult {
        let event = if self.reflexes.dock.is_docked() {
            ArmingEvent::Undock(by)
        } else {
            ArmingEvent::Arm(by)
        };
        self.arm_anew(event, by, now)
    }

    /// Allows motion from now on and forgets earlier requests (S19).
    fn arm_anew(&mut self, event: ArmingEvent, by: Holder, now: Tick) -> CommandResult {
        if by == Holder::Typist && self.parameters.hand_mode == HandMode::Forbidden {
            self.journal
                .note(LogLevel::Warn, "not armed:", "this board forbids hand mode");
            return Err(Refusal::Inhibited);
        }
        if self.reflexes.arming.is_escaping() {
            return Err(Refusal::Inhibited);
        }
        if self.inhibits().contains(Inhibit::ButtonStop) && self.reflexes.any_button() {
            return Err(Refusal::CauseRemains);
        }
        let ending = self.motion.halt(MoveEnd::Replaced);
        self.end(ending);
        self.cleaning.forget();
        self.reflexes.arming.take(event, now);
        if by == Holder::Typist {
            self.journal.note(
                LogLevel::Warn,
                "armed by hand:",
                "slow, until 10 s without motion",
            );
        }
        Ok(())
    }

    /// Starts or forbids charging. Valid on the dock only: each new docking begins with the default.
    fn charge(&mut self, wanted: bool) -> CommandResult {
        if !self.fitted.charger {
            return Err(Refusal::Absent);
        }
        let faulty = self.charger.status().fault.is_some();
        if !self.reflexes.is_held_by_dock() || (wanted && faulty) {
            return Err(Refusal::Inhibited);
        }
        self.charger.want(wanted);
        Ok(())
    }

    /// One reading without a lease, which needs a robot that cannot move, or repeated readings under a lease.
    fn probe(&mut self, probe: &Probe, now: Tick) -> CommandResult {
        if !self.fitted.probe {
            return Err(Refusal::Absent);
        }
        if probe.lease_ms == 0 && !self.reflexes.arming.is_locked() {
            return Err(Refusal::Inhibited);
        }
        self.probing.begin(&mut self.board.probe, probe, now)
    }

    fn set(&mut self, parameter: Parameter, value: i32, now: Tick) -> CommandResult {
        let (least, most) = parameter.range();
        if value != 0 && !(least..=most).contains(&value) {
            return Err(Refusal::Range);
        }
        let period_ms = u32::try_from(value).map_err(|_| Refusal::Range)?;
        match parameter {
            Parameter::StatePeriod => self.reporter.set_state_period(period_ms, now),
            Parameter::InfoPeriod => self.reporter.set_info_period(period_ms, now),
        }
        Ok(())
    }
}
