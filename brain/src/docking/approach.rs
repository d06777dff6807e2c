//! The approach by the two beams: scan for the dock, drive along the centreline between the lobes, and try again beside it.
//!
//! Terms. *Centreline*: where both lobes are received; it leads straight onto the dock. *Base*: direction of the centreline
//! in the robot's own count of its turns. *Trim*: correction of the base while only one lobe is received. *Try*: one drive
//! along the centreline.

use core::f64::consts::PI;

use super::centreline::CentrelineDrive;
use super::parameters::{APPROACH, TRIES};
use super::scan::{Scan, ScanStep};
use super::tries::FailedTry;
use crate::mapping::Lobe;
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::normalize_rad;
use crate::model::reason::Reason;
use crate::navigation::{Evasion, EvasionStep, Situation, TaskContext};

/// An approach.
#[derive(Clone, Debug)]
pub(super) struct Approach {
    phase: ApproachPhase,
    /// Angle turned since the start, radians.
    heading_rad: f64,
    tries: u32,
    scans: u32,
    wiggles: u32,
    wiggle_side: f64,
    /// Paths to the centreline that were tried.
    asides: usize,
    /// Forward travel in the near field, metres.
    depth_m: f64,
    /// Whether it touched something beside the centreline.
    met_something: bool,
    /// How the last try failed.
    failed: Option<FailedTry>,
}

#[derive(Clone, Copy, Debug)]
enum ApproachPhase {
    Scan(Scan),
    Centreline(CentrelineDrive),
    Straight(StraightDrive),
    Evade(Evasion, AfterEvasion),
}

/// A straight drive in one direction.
#[derive(Clone, Copy, Debug)]
struct StraightDrive {
    heading_rad: f64,
    left_m: f64,
    /// It ends where it meets the centreline.
    to_centreline: bool,
}

/// What follows an evasion.
#[derive(Clone, Copy, Debug)]
enum AfterEvasion {
    Scan,
    Centreline(f64),
    Straight(f64),
}

/// State of an approach after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ApproachStep {
    /// It goes on.
    Going(Motion),
    /// The beams are lost.
    Silent,
    /// All tries failed.
    Spent,
    /// The robot is held.
    Held(Reason),
}

impl Approach {
    /// An approach by the beams alone, after this many others.
    pub(super) fn by_beams(others: u32) -> Self {
        Self {
            asides: others as usize,
            ..Self::beginning(ApproachPhase::Scan(Scan::new()))
        }
    }

    /// An approach from a point in front of the dock. By the map the dock lies `bearing_rad` left of straight ahead.
    pub(super) fn from_map(bearing_rad: f64) -> Self {
        Self::beginning(ApproachPhase::Centreline(CentrelineDrive::of_map(bearing_rad)))
    }

    fn beginning(phase: ApproachPhase) -> Self {
        Self {
            phase,
            heading_rad: 0.0,
            tries: 0,
            scans: 0,
            wiggles: 0,
            wiggle_side: 1.0,
            asides: 0,
            depth_m: 0.0,
            met_something: false,
            failed: None,
        }
    }

    pub(super) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> ApproachStep {
        self.heading_rad += situation.advance.turn_rad;
        self.depth_m = if situation.beams.current().is_near() {
            (self.depth_m + situation.advance.distance_m).max(0.0)
        } else {
            0.0
        };
        match self.phase {
            ApproachPhase::Evade(evasion, after) => self.evade(evasion, after, situation),
            _ if situation.at_cliff => {
                let reason = Reason::of_cliffs(situation.observation.cliffs).unwrap_or(Reason::CliffFront);
                self.retry_elsewhere(Evasion::from_cliff, reason, context)
            }
            ApproachPhase::Scan(scan) => self.scan(scan, situation, context),
            ApproachPhase::Centreline(line) => self.drive_centreline(line, situation, context),
            ApproachPhase::Straight(drive) => self.drive_straight(drive, situation, context),
        }
    }

    /// How a try has failed since the last step, if one has.
    pub(super) fn take_failed_try(&mut self) -> Option<FailedTry> {
        self.failed.take()
    }

    fn evade(
        &mut self,
        mut evasion: Evasion,
        after: AfterEvasion,
        situation: &Situation<'_>,
    ) -> ApproachStep {
        match evasion.step(situation) {
            EvasionStep::Going(motion) => {
                self.phase = ApproachPhase::Evade(evasion, after);
                ApproachStep::Going(motion)
            }
            EvasionStep::Held(reason) => ApproachStep::Held(reason),
            EvasionStep::Free => {
                self.phase = match after {
                    AfterEvasion::Scan => ApproachPhase::Scan(Scan::new()),
                    AfterEvasion::Centreline(base_rad) => {
                        ApproachPhase::Centreline(CentrelineDrive::along(base_rad))
                    }
                    AfterEvasion::Straight(heading_rad) => ApproachPhase::Straight(StraightDrive {
                        heading_rad,
                        left_m: APPROACH.retry_away_m,
                        to_centreline: false,
                    }),
                };
                ApproachStep::Going(Motion::Halt)
            }
        }
    }

    fn scan(&mut self, mut scan: Scan, situation: &Situation<'_>, context: &mut TaskContext) -> ApproachStep {
        if situation.touching {
            return self.evade_contact(context);
        }
        match scan.step(situation.beams.current(), situation.advance.turn_rad) {
            ScanStep::Going(motion) => {
                self.phase = ApproachPhase::Scan(scan);
                ApproachStep::Going(motion)
            }
            ScanStep::Failed => ApproachStep::Silent,
            ScanStep::Found(bearing_rad) => {
                self.scans += 1;
                if self.scans > APPROACH.scans_max {
                    return self.spend_scans();
                }
                context.decide(DecisionKind::DockScan, Reason::DockBeam, bearing_rad);
                self.phase = self.after_scan(bearing_rad, situation, context);
                ApproachStep::Going(Motion::Halt)
            }
        }
    }

    /// Where to drive when the dock lies `bearing_rad` left of straight ahead.
    fn after_scan(
        &mut self,
        bearing_rad: f64,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> ApproachPhase {
        let dock_rad = self.heading_rad + bearing_rad;
        // A robot that faces the dock and receives the left lobe has the centreline on its right.
        let to_centreline = match situation.beams.current().lobe() {
            Lobe::Both => return ApproachPhase::Centreline(CentrelineDrive::along(dock_rad)),
            Lobe::Left => -1.0,
            Lobe::Right => 1.0,
            Lobe::None => away_from_wall(bearing_rad, situation).unwrap_or(if context.random.coin() {
                1.0
            } else {
                -1.0
            }),
        };
        let is_near = situation.beams.current().is_near();
        context.decide(DecisionKind::DockLine, Reason::DockBeam, to_centreline);
        let (aside_rad, left_m) = match (is_near, situation.beams.current().lobe()) {
            (false, _) => (self.aside_rad(), APPROACH.beside_max_m),
            (true, Lobe::None) => (APPROACH.at_wall_rad, APPROACH.at_wall_m),
            (true, _) => (APPROACH.near_field_rad, APPROACH.near_field_m),
        };
        ApproachPhase::Straight(StraightDrive {
            heading_rad: dock_rad + to_centreline * aside_rad,
            left_m,
            to_centreline: !is_near,
        })
    }

    fn aside_rad(&self) -> f64 {
        APPROACH
            .beside_rad
            .get(self.asides % APPROACH.beside_rad.len())
            .copied()
            .unwrap_or_default()
    }

    fn drive_straight(
        &mut self,
        mut drive: StraightDrive,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> ApproachStep {
        if situation.touching {
            self.asides += 1;
            return self.evade_contact(context);
        }
        drive.left_m -= situation.advance.distance_m.max(0.0);
        if drive.left_m <= 0.0 || (drive.to_centreline && situation.beams.current().lobe() == Lobe::Both) {
            self.phase = ApproachPhase::Scan(Scan::new());
            return ApproachStep::Going(Motion::Halt);
        }
        self.phase = ApproachPhase::Straight(drive);
        ApproachStep::Going(self.toward(drive.heading_rad, APPROACH.beside_m_per_s))
    }

    fn drive_centreline(
        &mut self,
        mut line: CentrelineDrive,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> ApproachStep {
        if situation.touching {
            return self.miss(line, situation, context);
        }
        line.follow(
            situation.beams.current(),
            situation.advance.distance_m,
            situation.advance.time_s,
        );
        self.phase = ApproachPhase::Centreline(line);
        if line.is_missed() {
            self.failed = Some(FailedTry::Passed);
            return self.leave(line.base_rad(), context);
        }
        let error_rad = normalize_rad(line.setpoint_rad() - self.heading_rad);
        if line.is_lost() && error_rad.abs() < APPROACH.turn_first_rad {
            self.phase = ApproachPhase::Scan(Scan::new());
            return ApproachStep::Going(Motion::Halt);
        }
        ApproachStep::Going(self.toward(line.setpoint_rad(), line.speed_m_per_s()))
    }

    /// Handles a contact before the dock contacts closed.
    fn miss(
        &mut self,
        line: CentrelineDrive,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> ApproachStep {
        let reason = Reason::of_contacts(situation.observation.contacts).unwrap_or(Reason::BumpFront);
        if !situation.beams.current().is_near() {
            // An obstacle is in the path.
            self.failed = Some(FailedTry::Obstructed);
            return self.retry_elsewhere(Evasion::from_contact, reason, context);
        }
        if self.wiggles >= APPROACH.wiggles_max {
            self.failed = Some(if self.depth_m < TRIES.dock_depth_m {
                FailedTry::Obstructed
            } else {
                FailedTry::NoContact
            });
            return self.leave(line.base_rad(), context);
        }
        self.wiggles += 1;
        context.decide(
            DecisionKind::DockWiggle,
            Reason::DockMissed,
            f64::from(self.wiggles),
        );
        let base_rad = line.base_rad() + self.wiggle_side * APPROACH.wiggle_rad * f64::from(self.wiggles);
        self.wiggle_side = -self.wiggle_side;
        let turn_rad = normalize_rad(base_rad - self.heading_rad);
        self.phase = ApproachPhase::Evade(
            Evasion::from_contact(APPROACH.wiggle_back_m, turn_rad),
            AfterEvasion::Centreline(base_rad),
        );
        ApproachStep::Going(Motion::Halt)
    }

    /// Leaves the dock for another try.
    fn leave(&mut self, base_rad: f64, context: &mut TaskContext) -> ApproachStep {
        self.tries += 1;
        self.wiggles = 0;
        // The next try wiggles to the other side first.
        self.wiggle_side = -self.wiggle_side;
        if self.tries >= APPROACH.tries_max {
            return ApproachStep::Spent;
        }
        context.decide(DecisionKind::DockRetry, Reason::DockMissed, f64::from(self.tries));
        let deviation_rad = context
            .random
            .between(-APPROACH.retry_spread_rad, APPROACH.retry_spread_rad);
        let away_rad = base_rad + PI + deviation_rad;
        let turn_rad = normalize_rad(away_rad - self.heading_rad);
        self.phase = ApproachPhase::Evade(
            Evasion::from_contact(APPROACH.retry_back_m, turn_rad),
            AfterEvasion::Straight(away_rad),
        );
        ApproachStep::Going(Motion::Halt)
    }

    /// Evades an obstacle that is not the dock. This uses up a try.
    fn retry_elsewhere(
        &mut self,
        evasion: fn(f64, f64) -> Evasion,
        reason: Reason,
        context: &mut TaskContext,
    ) -> ApproachStep {
        self.tries += 1;
        if self.tries >= APPROACH.tries_max {
            return ApproachStep::Spent;
        }
        context.decide(DecisionKind::DockRetry, reason, f64::from(self.tries));
        let side = match reason {
            Reason::BumpLeft | Reason::CliffLeft => -1.0,
            Reason::BumpRight | Reason::CliffRight => 1.0,
            _ if context.random.coin() => 1.0,
            _ => -1.0,
        };
        let turn_rad = side * context.random.within(&APPROACH.obstacle_turn_rad);
        self.phase = ApproachPhase::Evade(
            evasion(APPROACH.retry_back_m, turn_rad),
            AfterEvasion::Straight(self.heading_rad + turn_rad),
        );
        ApproachStep::Going(Motion::Halt)
    }

    /// Evades a contact during a scan or on the path to the centreline.
    fn evade_contact(&mut self, context: &mut TaskContext) -> ApproachStep {
        self.scans += 1;
        self.met_something = true;
        if self.scans > APPROACH.scans_max {
            return self.spend_scans();
        }
        let turn_rad = context
            .random
            .between(-APPROACH.contact_turn_max_rad, APPROACH.contact_turn_max_rad);
        self.phase = ApproachPhase::Evade(
            Evasion::from_contact(APPROACH.retry_back_m, turn_rad),
            AfterEvasion::Scan,
        );
        ApproachStep::Going(Motion::Halt)
    }

    /// Ends an approach that never drove in. What was met on its paths to the centreline stands before the dock.
    fn spend_scans(&mut self) -> ApproachStep {
        self.failed = self.met_something.then_some(FailedTry::Obstructed);
        ApproachStep::Spent
    }

    /// The motion towards a heading. Large errors are corrected on the spot first.
    fn toward(&self, target_rad: f64, speed_m_per_s: f64) -> Motion {
        let error_rad = normalize_rad(target_rad - self.heading_rad);
        if error_rad.abs() > APPROACH.turn_first_rad {
            return Motion::Drive {
                speed_m_per_s: 0.0,
                turn_rad_per_s: (APPROACH.heading_gain_per_s * error_rad.abs())
                    .clamp(APPROACH.turn_rad_per_s.start, APPROACH.turn_rad_per_s.end)
                    .copysign(error_rad),
            };
        }
        Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s: APPROACH.heading_gain_per_s * error_rad,
        }
    }
}

/// The side away from the wall of the dock, for a robot that faces the dock: +1 left, -1 right; `None` when no wall is
/// seen.
fn away_from_wall(bearing_rad: f64, situation: &Situation<'_>) -> Option<f64> {
    let sensors = situation.config.sensors.proximity.sensors();
    let on_left: f64 = sensors
        .iter()
        .zip(&situation.observation.proximity)
        .map(|(sensor, level)| libm::sin(sensor.heading_rad - bearing_rad) * f64::from(*level))
        .sum();
    (on_left.abs() > APPROACH.wall_level).then_some(-on_left.signum())
}
