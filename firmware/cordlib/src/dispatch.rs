//! What the host's commands do. They arrive checked: well-formed, sealed, fresh. Here they meet the machine's limits and
//! what inhibits.

use rvac_protocol::message::{
    Beep, Command, Drive, Inhibit, LogLevel, Motor, MotorCommand, Move, MoveEnd, Parameter, Refusal, Sequence,
};
use rvac_protocol::session::{HAND_SPEED_MAX, HAND_TURN_MAX, Mode, RobotEvent, SessionEnd};
use rvac_units::Tick;

use crate::board::{Beeper, Encoders, Parts};
use crate::cord::Cord;
use crate::motion::{Ending, Pace, Path, Side, suits_drive, suits_path};
use crate::permit::Standing;

/// Largest turn of one `move`, in radians: ten turns.
const MOVE_TURN_MAX: i32 = 63;
/// Speed of a `move` that a person types.
const HAND_PACE: Pace = Pace {
    speed_um_per_s: HAND_SPEED_MAX.0,
    turn_urad_per_s: HAND_TURN_MAX.0,
};

type Answer = Result<(), Refusal>;

impl<P: Parts> Cord<P> {
    /// Carries out one event of the session.
    pub(crate) fn dispatch(&mut self, event: &RobotEvent, now: Tick) {
        match event {
            RobotEvent::Command(command) => self.obey(command, now),
            RobotEvent::SessionOpened => {
                self.void_leases();
                self.journal.note(LogLevel::Info, "session opened", "");
            }
            RobotEvent::SessionClosed(end) => {
                self.void_leases();
                let why = match end {
                    SessionEnd::Hand => "by hand",
                    SessionEnd::Silence => "by silence",
                };
                self.journal.note(LogLevel::Warn, "session closed", why);
            }
        }
    }

    /// Leases of another session mean nothing.
    fn void_leases(&mut self) {
        if self.motion.is_active() {
            self.reflexes.host.lose_link();
        }
        self.stop_all(MoveEnd::Inhibited);
    }

    fn obey(&mut self, command: &Command, now: Tick) {
        match command {
            Command::Info => self.reporter.want_info(),
            Command::State => self.reporter.want_state(),
            Command::Drive(drive) => {
                let answer = self.drive(drive, now);
                self.answer_refusal(drive.sequence, answer);
            }
            Command::Motor(motor) => {
                let answer = self.motor(motor, now);
                self.answer_refusal(motor.sequence, answer);
            }
            Command::Move(movement) => {
                let answer = self.follow(movement, now);
                self.answer(movement.sequence, answer);
            }
            Command::Stop => self.stop(),
            Command::Beep(beep) => self.beep(*beep),
            Command::Led(led) => {
                self.lights.set(&mut self.board.lights, led);
            }
            Command::Arm { sequence, undock } => {
                let answer = if *undock { self.undock() } else { self.arm() };
                self.answer(*sequence, answer);
            }
            Command::Clear { sequence, inhibit } => {
                let answer = self.clear(*inhibit);
                self.answer(*sequence, answer);
            }
            Command::Set {
                sequence,
                parameter,
                value,
            } => {
                let answer = self.set(*parameter, *value, now);
                self.answer(*sequence, answer);
            }
            Command::Hello(_)
            | Command::Hand
            | Command::Describe { .. }
            | Command::Ping { .. }
            | Command::Seen { .. } => {}
        }
    }

    fn answer(&mut self, sequence: Sequence, answer: Answer) {
        self.session.answer(sequence, answer.err());
    }

    /// Motion that is repeated many times a second is answered only when it is refused.
    fn answer_refusal(&mut self, sequence: Sequence, answer: Answer) {
        if let Err(refusal) = answer {
            self.session.answer(sequence, Some(refusal));
        }
    }

    /// What a fresh motion command meets: it is the sign of life that ends `link-lost`.
    fn standing_for_command(&self) -> Standing {
        let mut standing = self.standing();
        standing.inhibits.remove(Inhibit::LinkLost);
        standing
    }

    fn drive(&mut self, drive: &Drive, now: Tick) -> Answer {
        let limits = &self.parameters.limits;
        if drive.speed.magnitude() > limits.speed_max.0 || drive.turn.magnitude() > limits.turn_max.0 {
            return Err(Refusal::Range);
        }
        let standing = self.standing_for_command();
        if !standing.armed || !suits_drive(drive, &standing, &self.parameters) {
            return Err(Refusal::Inhibited);
        }
        self.reflexes.host.hear();
        let ending = self.motion.drive(drive, now);
        self.end(ending);
        Ok(())
    }

    fn motor(&mut self, command: &MotorCommand, now: Tick) -> Answer {
        let side = match command.motor {
            Motor::WheelLeft => Side::Left,
            Motor::WheelRight => Side::Right,
            _ => return self.cleaner(command, now),
        };
        let standing = self.standing_for_command();
        let sign = command.throttle.millionths();
        let (left, right) = match side {
            Side::Left => (sign, 0),
            Side::Right => (0, sign),
        };
        if !standing.armed || !standing.allows_direction(left, right) {
            return Err(Refusal::Inhibited);
        }
        self.reflexes.host.hear();
        let lease_end = now.after(u32::from(command.lease_ms));
        let ending = self.motion.direct(side, command.throttle, lease_end);
        self.end(ending);
        Ok(())
    }

    fn cleaner(&mut self, command: &MotorCommand, now: Tick) -> Answer {
        let standing = self.standing_for_command();
        if !standing.armed {
            return Err(Refusal::Inhibited);
        }
        self.cleaning.command::<P>(command, &standing, now)
    }

    fn follow(&mut self, movement: &Move, now: Tick) -> Answer {
        if !P::Encoders::PRESENT {
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
        let pace = match self.session.mode() {
            Mode::Hand => HAND_PACE,
            Mode::Sealed => Pace {
                speed_um_per_s: motion.move_speed.0,
                turn_urad_per_s: motion.move_turn.0,
            },
        };
        let standing = self.standing_for_command();
        if !standing.armed {
            return Err(Refusal::Inhibited);
        }
        let start = (now, self.senses.gyro);
        let Some(path) = Path::plan(movement, pace, &self.parameters, start) else {
            let replaced = self.motion.halt(MoveEnd::Replaced);
            self.end(replaced);
            self.end(Some(Ending::Move(MoveEnd::Done)));
            return Ok(());
        };
        if !suits_path(&path, &standing) {
            return Err(Refusal::Inhibited);
        }
        self.reflexes.host.hear();
        self.heard = now;
        let replaced = self.motion.follow(path);
        self.end(replaced);
        Ok(())
    }

    fn stop(&mut self) {
        self.reflexes.host.stop();
        self.reflexes.dock.stay();
        self.stop_all(MoveEnd::Inhibited);
    }

    fn beep(&mut self, beep: Beep) {
        if P::Beeper::PRESENT && !self.sound.queue(beep) {
            self.journal.note(LogLevel::Warn, "beep dropped,", "queue full");
        }
    }

    fn arm(&mut self) -> Answer {
        if self.reflexes.dock.inhibits() {
            return Err(Refusal::Inhibited);
        }
        self.arm_anew()
    }

    fn undock(&mut self) -> Answer {
        self.arm_anew()?;
        self.reflexes.dock.undock();
        Ok(())
    }

    /// Motion is allowed from here on; what was asked before is forgotten (S19).
    fn arm_anew(&mut self) -> Answer {
        if self.inhibits().contains(Inhibit::ButtonStop) && self.reflexes.buttons() != 0 {
            return Err(Refusal::CauseRemains);
        }
        let ending = self.motion.halt(MoveEnd::Replaced);
        self.end(ending);
        self.cleaning.forget();
        self.reflexes.host.arm();
        Ok(())
    }

    fn clear(&mut self, inhibit: Inhibit) -> Answer {
        if !self.reflexes.clear(inhibit) {
            return Err(Refusal::CauseRemains);
        }
        if inhibit == Inhibit::BrushStall {
            self.cleaning.forgive();
        }
        Ok(())
    }

    fn set(&mut self, parameter: Parameter, value: i32, now: Tick) -> Answer {
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
