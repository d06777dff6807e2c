//! Builder of a trap's home TOML.

use core::fmt::Write;

use super::TrapBounds;
use crate::Pcg;
use crate::point::Point;

/// Streams of random numbers for traps begin here.
const STREAM: u64 = 50_000;

/// The things of a trap, and where it ends.
pub(super) struct Sketch {
    random: Pcg,
    things: String,
    pub(super) bounds: TrapBounds,
    start: (Point, f64),
}

impl Sketch {
    pub(super) fn new(seed: u64, kind: u64) -> Self {
        Self {
            random: Pcg::new(seed, STREAM + kind),
            things: String::new(),
            bounds: TrapBounds {
                low: [0.0; 2],
                high: [0.0; 2],
            },
            start: ([0.0; 2], 0.0),
        }
    }

    /// Any number within these borders.
    pub(super) fn number(&mut self, low: f64, high: f64) -> f64 {
        low + self.random.unit() * (high - low)
    }

    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.random.unit() < share
    }

    /// Where the trap ends: the robot's middle must come out of this rectangle.
    pub(super) fn end_at(&mut self, low: Point, high: Point) {
        self.bounds = TrapBounds { low, high };
    }

    pub(super) fn start(&mut self, place: Point, heading_deg: f64) {
        self.start = (place, heading_deg);
    }

    fn line(&mut self, line: &str) {
        // Writing into a string cannot fail.
        writeln!(self.things, "{line}").ok();
    }

    fn table(&mut self, table: &str) {
        self.line(&format!("\n[[{table}]]"));
    }

    fn strip(&mut self, table: &str, ends: [Point; 2]) {
        self.table(table);
        self.line(&format!("from = {}", point(ends[0])));
        self.line(&format!("to = {}", point(ends[1])));
    }

    pub(super) fn solid(&mut self, corners: &[Point]) {
        self.table("furniture");
        self.line(&format!("polygon = {}", points(corners)));
    }

    pub(super) fn block(&mut self, low: Point, high: Point) {
        self.solid(&corners(low, high));
    }

    pub(super) fn legs(&mut self, legs: &[Point], diameter_m: f64) {
        self.table("furniture");
        self.line(&format!("legs = {}", points(legs)));
        self.line(&format!("leg-diameter-m = {diameter_m:.3}"));
    }

    pub(super) fn wall(&mut self, ends: [Point; 2]) {
        self.strip("wall", ends);
    }

    /// A door that is shut and opens at some second, if ever.
    pub(super) fn shut_door(&mut self, ends: [Point; 2], opens_s: Option<f64>) {
        self.strip("door", ends);
        self.line("state = \"closed\"");
        if let Some(at_s) = opens_s {
            self.line(&format!("schedule = [{{ at-s = {at_s:.1}, state = \"open\" }}]"));
        }
    }

    pub(super) fn threshold(&mut self, ends: [Point; 2], width_m: f64, height_m: f64) {
        self.strip("threshold", ends);
        self.line(&format!("width-m = {width_m:.3}\nheight-m = {height_m:.4}"));
    }

    pub(super) fn mirror(&mut self, ends: [Point; 2]) {
        self.strip("mirror", ends);
    }

    /// Force on each wheel, share of the distance lost, degrees of turn for each metre.
    pub(super) fn rug(&mut self, corners: &[Point], [drag_n, slip, bias]: [f64; 3]) {
        self.table("rug");
        self.line(&format!("polygon = {}", points(corners)));
        self.line(&format!(
            "drag-n = {drag_n:.2}\nslip = {slip:.3}\nbias-deg-per-m = {bias:.2}"
        ));
    }

    pub(super) fn black_rug(&mut self, corners: &[Point]) {
        self.table("rug");
        self.line(&format!("polygon = {}\nblack = true", points(corners)));
    }

    pub(super) fn cliff(&mut self, low: Point, high: Point) {
        self.table("cliff");
        self.line(&format!("polygon = {}", points(&corners(low, high))));
    }

    pub(super) fn visitor(&mut self, place: Point, until_s: f64) {
        self.table("visitor");
        self.line(&format!("position = {}", point(place)));
        self.line(&format!(
            "diameter-m = 0.34\nfrom-s = 1.0\nuntil-s = {until_s:.1}"
        ));
    }

    /// The whole text.
    pub(super) fn text(&self, name: &str) -> String {
        let (place, heading_deg) = self.start;
        format!(
            "# A drawn trap. Lengths in metres.\nformat = \"librervac-home\"\nversion = 1\nname = \"Trap {name}\"\n\n\
             [[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n{}\n\
             [start]\nposition = {}\nheading-deg = {heading_deg:.1}\n\n\
             [dock]\nposition = [4.0, 1.5]\nheading-deg = 180.0\n",
            self.things,
            point(place)
        )
    }
}

pub(super) fn corners(low: Point, high: Point) -> [Point; 4] {
    [low, [high[0], low[1]], high, [low[0], high[1]]]
}

fn point([x_m, y_m]: Point) -> String {
    // Without `+ 0.0` a place left of 0 by nothing would be written as -0.
    format!("[{:.3}, {:.3}]", x_m + 0.0, y_m + 0.0)
}

fn points(points: &[Point]) -> String {
    let texts: Vec<String> = points.iter().map(|place| point(*place)).collect();
    format!("[{}]", texts.join(", "))
}
