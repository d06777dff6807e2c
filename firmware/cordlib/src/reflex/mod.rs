//! The reflexes: one file for each family of rules, and [`Reflexes`], which collects what they inhibit.
//!
//! Rule numbers are those of SAFETY.md. S2 and S3 are implemented in the protocol session, S5 in `watch`, S9 in `floor`, S22
//! in the integer types, S29 in `cleaning`.

mod battery;
mod bumper;
mod button;
mod cliff;
mod dock;
mod encoder;
mod lift;
mod progress;
mod reset;
mod runaway;
mod stall;

pub(crate) use battery::PackView;
pub(crate) use button::ButtonChange;
pub(crate) use stall::{Load, StallRule};

use rvac_protocol::message::{Bumpers, ChargeFault, Cliffs, Inhibit, Inhibits, Motor, WheelDrops};

use crate::arming::{Arming, ArmingEvent};
use crate::board::ResetRecord;
use crate::guarded::Latches;
use crate::motion::{MotionStatus, WheelStatus};
use crate::parameters::Parameters;
use crate::permit::{MotionPermit, ReverseBound};
use crate::senses::Senses;

use battery::BatteryRule;
use bumper::{BumperContext, BumperRule};
use button::ButtonRule;
use cliff::{CliffContext, CliffRule};
use dock::DockRule;
use encoder::EncoderRule;
use lift::LiftRule;
use progress::{Headway, ProgressRule};
use reset::ResetRule;
use runaway::RunawayRule;

/// State of all rules.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reflexes {
    pub(crate) arming: Arming,
    pub(crate) dock: DockRule,
    /// What is wrong with the charger.
    pub(crate) charger_fault: Option<ChargeFault>,
    battery: BatteryRule,
    buttons: ButtonRule,
    bumper: BumperRule,
    cliff: CliffRule,
    lift: LiftRule,
    reset: ResetRule,
    stall: [StallRule; 2],
    runaway: [RunawayRule; 2],
    encoder: [EncoderRule; 2],
    progress: ProgressRule,
    blinded: bool,
    lifted: bool,
    idle: bool,
    latched: Latches,
    wheel_turns: bool,
    /// Turning wheels are the robot's own doing, and no push by hand.
    is_watched: bool,
    /// Encoders are fitted and calibrated: counts are distances.
    counted: bool,
    /// Wheels whose encoder has counted since the reset, calibrated or not.
    alive: [bool; 2],
}

/// What the fast rules found in one pass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Findings {
    pub(crate) dock: Option<ArmingEvent>,
    pub(crate) buttons: ButtonChange,
}

impl Reflexes {
    /// Starts disarmed; a reset loop is latched from the start.
    pub(crate) fn new<R: ResetRecord>(record: &mut R, counted: bool, now: rvac_units::Tick) -> Self {
        let (reset, is_loop) = ResetRule::new(record, now);
        let mut latched = Latches::default();
        if is_loop {
            latched.insert(Inhibit::ResetLoop);
        }
        Self {
            arming: Arming::default(),
            dock: DockRule::default(),
            charger_fault: None,
            battery: BatteryRule::default(),
            buttons: ButtonRule::default(),
            bumper: BumperRule::default(),
            cliff: CliffRule::default(),
            lift: LiftRule::default(),
            reset,
            stall: [StallRule::default(); 2],
            runaway: [RunawayRule::default(); 2],
            encoder: [EncoderRule::default(); 2],
            progress: ProgressRule::default(),
            blinded: false,
            lifted: false,
            idle: false,
            latched,
            wheel_turns: false,
            is_watched: false,
            counted,
            alive: [false; 2],
        }
    }

    /// Runs the rules on contacts and the floor, in every pass.
    pub(crate) fn check_contacts(&mut self, senses: &Senses, motion: &MotionStatus) -> Findings {
        let now = senses.now;
        let dock = self.dock.update(senses.docked, now);
        let backing = motion.left.duty.saturating_add(motion.right.duty) < 0;
        let context = BumperContext {
            backing,
            travelled_nm: motion.travelled_nm,
            at_rest: self.arming.is_locked() || self.dock.is_docked(),
        };
        if self.bumper.update(senses.bumpers, context, now) {
            self.latched.insert(Inhibit::BumperStuck);
        }
        let context = CliffContext {
            driven: motion.left.duty != 0 || motion.right.duty != 0,
            travelled_nm: motion.travelled_nm,
        };
        let trapped = self.cliff.update(senses.no_floor, context, now);
        // Without encoders neither distance nor speed of the reverse from a cliff can be limited.
        let blind = !self.counted && context.driven && self.cliff.any();
        if trapped || blind {
            self.latched.insert(Inhibit::CliffTrapped);
        }
        self.blinded = senses.blinded != Cliffs::default();
        self.lifted = self.lift.update(senses.wheel_drops, now);
        Findings {
            dock,
            buttons: self.buttons.update(senses.buttons, senses.any_button, now),
        }
    }

    /// Runs the rules on motors, once in each control period. Returns wheels that were switched off for overload.
    pub(crate) fn judge_wheels(
        &mut self,
        senses: &Senses,
        motion: &MotionStatus,
        parameters: &Parameters,
    ) -> [Option<Motor>; 2] {
        if self.lifted {
            return [None; 2];
        }
        let limit = parameters.guard.wheel_current_max;
        let currents = senses.currents.map(|all| [all.wheel_left, all.wheel_right]);
        let loads = [
            (motion.left, currents.map(|[left, _]| (left, limit))),
            (motion.right, currents.map(|[_, right]| (right, limit))),
        ];
        let mut stalled = [None; 2];
        let motors = [Motor::WheelLeft, Motor::WheelRight];
        for ((((load, rule), out), motor), alive) in loads
            .into_iter()
            .zip(&mut self.stall)
            .zip(&mut stalled)
            .zip(motors)
            .zip(&mut self.alive)
        {
            let (wheel, current) = load;
            *alive |= wheel.turned;
            let turned = (self.counted || *alive).then_some(wheel.turned);
            let load = Load {
                duty: wheel.duty,
                turned,
                current,
            };
            if rule.update(load, senses.now) {
                rule.restart();
                self.latched.insert(Inhibit::WheelStall);
                *out = Some(motor);
            }
        }
        if self.counted {
            self.judge_encoders(senses, motion, parameters);
        }
        stalled
    }

    fn judge_encoders(&mut self, senses: &Senses, motion: &MotionStatus, parameters: &Parameters) {
        let wheels = [motion.left, motion.right];
        self.wheel_turns = wheels.iter().any(WheelStatus::is_turning);
        // A permission that ends does not end a bridge that goes on: the watch lasts until the wheels have come to rest.
        self.is_watched = !self.arming.is_locked() || (self.is_watched && self.wheel_turns);
        for (wheel, rule) in wheels.into_iter().zip(&mut self.encoder) {
            if rule.update(wheel, senses.now) {
                self.latched.insert(Inhibit::EncoderFault);
            }
        }
        for (wheel, rule) in wheels.into_iter().zip(&mut self.runaway) {
            if let Some(found) = rule.update(wheel, senses.now)
                && self.is_watched
            {
                self.latched.insert(found);
            }
        }
        let headway = Headway {
            duty: motion
                .left
                .duty
                .saturating_abs()
                .max(motion.right.duty.saturating_abs()),
            left_nm: motion.left.travelled_nm,
            right_nm: motion.right.travelled_nm,
            track_um: parameters.limits.track.0,
            gyro: senses.gyro,
        };
        self.idle = self.progress.update(headway, senses.now);
    }

    /// Runs the rules on the battery, in every pass.
    pub(crate) fn judge_battery(&mut self, view: &PackView, now: rvac_units::Tick) {
        let found = self.battery.update(view, now);
        self.latched.add(found);
    }

    /// Lets the reset record age.
    pub(crate) fn age<R: ResetRecord>(&mut self, record: &mut R, now: rvac_units::Tick) {
        self.reset.update(record, now);
    }

    /// Latches a fault that was found elsewhere.
    pub(crate) const fn latch(&mut self, inhibit: Inhibit) {
        self.latched.insert(inhibit);
    }

    /// Clears a latched inhibit whose cause is gone.
    pub(crate) const fn clear(&mut self, inhibit: Inhibit) {
        self.latched.remove(inhibit);
        if matches!(inhibit, Inhibit::BumperStuck) {
            self.bumper.reset_backed_distance();
        }
    }

    /// Whether the three resets of a loop are less than a minute old (S4).
    pub(crate) const fn is_young(&self) -> bool {
        self.reset.is_young()
    }

    /// Whether a bumper zone counts as pressed.
    pub(crate) const fn touches(&self) -> bool {
        self.bumper.any()
    }

    /// Whether a sensor counts as seeing no floor.
    pub(crate) const fn sees_cliff(&self) -> bool {
        self.cliff.any()
    }

    /// Whether a wheel turned in the last control period.
    pub(crate) const fn wheel_turns(&self) -> bool {
        self.wheel_turns
    }

    /// The rule of the battery.
    pub(crate) const fn battery(&self) -> &BatteryRule {
        &self.battery
    }

    /// What was latched, the charger's faults not included.
    pub(crate) const fn latched(&self) -> Inhibits {
        self.latched.members()
    }

    /// Goes on where the rules stood before a reset.
    #[must_use]
    pub(crate) fn taking_up(mut self, latched: Inhibits, battery: u8) -> Self {
        self.latched.add(latched);
        self.battery.take_up(battery);
        self
    }

    /// Everything that inhibits now.
    pub(crate) fn inhibits(&self) -> Inhibits {
        let mut all = Inhibits::from_bits(
            self.latched.members().bits() | self.arming.inhibits().bits() | self.battery.inhibits().bits(),
        );
        let shorted = self.charger_fault == Some(ChargeFault::Shorted);
        let present = [
            (Inhibit::ChargerShorted, shorted),
            (Inhibit::ChargerFault, self.charger_fault.is_some() && !shorted),
            (Inhibit::Bumper, self.bumper.any()),
            (Inhibit::Cliff, self.cliff.any()),
            (Inhibit::CliffSensorFault, self.blinded),
            (Inhibit::WheelDrop, self.lifted),
            (Inhibit::NotMoving, self.idle),
            (Inhibit::Docked, self.is_held_by_dock()),
        ];
        for (inhibit, is_present) in present {
            if is_present {
                all.insert(inhibit);
            }
        }
        all
    }

    /// Which motion is allowed, given whether a lease is fresh.
    pub(crate) fn motion_permit(&self, fresh: bool) -> MotionPermit {
        MotionPermit {
            armed: !self.arming.is_locked(),
            fresh,
            inhibits: self.inhibits(),
            bumpers: self.bumper.pressed(),
            escaping_dock: self.arming.is_escaping(),
            reverse: ReverseBound::default(),
        }
    }

    /// Whether the robot stands on the dock and is not about to leave it.
    pub(crate) const fn is_held_by_dock(&self) -> bool {
        self.dock.is_docked() && !self.arming.may_leave_dock()
    }

    /// Bumper zones that count as pressed.
    pub(crate) const fn bumpers(&self) -> Bumpers {
        self.bumper.pressed()
    }

    /// Sensors that count as seeing no floor.
    pub(crate) const fn cliffs(&self) -> Cliffs {
        self.cliff.seen()
    }

    /// Wheels that hang.
    pub(crate) const fn wheel_drops(&self) -> WheelDrops {
        self.lift.hanging()
    }

    /// Whether any button is down, whichever.
    pub(crate) const fn any_button(&self) -> bool {
        self.buttons.any_down()
    }

    /// Buttons that are down, bit by number.
    pub(crate) const fn buttons(&self) -> u8 {
        self.buttons.down()
    }
}
