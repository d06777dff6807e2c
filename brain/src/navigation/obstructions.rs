//! Contacts that block planned paths.
//!
//! A first contact near an obstacle of the map counts as a robot that came too close to it. Only a second contact there
//! makes it an obstruction.

use super::Situation;
use crate::mapping::{CELL_M, Cell, CellKnowledge};
use crate::model::geometry::Point2;
use crate::model::reason::Reason;
use crate::navigation::parameters::OBSTRUCTION;

/// The contacts of the last minutes.
#[derive(Debug, Default)]
pub(crate) struct Obstructions {
    kept: Vec<Obstruction>,
}

#[derive(Clone, Copy, Debug)]
struct Obstruction {
    since_us: u64,
    at: Point2,
    /// Other possible positions, within the resolution of the bumper.
    beside: [Point2; 2],
    is_confirmed: bool,
}

impl Obstructions {
    /// Records a contact or a cliff.
    pub(crate) fn add(&mut self, reason: Reason, situation: &Situation<'_>) {
        let (bearing, spread_rad) = bearing_rad(reason, situation);
        let at = rim(bearing, situation);
        let beside = [-spread_rad, spread_rad].map(|aside_rad| rim(bearing + aside_rad, situation));
        self.remember(at, beside, situation);
    }

    /// Records an obstacle that the sensors see at a point in the body frame.
    pub(crate) fn add_seen(&mut self, hit: Point2, situation: &Situation<'_>) {
        let at = rim(libm::atan2(hit.y_m, hit.x_m), situation);
        self.remember(at, [at; 2], situation);
    }

    fn remember(&mut self, at: Point2, beside: [Point2; 2], situation: &Situation<'_>) {
        let is_again = self
            .kept
            .iter()
            .any(|obstruction| obstruction.at.distance_m(at) < OBSTRUCTION.same_object_m);
        if self.kept.len() >= OBSTRUCTION.kept_max {
            self.kept.remove(0);
        }
        self.kept.push(Obstruction {
            since_us: situation.observation.time_us,
            at,
            beside,
            is_confirmed: is_again || !is_known(at, situation),
        });
    }

    /// Forgets all obstructions.
    pub(crate) fn clear(&mut self) {
        self.kept.clear();
    }

    /// Points that plans must avoid.
    pub(crate) fn points(&mut self, now_us: u64) -> Vec<Point2> {
        self.kept
            .retain(|obstruction| now_us < obstruction.since_us.saturating_add(OBSTRUCTION.kept_us));
        self.kept
            .iter()
            .filter(|obstruction| obstruction.is_confirmed)
            .flat_map(|obstruction| [obstruction.at, obstruction.beside[0], obstruction.beside[1]])
            .collect()
    }
}

/// The point of the rim in a direction from straight ahead.
fn rim(bearing_rad: f64, situation: &Situation<'_>) -> Point2 {
    let in_base = Point2::in_direction(bearing_rad, situation.config.body.radius_m);
    situation.pose.transform(in_base)
}

/// Whether the map has an obstacle near a point.
fn is_known(at: Point2, situation: &Situation<'_>) -> bool {
    let knowledge = situation.map.knowledge();
    let reach = libm::ceil(OBSTRUCTION.known_object_m / CELL_M) as i32;
    let middle = Cell::under(at);
    (-reach..=reach).any(|rise| {
        (-reach..=reach).any(|shift| {
            let cell = Cell {
                x: middle.x.saturating_add(shift),
                y: middle.y.saturating_add(rise),
            };
            !matches!(
                knowledge.get(cell),
                None | Some(CellKnowledge::Free | CellKnowledge::Unknown)
            )
        })
    })
}

/// Direction of a contact from straight ahead and its uncertainty: that of the proximity sensor with the highest level on
/// this side, otherwise the middle of the side.
fn bearing_rad(reason: Reason, situation: &Situation<'_>) -> (f64, f64) {
    let side = match reason {
        Reason::BumpLeft | Reason::CliffLeft => 1.0,
        Reason::BumpRight | Reason::CliffRight => -1.0,
        _ => return (0.0, OBSTRUCTION.ahead_spread_rad),
    };
    let levels = &situation.observation.proximity;
    let sensors = situation.config.sensors.proximity;
    let mut best = (
        OBSTRUCTION.touch_level,
        (side * OBSTRUCTION.side_bearing_rad, OBSTRUCTION.side_spread_rad),
    );
    for (level, sensor) in levels.iter().zip(sensors.sensors()) {
        if sensor.heading_rad * side > 0.0 && *level > best.0 {
            best = (*level, (sensor.heading_rad, 0.0));
        }
    }
    best.1
}
/// The cliff or contact that was just detected, if any.
pub(crate) fn encounter(situation: &Situation<'_>) -> Option<Reason> {
    if situation.at_cliff {
        Some(Reason::of_cliffs(situation.observation.cliffs).unwrap_or(Reason::CliffFront))
    } else if situation.touching {
        Some(Reason::of_contacts(situation.observation.contacts).unwrap_or(Reason::BumpFront))
    } else {
        None
    }
}
