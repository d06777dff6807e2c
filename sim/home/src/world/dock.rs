//! The dock: two beams that overlap in the middle, a weak one around, and two contacts.

use super::body::Body;
use super::sensors::{DOCK_LEFT, DOCK_NEAR, DOCK_RIGHT};
use crate::home::Home;
use crate::model::RobotModel;
use crate::pcg::Pcg;
use crate::plan::{Solid, docked_pose};
use crate::pose::{Pose, wrap_angle};

/// The two beams reach so far, metres.
const BEAM_M: f64 = 3.0;
/// The weak beam reaches so far, metres.
const NEAR_M: f64 = 0.5;
/// Tangent of the outer edge of a beam (35 degrees).
const BEAM_TAN: f64 = 0.70;
/// Tangent of how far a beam reaches over the middle (4 degrees).
const OVERLAP_TAN: f64 = 0.07;
/// Distance of the emitters in front of the dock's back, metres.
const EMITTER_M: f64 = 0.04;
/// Greatest errors with which the contacts still touch: along, aside in metres, and in heading.
const CONTACT_ALONG_M: f64 = 0.018;
const CONTACT_ASIDE_M: f64 = 0.02;
const CONTACT_RAD: f64 = 0.2;
/// Most steps of a line of sight.
const SIGHT_MAX: usize = 200;

/// Attenuation and reflections of the dock's beams; all zero is a dock in a dark room with black walls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BeamStrengths {
    /// Share of the words that a receiver misses.
    pub lost: f64,
    /// Share of codes in which a receiver that faces elsewhere receives one of the lobes reflected by a wall.
    pub reflected: f64,
    /// How ragged the edges of the lobes are: standard deviation of their angle, radians.
    pub ragged_rad: f64,
}

impl BeamStrengths {
    /// A sunny room with white walls.
    pub const POOR: Self = Self {
        lost: 0.1,
        reflected: 0.05,
        ragged_rad: 0.03,
    };
}

/// What the contacts of a dock do when the robot stands on them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DockContacts {
    /// They carry voltage and current.
    #[default]
    Clean,
    /// Dirt: this share of the times that they close they carry the voltage, but no current.
    Dirty(f64),
    /// They carry nothing.
    Dead,
}

/// The dock as an obstacle and a sender of beams.
#[derive(Clone, Debug)]
pub(crate) struct Dock {
    pose: Pose,
    plan_cos: f64,
    plan_sin: f64,
    docked: Pose,
    beams: BeamStrengths,
    random: Pcg,
    contacts: DockContacts,
    is_powered: bool,
    /// The contacts carried no current when they closed last.
    is_insulated: bool,
    /// Symbols of the receivers.
    pub(crate) symbols: [u8; 4],
    /// The contacts touch.
    pub(crate) docked_now: bool,
}

impl Dock {
    pub(crate) fn of(home: &Home, model: &RobotModel, random: Pcg) -> Option<Self> {
        let pose = home.dock()?;
        let mut dock = Self {
            pose,
            plan_cos: 0.0,
            plan_sin: 0.0,
            docked: pose,
            beams: BeamStrengths::default(),
            random,
            contacts: DockContacts::default(),
            is_powered: true,
            is_insulated: false,
            symbols: [0; 4],
            docked_now: false,
        };
        dock.stand_at(pose, model);
        Some(dock)
    }

    /// Moves the dock there, facing the room.
    pub(crate) fn stand_at(&mut self, pose: Pose, model: &RobotModel) {
        self.pose = pose;
        (self.plan_sin, self.plan_cos) = libm::sincos(pose.heading_rad);
        self.docked = docked_pose(pose, model.body.radius_m);
    }

    /// Shifts it along its wall, left positive as seen from the dock, and turns it.
    pub(crate) fn push(&mut self, aside_m: f64, turn_rad: f64, model: &RobotModel) {
        let (x_m, y_m) = self.pose.point(0.0, aside_m);
        self.stand_at(Pose::new(x_m, y_m, self.pose.heading_rad + turn_rad), model);
    }

    pub(crate) fn set_beams(&mut self, beams: BeamStrengths) {
        self.beams = beams;
    }

    /// Pose of a robot on the contacts.
    pub(crate) const fn docked(&self) -> Pose {
        self.docked
    }

    /// A place relative to the dock: metres into the room and to the dock's left.
    fn relative(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        let (dx, dy) = (x_m - self.pose.x_m, y_m - self.pose.y_m);
        (
            dx * self.plan_cos + dy * self.plan_sin,
            dy * self.plan_cos - dx * self.plan_sin,
        )
    }

    /// Samples the contacts.
    pub(crate) fn sample_contacts(&mut self, body: &Body) {
        let (along, aside) = self.relative(body.x_m, body.y_m);
        let (rest, _) = self.relative(self.docked.x_m, self.docked.y_m);
        let was_docked = self.docked_now;
        self.docked_now = (along - rest).abs() <= CONTACT_ALONG_M
            && aside.abs() <= CONTACT_ASIDE_M
            && wrap_angle(body.heading_rad - self.docked.heading_rad).abs() <= CONTACT_RAD;
        if let DockContacts::Dirty(share) = self.contacts
            && self.docked_now
            && !was_docked
        {
            self.is_insulated = self.random.unit() < share;
        }
    }

    pub(crate) fn set_contacts(&mut self, contacts: DockContacts) {
        self.contacts = contacts;
        self.is_insulated = false;
    }

    pub(crate) fn set_power(&mut self, is_powered: bool) {
        self.is_powered = is_powered;
    }

    /// Whether a robot on the contacts finds voltage there.
    pub(crate) fn gives_voltage(&self) -> bool {
        self.docked_now && self.is_powered && self.contacts != DockContacts::Dead
    }

    /// Whether current flows into a robot on the contacts that lets it in.
    pub(crate) fn gives_current(&self) -> bool {
        self.gives_voltage() && !self.is_insulated
    }

    /// Samples the receivers.
    pub(crate) fn sample_beams(&mut self, model: &RobotModel, solid: Solid<'_>, body: &Body) {
        self.symbols = [0; 4];
        if !self.is_powered {
            return;
        }
        let (along, aside) = self.relative(body.x_m, body.y_m);
        let (along, aside) = self.ragged(along - EMITTER_M, aside);
        let symbol = beams_at(along, aside);
        if symbol == 0 {
            return;
        }
        let emitter = self.pose.point(EMITTER_M, 0.0);
        if !in_sight(solid, (body.x_m, body.y_m), emitter) {
            return;
        }
        let direction = libm::atan2(emitter.1 - body.y_m, emitter.0 - body.x_m) - body.heading_rad;
        for (mount, heard) in model.dock_receivers.iter().zip(&mut self.symbols) {
            if wrap_angle(direction - mount.heading_rad).abs() <= mount.half_angle_rad {
                *heard = symbol;
            }
            if self.beams != BeamStrengths::default() {
                *heard = self.beams.heard(*heard, symbol, &mut self.random);
            }
        }
    }

    /// The place at which beams with ragged edges are received.
    fn ragged(&mut self, along: f64, aside: f64) -> (f64, f64) {
        if self.beams.ragged_rad <= 0.0 {
            return (along, aside);
        }
        let (sin, cos) = libm::sincos(self.beams.ragged_rad * self.random.normal());
        (along * cos - aside * sin, along * sin + aside * cos)
    }
}

impl BeamStrengths {
    /// Symbol of a receiver whose last one is `heard`, at a place where the beams have `symbol`.
    fn heard(self, heard: u8, symbol: u8, random: &mut Pcg) -> u8 {
        let (fate, lobe) = (random.unit(), random.below(2));
        if heard != 0 {
            return if fate < self.lost { 0 } else { heard };
        }
        let reflected = [DOCK_LEFT, DOCK_RIGHT][usize::from(lobe != 0)];
        if symbol != 0 && fate < self.reflected {
            reflected
        } else {
            0
        }
    }
}

/// Symbols at a place relative to the emitters. A robot that faces the dock has the dock's right on its left.
fn beams_at(along: f64, aside: f64) -> u8 {
    let squared = along * along + aside * aside;
    let mut symbols = 0;
    if along > 0.0 && squared < BEAM_M * BEAM_M {
        if aside < OVERLAP_TAN * along && aside > -BEAM_TAN * along {
            symbols |= DOCK_LEFT;
        }
        if aside > -OVERLAP_TAN * along && aside < BEAM_TAN * along {
            symbols |= DOCK_RIGHT;
        }
    }
    if squared < NEAR_M * NEAR_M {
        symbols |= DOCK_NEAR;
    }
    symbols
}

/// Whether nothing solid lies between two places.
fn in_sight(solid: Solid<'_>, from: (f64, f64), to: (f64, f64)) -> bool {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = libm::sqrt(dx * dx + dy * dy);
    if length < 1e-6 {
        return true;
    }
    let mut distance_m = 0.0;
    for _ in 0..SIGHT_MAX {
        if distance_m >= length {
            return true;
        }
        let clear_m = solid.at(
            from.0 + dx / length * distance_m,
            from.1 + dy / length * distance_m,
        );
        if clear_m < 0.0 {
            return false;
        }
        distance_m += clear_m.max(0.015);
    }
    false
}
