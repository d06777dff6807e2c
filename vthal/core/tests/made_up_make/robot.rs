//! A simulated pebble in a room of four walls with a hole in the floor: the robot's end of the line of text.

use std::fmt::Write as _;

use super::make::TRACK_M;

/// The robot's body for walls: the circle around its D.
pub(crate) const RADIUS_M: f64 = 0.2;
/// The cliff sensor looks this far ahead of the wheels.
const CLIFF_LEAD_M: f64 = 0.2;

/// The robot and its room. The room's corner is the origin; the hole reaches from `hole_m` on to the wall.
#[derive(Debug)]
pub(crate) struct Robot {
    pub(crate) size_m: [f64; 2],
    pub(crate) hole_m: f64,
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) heading_rad: f64,
    /// Speeds that the wheels were told, mm/s.
    pub(crate) wheels_mm_per_s: [f64; 2],
    /// Whether it obeys the host.
    pub(crate) is_driven: bool,
    pub(crate) is_lifted: bool,
    /// Whether it hears anything.
    pub(crate) hears: bool,
    /// Version of its firmware.
    pub(crate) version: &'static str,
    travelled_mm: [f64; 2],
    bumper: u8,
    line: Vec<u8>,
}

impl Robot {
    /// In a room whose floor ends at `hole_m`.
    pub(crate) fn before_hole(hole_m: f64) -> Self {
        Self {
            hole_m,
            ..Self::new()
        }
    }

    /// In a room without a hole, facing along x.
    pub(crate) fn new() -> Self {
        Self {
            size_m: [3.0, 2.0],
            hole_m: 100.0,
            x_m: 1.0,
            y_m: 1.0,
            heading_rad: 0.0,
            wheels_mm_per_s: [0.0; 2],
            is_driven: false,
            is_lifted: false,
            hears: true,
            version: "1.3",
            travelled_mm: [0.0; 2],
            bumper: 0,
            line: Vec::new(),
        }
    }

    pub(crate) fn stands(&self) -> bool {
        self.wheels_mm_per_s == [0.0; 2]
    }

    pub(crate) fn bumps(&self) -> bool {
        self.bumper != 0
    }

    pub(crate) fn sees_hole(&self) -> bool {
        self.x_m + CLIFF_LEAD_M * self.heading_rad.cos() > self.hole_m
    }

    /// A person frees the bumper.
    pub(crate) const fn free_bumper(&mut self) {
        self.bumper = 0;
    }

    /// Lets a millisecond pass.
    pub(crate) fn pass_ms(&mut self) {
        let [left, right] = self.wheels_mm_per_s.map(|mm_per_s| mm_per_s * 1e-3);
        for (total, way_mm) in self.travelled_mm.iter_mut().zip([left, right]) {
            // Its encoders tell no direction.
            *total += way_mm.abs();
        }
        self.heading_rad += 1e-3 * (right - left) / TRACK_M;
        let way_m = 0.5e-3 * (left + right);
        let (sin, cos) = self.heading_rad.sin_cos();
        let wished = [self.x_m + way_m * cos, self.y_m + way_m * sin];
        let [width_m, depth_m] = self.size_m;
        self.x_m = wished[0].clamp(RADIUS_M, width_m - RADIUS_M);
        self.y_m = wished[1].clamp(RADIUS_M, depth_m - RADIUS_M);
        let push = [wished[0] - self.x_m, wished[1] - self.y_m];
        if way_m != 0.0 {
            self.feel(push, [sin, cos]);
        }
    }

    fn feel(&mut self, push: [f64; 2], [sin, cos]: [f64; 2]) {
        let ahead = push[0] * cos + push[1] * sin;
        let aside = push[1] * cos - push[0] * sin;
        self.bumper = match (ahead > 0.0, aside > 0.2 * ahead, aside < -0.2 * ahead) {
            (false, _, _) => 0,
            (true, true, _) => 1,
            (true, false, true) => 2,
            (true, false, false) => 3,
        };
    }

    /// Takes what the host says and answers.
    pub(crate) fn hear(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut answer = String::new();
        if !self.hears {
            return Vec::new();
        }
        for byte in bytes {
            if *byte == b'\n' {
                let line = std::mem::take(&mut self.line);
                self.obey(&String::from_utf8_lossy(&line), &mut answer);
            } else {
                self.line.push(*byte);
            }
        }
        answer.into_bytes()
    }

    fn obey(&mut self, line: &str, answer: &mut String) {
        let words: Vec<&str> = line.split(' ').collect();
        match words.as_slice() {
            ["who"] => writeln!(answer, "pebble {}", self.version).unwrap_or_default(),
            ["mode", mode] => {
                self.is_driven = *mode == "drive";
                writeln!(answer, "mode {mode}").expect("a string takes everything");
            }
            ["wheels", left, right] if self.is_driven => {
                let speed = |text: &str| text.parse().expect("a number");
                self.wheels_mm_per_s = [speed(left), speed(right)];
            }
            ["sense"] => {
                let [left, right] = self.travelled_mm.map(|mm| mm as u32);
                let (cliff, drop) = (u8::from(self.sees_hole()), 3 * u8::from(self.is_lifted));
                writeln!(answer, "sense {left} {right} {} {cliff} {drop}", self.bumper)
                    .expect("a string takes everything");
            }
            _ => answer.push_str("what\n"),
        }
    }
}
