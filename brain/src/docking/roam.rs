//! Straight drives to unvisited floor.
//!
//! Terms. *Block*: a square of half a metre. A robot that crossed a block has also seen its neighbours, since beams reach
//! far. *Ray*: a straight line from the robot that no obstacle on the map blocks. Its value is the number of unseen blocks
//! that it crosses.

use core::f64::consts::{FRAC_PI_3, TAU};
use std::collections::BTreeSet;

use super::parameters::ROAM;
use crate::coverage::Bounce;
use crate::mapping::{Cell, CellKnowledge};
use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::{Point2, normalize_rad};
use crate::model::reason::Reason;
use crate::navigation::parameters::{CHASSIS, EVASION};
use crate::navigation::{Evasion, Situation, Task, TaskContext, TaskStatus, encounter, enters_forbidden};

/// The drives, and what was seen on all of them.
#[derive(Debug, Default)]
pub(super) struct Roam {
    seen: BTreeSet<(i32, i32)>,
    touched: Vec<Point2>,
    evasion: Option<Evasion>,
    bounce: Option<(Bounce, f64)>,
    straight_m: f64,
    without_news_m: f64,
    short_straights: u32,
}

impl Roam {
    /// Whether an evasion is in progress.
    pub(super) fn is_evading(&self) -> bool {
        self.evasion.is_some()
            || self
                .bounce
                .as_ref()
                .is_some_and(|(bounce, _)| bounce.is_evading())
    }

    /// Somebody else moved the robot.
    pub(super) fn interrupted(&mut self) {
        self.evasion = None;
        self.bounce = None;
    }

    /// Records where the robot is, whoever drives it.
    pub(super) fn note(&mut self, situation: &Situation<'_>) {
        let (x, y) = block(situation.pose.position());
        let mut is_news = false;
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)] {
            is_news |= self.seen.insert((x.saturating_add(dx), y.saturating_add(dy)));
        }
        let driven_m = situation.advance.distance_m.max(0.0);
        self.without_news_m = if is_news {
            0.0
        } else {
            self.without_news_m + driven_m
        };
    }

    pub(super) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        if let Some((bounce, left_s)) = &mut self.bounce {
            *left_s -= situation.advance.time_s;
            let bounces = *left_s > 0.0 && !enters_forbidden(situation);
            if bounces || bounce.is_evading() || !situation.is_free() {
                return bounce.step(situation, context);
            }
            self.bounce = None;
        }
        let evades = self.evasion.is_some();
        match Evasion::pursue(&mut self.evasion, situation) {
            Some(Ok(motion)) => return TaskStatus::Go(motion),
            Some(Err(reason)) => {
                self.interrupted();
                return TaskStatus::Trouble(reason);
            }
            None => {}
        }
        if evades {
            self.straight_m = 0.0;
        }
        self.straight_m += situation.advance.distance_m.max(0.0);
        if let Some(reason) = encounter(situation) {
            return self.turn_from(reason, situation, context);
        }
        if self.without_news_m > ROAM.compare_every_m {
            self.without_news_m = 0.0;
            if let Some(turn_rad) = self.better_direction(situation, context) {
                context.decide(DecisionKind::DockSearchTurn, Reason::DockUnknown, turn_rad);
                self.evasion = Some(Evasion::from_contact(0.0, turn_rad));
                return TaskStatus::Go(Motion::Halt);
            }
        }
        if enters_forbidden(situation) {
            return self.turn_from(Reason::NoGoAhead, situation, context);
        }
        TaskStatus::Go(ahead(situation))
    }

    /// Evades an obstacle, towards most unseen floor.
    fn turn_from(
        &mut self,
        reason: Reason,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> TaskStatus {
        self.remember(reason, situation);
        self.short_straights = if self.straight_m < ROAM.short_m {
            self.short_straights + 1
        } else {
            0
        };
        context.decide(DecisionKind::BackOff, reason, self.straight_m);
        if self.short_straights > ROAM.short_max {
            self.short_straights = 0;
            self.bounce = Some((Bounce::default(), ROAM.bounce_s));
            return TaskStatus::Go(Motion::Halt);
        }
        let away_rad = match reason {
            Reason::BumpLeft | Reason::CliffLeft => -FRAC_PI_3,
            Reason::BumpRight | Reason::CliffRight => FRAC_PI_3,
            _ => 0.0,
        };
        let turn_rad = self.best(situation, context, |turn_rad| {
            let from_obstacle_rad = normalize_rad(turn_rad + away_rad);
            from_obstacle_rad.abs() > ROAM.turn_from_obstacle_min_rad
        });
        let turn_rad = turn_rad.map_or(core::f64::consts::PI, |(turn_rad, _)| turn_rad);
        self.evasion = Some(if situation.at_cliff {
            Evasion::from_cliff(EVASION.cliff_back_m, turn_rad)
        } else {
            Evasion::from_contact(ROAM.contact_back_m, turn_rad)
        });
        TaskStatus::Go(Motion::Halt)
    }

    fn remember(&mut self, reason: Reason, situation: &Situation<'_>) {
        let side = match reason {
            Reason::BumpLeft | Reason::CliffLeft => ROAM.contact_bearing_rad,
            Reason::BumpRight | Reason::CliffRight => -ROAM.contact_bearing_rad,
            _ => 0.0,
        };
        if self.touched.len() >= ROAM.contacts_max {
            self.touched.remove(0);
        }
        let in_base = Point2::in_direction(side, situation.config.body.radius_m);
        self.touched.push(situation.pose.transform(in_base));
    }

    /// A turn to a direction that is worth changing to.
    fn better_direction(&self, situation: &Situation<'_>, context: &mut TaskContext) -> Option<f64> {
        let (turn_rad, news) = self.best(situation, context, |_| true)?;
        let straight = self.news(situation, 0.0);
        (news > straight + ROAM.better_steps).then_some(turn_rad)
    }

    /// The turn to the direction with most unseen floor, among the allowed ones; chance decides between equal ones.
    fn best(
        &self,
        situation: &Situation<'_>,
        context: &mut TaskContext,
        allowed: impl Fn(f64) -> bool,
    ) -> Option<(f64, f64)> {
        (0..ROAM.directions)
            .map(|direction| normalize_rad(TAU * f64::from(direction) / f64::from(ROAM.directions)))
            .filter(|turn_rad| allowed(*turn_rad))
            .map(|turn_rad| {
                (
                    turn_rad,
                    self.news(situation, turn_rad) + context.random.between(0.0, ROAM.tie_steps),
                )
            })
            .max_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Steps of a ray through unseen blocks; free steps through seen blocks count a little.
    fn news(&self, situation: &Situation<'_>, turn_rad: f64) -> f64 {
        let (sin, cos) = libm::sincos(turn_rad);
        let knowledge = situation.map.knowledge();
        let (mut ray_m, mut news) = (ROAM.ray_from_m, 0.0);
        while ray_m < ROAM.ray_max_m {
            let at = situation.pose.transform(Point2 {
                x_m: ray_m * cos,
                y_m: ray_m * sin,
            });
            let bars = matches!(
                knowledge.get(Cell::under(at)),
                Some(CellKnowledge::Occupied | CellKnowledge::Cliff | CellKnowledge::NoGo)
            );
            if bars
                || self
                    .touched
                    .iter()
                    .any(|touched| touched.distance_m(at) < ROAM.contact_radius_m)
            {
                break;
            }
            news += if self.seen.contains(&block(at)) {
                ROAM.seen_step_worth
            } else {
                1.0
            };
            ray_m += ROAM.ray_step_m;
        }
        news
    }
}

fn block(at: Point2) -> (i32, i32) {
    (
        libm::floor(at.x_m / ROAM.block_m) as i32,
        libm::floor(at.y_m / ROAM.block_m) as i32,
    )
}

/// Straight ahead, slower when an obstacle is near.
fn ahead(situation: &Situation<'_>) -> Motion {
    let proximity = &situation.observation.proximity;
    let third = proximity.len() / 3;
    let front = proximity.get(third..proximity.len() - third).unwrap_or_default();
    let cruise_m_per_s = situation.config.speeds.cruise_m_per_s;
    let is_near = front.iter().any(|level| *level > CHASSIS.near_level);
    Motion::Drive {
        speed_m_per_s: if is_near {
            cruise_m_per_s.min(CHASSIS.near_m_per_s)
        } else {
            cruise_m_per_s
        },
        turn_rad_per_s: 0.0,
    }
}
