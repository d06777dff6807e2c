//! Homes drawn from a seed: rooms in a row with doors, furniture, rugs, and stairs.

use std::fmt::Write;

use home::Pcg;

/// The text of a home in the project's own format. The same seed gives the same text.
pub(crate) fn floorplan(seed: u64) -> String {
    let mut draw = RoomDraw {
        random: Pcg::new(seed, STREAM),
        text: format!("format = \"librervac-home\"\nversion = 1\nname = \"drawn-{seed}\"\n"),
    };
    draw.home();
    draw.text
}

const STREAM: u64 = 0x400E;
const DEPTH_MIN_M: f64 = 2.2;
const DEPTH_SPREAD_M: f64 = 1.5;
const WIDTH_MIN_M: f64 = 2.0;
const WIDTH_SPREAD_M: f64 = 2.0;
const DOOR_M: f64 = 0.85;
/// Free floor around the dock, which is in the first room at the left wall.
const DOCK_CLEAR_M: f64 = 1.0;

struct RoomDraw {
    random: Pcg,
    text: String,
}

impl RoomDraw {
    fn home(&mut self) {
        let depth = self.between(DEPTH_MIN_M, DEPTH_MIN_M + DEPTH_SPREAD_M);
        let rooms = 1 + self.random.below(3);
        let mut left = 0.0;
        for room in 0..rooms {
            let right = left + self.between(WIDTH_MIN_M, WIDTH_MIN_M + WIDTH_SPREAD_M);
            self.polygon("room", [left, 0.0, right, depth]);
            if room > 0 {
                self.door(left, depth);
            }
            let first_free = if room == 0 {
                left + DOCK_CLEAR_M
            } else {
                left + 0.5
            };
            self.furniture([first_free, 0.1, right - 0.5, depth - 0.1]);
            left = right;
        }
        if self.random.below(2) == 0 {
            // A stairwell goes down where the last room ends: an open edge over the whole depth.
            self.polygon("cliff", [left, 0.0, left + 1.0, depth]);
        }
        let dock_y = self.between(0.6, depth - 0.6);
        self.push(format_args!(
            "[dock]\nposition = [0.0, {dock_y:.3}]\nheading-deg = 0.0\n"
        ));
    }

    fn door(&mut self, x: f64, depth: f64) {
        let low = self.between(0.2, depth - 0.2 - DOOR_M);
        let high = low + DOOR_M;
        self.push(format_args!(
            "[[wall]]\nfrom = [{x:.3}, 0.0]\nto = [{x:.3}, {low:.3}]\n"
        ));
        self.push(format_args!(
            "[[wall]]\nfrom = [{x:.3}, {high:.3}]\nto = [{x:.3}, {depth:.3}]\n"
        ));
    }

    fn furniture(&mut self, [left, low, right, high]: [f64; 4]) {
        for _ in 0..self.random.below(4) {
            let (x, y) = (self.between(left, right), self.between(low, high));
            match self.random.below(3) {
                0 => self.box_at(x, y, [left, low, right, high]),
                1 => self.legs_at(x, y),
                _ => self.polygon("rug", [x, y, (x + 0.8).min(right), (y + 0.6).min(high)]),
            }
        }
    }

    fn box_at(&mut self, x: f64, y: f64, [_, _, right, high]: [f64; 4]) {
        let (x1, y1) = (
            (x + self.between(0.2, 0.6)).min(right),
            (y + self.between(0.2, 0.5)).min(high),
        );
        self.polygon("furniture", [x, y, x1.max(x + 0.05), y1.max(y + 0.05)]);
    }

    fn legs_at(&mut self, x: f64, y: f64) {
        let span = self.between(0.3, 0.8);
        let (x1, y1) = (x + span, y + span);
        self.push(format_args!(
            "[[furniture]]\nlegs = [[{x:.3}, {y:.3}], [{x1:.3}, {y:.3}], [{x:.3}, {y1:.3}], [{x1:.3}, {y1:.3}]]\nleg-diameter-m = 0.04\n"
        ));
    }

    fn polygon(&mut self, kind: &str, [x0, y0, x1, y1]: [f64; 4]) {
        self.push(format_args!(
            "[[{kind}]]\npolygon = [[{x0:.3}, {y0:.3}], [{x1:.3}, {y0:.3}], [{x1:.3}, {y1:.3}], [{x0:.3}, {y1:.3}]]\n"
        ));
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low).max(0.0) * self.random.unit()
    }

    fn push(&mut self, text: std::fmt::Arguments<'_>) {
        self.text.write_fmt(text).expect("a string takes all text");
    }
}

#[cfg(test)]
mod tests {
    use super::floorplan;
    use home::{Home, RobotModel};

    #[test]
    fn every_drawn_home_can_be_lived_in() {
        let model = RobotModel::by_name("sr8730").unwrap();
        for seed in 0..60 {
            let home = Home::from_floorplan("drawn", &floorplan(seed), &model).unwrap();
            assert!(
                home.reachable_area_m2() > 1.0,
                "seed {seed}: {} m2",
                home.reachable_area_m2()
            );
        }
    }

    #[test]
    fn the_same_seed_draws_the_same_home() {
        assert_eq!(floorplan(7), floorplan(7));
        assert_ne!(floorplan(7), floorplan(8));
    }
}
