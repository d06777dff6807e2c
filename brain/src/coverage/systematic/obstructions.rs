//! Where something was met that stands in the way of plans.

use crate::behavior::Reason;
use crate::geometry::Point2;
use crate::task::Situation;

/// An obstruction is believed for this long.
const BELIEVED_US: u64 = 240_000_000;
/// Obstructions kept; the oldest go first.
const KEPT_MAX: usize = 64;
/// Direction of a contact on one side from straight ahead when nothing else tells, radians.
const SIDE_RAD: f64 = 0.7;
/// Proximity level of a sensor that looks at what was touched.
const TOUCH_LEVEL: f32 = 0.5;

/// The obstructions of the last minutes.
#[derive(Debug, Default)]
pub(super) struct Obstructions {
    known: Vec<(u64, Point2)>,
}

impl Obstructions {
    /// Notes what was met.
    pub(super) fn add(&mut self, reason: Reason, situation: &Situation<'_>) {
        let bearing_rad = bearing_rad(reason, situation);
        let (sin, cos) = libm::sincos(bearing_rad);
        let radius_m = situation.config.body.radius_m;
        let at = situation.pose.transform(Point2 {
            x_m: radius_m * cos,
            y_m: radius_m * sin,
        });
        if self.known.len() >= KEPT_MAX {
            self.known.remove(0);
        }
        self.known.push((situation.observation.time_us, at));
    }

    /// Those that are still believed.
    pub(super) fn points(&mut self, now_us: u64) -> Vec<Point2> {
        self.known
            .retain(|(since_us, _)| now_us < since_us.saturating_add(BELIEVED_US));
        self.known.iter().map(|(_, at)| *at).collect()
    }
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
    let spread = levels.len().saturating_sub(1).max(1) as f64;
    let mut best = (TOUCH_LEVEL, side * SIDE_RAD);
    for (number, level) in levels.iter().enumerate() {
        // Sensors lie from -90 to 90 degrees, evenly.
        let bearing_rad = core::f64::consts::PI * (number as f64 / spread - 0.5);
        if bearing_rad * side > 0.0 && *level > best.0 {
            best = (*level, bearing_rad);
        }
    }
    best.1
}
