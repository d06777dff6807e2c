//! A shorted transistor of the charger: current flows whatever the firmware does, and only leaving the dock cuts it (S18).
//! The host is told at once. If it does nothing the robot warns with three beeps, waits two seconds and backs off by
//! itself, a hand's breadth, at most three times.

use rvac_protocol::message::{
    Beep, Command, Drive, LogLevel, Motor, MotorCommand, MoveEnd, Refusal, Sequence,
};
use rvac_units::{AngularSpeed, Frequency, Ratio, Speed, Throttle, Tick};

use crate::board::Parts;
use crate::cord::Cord;
use crate::timing::{Held, Periodic, Until};

const TRIES_MAX: u8 = 3;
const WARNING_MS: u32 = 2_000;
/// A try lasts no longer: 0.2 m. The same time passes before the next one.
const TRY_MS: u32 = 2_000;
const SPEED: Speed = Speed(-100_000);
/// Without encoders the speed is not known: a duty that moves any robot, not fast.
const BLIND_DUTY: i32 = -450_000;
/// The wish is renewed at this pace and lives a little longer.
const RENEW_MS: u32 = 100;
const LEASE_MS: u16 = 150;
/// The contacts must have been open for so long: some centimetres away from them.
const OPEN_MS: u32 = 400;

/// Where it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Stage {
    #[default]
    Resting,
    Warning,
    Backing,
}

/// The way off a dock that does not let go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaving {
    stage: Stage,
    until: Until,
    renew: Periodic,
    open: Held,
    tries: u8,
}

impl Leaving {
    pub(crate) fn starting_at(now: Tick) -> Self {
        Self {
            stage: Stage::Resting,
            until: Until::NEVER,
            renew: Periodic::starting_at(now),
            open: Held::default(),
            tries: 0,
        }
    }

    /// Whether the robot backs off now.
    pub(crate) fn is_backing(&self) -> bool {
        self.stage == Stage::Backing
    }
}

impl<P: Parts> Cord<P> {
    /// Backs off the dock if current flows that nothing else can stop.
    pub(crate) fn leave_shorted_dock(&mut self, now: Tick) {
        // A host that has armed the robot on the dock leads it off itself.
        let led = self.reflexes.host.is_armed() && !self.leaving.is_backing();
        let held = self.is_charger_shorted() && self.reflexes.dock.is_docked() && !led;
        let over = self.leaving.until.has_come(now);
        match self.leaving.stage {
            Stage::Resting if !held => self.leaving.tries = 0,
            Stage::Resting if self.leaving.tries < TRIES_MAX && !self.leaving.until.is_running() => {
                self.warn(now);
            }
            Stage::Resting => {}
            Stage::Warning if over && held => self.begin_to_leave(now),
            Stage::Warning if over => self.leaving.stage = Stage::Resting,
            Stage::Warning => {}
            Stage::Backing => self.back_off(over, now),
        }
    }

    /// Off the contacts, or when the try has failed, nothing goes on by itself.
    fn back_off(&mut self, over: bool, now: Tick) {
        let open = !self.senses.docked;
        let away = self.leaving.open.for_at_least(open, now, OPEN_MS);
        if !over && !away && self.leaving.renew.is_due(now, RENEW_MS) {
            let answer = self.push_back(now);
            if let Err(refusal) = answer {
                self.journal
                    .note(LogLevel::Error, "cannot leave the dock:", refusal.name());
            }
        }
        if over || away {
            self.leaving.stage = Stage::Resting;
            self.leaving.until = Until::at(now.after(TRY_MS));
            self.reflexes.host.disarm();
            self.reflexes.dock.stay();
            self.stop_all(MoveEnd::Inhibited);
        }
    }

    fn warn(&mut self, now: Tick) {
        self.leaving.stage = Stage::Warning;
        self.leaving.until = Until::at(now.after(WARNING_MS));
        self.leaving.tries = self.leaving.tries.saturating_add(1);
        self.journal.note(
            LogLevel::Error,
            "charger does not switch off:",
            "leaving the dock",
        );
        for pitch in [880, 0, 880, 0, 880] {
            self.sound.queue(Beep {
                pitch: Frequency(pitch),
                duration_ms: 200,
                volume: Ratio::ONE,
            });
        }
    }

    /// Uses the ways of a command, so that the gate and every reflex hold.
    fn begin_to_leave(&mut self, now: Tick) {
        self.leaving.stage = Stage::Backing;
        self.leaving.until = Until::at(now.after(TRY_MS));
        self.leaving.renew = Periodic::starting_at(now);
        self.leaving.open.restart();
        let undock = Command::Arm {
            sequence: Sequence(0),
            undock: true,
        };
        if let Err(refusal) = self.carry_out(&undock, now) {
            self.journal
                .note(LogLevel::Error, "cannot leave the dock:", refusal.name());
        }
    }

    fn push_back(&mut self, now: Tick) -> Result<(), Refusal> {
        let sequence = Sequence(0);
        if self.fitted.encoders {
            return self.carry_out(
                &Command::Drive(Drive {
                    speed: SPEED,
                    turn: AngularSpeed::ZERO,
                    lease_ms: LEASE_MS,
                    sequence,
                    seen_tick: now,
                }),
                now,
            );
        }
        for motor in [Motor::WheelLeft, Motor::WheelRight] {
            let back = MotorCommand {
                motor,
                throttle: Throttle::saturating_from_millionths(BLIND_DUTY),
                lease_ms: LEASE_MS,
                sequence,
                seen_tick: now,
            };
            self.carry_out(&Command::Motor(back), now)?;
        }
        Ok(())
    }
}
