//! Infrared proximity: each sensor sends a narrow cone outward and measures how much comes back.

use super::body::Body;
use crate::home::Home;
use crate::model;
use crate::plan::Solid;
use crate::{Noise, Pcg};

/// Most marching steps of one beam; enough to creep along a wall for the whole range.
const MARCH_MAX: usize = 32;
/// Smallest marching step, metres.
const MARCH_M: f64 = 0.004;
/// Side of the patches of walls and furniture that share one albedo, metres.
const PATCH_M: f64 = 0.4;

/// A mirror gives light back within this cosine of its normal (10 degrees).
const MIRROR_COS: f64 = 0.985;

/// The middle of a sensor's cone, or a ray of the lidar: where it starts and its direction.
pub(super) struct Beam {
    pub(super) x_m: f64,
    pub(super) y_m: f64,
    pub(super) dx: f64,
    pub(super) dy: f64,
}

impl Beam {
    #[inline]
    pub(super) fn at(&self, distance_m: f64) -> (f64, f64) {
        (self.x_m + self.dx * distance_m, self.y_m + self.dy * distance_m)
    }
}

/// What the sensors look at: the home as it was drawn, and what stands in it at this moment.
#[derive(Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) home: &'a Home,
    pub(crate) solid: Solid<'a>,
}

/// All proximity sensors of the robot.
#[derive(Clone, Debug)]
pub(crate) struct Proximity {
    /// Directions in the body's frame.
    directions: Vec<(f64, f64)>,
    mount_m: f64,
    skin_m: f64,
    range_m: f64,
    spread: f64,
    half_level_m: f64,
    /// Light from which on a sensor with one line says near, 0..1.
    near_light: Option<f64>,
    noise: f64,
    albedo: f64,
    dropout: f64,
    patches: u64,
    next: usize,
    pub(crate) levels: [u8; 8],
}

impl Proximity {
    pub(crate) fn new(part: &model::ProximityModel, radius_m: f64, noise: &Noise, random: &mut Pcg) -> Self {
        let skin_m = radius_m - part.mount_radius_m;
        let near_light = part
            .near_m
            .map(|near_m| light(near_m - skin_m, part.half_level_m));
        Self {
            near_light,
            directions: part
                .headings_rad
                .iter()
                .map(|heading| {
                    let (sin, cos) = libm::sincos(*heading);
                    (cos, sin)
                })
                .collect(),
            mount_m: part.mount_radius_m,
            skin_m,
            range_m: part.range_m,
            spread: libm::tan(part.half_angle_rad),
            half_level_m: part.half_level_m,
            noise: noise.infrared_noise,
            albedo: noise.infrared_albedo,
            dropout: noise.infrared_dropout,
            patches: u64::from(random.next_u32()) << 32 | u64::from(random.next_u32()),
            next: 0,
            levels: [0; 8],
        }
    }

    /// Samples the next sensor in turn.
    pub(crate) fn sample_next(&mut self, around: Surroundings<'_>, body: &Body, random: &mut Pcg) {
        let sensor = self.next;
        self.next += 1;
        if self.next >= self.directions.len() {
            self.next = 0;
        }
        let Some((cos, sin)) = self.directions.get(sensor).copied() else {
            return;
        };
        let level = if body.free_m > self.range_m {
            0
        } else {
            let (dx, dy) = (body.cos * cos - body.sin * sin, body.sin * cos + body.cos * sin);
            let beam = Beam {
                x_m: body.x_m + dx * self.mount_m,
                y_m: body.y_m + dy * self.mount_m,
                dx,
                dy,
            };
            self.sample(around, &beam, random)
        };
        if let Some(shown) = self.levels.get_mut(sensor) {
            *shown = level;
        }
    }

    fn sample(&self, Surroundings { home, solid }: Surroundings<'_>, beam: &Beam, random: &mut Pcg) -> u8 {
        let Some(distance_m) = self.march(solid, beam) else {
            return 0;
        };
        if random.unit() < self.dropout || deflected(home, beam, distance_m) {
            return 0;
        }
        let (x_m, y_m) = beam.at(distance_m);
        let white = light(distance_m - self.skin_m, self.half_level_m);
        let seen = self.reflection(x_m, y_m) * white * (1.0 + self.noise * random.normal());
        match self.near_light {
            Some(near_light) if seen >= near_light => u8::MAX,
            Some(_) => 0,
            None => (255.0 * seen) as u8,
        }
    }

    /// Distance from the sensor to what its cone hits.
    fn march(&self, solid: Solid<'_>, beam: &Beam) -> Option<f64> {
        let mut distance_m = 0.0;
        for _ in 0..MARCH_MAX {
            let (x_m, y_m) = beam.at(distance_m);
            let clear_m = solid.at(x_m, y_m);
            if clear_m <= self.spread * distance_m + 0.001 {
                return Some(distance_m + clear_m.max(0.0));
            }
            distance_m += (0.95 * clear_m).max(MARCH_M);
            if distance_m > self.range_m {
                return None;
            }
        }
        None
    }

    /// Reflection of the patch around a place, 1 on average.
    fn reflection(&self, x_m: f64, y_m: f64) -> f64 {
        let (column, row) = ((x_m / PATCH_M) as i64, (y_m / PATCH_M) as i64);
        let mut hash = self.patches ^ (column as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash ^= (row as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        hash = (hash ^ (hash >> 31)).wrapping_mul(0xd6e8_feb8_6659_fd93);
        let unit = f64::from((hash >> 32) as u32) / 4_294_967_296.0;
        1.0 + self.albedo * (2.0 * unit - 1.0)
    }
}

/// Light that comes back from a white wall so far beyond the rim, 1 at the rim.
fn light(beyond_m: f64, half_level_m: f64) -> f64 {
    let beyond = beyond_m.max(0.0) / half_level_m;
    1.0 / (1.0 + beyond * beyond)
}

/// Whether a mirror throws the light elsewhere: only light at a right angle to it comes back.
fn deflected(home: &Home, beam: &Beam, distance_m: f64) -> bool {
    if home.mirrors.is_empty() {
        return false;
    }
    let (x_m, y_m) = beam.at(distance_m);
    let is_mirror = home
        .grid()
        .index(x_m, y_m)
        .is_some_and(|index| home.mirrors.get(index) == Some(&true));
    let (nx, ny) = home.solid.away(x_m, y_m);
    is_mirror && -(nx * beam.dx + ny * beam.dy) < MIRROR_COS
}
