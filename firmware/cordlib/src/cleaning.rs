//! Brushes and suction: leases, the start rule S29, and the brush half of S11.
//!
//! S29: they start only with both wheels down and the bumper free. S1: the lease of each ends exactly with its `ttl`.
//! S10: an inhibit also clears their command, so that they never restart by themselves.
//! S11: a blocked main brush reverses once for 0.5 s. If it blocks again within 10 s it is switched off and latched.

use rvac_protocol::message::{Motor, MotorCommand, Refusal};
use rvac_units::{Current, Throttle, Tick};

use crate::board::{Board, CleaningMotor, Parts};
use crate::limit::within;
use crate::motion::CONTROL_MS;
use crate::permit::MotionPermit;
use crate::reflex::{Load, StallRule};
use crate::rules::brush::{REVERSE_MS, TRIED_MS};
use crate::timing::Deadline;

/// From rest to full in 0.2 s.
const SLEW_PER_PERIOD: i32 = 50_000;

/// Request and state of one motor.
#[derive(Clone, Copy, Debug, Default)]
struct CleanerMotor {
    duty: Throttle,
    lease: Deadline,
    asked: Throttle,
    applied: Throttle,
}

/// What the main brush did in a control period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BrushLoad {
    /// Nothing special.
    Free,
    /// Blocked for the first time: it reverses.
    Reversing,
    /// Blocked again: it is to be switched off.
    Blocked,
}

/// All cleaning motors.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cleaning {
    main: CleanerMotor,
    sides: CleanerMotor,
    vacuum: CleanerMotor,
    stall: StallRule,
    pulses: u32,
    reversing: Deadline,
    tried: Deadline,
}

impl Cleaning {
    /// A command for one cleaning motor that the machine has.
    ///
    /// # Errors
    /// `Inhibited` if it must not start now, `Absent` if it is none of the three.
    pub(crate) fn command(
        &mut self,
        command: &MotorCommand,
        permit: &MotionPermit,
        now: Tick,
    ) -> Result<(), Refusal> {
        let duty = command.throttle;
        let motor = match command.motor {
            Motor::BrushMain => &mut self.main,
            Motor::BrushSides => &mut self.sides,
            Motor::Vacuum => &mut self.vacuum,
            Motor::WheelLeft | Motor::WheelRight | Motor::BrushLeft | Motor::BrushRight => {
                return Err(Refusal::Absent);
            }
        };
        let starts = motor.applied == Throttle::ZERO && duty != Throttle::ZERO;
        let forbidden = !permit.armed || permit.restrict_cleaner(duty) != duty;
        if forbidden || (starts && permit.has_contact()) {
            return Err(Refusal::Inhibited);
        }
        motor.duty = duty;
        motor.lease = Deadline::at(now.after(u32::from(command.lease_ms)));
        Ok(())
    }

    /// Ends what has no lease any more. Called in every pass.
    pub(crate) fn expire(&mut self, now: Tick) {
        for motor in self.motors() {
            if motor.lease.has_come(now) {
                motor.duty = Throttle::ZERO;
                motor.asked = Throttle::ZERO;
            }
        }
    }

    /// Forgets all requests.
    pub(crate) fn forget(&mut self) {
        for motor in self.motors() {
            motor.duty = Throttle::ZERO;
            motor.asked = Throttle::ZERO;
            motor.lease = Deadline::default();
        }
        self.reversing = Deadline::default();
    }

    /// Whether any motor is on.
    pub(crate) fn is_running(&self) -> bool {
        [self.main, self.sides, self.vacuum]
            .iter()
            .any(|motor| motor.applied != Throttle::ZERO)
    }

    /// Motors that are on: bit 0 main brush, 1 side brushes, 2 suction.
    pub(crate) fn running(&self) -> u8 {
        let bit = |motor: &CleanerMotor, value: u8| if motor.applied == Throttle::ZERO { 0 } else { value };
        bit(&self.main, 1) | bit(&self.sides, 2) | bit(&self.vacuum, 4)
    }

    /// One control period: ramps, and the load of the main brush, whose current and limit are `current`.
    pub(crate) fn control<P: Parts>(
        &mut self,
        board: &mut Board<P>,
        current: Option<(Current, Current)>,
        now: Tick,
    ) -> BrushLoad {
        self.tried.has_come(now);
        self.reversing.has_come(now);
        let load = self.main_load(&mut board.brush_main, current, now);
        let main_goal = if self.reversing.is_running() {
            -self.main.duty.millionths()
        } else {
            self.main.duty.millionths()
        };
        self.main.ramp(main_goal);
        self.sides.asked = self.sides.duty;
        self.vacuum.asked = self.vacuum.duty;
        load
    }

    /// Sends what is permitted to the board, where it differs from what is there.
    pub(crate) fn apply<P: Parts>(&mut self, board: &mut Board<P>, permit: &MotionPermit) {
        if permit.restrict_cleaner(Throttle::FULL) == Throttle::ZERO {
            self.forget();
        }
        self.main.apply(&mut board.brush_main, permit);
        self.sides.apply(&mut board.brush_sides, permit);
        self.vacuum.apply(&mut board.vacuum, permit);
    }

    /// Writes the permitted duties to the board again, changed or not.
    pub(crate) fn renew<P: Parts>(&self, board: &mut Board<P>, permit: &MotionPermit) {
        board.brush_main.set(permit.restrict_cleaner(self.main.asked));
        board.brush_sides.set(permit.restrict_cleaner(self.sides.asked));
        board.vacuum.set(permit.restrict_cleaner(self.vacuum.asked));
    }

    /// `stop_all` has switched the motors off directly.
    pub(crate) fn stopped(&mut self) {
        self.forget();
        for motor in self.motors() {
            motor.applied = Throttle::ZERO;
        }
    }

    /// A person has freed the brush: it may reverse once again.
    pub(crate) const fn forgive(&mut self) {
        self.stall.restart();
        self.tried = Deadline::NONE;
    }

    fn motors(&mut self) -> [&mut CleanerMotor; 3] {
        [&mut self.main, &mut self.sides, &mut self.vacuum]
    }

    fn main_load<M: CleaningMotor>(
        &mut self,
        motor: &mut M,
        current: Option<(Current, Current)>,
        now: Tick,
    ) -> BrushLoad {
        let turned = motor.pulses().map(|pulses| pulses != self.pulses);
        self.pulses = motor.pulses().unwrap_or(0);
        let load = Load {
            duty: self.main.applied.millionths(),
            turned,
            current,
        };
        if self.reversing.is_running() {
            self.stall.restart();
            return BrushLoad::Free;
        }
        if !self.stall.update(load, now) {
            return BrushLoad::Free;
        }
        self.stall.restart();
        if self.tried.is_running() {
            return BrushLoad::Blocked;
        }
        self.reversing = Deadline::at(now.after(REVERSE_MS));
        self.tried = Deadline::at(now.after(TRIED_MS));
        BrushLoad::Reversing
    }
}

impl CleanerMotor {
    /// One step towards the goal. A reversal never rests at 0, which would be a stop and a new start (S29); the brush has
    /// stopped by itself when it is reversed.
    fn ramp(&mut self, goal: i32) {
        let from = self.asked.millionths();
        let opposite = from.signum() * goal.signum() < 0;
        let next = if goal == 0 {
            0
        } else if opposite {
            SLEW_PER_PERIOD.min(goal.saturating_abs()) * goal.signum()
        } else {
            within(
                goal,
                from.saturating_sub(SLEW_PER_PERIOD),
                from.saturating_add(SLEW_PER_PERIOD),
            )
        };
        self.asked = Throttle::saturating_from_millionths(next);
    }

    fn apply<M: CleaningMotor>(&mut self, motor: &mut M, permit: &MotionPermit) {
        let permitted = permit.restrict_cleaner(self.asked);
        if permitted != self.applied {
            motor.set(permitted);
            self.applied = permitted;
        }
    }
}

const _: () = assert!(REVERSE_MS.is_multiple_of(CONTROL_MS));
