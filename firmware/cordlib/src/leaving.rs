//! A shorted transistor of the charger: current flows whatever the firmware does, and only leaving the dock cuts it (S18).
//! The host is told at once. If it does nothing the robot warns with three beeps, waits two seconds and backs off by
//! itself, a hand's breadth, at most three times.

use rvac_protocol::message::{Beep, Command, LogLevel, Motor, MotorCommand, Move, Sequence};
use rvac_units::{Frequency, Length, Ratio, Throttle, Tick};

use crate::board::Parts;
use crate::cord::Cord;
use crate::timing::Until;

const TRIES_MAX: u8 = 3;
const WARNING_MS: u32 = 2_000;
/// Until the next try, or until it is over.
const TRY_MS: u32 = 4_000;
const WAY: Length = Length(-150_000);
/// Without encoders the way is measured by time: about a third of the speed, for a second.
const BLIND_DUTY: i32 = -450_000;
const BLIND_MS: u16 = 1_000;

/// Where it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Stage {
    #[default]
    Resting,
    Warning,
    Backing,
}

/// The way off a dock that does not let go.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Leaving {
    stage: Stage,
    until: Until,
    tries: u8,
}

impl Leaving {
    /// Whether the robot backs off now.
    pub(crate) fn is_backing(&self) -> bool {
        self.stage == Stage::Backing
    }
}

impl<P: Parts> Cord<P> {
    /// Backs off the dock if current flows that nothing else can stop.
    pub(crate) fn leave_shorted_dock(&mut self, now: Tick) {
        let held = self.is_charger_shorted() && self.reflexes.dock.is_docked();
        let over = self.leaving.until.has_come(now);
        match self.leaving.stage {
            Stage::Resting if !held => self.leaving.tries = 0,
            Stage::Resting if self.leaving.tries < TRIES_MAX && !self.leaving.until.is_running() => {
                self.warn(now);
            }
            Stage::Resting => {}
            Stage::Warning if over && held => self.back_off(now),
            Stage::Warning if over => self.leaving.stage = Stage::Resting,
            Stage::Warning => {}
            // Off the contacts, or the try has failed: nothing goes on by itself.
            Stage::Backing if over || !self.is_in_motion() => {
                self.leaving.stage = Stage::Resting;
                self.leaving.until = Until::at(now.after(TRY_MS));
                self.reflexes.host.disarm();
                self.reflexes.dock.stay();
                self.stop_all(rvac_protocol::message::MoveEnd::Inhibited);
            }
            Stage::Backing => {}
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
    fn back_off(&mut self, now: Tick) {
        self.leaving.stage = Stage::Backing;
        self.leaving.until = Until::at(now.after(TRY_MS));
        let sequence = Sequence(0);
        let undock = Command::Arm {
            sequence,
            undock: true,
        };
        let mut answer = self.carry_out(&undock, now);
        if self.fitted.encoders {
            let back = Command::Move(Move {
                length: WAY,
                radius: None,
                sequence,
                seen_tick: now,
            });
            answer = answer.and_then(|()| self.carry_out(&back, now));
        } else {
            for motor in [Motor::WheelLeft, Motor::WheelRight] {
                let back = Command::Motor(MotorCommand {
                    motor,
                    throttle: Throttle::saturating_from_millionths(BLIND_DUTY),
                    lease_ms: BLIND_MS,
                    sequence,
                    seen_tick: now,
                });
                answer = answer.and_then(|()| self.carry_out(&back, now));
            }
        }
        if let Err(refusal) = answer {
            self.journal
                .note(LogLevel::Error, "cannot leave the dock:", refusal.name());
        }
    }
}
