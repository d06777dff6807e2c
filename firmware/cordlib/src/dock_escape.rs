//! Reaction to a shorted transistor of the charger (S18). The current cannot be switched off; only leaving the dock ends
//! it. The robot reports the fault at once. If the current still flows after three beeps and 2 s, whether a host lives or
//! has armed or not, the robot backs off by itself, up to 0.2 m, at most three times. [`crate::arming`] keeps the permission.

use rvac_protocol::message::{
    Beep, Command, Drive, LogLevel, Motor, MotorCommand, MoveEnd, Refusal, Sequence,
};
use rvac_units::{AngularSpeed, Frequency, Ratio, Speed, Throttle, Tick};

use crate::arming::{ArmingEvent, Holder};
use crate::board::Parts;
use crate::cord::Cord;
use crate::rules::dock_escape::{
    BLIND_DUTY, LEASE_MS, OPEN_MS, RENEW_MS, SPEED_UM_PER_S, TRIES_MAX, TRY_MS, WARNING_MS,
};
use crate::timing::{Deadline, HoldTimer, Periodic};

/// Stage of the escape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum EscapeStage {
    #[default]
    Resting,
    Warning,
    Backing,
}

/// Backing off a dock whose current cannot be switched off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DockEscape {
    stage: EscapeStage,
    deadline: Deadline,
    renew: Periodic,
    open: HoldTimer,
    tries: u8,
}

impl DockEscape {
    pub(crate) fn starting_at(now: Tick) -> Self {
        Self {
            stage: EscapeStage::Resting,
            deadline: Deadline::NONE,
            renew: Periodic::starting_at(now),
            open: HoldTimer::default(),
            tries: 0,
        }
    }
}

impl<P: Parts> Cord<P> {
    /// Backs off the dock if current flows that nothing else can stop.
    pub(crate) fn escape_shorted_dock(&mut self, now: Tick) {
        let docked = self.reflexes.dock.is_docked();
        let held = docked && self.is_charger_shorted() && self.charger.leaks();
        let over = self.dock_escape.deadline.has_come(now);
        match self.dock_escape.stage {
            EscapeStage::Resting if !docked || !self.is_charger_shorted() => self.dock_escape.tries = 0,
            EscapeStage::Resting
                if held && self.dock_escape.tries < TRIES_MAX && !self.dock_escape.deadline.is_running() =>
            {
                self.warn(now);
            }
            EscapeStage::Resting => {}
            EscapeStage::Warning if over && held => self.begin_backing(now),
            EscapeStage::Warning if over => self.dock_escape.stage = EscapeStage::Resting,
            EscapeStage::Warning => {}
            EscapeStage::Backing => self.back_off(over, now),
        }
    }

    /// Ends when the contacts are open, the time is over or a person stops it; the robot is then locked.
    fn back_off(&mut self, over: bool, now: Tick) {
        let open = !self.senses.docked;
        let away = self.dock_escape.open.for_at_least(open, now, OPEN_MS);
        let ended = over || away || !self.reflexes.arming.is_escaping();
        if !ended && self.dock_escape.renew.is_due(now, RENEW_MS) {
            let answer = self.push_back(now);
            if let Err(refusal) = answer {
                self.journal
                    .note(LogLevel::Error, "cannot leave the dock:", refusal.name());
            }
        }
        if ended {
            self.dock_escape.stage = EscapeStage::Resting;
            self.dock_escape.deadline = Deadline::at(now.after(TRY_MS));
            self.reflexes.arming.take(ArmingEvent::EscapeOver, now);
            self.stop_all(MoveEnd::Inhibited);
        }
    }

    fn warn(&mut self, now: Tick) {
        self.dock_escape.stage = EscapeStage::Warning;
        self.dock_escape.deadline = Deadline::at(now.after(WARNING_MS));
        self.dock_escape.tries = self.dock_escape.tries.saturating_add(1);
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

    fn begin_backing(&mut self, now: Tick) {
        self.dock_escape.stage = EscapeStage::Backing;
        self.dock_escape.deadline = Deadline::at(now.after(TRY_MS));
        self.dock_escape.renew = Periodic::starting_at(now);
        self.dock_escape.open.restart();
        self.stop_all(MoveEnd::Inhibited);
        self.reflexes.arming.take(ArmingEvent::EscapeBegins, now);
    }

    /// Goes through the same code as a command of the host, so that the permit and every reflex apply.
    fn push_back(&mut self, now: Tick) -> Result<(), Refusal> {
        let sequence = Sequence(0);
        if self.fitted.encoders {
            return self.carry_out(
                &Command::Drive(Drive {
                    speed: Speed(SPEED_UM_PER_S),
                    turn: AngularSpeed::ZERO,
                    lease_ms: LEASE_MS,
                    sequence,
                    seen_tick: now,
                }),
                Holder::Escape,
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
            self.carry_out(&Command::Motor(back), Holder::Escape, now)?;
        }
        Ok(())
    }
}
