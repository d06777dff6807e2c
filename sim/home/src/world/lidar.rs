//! A turning lidar.

use super::body::Body;
use super::proximity::Beam;
use super::sensors::LidarScan;
use super::wheel::STEP_S;
use crate::plan::Solid;
use crate::{Pcg, model};

/// Most marching steps of one beam.
const MARCH_MAX: usize = 96;
/// A beam ends where something solid is nearer than this, metres.
const HIT_M: f64 = 0.003;

/// The lidar: measures a few beams in every step, so a scan is taken while the robot moves, as a real one is.
#[derive(Clone, Debug)]
pub(crate) struct Lidar {
    part: model::LidarModel,
    beams_per_step: f64,
    due: f64,
    next: usize,
    growing: Vec<f32>,
    /// The last complete turn.
    pub(crate) scan: LidarScan,
}

impl Lidar {
    pub(crate) fn new(part: model::LidarModel) -> Self {
        let beams = usize::from(part.beams);
        Self {
            part,
            beams_per_step: f64::from(part.beams) * part.turns_hz * STEP_S,
            due: 0.0,
            next: 0,
            growing: vec![0.0; beams],
            scan: LidarScan {
                turn: 0,
                ranges_m: vec![0.0; beams],
            },
        }
    }

    pub(crate) fn step(&mut self, solid: Solid<'_>, body: &Body, random: &mut Pcg) {
        self.due += self.beams_per_step;
        while self.due >= 1.0 {
            self.due -= 1.0;
            self.measure(solid, body, random);
        }
    }

    fn measure(&mut self, solid: Solid<'_>, body: &Body, random: &mut Pcg) {
        let share = self.next as f64 / self.growing.len() as f64;
        let (sin, cos) = libm::sincos(body.heading_rad + core::f64::consts::TAU * share);
        let beam = Beam {
            x_m: body.x_m,
            y_m: body.y_m,
            dx: cos,
            dy: sin,
        };
        let distance_m = self.march(solid, &beam);
        if let Some(range) = self.growing.get_mut(self.next) {
            *range = (distance_m * (1.0 + self.part.noise * random.normal())) as f32;
        }
        self.next += 1;
        if self.next >= self.growing.len() {
            self.next = 0;
            self.scan.turn = self.scan.turn.wrapping_add(1);
            self.scan.ranges_m.copy_from_slice(&self.growing);
        }
    }

    /// Distance to what the beam hits; 0 when nothing is within range.
    fn march(&self, solid: Solid<'_>, beam: &Beam) -> f64 {
        let mut distance_m = 0.0;
        for _ in 0..MARCH_MAX {
            let (x_m, y_m) = beam.at(distance_m);
            let clear_m = solid.at(x_m, y_m);
            if clear_m < HIT_M {
                return distance_m;
            }
            distance_m += clear_m;
            if distance_m > self.part.range_m {
                return 0.0;
            }
        }
        0.0
    }
}
