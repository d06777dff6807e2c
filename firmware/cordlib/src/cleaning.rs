//! Brushes and suction: leases, the start rule S29, and the brush half of S11.
//!
//! S29: they start only with both wheels down and the bumper free. S1: they go on for 2 s after their last command.
//! S10: whatever forbids them makes them forget their command, so that they never start again by themselves.
//! S11: a blocked main brush turns backwards for 0.5 s once; blocked again within 10 s it is given up, latched.

use rvac_protocol::message::{Motor, MotorCommand, Refusal};
use rvac_units::{Current, Throttle, Tick};

use crate::board::{Board, CleaningMotor, Parts};
use crate::limit::within;
use crate::motion::CONTROL_MS;
use crate::permit::Standing;
use crate::reflex::{Load, StallRule};
use crate::timing::Until;

const GRACE_MS: u32 = 2_000;
const REVERSE_MS: u32 = 500;
const TRIED_MS: u32 = 10_000;
/// From rest to full in 0.2 s.
const SLEW_PER_PERIOD: i32 = 50_000;

/// One motor's wish.
#[derive(Clone, Copy, Debug, Default)]
struct Wish {
    duty: Throttle,
    lease: Until,
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
    /// Blocked again: give up.
    Blocked,
}

/// All cleaning motors.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cleaning {
    main: Wish,
    sides: Wish,
    vacuum: Wish,
    stall: StallRule,
    pulses: u32,
    reversing: Until,
    tried: Until,
}

impl Cleaning {
    /// A command for one cleaning motor that the machine has.
    ///
    /// # Errors
    /// `Inhibited` if it must not start now, `Absent` if it is none of the three.
    pub(crate) fn command(
        &mut self,
        command: &MotorCommand,
        standing: &Standing,
        now: Tick,
    ) -> Result<(), Refusal> {
        let duty = command.throttle;
        let wish = match command.motor {
            Motor::BrushMain => &mut self.main,
            Motor::BrushSides => &mut self.sides,
            Motor::Vacuum => &mut self.vacuum,
            Motor::WheelLeft | Motor::WheelRight | Motor::BrushLeft | Motor::BrushRight => {
                return Err(Refusal::Absent);
            }
        };
        let starts = wish.applied == Throttle::ZERO && duty != Throttle::ZERO;
        let forbidden = !standing.armed || standing.permit_cleaner(duty) != duty;
        if forbidden || (starts && standing.touches()) {
            return Err(Refusal::Inhibited);
        }
        wish.duty = duty;
        wish.lease = Until::at(now.after(GRACE_MS));
        Ok(())
    }

    /// Forgets all wishes.
    pub(crate) fn forget(&mut self) {
        for wish in self.wishes() {
            wish.duty = Throttle::ZERO;
            wish.asked = Throttle::ZERO;
            wish.lease = Until::default();
        }
        self.reversing = Until::default();
    }

    /// Whether any motor is on.
    pub(crate) fn is_running(&self) -> bool {
        [self.main, self.sides, self.vacuum]
            .iter()
            .any(|wish| wish.applied != Throttle::ZERO)
    }

    /// Motors that are on: bit 0 main brush, 1 side brushes, 2 suction.
    pub(crate) fn running(&self) -> u8 {
        let bit = |wish: &Wish, value: u8| if wish.applied == Throttle::ZERO { 0 } else { value };
        bit(&self.main, 1) | bit(&self.sides, 2) | bit(&self.vacuum, 4)
    }

    /// One control period: leases, ramps, and the load of the main brush, whose current and limit are `current`.
    pub(crate) fn control<P: Parts>(
        &mut self,
        board: &mut Board<P>,
        current: Option<(Current, Current)>,
        now: Tick,
    ) -> BrushLoad {
        for wish in self.wishes() {
            if wish.lease.has_come(now) {
                wish.duty = Throttle::ZERO;
            }
        }
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
    pub(crate) fn apply<P: Parts>(&mut self, board: &mut Board<P>, standing: &Standing) {
        if standing.permit_cleaner(Throttle::FULL) == Throttle::ZERO {
            self.forget();
        }
        self.main.apply(&mut board.brush_main, standing);
        self.sides.apply(&mut board.brush_sides, standing);
        self.vacuum.apply(&mut board.vacuum, standing);
    }

    /// Tells the board again what is permitted, changed or not.
    pub(crate) fn renew<P: Parts>(&self, board: &mut Board<P>, standing: &Standing) {
        board.brush_main.set(standing.permit_cleaner(self.main.asked));
        board.brush_sides.set(standing.permit_cleaner(self.sides.asked));
        board.vacuum.set(standing.permit_cleaner(self.vacuum.asked));
    }

    /// The board was switched off behind our back, by the one stop path.
    pub(crate) fn stopped(&mut self) {
        self.forget();
        for wish in self.wishes() {
            wish.applied = Throttle::ZERO;
        }
    }

    /// The brush was cleared: it has its one reverse try again.
    pub(crate) const fn forgive(&mut self) {
        self.stall.restart();
        self.tried = Until::NEVER;
    }

    fn wishes(&mut self) -> [&mut Wish; 3] {
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
        self.reversing = Until::at(now.after(REVERSE_MS));
        self.tried = Until::at(now.after(TRIED_MS));
        BrushLoad::Reversing
    }
}

impl Wish {
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

    fn apply<M: CleaningMotor>(&mut self, motor: &mut M, standing: &Standing) {
        let permitted = standing.permit_cleaner(self.asked);
        if permitted != self.applied {
            motor.set(permitted);
            self.applied = permitted;
        }
    }
}

const _: () = assert!(REVERSE_MS.is_multiple_of(CONTROL_MS));
