//! Sizes and amounts of a home TOML are checked before anything is drawn.

use std::path::Path;

use super::raw::{RawDoor, RawFurniture, RawPlan, RawVisitor, RawWalker};
use crate::load::raster::CORNERS_MAX;
use crate::load::{CELL_MAX_M, HomeError};
use crate::point::Point;

/// Farthest coordinate, metres.
const COORDINATE_MAX_M: f64 = 1_000.0;
/// Most things of one kind.
const THINGS_MAX: usize = 2_000;
/// Most people and pets that walk.
const WALKERS_MAX: usize = 20;
/// Most goals of one of them.
const GOALS_MAX: usize = 32;
/// Most legs of one piece.
const LEGS_MAX: usize = 64;
/// Complains with the file's name.
pub(super) struct Check<'a> {
    pub(super) path: &'a Path,
}

impl Check<'_> {
    pub(super) fn invalid(&self, place: &str, problem: String) -> HomeError {
        HomeError::Invalid {
            path: self.path.to_owned(),
            place: place.to_owned(),
            problem,
        }
    }

    pub(super) fn plan(&self, plan: &RawPlan) -> Result<(), HomeError> {
        if plan.format != "librervac-home" || plan.version != 1 {
            let problem = format!(
                "format `{}` version {} is not known; `librervac-home` version 1 is",
                plan.format, plan.version
            );
            return Err(self.invalid("`format`", problem));
        }
        self.size("`cell-m`", plan.cell_m, 0.01..=CELL_MAX_M)?;
        self.amounts(plan)?;
        for (index, room) in plan.rooms.iter().enumerate() {
            self.polygon(&format!("`room` {}", index + 1), &room.polygon)?;
        }
        for (index, cliff) in plan.cliffs.iter().enumerate() {
            self.polygon(&format!("`cliff` {}", index + 1), &cliff.polygon)?;
        }
        for (index, wall) in plan.walls.iter().enumerate() {
            let place = format!("`wall` {}", index + 1);
            self.points(&place, &[wall.from, wall.to])?;
            self.size(&place, wall.thickness_m, 0.01..=2.0)?;
        }
        for (index, door) in plan.doors.iter().enumerate() {
            self.door(&format!("`door` {}", index + 1), door)?;
        }
        for (index, mirror) in plan.mirrors.iter().enumerate() {
            let place = format!("`mirror` {}", index + 1);
            self.points(&place, &[mirror.from, mirror.to])?;
            self.size(&place, mirror.thickness_m, 0.01..=2.0)?;
        }
        for (index, visitor) in plan.visitors.iter().enumerate() {
            self.visitor(&format!("`visitor` {}", index + 1), visitor)?;
        }
        for (index, walker) in plan.walkers.iter().enumerate() {
            self.walker(&format!("`walker` {}", index + 1), walker)?;
        }
        for (index, piece) in plan.furniture.iter().enumerate() {
            self.piece(&format!("`furniture` {}", index + 1), piece)?;
        }
        self.surfaces(plan)?;
        for (place, pose) in [("`dock`", &plan.dock), ("`start`", &plan.start)] {
            if let Some(pose) = pose {
                self.points(place, &[pose.position])?;
                self.size(place, pose.heading_deg, -360.0..=360.0)?;
            }
        }
        Ok(())
    }

    fn visitor(&self, place: &str, visitor: &RawVisitor) -> Result<(), HomeError> {
        self.points(place, &[visitor.position])?;
        self.size(place, visitor.diameter_m, 0.05..=1.0)?;
        self.size(place, visitor.from_s, 0.0..=1e7)?;
        self.size(place, visitor.until_s, 0.0..=1e7)?;
        if visitor.until_s <= visitor.from_s {
            return Err(self.invalid(place, "it must leave later than it comes".to_owned()));
        }
        Ok(())
    }

    fn walker(&self, place: &str, walker: &RawWalker) -> Result<(), HomeError> {
        if !(2..=GOALS_MAX).contains(&walker.goals.len()) {
            let count = walker.goals.len();
            return Err(self.invalid(place, format!("it needs 2 to {GOALS_MAX} goals, not {count}")));
        }
        self.points(place, &walker.goals)?;
        for second in [walker.rest_s, walker.from_s, walker.until_s] {
            self.size(place, second, 0.0..=1e7)?;
        }
        if walker.until_s <= walker.from_s {
            return Err(self.invalid(place, "it must leave later than it comes".to_owned()));
        }
        Ok(())
    }

    fn amounts(&self, plan: &RawPlan) -> Result<(), HomeError> {
        let counts = [
            ("`room`", plan.rooms.len()),
            ("`wall`", plan.walls.len()),
            ("`door`", plan.doors.len()),
            ("`furniture`", plan.furniture.len()),
            ("`rug`", plan.rugs.len()),
            ("`threshold`", plan.thresholds.len()),
            ("`cliff`", plan.cliffs.len()),
            ("`mirror`", plan.mirrors.len()),
            ("`visitor`", plan.visitors.len()),
        ];
        let limited = counts
            .into_iter()
            .map(|(place, count)| (place, count, THINGS_MAX));
        let walkers = ("`walker`", plan.walkers.len(), WALKERS_MAX);
        match limited.chain([walkers]).find(|(_, count, most)| count > most) {
            Some((place, count, most)) => {
                Err(self.invalid(place, format!("there are {count}, at most {most} are supported")))
            }
            None => Ok(()),
        }
    }

    fn door(&self, place: &str, door: &RawDoor) -> Result<(), HomeError> {
        self.points(place, &[door.from, door.to])?;
        self.size(place, door.thickness_m, 0.01..=2.0)?;
        for event in &door.schedule {
            self.size(place, event.at_s, 0.0..=1e7)?;
        }
        if door.schedule.len() > THINGS_MAX
            || door.schedule.windows(2).any(|pair| pair[0].at_s >= pair[1].at_s)
        {
            return Err(self.invalid(
                place,
                "`schedule` must be short and its `at-s` must rise".to_owned(),
            ));
        }
        Ok(())
    }

    fn piece(&self, place: &str, piece: &RawFurniture) -> Result<(), HomeError> {
        match &piece.polygon {
            Some(polygon) => self.polygon(place, polygon)?,
            None if piece.legs.is_empty() => {
                return Err(self.invalid(place, "it has neither `polygon` nor `legs`".to_owned()));
            }
            None => {}
        }
        if piece.legs.len() > LEGS_MAX {
            return Err(self.invalid(place, format!("it has more than {LEGS_MAX} legs")));
        }
        self.points(place, &piece.legs)?;
        self.size(place, piece.leg_diameter_m, 0.005..=1.0)
    }

    fn surfaces(&self, plan: &RawPlan) -> Result<(), HomeError> {
        for (index, rug) in plan.rugs.iter().enumerate() {
            let place = format!("`rug` {}", index + 1);
            self.polygon(&place, &rug.polygon)?;
            self.size(&place, rug.drag_n, 0.0..=20.0)?;
            self.size(&place, rug.slip, 0.0..=0.5)?;
            self.size(&place, rug.bias_deg_per_m, -45.0..=45.0)?;
        }
        for (index, threshold) in plan.thresholds.iter().enumerate() {
            let place = format!("`threshold` {}", index + 1);
            self.points(&place, &[threshold.from, threshold.to])?;
            self.size(&place, threshold.width_m, 0.005..=1.0)?;
            self.size(&place, threshold.height_m, 0.0..=0.5)?;
        }
        Ok(())
    }

    fn polygon(&self, place: &str, polygon: &[Point]) -> Result<(), HomeError> {
        if !(3..=CORNERS_MAX).contains(&polygon.len()) {
            let problem = format!(
                "a polygon needs 3 to {CORNERS_MAX} corners, not {}",
                polygon.len()
            );
            return Err(self.invalid(place, problem));
        }
        self.points(place, polygon)
    }

    fn points(&self, place: &str, points: &[Point]) -> Result<(), HomeError> {
        let far = |value: &f64| !value.is_finite() || value.abs() > COORDINATE_MAX_M;
        match points.iter().flatten().find(|value| far(value)) {
            Some(value) => Err(self.invalid(
                place,
                format!("the coordinate {value} is not within {COORDINATE_MAX_M} m"),
            )),
            None => Ok(()),
        }
    }

    fn size(&self, place: &str, value: f64, range: core::ops::RangeInclusive<f64>) -> Result<(), HomeError> {
        if range.contains(&value) {
            Ok(())
        } else {
            let (low, high) = (range.start(), range.end());
            Err(self.invalid(place, format!("{value} must lie within {low} to {high}")))
        }
    }
}
