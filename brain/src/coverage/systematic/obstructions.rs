//! Where something was met that stands in the way of plans.
//!
//! A contact near to what the map knows is first taken for a robot that came too near to it; met again, it stands there.

use crate::behavior::Reason;
use crate::geometry::Point2;
use crate::mapping::{CELL_M, Cell, CellKnowledge};
use crate::task::Situation;

/// An obstruction is believed for this long.
const BELIEVED_US: u64 = 240_000_000;
/// Contacts kept; the oldest go first.
const KEPT_MAX: usize = 64;
/// Two contacts nearer than this are with the same thing.
const SAME_M: f64 = 0.12;
/// A contact this near to something known is with that.
const KNOWN_M: f64 = 0.06;
/// Direction of a contact on one side from straight ahead when nothing else tells, radians.
const SIDE_RAD: f64 = 0.7;
/// Proximity level of a sensor that looks at what was touched.
const TOUCH_LEVEL: f32 = 0.5;

/// The contacts of the last minutes.
#[derive(Debug, Default)]
pub(crate) struct Obstructions {
    met: Vec<Met>,
}

#[derive(Clone, Copy, Debug)]
struct Met {
    since_us: u64,
    at: Point2,
    is_believed: bool,
}

impl Obstructions {
    /// Notes what was met.
    pub(crate) fn add(&mut self, reason: Reason, situation: &Situation<'_>) {
        let (sin, cos) = libm::sincos(bearing_rad(reason, situation));
        let radius_m = situation.config.body.radius_m;
        let at = situation.pose.transform(Point2 {
            x_m: radius_m * cos,
            y_m: radius_m * sin,
        });
        let is_again = self.met.iter().any(|met| met.at.distance_m(at) < SAME_M);
        if self.met.len() >= KEPT_MAX {
            self.met.remove(0);
        }
        self.met.push(Met {
            since_us: situation.observation.time_us,
            at,
            is_believed: is_again || !is_known(at, situation),
        });
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.met.clear();
    }

    /// Where plans must not lead over.
    pub(crate) fn points(&mut self, now_us: u64) -> Vec<Point2> {
        self.met
            .retain(|met| now_us < met.since_us.saturating_add(BELIEVED_US));
        self.met
            .iter()
            .filter(|met| met.is_believed)
            .map(|met| met.at)
            .collect()
    }
}

/// Whether the map knows of something near a point.
fn is_known(at: Point2, situation: &Situation<'_>) -> bool {
    let knowledge = situation.map.knowledge();
    let reach = libm::ceil(KNOWN_M / CELL_M) as i32;
    let middle = Cell::under(at);
    (-reach..=reach).any(|rise| {
        (-reach..=reach).any(|shift| {
            let cell = Cell {
                x: middle.x.saturating_add(shift),
                y: middle.y.saturating_add(rise),
            };
            knowledge.get(cell) != Some(&CellKnowledge::Free)
        })
    })
}

/// Direction of what was met from straight ahead: that of the proximity sensor that sees most on this side, else the
/// middle of the side.
fn bearing_rad(reason: Reason, situation: &Situation<'_>) -> f64 {
    let side = match reason {
        Reason::BumpLeft | Reason::CliffLeft => 1.0,
        Reason::BumpRight | Reason::CliffRight => -1.0,
        _ => return 0.0,
    };
    let levels = &situation.observation.proximity;
    let sensors = situation.config.sensors.proximity;
    let mut best = (TOUCH_LEVEL, side * SIDE_RAD);
    for (level, sensor) in levels.iter().zip(sensors.sensors()) {
        if sensor.heading_rad * side > 0.0 && *level > best.0 {
            best = (*level, sensor.heading_rad);
        }
    }
    best.1
}
