//! What is under the robot: drops, rugs, thresholds.

use super::body::Body;
use crate::home::Home;
use crate::model::RobotModel;
use crate::plan::Surface;
use crate::{Noise, Pcg};

/// The light spot of a cliff sensor has this radius, metres.
const SPOT_M: f64 = 0.008;
/// A wheel hangs when its contact point is this far over the edge, metres: the tyre is not a point.
const EDGE_M: f64 = 0.004;
/// Level of a cliff sensor over a usual floor, emitter on.
const FLOOR_LEVEL: f64 = 180.0;
/// Sample points across the brush: a brush half on a rug has half the load.
const BRUSH_SHARES: [f64; 5] = [-0.8, -0.4, 0.0, 0.4, 0.8];
/// Share of the light that a black rug gives back.
const BLACK_SHARE: f64 = 0.05;
/// Level over a drop or with the emitter off: the light of the room.
const AMBIENT_LEVEL: f64 = 10.0;

/// What is under the robot.
#[derive(Clone, Debug)]
pub(crate) struct Underneath {
    half_track_m: f64,
    half_swath_m: f64,
    /// No drop is nearer to the centre than this, metres.
    cliff_free_m: f64,
    radius_m: f64,
    noise: f64,
    /// Brightness of each sensor.
    gains: [f64; 4],
    /// Levels with the emitter on.
    lit: [u8; 4],
    /// Levels with the emitter off.
    dark: [u8; 4],
    pub(crate) surface: Surface,
    /// How much more the main brush draws than on hard floor, relative.
    pub(crate) brush_load: f64,
    pub(crate) left_over_cliff: bool,
    pub(crate) right_over_cliff: bool,
    pub(crate) centre_over_cliff: bool,
}

impl Underneath {
    pub(crate) fn new(model: &RobotModel, noise: &Noise, random: &mut Pcg) -> Self {
        Self {
            half_track_m: 0.5 * model.drive.track_m,
            half_swath_m: 0.5 * model.body.swath_m,
            cliff_free_m: 0.0,
            radius_m: model.body.radius_m,
            noise: noise.infrared_noise,
            gains: core::array::from_fn(|_| 1.0 + 0.5 * noise.infrared_albedo * random.symmetric()),
            lit: [FLOOR_LEVEL as u8; 4],
            dark: [AMBIENT_LEVEL as u8; 4],
            surface: Surface::default(),
            brush_load: 0.0,
            left_over_cliff: false,
            right_over_cliff: false,
            centre_over_cliff: false,
        }
    }

    /// After the body was put somewhere else.
    pub(crate) fn forget(&mut self) {
        self.cliff_free_m = 0.0;
    }

    /// Whether wheels hang; called after every move of `distance_m`.
    pub(crate) fn move_on(&mut self, home: &Home, body: &Body, distance_m: f64) {
        let Some(cliffs) = &home.cliffs else {
            return;
        };
        self.cliff_free_m -= distance_m.abs();
        if self.cliff_free_m > self.radius_m {
            return;
        }
        let over = |(x_m, y_m): (f64, f64), edge_m: f64| cliffs.at(x_m, y_m) < -edge_m;
        self.cliff_free_m = cliffs.at(body.x_m, body.y_m);
        self.left_over_cliff = over(body.point(0.0, self.half_track_m), EDGE_M);
        self.right_over_cliff = over(body.point(0.0, -self.half_track_m), EDGE_M);
        self.centre_over_cliff = over((body.x_m, body.y_m), EDGE_M);
    }

    /// Samples the surface under the centre, and that under the brush.
    pub(crate) fn sample_surface(&mut self, home: &Home, body: &Body) {
        if !home.surfaces.is_hard() {
            self.surface = surface(home, body.x_m, body.y_m);
            let loads = BRUSH_SHARES.map(|share| {
                let (x_m, y_m) = body.point(0.0, share * self.half_swath_m);
                surface(home, x_m, y_m).brush_load
            });
            self.brush_load = loads.iter().sum::<f64>() / loads.len() as f64;
        }
    }

    /// Samples the cliff sensors; `in_air` = nothing under the whole robot.
    pub(crate) fn sample_cliffs(&mut self, model: &RobotModel, (home, body): (&Home, &Body), in_air: bool) {
        let near = self.cliff_free_m < 2.0 * self.radius_m;
        let cliffs = home.cliffs.as_ref().filter(|_| near);
        let has_black = home.surfaces.has_black();
        for (mount, (lit, gain)) in model.cliffs.iter().zip(self.lit.iter_mut().zip(&self.gains)) {
            let floor = match cliffs {
                _ if in_air => 0.0,
                None => 1.0,
                Some(cliffs) => {
                    let (x_m, y_m) = body.point(mount.x_m, mount.y_m);
                    (0.5 + cliffs.at(x_m, y_m) / (2.0 * SPOT_M)).clamp(0.0, 1.0)
                }
            };
            let floor = if has_black && floor > 0.0 {
                let (x_m, y_m) = body.point(mount.x_m, mount.y_m);
                floor * shade(home, x_m, y_m)
            } else {
                floor
            };
            *lit = (AMBIENT_LEVEL + (FLOOR_LEVEL * gain - AMBIENT_LEVEL) * floor) as u8;
        }
    }

    /// Levels of the cliff sensors.
    pub(crate) const fn levels(&self, emitter: bool) -> [u8; 4] {
        if emitter { self.lit } else { self.dark }
    }

    /// Lets the room's light flicker, so that a frozen reading differs from a live one.
    pub(crate) fn flicker(&mut self, random: &mut Pcg) {
        for dark in &mut self.dark {
            *dark = (AMBIENT_LEVEL * (1.0 + self.noise * random.normal())) as u8;
        }
    }
}

fn surface(home: &Home, x_m: f64, y_m: f64) -> Surface {
    let index = home.grid().index(x_m, y_m);
    index.map(|index| home.surfaces.at(index)).unwrap_or_default()
}

/// Share of the light that the floor at a place gives back.
fn shade(home: &Home, x_m: f64, y_m: f64) -> f64 {
    let index = home.grid().index(x_m, y_m);
    if index.is_some_and(|index| home.surfaces.at(index).black) {
        BLACK_SHARE
    } else {
        1.0
    }
}
